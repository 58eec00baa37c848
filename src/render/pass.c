/*
 * One pass of a render, whole or in part, and how far it is.
 */
#include "base/clock.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"
#include "render/pace.h"
#include "render/render_state.h"
#include "render/stop.h"

#include <math.h>

/* The caller hears of progress no more often than this, s. */
#define PROGRESS_INTERVAL 0.1

/* Where denoising takes more of the time given than that, fewer windows save more error
   than they make: of a tenth three fifths, for 3 to 6 % of error where passes are few. */
#define COARSE_SHARE 0.1

/* Trials of denoising may take so much of the time given at first, when they decide what
   the picture can be, and so much each time later. */
#define FIRST_TRIALS 0.02
#define LATER_TRIALS 0.01

/* Of the time given so much goes into finding out how long writing takes, each time, */
#define WRITE_SHARE 0.01

/* and of what has passed since so much at most into asking for all that comes after. */
#define TIMING_SHARE 0.05

/* Nothing is done before it is. */
#define LARGEST_FRACTION 0.99

/* ---- How far it is ---- */

/* Share of the pass under way that is done. While photons are on their way, time tells,
   as the last pass spent it. */
static double pass_fraction(const render *r)
{
    if (r->look)
        return r->photon_share + (1.0 - r->photon_share) * look_fraction(r->look);
    if (!(r->last_pass > 0.0))
        return 0.0;
    return fmin((clock_seconds() - r->pass_start) / r->last_pass, r->photon_share);
}

double render_seconds_after(const render *r)
{
    return r->denoising + r->writing;
}

stop_state render_state_now(const render *r, double pass_fraction)
{
    return (stop_state){
        .passes = (double)r->passes_done + pass_fraction,
        .elapsed = clock_seconds() - r->start,
        .last_pass = r->last_pass,
        .last_photons = r->photon_share * r->last_pass,
        .noise = r->statistics.noise,
        .after = render_seconds_after(r),
    };
}

void render_tell(render *r, double pass_fraction)
{
    stop_state now = render_state_now(r, pass_fraction);
    r->last_progress = clock_seconds();
    r->statistics.time_total = now.elapsed;
    double fraction = r->statistics.stopped_by == RENDER_GOES_ON
                          ? fmin(stop_fraction(&r->plan.how, &now), LARGEST_FRACTION)
                          : 1.0;
    if (r->progress && !r->progress(fraction, &r->statistics, r->progress_data))
        atomic_store(&r->cancel.set, true);
}

/* Of the pass under way so many cells are rendered whatever the time: of the first one,
   so that there is a coarse picture, and enough to be denoised. */
static int least_cells(const render *r)
{
    if (r->passes_done > 0)
        return 0;
    return r->film.lends && r->denoising > 0.0 ? HALVES_CELLS : 1;
}

/* A pass that is not done when the time is over is given up. */
static void watch_time(render *r)
{
    stop_state now = render_state_now(r, 0.0);
    bool has_picture = r->film.n_cells >= least_cells(r);
    if (r->prepared && has_picture && stop_at_once(&r->plan.how, &now)) {
        r->given_up = true;
        atomic_store(&r->cancel.set, true);
    }
}

/* cancel_flag.progress: comes from all parallel work, on the thread that called. */
void render_on_progress(void *data)
{
    render *r = data;
    if (r->plan.how.time > 0.0 && !r->is_dealt)
        watch_time(r);
    if (r->progress && clock_seconds() - r->last_progress >= PROGRESS_INTERVAL)
        render_tell(r, r->prepared ? pass_fraction(r) : 0.0);
}

/* ---- One pass ---- */

/* So much of the pass under way is part of the picture. */
void render_set_part(render *r, int n_cells)
{
    r->film.n_cells = n_cells;
    r->statistics.part = (double)n_cells / FILM_CELLS;
}

static void add_counts(render_statistics *st, const transport_counts *counts)
{
    st->time_trace += counts->time_trace;
    st->time_build += counts->time_build;
    st->photon_rays += counts->photon_rays;
    st->n_not_finite += counts->n_not_finite;
    st->memory_photons = MAX(st->memory_photons, counts->memory_photons);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        st->emitted[c] += counts->emitted[c];
        st->stored[c] += counts->stored[c];
        st->radius[c] = counts->radius[c];
    }
}

/* s for a unit of what there is to denoise. */
static double try_windows(render *r, bool coarse)
{
    double share = r->timing > 0.0 ? LATER_TRIALS : FIRST_TRIALS;
    r->film.coarse = coarse;
    return film_denoise_trial(&r->film, r->plan.view, r->n_threads,
                              share * r->plan.how.time);
}

static double denoise_work(const render *r)
{
    return film_denoise_work(&r->film, r->n_threads, r->is_dealt);
}

/* In fewer windows where time is short. Those are tried first, for where even they take
   long all would. */
static double try_denoising(render *r)
{
    settings *how = &r->plan.how;
    if (how->denoise_windows != WINDOWS_AUTO)
        return try_windows(r, r->film.coarse);
    double most = COARSE_SHARE * how->time, coarse = try_windows(r, true);
    bool is_short = coarse * denoise_work(r) <= most;
    double fine = is_short ? try_windows(r, false) : 0.0;
    if (is_short && fine * denoise_work(r) <= most)
        return fine;
    how->denoise_windows = WINDOWS_COARSE;
    r->film.coarse = true;
    return coarse;
}

void render_tell_denoising(render *r)
{
    r->denoising = r->denoise_unit * denoise_work(r);
}

/* Whole passes that there must be to be denoised. */
static uint32_t passes_halved(const render *r)
{
    return r->film.lends ? 1 : 2;
}

/* Whether how long writing and denoising take is to be tried: at the start, and, unless
   that would take much of the time or there is none left, of the first pictures and again
   when half of the time is over, since it depends on what the picture shows and what else
   the machine does. */
static bool trial_is_due(const render *r, double elapsed)
{
    double time = r->plan.how.time;
    if (!(r->timing > 0.0))
        return true;
    bool is_over = elapsed + render_seconds_after(r) > time;
    if (is_over || elapsed - r->timed_at < r->timing / TIMING_SHARE)
        return false;
    return r->passes_done < 1 || r->passes_done == passes_halved(r) ||
           (elapsed > 0.5 * time && r->timed_at < 0.5 * time);
}

/* When it is first seen which lights there are, where, and that there are halves. */
static bool work_is_news(const render *r)
{
    return r->film.n_cells == 1 || r->passes_done == passes_halved(r);
}

void render_leave_noise(render *r)
{
    r->film.no_time = r->statistics.left_noisy = true;
    r->denoising = 0.0;
}

/* How long it takes at least until there is enough to be denoised: as the last cells, or
   as the trial told if they are few, which may have been slow by chance. */
static double seconds_to_halves(const render *r)
{
    int done = r->film.n_cells;
    if (!r->film.lends || !r->look || done == 0)
        return 0.0;
    double told = r->expected_pass / FILM_CELLS;
    bool is_slow = done < HALVES_CELLS / 2 && told > 0.0 && told < r->cell;
    return MAX(HALVES_CELLS - done, 0) * (is_slow ? told : r->cell);
}

/* Noise is left where taking it out would end far too late, by the least that was told so
   far: it saves far more error than passes do in that time, and this picture counted on
   it. */
static void give_up_denoising(render *r)
{
    bool has_some = r->passes_done > 0 || r->film.n_cells > 0;
    if (!has_some || r->passes_done > passes_halved(r) || !(r->denoising > 0.0))
        return;
    stop_state now = render_state_now(r, 0.0);
    now.elapsed += seconds_to_halves(r) - LATE_DENOISING;
    now.after = r->writing + r->least_unit * denoise_work(r);
    if (stop_at_once(&r->plan.how, &now))
        render_leave_noise(r);
}

/* Of a few cells many pixels are alike, and sooner written than those that come. */
static double time_writing(const render *r)
{
    double now = pace_write_seconds(&r->film, r->n_threads, r->paths,
                                    WRITE_SHARE * r->plan.how.time);
    return r->passes_done > 0 ? now : fmax(now, r->writing);
}

/* Trials are so short that what else the machine does may double what one takes: what is
   told is half what they say now and half the least of all so far. */
static void try_writing(render *r, double elapsed)
{
    double unit = try_denoising(r);
    r->writing = time_writing(r);
    r->least_unit = r->timing > 0.0 ? fmin(unit, r->least_unit) : unit;
    r->denoise_unit = 0.5 * (unit + r->least_unit);
    r->timed_at = elapsed;
    r->timing = clock_seconds() - r->start - elapsed;
}

void render_time_writing(render *r)
{
    double elapsed = clock_seconds() - r->start;
    bool is_due = r->plan.how.time > 0.0 && trial_is_due(r, elapsed);
    if (is_due)
        try_writing(r, elapsed);
    if (is_due || (r->timing > 0.0 && work_is_news(r))) {
        render_tell_denoising(r);
        give_up_denoising(r);
    }
}

/* Nobody works on the film just now, and of the first pass there is a coarse picture. */
static void tell_coarse(render *r, int n_cells)
{
    render_set_part(r, n_cells);
    render_time_writing(r);
    watch_time(r);
    r->statistics.can_look = true;
    render_tell(r, pass_fraction(r));
    r->statistics.can_look = false;
}

/* How many cells of the pass come next, so that the whole picture can be seen soon and
   the pass ends in time. */
static int next_cells(const render *r, int done, int wanted)
{
    if (r->is_dealt)
        return wanted - done;
    stop_state now = render_state_now(r, 0.0);
    stop_part part = {.done = done,
                      .wanted = wanted,
                      .least = least_cells(r),
                      .is_first = r->passes_done == 0};
    part.cell = done > 0 ? r->cell : (now.last_pass - now.last_photons) / FILM_CELLS;
    return stop_next_cells(&r->plan.how, &now, &part);
}

/* The camera looks, at so many cells. @return false: cancelled, but not for want of time
 */
static bool look_on(render *r, int wanted, int *done)
{
    for (int n; (n = next_cells(r, *done, wanted)) > 0; *done += n) {
        double before = look_seconds(r->look);
        if (!look_cells(r->look, *done, *done + n))
            return r->given_up;
        r->cell = (look_seconds(r->look) - before) / n;
        if (r->passes_done == 0 && *done + n < wanted)
            tell_coarse(r, *done + n);
    }
    return true;
}

static void add_look(render_statistics *st, double seconds,
                     const transport_counts *counts)
{
    st->camera_rays += counts->camera_rays;
    st->shadow_rays += counts->shadow_rays;
    st->n_not_finite += counts->n_not_finite;
    st->time_camera += seconds;
    st->time_gather += counts->time_gather;
}

static bool look_through(render *r, const look_task *task, int wanted, int *done,
                         GError **error)
{
    transport_counts counts = {0};
    r->look = look_open(task, error);
    if (!r->look)
        return false;
    bool goes_on = look_on(r, wanted, done);
    double seconds = look_seconds(r->look);
    bool well = look_close(g_steal_pointer(&r->look), &counts, error);
    add_look(&r->statistics, seconds, &counts);
    if (well && !goes_on)
        error_set(error, ERROR_CANCELLED, "cancelled");
    return well && goes_on;
}

static void add_splats(render *r, const void *pass)
{
    if (!r->transport->splats)
        return;
    film_pass colors = film_pass_for(&r->film, r->transport->pass_wavelengths(pass));
    film_add_splats(&r->film, &colors, &r->plan.view->filter, r->transport->splats(pass),
                    r->n_threads);
}

static void note_pass(render *r, double photons_done)
{
    render_statistics *st = &r->statistics;
    const settings *how = &r->plan.how;
    double took = clock_seconds() - r->pass_start;
    bool is_small = r->passes_done == 0 && how->first_spp > 0;
    r->photon_share = took > 0.0 ? photons_done / took : 0.0;
    r->last_pass = is_small ? took * (double)how->spp / (double)how->first_spp : took;
    st->passes = ++r->passes_done;
    st->can_look = true;
    render_time_writing(r);
    if (how->noise > 0.0 && !r->is_dealt)
        st->noise = film_noise(&r->film);
}

/* The pass is whole, or what there is of it when it ended early becomes part of the
   picture. */
static void end_pass(render *r, int done, int wanted, double photons_done)
{
    if (done == FILM_CELLS) {
        film_end_pass(&r->film, r->n_threads);
        render_set_part(r, 0);
        note_pass(r, photons_done);
        return;
    }
    render_set_part(r, done);
    if (done < wanted)
        r->statistics.stopped_by = RENDER_TIME_UP;
}

/* @param wanted cells */
bool render_run_pass(render *r, uint32_t index, int wanted, GError **error)
{
    transport_counts counts = {0};
    const transport_plan *plan = index == 0 ? &r->first_plan : &r->plan;
    int done = 0;
    r->pass_start = clock_seconds();
    r->film.index = index;
    void *pass = render_begin_pass(r, plan, index, &counts, error);
    if (!pass)
        return false;
    double photons_done = clock_seconds() - r->pass_start;
    add_counts(&r->statistics, &counts);
    const look_task task = {plan, r->transport, pass, index, &r->film, &r->cancel};
    bool ok = look_through(r, &task, wanted, &done, error);
    if (ok)
        add_splats(r, pass);
    render_end_pass(r, pass);
    if (ok)
        end_pass(r, done, wanted, photons_done);
    return ok;
}
