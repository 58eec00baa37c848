#include "render/kept/checkpoint.h"

#include "api/render/fingerprint.h"
#include "api/render/render.h"

static render_identity identity_of(NephRender *r)
{
    if (!r->fingerprint)
        r->fingerprint = scene_fingerprint(r->scene);
    return (render_identity){(char *)neph_version(), r->fingerprint};
}

bool neph_render_save_checkpoint(NephRender *r, const char *path, GError **error)
{
    const render_identity who = identity_of(r);
    return render_save_checkpoint(r->render, &who, path, error);
}

bool neph_render_resume(NephRender *r, const char *path, GError **error)
{
    const render_identity who = identity_of(r);
    return render_resume(r->render, &who, path, error);
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
