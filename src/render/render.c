#include "render/render.h"

#include "base/clock.h"
#include "base/memory.h"
#include "render/pace.h"
#include "render/render_state.h"
#include "render/stop.h"

#include <string.h>

/* The caller hears of progress no more often than this, s. */
#define PROGRESS_INTERVAL 0.1

/* Of the time given so much goes into finding out how long writing takes, each time. */
#define WRITE_SHARE 0.01

/* Nothing is done before it is. */
#define LARGEST_FRACTION 0.99

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
    if (film_open(&r->film, v, error))
        return r;
    render_free(r);
    return NULL;
}

void render_free(render *r)
{
    if (!r)
        return;
    film_clear(&r->film);
    transport_plan_clear(&r->plan);
    g_strfreev(r->paths);
    g_free(r->expected);
    g_aligned_free(r);
}

void render_cancel(render *r)
{
    atomic_store(&r->cancel.set, true);
}

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

static stop_state state_of(const render *r, double pass_fraction)
{
    return (stop_state){
        .passes = (double)r->passes_done + pass_fraction,
        .elapsed = clock_seconds() - r->start,
        .last_pass = r->last_pass,
        .last_photons = r->photon_share * r->last_pass,
        .noise = r->statistics.noise,
        .after = r->after,
    };
}

static void tell(render *r, double pass_fraction)
{
    stop_state now = state_of(r, pass_fraction);
    r->last_progress = clock_seconds();
    r->statistics.time_total = now.elapsed;
    double fraction = r->statistics.stopped_by == RENDER_GOES_ON
                          ? fmin(stop_fraction(&r->plan.how, &now), LARGEST_FRACTION)
                          : 1.0;
    if (r->progress && !r->progress(fraction, &r->statistics, r->progress_data))
        render_cancel(r);
}

/* A pass that is not done when the time is over is given up, unless there was none: then
   there must be a coarse picture at least. */
static void watch_time(render *r)
{
    stop_state now = state_of(r, 0.0);
    bool has_picture = r->passes_done > 0 || r->film.n_cells > 0;
    if (r->prepared && has_picture && stop_at_once(&r->plan.how, &now)) {
        r->given_up = true;
        render_cancel(r);
    }
}

/* cancel_flag.progress: comes from all parallel work, on the thread that called. */
static void on_progress(void *data)
{
    render *r = data;
    if (r->plan.how.time > 0.0)
        watch_time(r);
    if (r->progress && clock_seconds() - r->last_progress >= PROGRESS_INTERVAL)
        tell(r, r->prepared ? pass_fraction(r) : 0.0);
}

/* ---- One pass ---- */

/* So much of the pass under way is part of the picture. */
static void set_part(render *r, int n_cells)
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

/* How long writing takes is asked at the start, of the first pictures, and again when
   half of the time is over: it depends on what the picture shows and what else the
   machine does. */
static void time_writing(render *r)
{
    double time = r->plan.how.time, elapsed = clock_seconds() - r->start;
    bool is_due = r->passes_done <= 1 || !(r->after > 0.0) ||
                  (elapsed > 0.5 * time && r->timed_at < 0.5 * time);
    if (!(time > 0.0) || !is_due)
        return;
    r->after = pace_write_seconds(&r->film, r->n_threads, r->paths, WRITE_SHARE * time);
    r->timed_at = elapsed;
}

/* Nobody works on the film just now, and of the first pass there is a coarse picture. */
static void tell_coarse(render *r, int n_cells)
{
    set_part(r, n_cells);
    time_writing(r);
    watch_time(r);
    r->statistics.can_look = true;
    tell(r, pass_fraction(r));
    r->statistics.can_look = false;
}

/* How many cells of the pass come next, so that the whole picture can be seen soon and
   the pass ends in time. */
static int next_cells(const render *r, int done, int wanted)
{
    stop_state now = state_of(r, 0.0);
    stop_part part = {.done = done, .wanted = wanted, .is_first = r->passes_done == 0};
    part.cell = done > 0 ? look_seconds(r->look) / done
                         : (now.last_pass - now.last_photons) / FILM_CELLS;
    return stop_next_cells(&r->plan.how, &now, &part);
}

/* The camera looks, at so many cells. @return false: cancelled, but not for want of time
 */
static bool look_on(render *r, int wanted, int *done)
{
    for (int n; (n = next_cells(r, *done, wanted)) > 0; *done += n) {
        if (!look_cells(r->look, *done, *done + n))
            return r->given_up;
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
    film_add_splats(&r->film, &colors, &r->plan.view->filter, r->transport->splats(pass));
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
    time_writing(r);
    if (how->noise > 0.0)
        st->noise = film_noise(&r->film);
}

/* The pass is whole, or what there is of it when it ended early becomes part of the
   picture. */
static void end_pass(render *r, int done, int wanted, double photons_done)
{
    if (done == FILM_CELLS) {
        film_end_pass(&r->film, r->n_threads);
        set_part(r, 0);
        note_pass(r, photons_done);
        return;
    }
    set_part(r, done);
    if (done < wanted)
        r->statistics.stopped_by = RENDER_TIME_UP;
}

/* @param wanted cells */
static bool run_pass(render *r, int wanted, GError **error)
{
    transport_counts counts = {0};
    const transport_plan *plan = r->passes_done == 0 ? &r->first_plan : &r->plan;
    int done = 0;
    r->pass_start = clock_seconds();
    void *pass =
        r->transport->begin_pass(plan, r->passes_done, &r->cancel, &counts, error);
    if (!pass)
        return false;
    double photons_done = clock_seconds() - r->pass_start;
    add_counts(&r->statistics, &counts);
    const look_task task = {plan,           r->transport, pass,
                            r->passes_done, &r->film,     &r->cancel};
    bool ok = look_through(r, &task, wanted, &done, error);
    if (ok)
        add_splats(r, pass);
    r->transport->end_pass(pass);
    if (ok)
        end_pass(r, done, wanted, photons_done);
    return ok;
}

/* ---- All passes ---- */

/* Where there is little time, passes are made small enough for it. */
static bool set_pace(render *r, GError **error)
{
    const settings *how = &r->asked;
    pace_costs costs;
    double n_pixels = (double)r->film.width * (double)r->film.height;
    if (r->paced || !(how->time > 0.0) || how->passes > 0)
        return true;
    double left = how->time - r->after - (clock_seconds() - r->start);
    if (!pace_measure(&r->plan, &r->film, left, &r->cancel, &costs, error))
        return false;
    left = how->time - r->after - (clock_seconds() - r->start);
    r->plan.how = pace_choose(how, &costs, n_pixels, left);
    return r->paced = true;
}

/* Says so where the plan has clearly fewer photons than were asked for. */
static void note_photons(render *r)
{
    const settings *how = &r->asked;
    double planned = 0.0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        planned += (double)r->plan.n_photons[c];
    bool fewer = planned + N_PHOTON_CLASSES < (double)how->photons;
    r->statistics.photons_wanted =
        fewer && settings_reads(how, settings_find("photons")) ? how->photons : 0;
}

/* Of the first pass: with fewer samples, and photons likewise. */
static transport_plan first_plan_of(const transport_plan *plan)
{
    transport_plan first = *plan;
    if (plan->how.first_spp == 0 || plan->how.first_spp >= plan->how.spp)
        return first;
    double share = (double)plan->how.first_spp / (double)plan->how.spp;
    first.how.spp = plan->how.first_spp;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        if (plan->n_photons[c] > 0)
            first.n_photons[c] = MAX((uint64_t)((double)plan->n_photons[c] * share), 1);
    return first;
}

/* What goes on from a checkpoint must be planned as that was. */
static bool plan_is_expected(const render *r, GError **error)
{
    const render_plan plan = render_plan_of(&r->plan);
    g_autofree char *found = render_plan_digest(&plan);
    if (!r->expected || strcmp(r->expected, found) == 0)
        return true;
    error_set(error, ERROR_FAILED,
              "the plan of this render is not that of its checkpoint: another kind of "
              "processor made it");
    return false;
}

static bool prepare(render *r, GError **error)
{
    double start = clock_seconds();
    if (r->prepared)
        return true;
    r->prepared = set_pace(r, error) &&
                  transport_plan_prepare(&r->plan, &r->cancel, error) &&
                  plan_is_expected(r, error);
    if (r->prepared && cancelled(&r->cancel)) { /* what was measured is worth nothing */
        error_set(error, ERROR_CANCELLED, "cancelled");
        r->prepared = false;
    }
    r->first_plan = first_plan_of(&r->plan);
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
    set_part(r, 0);
    bool done = run_pass(r, cells_wanted(r), &failed);
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
    stop_state now = state_of(r, 0.0);
    r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
    while (r->statistics.stopped_by == RENDER_GOES_ON) {
        if (!try_pass(r, error))
            return false;
        now = state_of(r, r->statistics.part);
        if (r->statistics.stopped_by == RENDER_GOES_ON)
            r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
        tell(r, r->statistics.part);
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

/* What was done before, in this process or another, counts. */
static void start_clock(render *r)
{
    r->start = clock_seconds() - MAX(r->statistics.time_total, r->earlier + r->before);
}

bool render_run(render *r, render_progress progress, void *data, GError **error)
{
    r->progress = progress;
    r->progress_data = data;
    start_clock(r);
    r->given_up = false;
    time_writing(r);
    r->cancel.progress = on_progress;
    r->cancel.progress_data = r;
    r->statistics.stopped_by = RENDER_GOES_ON;
    bool ok = prepare(r, error) && run_passes(r, error);
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
    image *img = film_image(&r->film, r->n_threads, error);
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
        start_clock(r);
        if (!prepare(r, error))
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
