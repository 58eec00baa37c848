#include "api/render/fingerprint.h"
#include "api/render/render.h"
#include "api/statistics.h"

static render_identity identity_of(NephRender *r)
{
    if (!r->fingerprint)
        r->fingerprint = scene_fingerprint(r->scene);
    return (render_identity){(char *)neph_version(), r->fingerprint};
}

GBytes *neph_render_plan_bytes(NephRender *r, GError **error)
{
    const render_identity who = identity_of(r);
    return render_plan_bytes(r->render, &who, error);
}

bool neph_render_take_plan(NephRender *r, GBytes *plan, GError **error)
{
    const render_identity who = identity_of(r);
    return render_take_plan(r->render, &who, plan, error);
}

bool neph_render_pass(NephRender *r, uint32_t index, NephProgressFunc progress,
                      void *data, GError **error)
{
    r->progress = progress;
    r->progress_data = data;
    return render_dealt_pass(r->render, index, progress ? render_forward_progress : NULL,
                             r, error);
}

size_t neph_render_count_sums(const NephRender *r)
{
    return render_count_sums(r->render);
}

void neph_render_get_sums(const NephRender *r, size_t first, size_t n, double *out)
{
    render_get_sums(r->render, first, n, out);
}

void neph_render_add_sums(NephRender *r, size_t first, size_t n, const double *more)
{
    render_add_sums(r->render, first, n, more);
}

void neph_render_add_statistics(NephRender *r, const NephStatistics *more)
{
    render_statistics add = {
        .passes = more->passes,
        .time_trace = more->time_trace,
        .time_build = more->time_build,
        .time_gather = more->time_gather,
        .time_camera = more->time_camera,
        .photon_rays = more->photon_rays,
        .camera_rays = more->camera_rays,
        .shadow_rays = more->shadow_rays,
        .n_not_finite = more->n_not_finite,
    };
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        add.emitted[c] = more->emitted[c];
        add.stored[c] = more->stored[c];
    }
    render_add_statistics(r->render, &add);
}

void neph_render_forget(NephRender *r)
{
    render_forget(r->render);
}

double neph_render_seconds_after(const NephRender *r)
{
    return render_seconds_after(r->render);
}

double neph_render_pass_seconds(NephRender *r)
{
    return render_pass_seconds(r->render);
}

NephSettings *neph_render_settings(const NephRender *r)
{
    NephSettings *out = neph_settings_new();
    out->values = render_settings(r->render);
    return out;
}

char *neph_render_fingerprint(NephRender *r, GError **error)
{
    render_plan plan;
    if (!render_get_plan(r->render, &plan, error))
        return NULL;
    if (!r->fingerprint)
        r->fingerprint = scene_fingerprint(r->scene);
    g_autofree char *digest = render_plan_digest(&plan);
    return g_strdup_printf("%s %s %s", neph_version(), r->fingerprint, digest);
}
