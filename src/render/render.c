#include "render/render.h"
#include "base/clock.h"

#include "base/memory.h"
#include "render/gbuffer.h"
#include "render/pace.h"
#include "render/stop.h"

#include <string.h>

enum {
    SAMPLES_BETWEEN_PROGRESS = 64,
    TIMED_SHARE = 16, /* one camera sample in so many is timed: the clock is not free */
};

/* The caller hears of progress no more often than this, s. */
#define PROGRESS_INTERVAL 0.1

/* Nothing is done before it is. */
#define LARGEST_FRACTION 0.99

struct render {
    transport_plan plan; /* by settings that may be paced */
    settings asked;
    const transport_kind *transport;
    film film;
    bool paced, prepared;
    bool given_up; /* the pass under way, since the time is over */
    double before; /* see render_set_time_around */
    char **paths;
    double after; /* s that writing to these takes */
    uint32_t passes_done;
    render_statistics statistics;
    cancel_flag cancel;
    unsigned n_threads;

    /* Of the call under way. */
    render_progress progress;
    void *progress_data;
    double start;         /* clock when it would have begun without pauses */
    double last_progress; /* clock */

    /* Of the pass under way: how far it is. */
    double pass_start, last_pass; /* clock; s */
    double photon_share;          /* of the last pass, before the camera looked */
    size_t n_tiles;               /* 0: the camera does not look yet */
    atomic_size_t tiles_done;
};

render *render_new(const view *v, const settings *how, GError **error)
{
    render *r = g_aligned_alloc0(1, sizeof *r, 64);
    r->plan = transport_plan_of(v, how);
    r->transport = transport_find(how->integrator);
    r->n_threads = (unsigned)r->plan.how.threads;
    r->asked = r->plan.how;
    r->statistics.noise = (double)INFINITY;
    bool open_end = how->passes == 0 && (how->time > 0.0 || how->noise > 0.0);
    r->statistics.passes_wanted = open_end ? 0 : settings_most_passes(how);
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
    if (r->n_tiles > 0)
        return r->photon_share + (1.0 - r->photon_share) *
                                     (double)atomic_load(&r->tiles_done) /
                                     (double)r->n_tiles;
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
    bool has_picture = r->passes_done > 0 || r->film.grid > 0;
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

/* Which camera samples of a thread are timed. */
typedef struct sample_clock {
    uint64_t n_samples;
    double time; /* s, of those that were timed */
} sample_clock;

/* The camera's half of a pass, shared by all threads. */
typedef struct camera_loop {
    render *render;
    int step;  /* of every step-th pixel in both directions ... */
    bool fill; /* ... those that are not at every 2 step-th, which are done */
    const void *pass;
    film_pass film_pass;
    uint32_t index;
    int n_tiles_x;
    transport_scratch *scratch; /* one a thread */
    sample_clock *clocks;       /* likewise */
    spectrum *groups; /* 2 n_groups a thread: of a sample, and their sums over a pixel */
} camera_loop;

/* What a pixel gets by light groups. */
typedef struct group_sums {
    size_t n;
    spectrum *sample, *sum; /* NULL if n is 0 */
} group_sums;

/* A thread's, zeroed. */
static group_sums groups_of(const camera_loop *loop, unsigned thread)
{
    size_t n = (size_t)loop->render->film.n_groups;
    if (n == 0)
        return (group_sums){0};
    spectrum *own = loop->groups + 2 * n * thread;
    memset(own, 0, 2 * n * sizeof *own);
    return (group_sums){n, own, own + n};
}

/* What a pixel gets in a pass, groups apart. */
typedef struct pixel_sums {
    film_sum film;
    surface_sum surface;
} pixel_sums;

/* Where in the pixel and on the lens, and when, a sample looks. */
typedef struct pixel_look {
    vec2 offset, u_lens;
    float time, weight;
} pixel_look;

static pixel_look look_at(const view *v, sampler *random)
{
    pixel_look look;
    look.offset = filter_sample(&v->filter, sampler_2d(random), &look.weight);
    look.u_lens = sampler_2d(random);
    look.time = sampler_1d(random);
    if (v->scene->switches.fixed_pixels)
        look = (pixel_look){{0.0f, 0.0f}, {0.5f, 0.5f}, 0.5f, 1.0f};
    return look;
}

/* What a ray from the eye finds. Within a timed sample all gathers are: so their part of
   it is never more than the whole. */
static void find_radiance(camera_loop *loop, const ray *from_eye, sampler *random,
                          unsigned thread, radiance_sample *sample)
{
    transport_scratch *scratch = &loop->scratch[thread];
    sample_clock *clock = &loop->clocks[thread];
    scratch->timed = clock->n_samples++ % TIMED_SHARE == 0;
    double start = scratch->timed ? clock_seconds() : 0.0;
    loop->render->transport->radiance(loop->pass, from_eye, random, scratch, sample);
    if (scratch->timed)
        clock->time += clock_seconds() - start;
}

/* One camera sample of a pixel, random already told which. */
static void render_sample(camera_loop *loop, vec2 pixel, sampler *random, unsigned thread,
                          pixel_sums *sums, const group_sums *groups)
{
    render *r = loop->render;
    const view *v = r->plan.view;
    pixel_look look = look_at(v, random);
    float weight = look.weight;
    vec2 raster = {pixel.x + 0.5f + look.offset.x, pixel.y + 0.5f + look.offset.y};
    ray from_eye = camera_ray(&v->camera, raster, look.u_lens, look.time);
    radiance_sample sample = {.groups = groups->sample};
    for (size_t k = 0; k < groups->n; k++)
        groups->sample[k] = (spectrum){0};
    find_radiance(loop, &from_eye, random, thread, &sample);
    gbuffer_turn(v, from_eye.time, &sample);
    float dimmed = film_add(&sums->film, &loop->film_pass, &sample, weight);
    const gbuffer_sample seen = {raster, look.u_lens, from_eye, weight, dimmed};
    gbuffer_add(&sums->surface, &r->film, v, &loop->film_pass, &seen, &sample);
    for (size_t k = 0; k < groups->n; k++)
        groups->sum[k] += weight * dimmed * groups->sample[k];
}

static void render_pixel(camera_loop *loop, int x, int y, unsigned thread)
{
    render *r = loop->render;
    const settings *how = &r->plan.how;
    uint64_t pixel = (uint64_t)y * (uint64_t)r->plan.view->film.width + (uint64_t)x;
    uint64_t key = hash_mix((uint64_t)how->seed, hash_mix(pixel, 0x7069786cu));
    pixel_sums sums = {0};
    group_sums groups = groups_of(loop, thread);
    for (int64_t i = 0; i < how->spp; i++) {
        if (cancelled(&r->cancel))
            return;
        if (thread == 0 && i % SAMPLES_BETWEEN_PROGRESS == 0)
            on_progress(r);
        sampler random =
            sampler_make(key, loop->index * (uint64_t)how->spp + (uint64_t)i);
        render_sample(loop, (vec2){(float)x, (float)y}, &random, thread, &sums, &groups);
    }
    if (cancelled(&r->cancel)) /* then the last sample is not whole */
        return;
    film_put(&r->film, x, y, &sums.film);
    gbuffer_put(&r->film, x, y, &sums.surface);
    film_put_groups(&r->film, &loop->film_pass, x, y, groups.sum);
}

static void render_tile(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)end;
    camera_loop *loop = data;
    render *r = loop->render;
    const film *f = &r->film;
    int x0 = f->x0 + FILM_TILE * (int)(begin % (size_t)loop->n_tiles_x);
    int y0 = f->y0 + FILM_TILE * (int)(begin / (size_t)loop->n_tiles_x);
    int x1 = MIN(x0 + FILM_TILE, f->x0 + f->width),
        y1 = MIN(y0 + FILM_TILE, f->y0 + f->height);
    int step = loop->step, coarse = 2 * step;
    for (int y = y0; y < y1; y += step) {
        for (int x = x0; x < x1; x += step) {
            bool done = loop->fill && (x - x0) % coarse == 0 && (y - y0) % coarse == 0;
            if (!done)
                render_pixel(loop, x, y, thread);
        }
    }
    if (step == 1)
        atomic_fetch_add(&r->tiles_done, 1);
}

/* @param time s, that the camera looked */
static bool collect(camera_loop *loop, double time, GError **error)
{
    bool failed = false;
    render *r = loop->render;
    render_statistics *st = &r->statistics;
    double timed = 0.0, gathering = 0.0;
    for (unsigned i = 0; i < r->n_threads; i++) {
        const transport_scratch *scratch = &loop->scratch[i];
        st->camera_rays += scratch->camera_rays;
        st->shadow_rays += scratch->shadow_rays;
        st->n_not_finite += scratch->n_not_finite;
        timed += loop->clocks[i].time;
        gathering += scratch->time_gather;
        failed |= scratch->estimate.failed;
    }
    st->time_camera += time;
    if (timed > 0.0)
        st->time_gather += time * (gathering / timed);
    if (failed)
        error_set(error, ERROR_FAILED, "out of memory for radiance estimates");
    return !failed;
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

/* Memory of the threads. */
static bool open_loop(camera_loop *loop, GError **error)
{
    const render *r = loop->render;
    size_t n_groups = (size_t)r->film.n_groups;
    loop->scratch =
        big_alloc(r->n_threads, sizeof *loop->scratch, "thread scratch", error);
    loop->clocks = g_new0(sample_clock, r->n_threads);
    bool ok = loop->scratch != NULL;
    for (unsigned i = 0; i < r->n_threads && ok; i++)
        ok = transport_scratch_init(&loop->scratch[i], n_groups, error);
    if (ok && n_groups > 0) {
        loop->groups = big_alloc(2 * n_groups * r->n_threads, sizeof *loop->groups,
                                 "light groups", error);
        ok = loop->groups != NULL;
    }
    return ok;
}

static void close_loop(camera_loop *loop)
{
    for (unsigned i = 0; i < loop->render->n_threads && loop->scratch; i++)
        transport_scratch_clear(&loop->scratch[i]);
    big_free(loop->scratch);
    big_free(loop->groups);
    g_free(loop->clocks);
}

/* Nobody works on the film just now, and of the first pass there is a coarse picture. */
static void tell_coarse(render *r)
{
    watch_time(r);
    r->statistics.can_look = true;
    tell(r, pass_fraction(r));
    r->statistics.can_look = false;
}

/* Renders all pixels; in the first pass every eighth comes first, then the fourth and so
   on, so that the whole picture can be seen soon. */
static bool render_tiles(camera_loop *loop)
{
    render *r = loop->render;
    const int first_step = r->passes_done == 0 ? FILM_COARSE : 1;
    bool done = true;
    for (loop->step = first_step; loop->step >= 1 && done; loop->step /= 2) {
        loop->fill = loop->step < first_step;
        atomic_store(&r->tiles_done, 0);
        done = parallel_for(r->n_tiles, 1, r->n_threads, &r->cancel, render_tile, loop);
        if (done && r->passes_done == 0)
            r->film.grid = r->statistics.grid = loop->step;
        if (done && loop->step > 1)
            tell_coarse(r);
    }
    return done;
}

static bool look(render *r, const void *pass, GError **error)
{
    const film *f = &r->film;
    camera_loop loop = {
        .render = r,
        .pass = pass,
        .film_pass = film_pass_for(&r->film, r->transport->pass_wavelengths(pass)),
        .index = r->passes_done,
        .n_tiles_x = (f->width + FILM_TILE - 1) / FILM_TILE,
    };
    bool ready = open_loop(&loop, error);
    double start = clock_seconds();
    r->n_tiles =
        (size_t)loop.n_tiles_x * (size_t)((f->height + FILM_TILE - 1) / FILM_TILE);
    bool done = ready && render_tiles(&loop);
    r->n_tiles = 0;
    bool collected = ready && collect(&loop, clock_seconds() - start, error);
    close_loop(&loop);
    if (collected && !done)
        error_set(error, ERROR_CANCELLED, "cancelled");
    return collected && done;
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
    double now = clock_seconds();
    r->last_pass = now - r->pass_start;
    r->photon_share = r->last_pass > 0.0 ? photons_done / r->last_pass : 0.0;
    st->passes = ++r->passes_done;
    st->can_look = true;
    if (r->plan.how.time > 0.0 && r->passes_done == 1)
        r->after = pace_write_seconds(&r->film, r->n_threads, r->paths);
    if (r->plan.how.noise > 0.0)
        st->noise = film_noise(&r->film);
}

static bool run_pass(render *r, GError **error)
{
    transport_counts counts = {0};
    r->pass_start = clock_seconds();
    void *pass =
        r->transport->begin_pass(&r->plan, r->passes_done, &r->cancel, &counts, error);
    if (!pass)
        return false;
    double photons_done = clock_seconds() - r->pass_start;
    add_counts(&r->statistics, &counts);
    bool ok = look(r, pass, error);
    if (ok)
        add_splats(r, pass);
    r->transport->end_pass(pass);
    if (!ok)
        return false;
    film_end_pass(&r->film, r->n_threads);
    note_pass(r, photons_done);
    return true;
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

static bool prepare(render *r, GError **error)
{
    double start = clock_seconds();
    if (r->prepared)
        return true;
    r->prepared =
        set_pace(r, error) && transport_plan_prepare(&r->plan, &r->cancel, error);
    if (r->prepared && cancelled(&r->cancel)) { /* what was measured is worth nothing */
        error_set(error, ERROR_CANCELLED, "cancelled");
        r->prepared = false;
    }
    r->statistics.time_prepare += clock_seconds() - start;
    note_photons(r);
    return r->prepared;
}

/* The next pass; true also where it was given up for want of time. */
static bool try_pass(render *r, GError **error)
{
    GError *failed = NULL;
    r->film.grid = r->statistics.grid = 0;
    if (run_pass(r, &failed))
        return true;
    if (r->given_up && g_error_matches(failed, NEPH_ERROR, ERROR_CANCELLED)) {
        g_clear_error(&failed);
        atomic_store(&r->cancel.set, false);
        r->statistics.stopped_by = RENDER_TIME_UP;
        return true;
    }
    g_propagate_error(error, failed);
    return false;
}

/* Renders until a rule says stop. */
static bool run_passes(render *r, GError **error)
{
    stop_state now = state_of(r, 0.0);
    r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
    while (r->statistics.stopped_by == RENDER_GOES_ON) {
        if (!try_pass(r, error))
            return false;
        now = state_of(r, 0.0);
        if (r->statistics.stopped_by == RENDER_GOES_ON)
            r->statistics.stopped_by = stop_decide(&r->plan.how, &now);
        tell(r, 0.0);
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

bool render_run(render *r, render_progress progress, void *data, GError **error)
{
    r->progress = progress;
    r->progress_data = data;
    r->start = clock_seconds() - MAX(r->statistics.time_total, r->before);
    r->given_up = false;
    if (r->plan.how.time > 0.0)
        r->after = pace_write_seconds(&r->film, r->n_threads, r->paths);
    r->cancel.progress = on_progress;
    r->cancel.progress_data = r;
    r->statistics.stopped_by = RENDER_GOES_ON;
    bool ok = prepare(r, error) && run_passes(r, error);
    end_run(r);
    return ok;
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
    g_autofree char *passes = g_strdup_printf("%u", r->passes_done);
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
    if (r->passes_done == 0)
        return NULL;
    settings same = r->plan.how;
    same.passes = r->passes_done;
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
        r->start = clock_seconds() - MAX(r->statistics.time_total, r->before);
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
