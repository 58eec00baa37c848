#include "render/render.h"

#include "base/clock.h"
#include "base/memory.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"
#include "render/film/film_planes.h"
#include "render/footprint.h"
#include "render/pace.h"
#include "render/render_state.h"
#include "render/stop.h"

#include <math.h>
#include <string.h>

render *render_new(const view *v, const settings *how, GError **error)
{
    render *r = g_aligned_alloc0(1, sizeof *r, 64);
    r->plan = transport_plan_of(v, how);
    r->transport = transport_find(how->integrator);
    r->n_threads = (unsigned)r->plan.how.threads;
    r->asked = r->plan.how;
    r->statistics.noise = (double)INFINITY;
    bool open_end = how->passes == 0 && (how->time > 0.0 || how->noise > 0.0);
    r->statistics.passes_wanted = open_end ? 0 : (int64_t)ceil(settings_most_passes(how));
    size_t before = memory_resident() + footprint_begun(how);
    bool open = film_open(&r->film, v, how->denoise, error);
    r->film.coarse = how->denoise_windows == WINDOWS_COARSE;
    if (open && footprint_check(r->beside = before + film_bytes_in_all(&r->film), error))
        return r;
    render_free(r);
    return NULL;
}

void render_free(render *r)
{
    if (!r)
        return;
    film_clear(&r->film);
    render_forget_photons(r);
    transport_plan_clear(&r->plan);
    g_strfreev(r->paths);
    g_free(r->expected);
    g_aligned_free(r);
}

void render_cancel(render *r)
{
    atomic_store(&r->cancel.set, true);
}

/* ---- All passes ---- */

/* Samples a pixel of which lights are still filtered as one: a cell less. */
#define MOST_TOGETHER (SAMPLES_APART - 1.0 / FILM_CELLS)

static void take_pace(render *r, const settings *how, const pace_costs *costs,
                      double left)
{
    double n_pixels = (double)r->film.width * (double)r->film.height;
    r->plan.how = pace_choose(how, costs, n_pixels, left);
    r->expected_pass = pace_pass_seconds(costs, how, &r->plan.how, n_pixels);
}

/* Where lights are filtered as one there is time for more, but no plan to have so much of
   it that they are not. @return the time left */
static double choose_lights(render *r, const settings *how, const pace_costs *costs,
                            double left)
{
    double apart = r->denoising;
    if (!settings_filters_together(&r->plan.how))
        return left;
    r->film.together = true;
    render_tell_denoising(r);
    left += apart - r->denoising;
    take_pace(r, how, costs, left);
    r->plan.how.planned_passes =
        fmin(r->plan.how.planned_passes, MOST_TOGETHER / (double)r->plan.how.spp);
    return left;
}

static void plan_with_noise(render *r, settings *how, const pace_costs *costs,
                            double left)
{
    how->denoise = false;
    how->denoise_windows = r->asked.denoise_windows;
    render_leave_noise(r);
    take_pace(r, how, costs, left);
}

/* Passes that fit into the time left beside denoising, or so much of one as has halves,
   which is rendered anyway; where that would end far too late, the picture is planned as
   one whose noise stays. */
static void choose_pace(render *r, const pace_costs *costs)
{
    settings how = r->asked;
    how.denoise_windows = r->plan.how.denoise_windows; /* as trials chose */
    double left = how.time - render_seconds_after(r) - (clock_seconds() - r->start);
    take_pace(r, &how, costs, left);
    left = choose_lights(r, &how, costs, left);
    const double halves = (double)HALVES_CELLS / FILM_CELLS;
    double late = halves * r->expected_pass - left;
    if (how.denoise && late > fmax(stop_grace(how.time), LATE_DENOISING))
        plan_with_noise(r, &how, costs, left + r->denoising);
    else if (how.denoise)
        r->plan.how.planned_passes = fmax(r->plan.how.planned_passes, halves);
}

/* Where there is little time, passes are made small enough for it. */
static bool set_pace(render *r, GError **error)
{
    const settings *how = &r->asked;
    pace_costs costs;
    if (r->paced || !(how->time > 0.0) || how->passes > 0)
        return true;
    double left = how->time - render_seconds_after(r) - (clock_seconds() - r->start);
    if (!pace_measure(&r->plan, &r->film, left, &r->cancel, &costs, error))
        return false;
    choose_pace(r, &costs);
    return r->paced = true;
}

static uint64_t photons_planned(const render *r)
{
    uint64_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += r->plan.n_photons[c];
    return n;
}

/* Says so where the plan has clearly fewer photons than were asked for. */
static void note_photons(render *r)
{
    const settings *how = &r->asked;
    bool fewer = photons_planned(r) + N_PHOTON_CLASSES < (uint64_t)how->photons;
    if (!r->statistics.short_of_memory)
        r->statistics.photons_wanted =
            fewer && settings_reads(how, settings_find("photons")) ? how->photons : 0;
}

/* A plan that others have too is taken as it is. */
static bool fit_memory(render *r, GError **error)
{
    uint64_t wanted = photons_planned(r);
    if (r->photons)
        return true;
    bool ok = footprint_fit(&r->plan, r->beside, !r->expected, &r->cancel, error);
    r->statistics.short_of_memory = ok && photons_planned(r) < wanted;
    if (r->statistics.short_of_memory)
        r->statistics.photons_wanted = (int64_t)wanted;
    return ok;
}

/* What goes on from a checkpoint must be planned as that was. */
static bool plan_is_expected(const render *r, GError **error)
{
    g_autofree char *found = render_digest(r);
    if (!r->expected || strcmp(r->expected, found) == 0)
        return true;
    error_set(error, ERROR_FAILED,
              "the plan of this render is not that of its checkpoint: another kind of "
              "processor made it, or its photons were others");
    return false;
}

bool render_prepare(render *r, GError **error)
{
    double start = clock_seconds();
    if (r->prepared)
        return true;
    r->prepared = (r->photons ? render_plan_by_file(r, error)
                              : set_pace(r, error) && transport_plan_prepare(
                                                          &r->plan, &r->cancel, error)) &&
                  fit_memory(r, error) && plan_is_expected(r, error);
    if (r->prepared && cancelled(&r->cancel)) { /* what was measured is worth nothing */
        error_set(error, ERROR_CANCELLED, "cancelled");
        r->prepared = false;
    }
    r->first_plan = render_first_plan(&r->plan);
    r->film.lends = r->first_plan.how.spp <= MOST_LENT_SAMPLES;
    r->film.together = settings_filters_together(&r->plan.how);
    r->statistics.time_prepare += clock_seconds() - start;
    note_photons(r);
    return r->prepared;
}

/* Of the next pass, which may be the last. */
static int cells_wanted(const render *r)
{
    double passes = settings_most_passes(&r->plan.how) - (double)r->passes_done;
    return passes < 1.0 ? (int)lrint(passes * FILM_CELLS) : FILM_CELLS;
}

/* The next pass; true also where it was given up for want of time. */
static bool try_pass(render *r, GError **error)
{
    GError *failed = NULL;
    render_set_part(r, 0);
    bool done = render_run_pass(r, r->passes_done, cells_wanted(r), &failed);
    if (r->given_up && (done || g_error_matches(failed, NEPH_ERROR, ERROR_CANCELLED))) {
        g_clear_error(&failed);
        atomic_store(&r->cancel.set, false);
        r->statistics.stopped_by = RENDER_TIME_UP;
        return true;
    }
    if (failed)
        g_propagate_error(error, failed);
    return done;
}

/* Renders until a rule says stop. */
static bool run_passes(render *r, GError **error)
{
    stop_state now = render_state_now(r, 0.0);
    r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
    while (r->statistics.stopped_by == RENDER_GOES_ON) {
        if (!try_pass(r, error))
            return false;
        now = render_state_now(r, r->statistics.part);
        if (r->statistics.stopped_by == RENDER_GOES_ON)
            r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
        render_tell(r, r->statistics.part);
    }
    return true;
}

static void end_run(render *r)
{
    render_statistics *st = &r->statistics;
    r->cancel.progress = NULL;
    st->time_total = clock_seconds() - r->start;
    st->memory_peak = memory_peak();
    st->noise = film_noise(&r->film);
    if (atomic_exchange(&r->cancel.set, false) && st->stopped_by == RENDER_GOES_ON)
        st->stopped_by = RENDER_CANCELLED;
}

void render_start_clock(render *r)
{
    r->start = clock_seconds() - MAX(r->statistics.time_total, r->earlier + r->before);
}

bool render_run(render *r, render_progress progress, void *data, GError **error)
{
    r->progress = progress;
    r->progress_data = data;
    render_start_clock(r);
    r->given_up = false;
    render_time_writing(r);
    r->cancel.progress = render_on_progress;
    r->cancel.progress_data = r;
    r->statistics.stopped_by = RENDER_GOES_ON;
    bool ok = render_prepare(r, error) && run_passes(r, error);
    end_run(r);
    return ok;
}

/* That the picture is made of. */
static double passes_shown(const render *r)
{
    return (double)r->passes_done + r->statistics.part;
}

static void describe(const render *r, image *img)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *key = g_strdup_printf("nephroid:%s", rows[i].name);
        g_autofree char *value = settings_get(&r->plan.how, &rows[i]);
        image_header_set(img, key, value);
    }
    char passes[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_dtostr(passes, sizeof passes, passes_shown(r));
    image_header_set(img, "nephroid:passes_done", passes);
}

image *render_image(const render *r, GError **error)
{
    return render_image_while(r, NULL, error);
}

/* Of a render under way better pictures follow. */
image *render_image_while(const render *r, const cancel_flag *cancel, GError **error)
{
    film shown = r->film;
    bool under_way = r->cancel.progress != NULL;
    shown.coarse |= under_way && r->plan.how.denoise_windows == WINDOWS_AUTO;
    shown.together |= under_way && r->passes_done < 2;
    image *img = film_image(&shown, r->n_threads, cancel, error);
    if (img)
        describe(r, img);
    return img;
}

void render_set_time_around(render *r, double before, const char *const *paths)
{
    r->before = before;
    g_strfreev(r->paths);
    r->paths = g_strdupv((char **)paths);
}

double render_pass_seconds(render *r)
{
    const settings *how = &r->plan.how;
    pace_costs costs;
    double n_pixels = (double)r->film.width * (double)r->film.height;
    double left = how->time - render_seconds_after(r) - (clock_seconds() - r->start);
    if (!(r->expected_pass > 0.0) && how->time > 0.0 &&
        pace_measure(&r->plan, &r->film, left, &r->cancel, &costs, NULL))
        r->expected_pass = pace_pass_seconds(&costs, how, how, n_pixels);
    return r->expected_pass;
}

GStrv render_repeat(const render *r)
{
    settings same = r->plan.how;
    same.passes = passes_shown(r);
    if (!(same.passes > 0.0))
        return NULL;
    same.planned_passes = settings_planned_passes(&r->plan.how);
    g_autoptr(GStrvBuilder) builder = g_strv_builder_new();
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *before = settings_get(&r->asked, &rows[i]);
        g_autofree char *value = settings_get(&same, &rows[i]);
        g_autofree char *pair = g_strconcat(rows[i].name, "=", value, NULL);
        if (strcmp(before, value) != 0 && settings_reads(&same, &rows[i]))
            g_strv_builder_add(builder, pair);
    }
    return g_strv_builder_end(builder);
}

bool render_get_plan(render *r, render_plan *out, GError **error)
{
    if (!r->prepared && r->cancel.progress) /* it is being made */
        return false;
    if (!r->prepared) {
        render_start_clock(r);
        render_time_writing(r);
        if (!render_prepare(r, error))
            return false;
        r->statistics.time_total = clock_seconds() - r->start;
    }
    *out = render_plan_of(&r->plan);
    return true;
}

render_statistics render_get_statistics(const render *r)
{
    return r->statistics;
}

double render_noise(const render *r)
{
    return film_noise(&r->film);
}
