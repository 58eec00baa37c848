#include "render/kept/checkpoint.h"

#include "api/asking.h"
#include "api/render/fingerprint.h"
#include "api/render/render.h"
#include "base/wanted.h"

static render_identity identity_of(NephRender *r)
{
    if (!r->fingerprint)
        r->fingerprint = scene_fingerprint(r->scene);
    return (render_identity){(char *)neph_version(), r->fingerprint};
}

/* Ends what was asked whether to go on: who it was that has been stopped is not known,
   and of the scene's files not all may have been read. */
static bool end(NephRender *r, bool done, const cancel_flag *before, GError **error)
{
    bool wanted = done || still_wanted(NULL);
    wanted_by(before);
    if (wanted)
        return done;
    g_clear_pointer(&r->fingerprint, g_free);
    g_clear_error(error);
    error_set(error, ERROR_CANCELLED, "cancelled");
    return false;
}

bool neph_render_save_checkpoint_while(NephRender *r, const char *path,
                                       NephGoOnFunc go_on, void *data, GError **error)
{
    asking a;
    const cancel_flag *before = wanted_by(asking_begin(&a, go_on, data));
    const render_identity who = identity_of(r);
    bool done =
        still_wanted(error) && render_save_checkpoint(r->render, &who, path, error);
    return end(r, done, before, error);
}

bool neph_render_save_checkpoint(NephRender *r, const char *path, GError **error)
{
    return neph_render_save_checkpoint_while(r, path, NULL, NULL, error);
}

bool neph_render_resume_while(NephRender *r, const char *path, NephGoOnFunc go_on,
                              void *data, GError **error)
{
    asking a;
    const cancel_flag *before = wanted_by(asking_begin(&a, go_on, data));
    const render_identity who = identity_of(r);
    bool done = still_wanted(error) && render_resume(r->render, &who, path, error);
    return end(r, done, before, error);
}

bool neph_render_resume(NephRender *r, const char *path, GError **error)
{
    return neph_render_resume_while(r, path, NULL, NULL, error);
}

NephSettings *neph_checkpoint_settings(const char *path, int *width, int *height,
                                       GError **error)
{
    g_auto(checkpoint) c = {0};
    if (!checkpoint_read(&c, NULL, path, error))
        return NULL;
    NephSettings *out = neph_settings_new();
    out->values = c.asked;
    out->values.threads = 0;
    if (width)
        *width = c.width;
    if (height)
        *height = c.height;
    return out;
}
