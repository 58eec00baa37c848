/*
 * Tracing: photons and camera paths in the Cornell box, on one thread, against Embree
 * alone on the very same rays. What the house adds to a ray (the hit's geometry, the
 * BSDF, random numbers, the store) is what is seen here; seconds are the thread's own, so
 * that a busy machine disturbs little, and the two are timed in turns.
 *
 *   bench_trace [photons, default 100000]
 */
#include "format/format.h"
#include "photon/trace/trace.h"
#include "render/render.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { ROUNDS = 5 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void give_up(const char *what)
{
    fprintf(stderr, "bench_trace: %s\n", what);
    exit(3);
}

/* ---- Embree alone ---- */

typedef struct bare {
    RTCDevice device;
    RTCScene scene;
} bare;

static bare bare_new(const scene *s)
{
    bare b = {.device = rtcNewDevice("threads=1,set_affinity=0")};
    b.scene = rtcNewScene(b.device);
    rtcSetSceneFlags(b.scene, RTC_SCENE_FLAG_ROBUST);
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *on = s->shapes->pdata[i];
        if (!on->kind->triangles)
            give_up("the scene must be of triangles");
        const mesh *m = on->kind->triangles(on->self);
        RTCGeometry g = rtcNewGeometry(b.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   m->positions, 0, 3 * sizeof(float), m->n_vertices);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   m->indices, 0, 3 * sizeof(uint32_t), m->n_triangles);
        rtcCommitGeometry(g);
        rtcAttachGeometry(b.scene, g);
        rtcReleaseGeometry(g);
    }
    rtcCommitScene(b.scene);
    return b;
}

static void bare_free(bare *b)
{
    rtcReleaseScene(b->scene);
    rtcReleaseDevice(b->device);
}

static double bare_time(const bare *b, const GArray *rays)
{
    double start = seconds();
    for (guint i = 0; i < rays->len; i++) {
        const ray *r = &g_array_index(rays, ray, i);
        struct RTCRayHit query = {
            .ray = {.org_x = r->origin[0],
                    .org_y = r->origin[1],
                    .org_z = r->origin[2],
                    .tnear = FLT_MIN,
                    .dir_x = r->direction[0],
                    .dir_y = r->direction[1],
                    .dir_z = r->direction[2],
                    .tfar = r->t_max,
                    .mask = ~0u},
            .hit = {.geomID = RTC_INVALID_GEOMETRY_ID},
        };
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(b->scene, &query, NULL);
#else
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(b->scene, &context, &query);
#endif
    }
    return seconds() - start;
}

static double intersect_time(const scene *s, const GArray *rays)
{
    double start = seconds();
    for (guint i = 0; i < rays->len; i++) {
        surface_hit hit;
        scene_intersect(s, &g_array_index(rays, ray, i), &hit);
    }
    return seconds() - start;
}

/* ---- Photons ---- */

/* Every ray that photons travel, as their story tells it. */
static void note_ray(const photon_event *event, void *data)
{
    ray r = {event->p, event->direction, INFINITY, 0.0f, {{0}, 0}};
    if (event->kind == PHOTON_SCATTERED)
        r = hit_ray(event->hit, event->direction);
    else if (event->kind != PHOTON_EMITTED)
        return;
    g_array_append_val((GArray *)data, r);
}

static double trace_time(const trace_task *task)
{
    trace_result result;
    double start = seconds();
    if (!photon_trace(task, false, &result, NULL))
        give_up("the photons can not be traced");
    double time = seconds() - start;
    trace_result_clear(&result);
    return time;
}

static void bench_photons(const scene *s, uint64_t n)
{
    trace_task task = {.scene = s,
                       .how = &s->settings,
                       .w = wavelengths_for_pass(1, 0),
                       .photon_class = PHOTON_INDIRECT,
                       .n_photons = n};
    g_autoptr(GArray) rays = g_array_new(FALSE, FALSE, sizeof(ray));
    for (uint64_t i = 0; i < n; i++)
        photon_tell(&task, i, note_ray, rays);
    bare b = bare_new(s);
    double embree = HUGE_VAL, ours = HUGE_VAL, trace = HUGE_VAL;
    for (int round = 0; round < ROUNDS; round++) {
        embree = MIN(embree, bare_time(&b, rays));
        ours = MIN(ours, intersect_time(s, rays));
        trace = MIN(trace, trace_time(&task));
    }
    bare_free(&b);
    double million = 1e-6 * (double)rays->len;
    printf("%u rays of %llu photons, millions a second: Embree %.2f, scene_intersect "
           "%.2f (%.2f of Embree), photon pass %.2f (%.2f of Embree)\n",
           rays->len, (unsigned long long)n, million / embree, million / ours,
           embree / ours, million / trace, embree / trace);
}

/* ---- Camera paths ---- */

static void bench_camera(const view *v, const char *name, integrator_choice integrator)
{
    settings how = v->scene->settings;
    how.integrator = integrator;
    how.passes = 1;
    how.spp = 1;
    how.threads = 1;
    how.photons = 100000;
    double best = HUGE_VAL;
    render_statistics st = {0};
    for (int round = 0; round < ROUNDS; round++) {
        g_autoptr(render) r = render_new(v, &how, NULL);
        double start = seconds();
        if (!r || !render_run(r, NULL, NULL, NULL))
            give_up("the scene can not be rendered");
        double time = seconds() - start;
        st = render_get_statistics(r);
        best = MIN(best, time - st.time_trace - st.time_build);
    }
    double rays = (double)(st.camera_rays + st.shadow_rays);
    printf("%s: %.2f million camera and shadow rays a second\n", name,
           1e-6 * rays / best);
}

int main(int argc, char **argv)
{
    uint64_t n = argc > 1 ? strtoull(argv[1], NULL, 10) : 100000;
    const load_options how = {.threads = 1};
    g_autoptr(view) v = format_load_view(BENCH_SCENE, &how, NULL);
    if (!v)
        give_up("no scene " BENCH_SCENE);
    v->owned->settings.threads = 1;
    view_resize(v, 192, 192);
    bench_photons(v->scene, n);
    bench_camera(v, "path", INTEGRATOR_PATH);
    bench_camera(v, "photonmap", INTEGRATOR_PHOTONMAP);
    return 0;
}
