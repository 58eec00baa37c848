#include "render/kept/photon_file.h"

#include "api/asking.h"
#include "api/render/fingerprint.h"
#include "api/render/render.h"
#include "api/statistics.h"

bool neph_photons_save(const NephScene *s, const NephSettings *how, const char *path,
                       const NephSaveOptions *options, GError **error)
{
    asking a;
    g_autofree char *world = world_fingerprint(s);
    const render_identity who = {(char *)neph_version(), world};
    const photon_file_order order = {
        .view = s->view,
        .how = &how->values,
        .who = &who,
        .n_passes = MAX(options->passes, 1),
        .cancel = asking_begin(&a, options->go_on, options->go_on_data)};
    render_statistics statistics = {0};
    if (order.n_passes > G_MAXINT32) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "passes: expected at most %d, found %" G_GINT64_FORMAT, G_MAXINT32,
                    order.n_passes);
        return false;
    }
    bool done = photon_file_write(&order, path, &statistics, error);
    if (options->statistics)
        *options->statistics = statistics_export(&statistics);
    return done;
}

bool neph_render_use_photons(NephRender *r, const char *path, GError **error)
{
    g_autofree char *world = world_fingerprint(r->scene);
    const render_identity who = {(char *)neph_version(), world};
    return render_use_photons(r->render, &who, path, error);
}

NephSettings *neph_photons_settings(const char *path, int64_t *passes, GError **error)
{
    g_autoptr(photon_file) file = photon_file_open(path, error);
    if (!file)
        return NULL;
    NephSettings *out = neph_settings_new();
    out->values = photon_file_settings(file);
    out->values.threads = 0;
    if (passes)
        *passes = photon_file_passes(file);
    return out;
}
