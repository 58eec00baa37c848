#include "api/asking.h"
#include "api/objects.h"

#include "api/render/render.h"
#include "api/statistics.h"

_Static_assert(NEPH_MOST_PLAN_TRIALS == (int)MOST_PLAN_TRIALS, "lists are as long");
_Static_assert(NEPH_GOES_ON == (int)RENDER_GOES_ON, "reasons are one list");
_Static_assert(NEPH_PASSES_DONE == (int)RENDER_PASSES_DONE, "reasons are one list");
_Static_assert(NEPH_TIME_UP == (int)RENDER_TIME_UP, "reasons are one list");
_Static_assert(NEPH_NOISE_REACHED == (int)RENDER_NOISE_REACHED, "reasons are one list");
_Static_assert(NEPH_CANCELLED == (int)RENDER_CANCELLED, "reasons are one list");

NephStatistics statistics_export(const render_statistics *from)
{
    NephStatistics out = {.passes = from->passes,
                          .passes_wanted = from->passes_wanted,
                          .time_total = from->time_total,
                          .time_prepare = from->time_prepare,
                          .time_trace = from->time_trace,
                          .time_build = from->time_build,
                          .time_gather = from->time_gather,
                          .time_camera = from->time_camera,
                          .photon_rays = from->photon_rays,
                          .camera_rays = from->camera_rays,
                          .shadow_rays = from->shadow_rays,
                          .memory_peak = from->memory_peak,
                          .memory_photons = from->memory_photons,
                          .n_not_finite = from->n_not_finite,
                          .noise = from->noise,
                          .photons_wanted = from->photons_wanted,
                          .short_of_memory = from->short_of_memory,
                          .left_noisy = from->left_noisy,
                          .can_look = from->can_look,
                          .part = from->part,
                          .stopped_by = (NephStop)from->stopped_by};
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        out.emitted[c] = from->emitted[c];
        out.stored[c] = from->stored[c];
        out.radius[c] = from->radius[c];
    }
    return out;
}

NephRender *neph_render_new(const NephScene *s, const NephSettings *how, GError **error)
{
    render *made = render_new(s->view, &how->values, error);
    if (!made)
        return NULL;
    NephRender *r = g_new0(NephRender, 1);
    r->render = made;
    r->scene = s;
    return r;
}

void neph_render_free(NephRender *r)
{
    if (!r)
        return;
    render_free(r->render);
    g_free(r->fingerprint);
    g_free(r);
}

bool render_forward_progress(double fraction, const render_statistics *so_far, void *data)
{
    const NephRender *r = data;
    const NephStatistics statistics = statistics_export(so_far);
    return r->progress(fraction, &statistics, r->progress_data);
}

bool neph_render_run(NephRender *r, NephProgressFunc progress, void *data, GError **error)
{
    r->progress = progress;
    r->progress_data = data;
    return render_run(r->render, progress ? render_forward_progress : NULL, r, error);
}

void neph_render_cancel(NephRender *r)
{
    render_cancel(r->render);
}

NephImage *neph_render_image(const NephRender *r, GError **error)
{
    return neph_image_wrap(render_image(r->render, error));
}

NephImage *neph_render_image_while(const NephRender *r, NephGoOnFunc go_on, void *data,
                                   GError **error)
{
    asking a;
    return neph_image_wrap(
        render_image_while(r->render, asking_begin(&a, go_on, data), error));
}

void neph_render_statistics(const NephRender *r, NephStatistics *out)
{
    const render_statistics now = render_get_statistics(r->render);
    *out = statistics_export(&now);
}

static NephPlan plan_export(const render_plan *from)
{
    NephPlan out = {.integrator = transport_find((int)from->integrator)->name,
                    .radius_is_set = from->radius_is_set,
                    .discs = from->discs,
                    .spots = from->p_spots,
                    .blurred_gathers = from->p_blurred,
                    .time_slices = from->time_slices,
                    .work = from->work,
                    .planning = from->planning,
                    .n_trials = from->n_trials};
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        out.photons[c] = from->photons[c];
        out.radius[c] = from->radius[c];
        out.guided |= out.guided_classes[c] = from->guided[c];
    }
    for (int i = 0; i < from->n_trials; i++) {
        const plan_trial *t = &from->trials[i];
        out.trials[i] =
            (NephPlanTrial){t->what,          t->without.variance, t->without.rays,
                            t->with.variance, t->with.rays,        t->taken};
    }
    return out;
}

bool neph_render_plan(NephRender *r, NephPlan *out, GError **error)
{
    render_plan plan;
    if (!render_get_plan(r->render, &plan, error))
        return false;
    *out = plan_export(&plan);
    return true;
}

double neph_render_noise(const NephRender *r)
{
    return render_noise(r->render);
}

void neph_render_set_time_around(NephRender *r, double before, const char *const *paths)
{
    render_set_time_around(r->render, before, paths);
}

char **neph_render_repeat(const NephRender *r)
{
    return render_repeat(r->render);
}
