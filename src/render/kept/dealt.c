/*
 * Passes that are dealt out to many processes: each renders those that it is told, and
 * their sums are joined by who tells. Passes are functions of their number, so the
 * picture is the same whoever renders which, but for the order in which sums are rounded.
 */
#include "base/clock.h"
#include "base/memory.h"
#include "render/film/film_planes.h"
#include "render/render_state.h"

bool render_dealt_pass(render *r, uint32_t index, render_progress progress, void *data,
                       GError **error)
{
    if (!r->is_dealt)
        render_start_clock(r);
    r->is_dealt = r->paced = true;
    r->progress = progress;
    r->progress_data = data;
    r->cancel.progress = render_on_progress;
    r->cancel.progress_data = r;
    bool done = render_prepare(r, error) && render_run_pass(r, index, FILM_CELLS, error);
    r->cancel.progress = NULL;
    r->statistics.time_total = clock_seconds() - r->start;
    r->statistics.memory_peak = memory_peak();
    atomic_store(&r->cancel.set, false);
    return done;
}

size_t render_count_sums(const render *r)
{
    return film_count_sums(&r->film);
}

void render_get_sums(const render *r, size_t first, size_t n, double *out)
{
    film_get_sums(&r->film, first, n, out);
}

void render_add_sums(render *r, size_t first, size_t n, const double *more)
{
    film_add_sums(&r->film, first, n, more);
}

void render_add_statistics(render *r, const render_statistics *more)
{
    render_statistics *st = &r->statistics;
    st->time_trace += more->time_trace;
    st->time_build += more->time_build;
    st->time_gather += more->time_gather;
    st->time_camera += more->time_camera;
    st->photon_rays += more->photon_rays;
    st->camera_rays += more->camera_rays;
    st->shadow_rays += more->shadow_rays;
    st->n_not_finite += more->n_not_finite;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        st->emitted[c] += more->emitted[c];
        st->stored[c] += more->stored[c];
    }
    st->passes += more->passes;
    r->passes_done += (uint32_t)more->passes;
    r->film.n_passes += more->passes;
    st->can_look |= more->passes > 0;
    st->noise = film_noise(&r->film);
}

void render_forget(render *r)
{
    int64_t wanted = r->statistics.passes_wanted;
    film_reset(&r->film);
    r->statistics =
        (render_statistics){.passes_wanted = wanted, .noise = (double)INFINITY};
    r->passes_done = 0;
}

settings render_settings(const render *r)
{
    return r->plan.how;
}
