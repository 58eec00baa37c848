#include "render/render.h"

#include "base/memory.h"
#include "render/film.h"
#include "transport/transport.h"

enum { TILE = 16 };

struct render {
    transport_plan plan;
    const transport_kind *transport;
    film film;
    uint32_t passes_done;
    render_statistics statistics;
    cancel_flag cancel;
    unsigned n_threads;
};

static double seconds(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}

render *render_new(const scene *s, const settings *how, GError **error)
{
    render *r = g_aligned_alloc0(1, sizeof *r, 64);
    r->plan.scene = s;
    r->plan.how = *how;
    r->transport = transport_find(how->integrator);
    r->n_threads = parallel_threads((unsigned)how->threads);
    r->plan.how.threads = r->n_threads;
    double start = seconds();
    if (!film_open(&r->film, s, error) ||
        !r->transport->prepare(&r->plan, &r->cancel, error)) {
        render_free(r);
        return NULL;
    }
    r->statistics.time_prepare = seconds() - start;
    r->statistics.time_total = r->statistics.time_prepare;
    return r;
}

void render_free(render *r)
{
    if (!r)
        return;
    film_clear(&r->film);
    transport_plan_clear(&r->plan);
    g_aligned_free(r);
}

void render_cancel(render *r)
{
    atomic_store(&r->cancel.set, true);
}

/* ---- One pass ---- */

/* The camera's half of a pass, shared by all threads. */
typedef struct camera_loop {
    render *render;
    const void *pass;
    film_pass film_pass;
    uint32_t index;
    int n_tiles_x;
    size_t n_tiles;
    atomic_size_t tiles_done;
    transport_scratch *scratch; /* one a thread */
    render_progress progress;
    void *progress_data;
    double last_progress; /* only the calling thread's */
} camera_loop;

static void render_pixel(camera_loop *loop, int x, int y, transport_scratch *scratch)
{
    render *r = loop->render;
    const scene *s = r->plan.scene;
    const settings *how = &r->plan.how;
    uint64_t pixel = (uint64_t)y * (uint64_t)s->film.width + (uint64_t)x;
    uint64_t key = hash_mix((uint64_t)how->seed, hash_mix(pixel, 0x7069786cu));
    for (int64_t i = 0; i < how->spp; i++) {
        sampler random =
            sampler_make(key, loop->index * (uint64_t)how->spp + (uint64_t)i);
        float weight;
        vec2 offset = filter_sample(&s->filter, sampler_2d(&random), &weight);
        vec2 raster = {(float)x + 0.5f + offset.x, (float)y + 0.5f + offset.y};
        vec2 u_lens = sampler_2d(&random);
        ray from_eye = camera_ray(&s->camera, raster, u_lens, sampler_1d(&random));
        radiance_sample sample;
        r->transport->radiance(loop->pass, &from_eye, &random, scratch, &sample);
        film_add(&r->film, &loop->film_pass, x, y, &sample, weight);
    }
}

static double fraction_done(const camera_loop *loop)
{
    double in_pass = (double)atomic_load(&loop->tiles_done) / (double)loop->n_tiles;
    return ((double)loop->index + in_pass) / (double)loop->render->plan.how.passes;
}

/* Tells the caller now and then; only on the thread that called render_run. */
static void tell_progress(camera_loop *loop, unsigned thread)
{
    double now = thread == 0 ? seconds() : 0.0;
    if (thread != 0 || !loop->progress || now - loop->last_progress < 0.1)
        return;
    loop->last_progress = now;
    if (!loop->progress(fraction_done(loop), &loop->render->statistics,
                        loop->progress_data))
        render_cancel(loop->render);
}

static void render_tile(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)end;
    camera_loop *loop = data;
    const film *f = &loop->render->film;
    int x0 = f->x0 + TILE * (int)(begin % (size_t)loop->n_tiles_x);
    int y0 = f->y0 + TILE * (int)(begin / (size_t)loop->n_tiles_x);
    int x1 = MIN(x0 + TILE, f->x0 + f->width), y1 = MIN(y0 + TILE, f->y0 + f->height);
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++)
            render_pixel(loop, x, y, &loop->scratch[thread]);
    }
    atomic_fetch_add(&loop->tiles_done, 1);
    tell_progress(loop, thread);
}

static bool collect(render *r, transport_scratch *scratch, GError **error)
{
    bool failed = false;
    render_statistics *st = &r->statistics;
    for (unsigned i = 0; i < r->n_threads; i++) {
        st->camera_rays += scratch[i].camera_rays;
        st->shadow_rays += scratch[i].shadow_rays;
        st->n_not_finite += scratch[i].n_not_finite;
        st->time_gather += scratch[i].time_gather / r->n_threads;
        failed |= scratch[i].estimate.failed;
        estimate_scratch_clear(&scratch[i].estimate);
    }
    big_free(scratch);
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

static bool look(render *r, const void *pass, uint32_t index, render_progress progress,
                 void *data, GError **error)
{
    const film *f = &r->film;
    camera_loop loop = {
        .render = r,
        .pass = pass,
        .film_pass = film_pass_for(r->transport->pass_wavelengths(pass)),
        .index = index,
        .n_tiles_x = (f->width + TILE - 1) / TILE,
        .progress = progress,
        .progress_data = data,
    };
    loop.n_tiles = (size_t)loop.n_tiles_x * (size_t)((f->height + TILE - 1) / TILE);
    loop.scratch = big_alloc(r->n_threads, sizeof *loop.scratch, "thread scratch", error);
    if (!loop.scratch)
        return false;
    double start = seconds();
    bool done =
        parallel_for(loop.n_tiles, 1, r->n_threads, &r->cancel, render_tile, &loop);
    r->statistics.time_camera += seconds() - start;
    if (!collect(r, loop.scratch, error))
        return false;
    if (!done)
        error_set(error, ERROR_CANCELLED, "cancelled");
    return done;
}

static bool run_pass(render *r, uint32_t index, render_progress progress, void *data,
                     GError **error)
{
    transport_counts counts = {0};
    void *pass = r->transport->begin_pass(&r->plan, index, &r->cancel, &counts, error);
    if (!pass)
        return false;
    add_counts(&r->statistics, &counts);
    bool ok = look(r, pass, index, progress, data, error);
    r->transport->end_pass(pass);
    return ok;
}

bool render_run(render *r, render_progress progress, void *data, GError **error)
{
    while (r->passes_done < r->plan.how.passes) {
        double start = seconds();
        bool ok = run_pass(r, r->passes_done, progress, data, error);
        r->statistics.time_total += seconds() - start;
        r->statistics.memory_peak = memory_peak();
        if (!ok)
            return false;
        r->statistics.passes = ++r->passes_done;
        double fraction = (double)r->passes_done / (double)r->plan.how.passes;
        if (progress && !progress(fraction, &r->statistics, data))
            render_cancel(r);
    }
    return true;
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
    image *img = film_image(&r->film, error);
    if (img)
        describe(r, img);
    return img;
}

render_statistics render_get_statistics(const render *r)
{
    return r->statistics;
}
