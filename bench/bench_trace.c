/*
 * Tracing against Embree alone on the very same rays: what the house adds to a ray (the
 * hit's geometry, the BSDF, random numbers, lights, the store or the film) is what is
 * seen here. Every ray that Embree is asked is written down as it is asked, by the
 * linker's --wrap; then the rays are asked again, of the same structure, and the whole is
 * run again, in turns. Seconds are the thread's own, so that a busy machine disturbs
 * little; what is printed is the median.
 *
 *   bench_trace WHAT SCENE...     WHAT: photons, or an integrator of a camera pass
 *
 * SCENE is a file, or a number of triangles: a cave of so many, with a lamp in it. A line
 * each: what, scene, rays, microseconds a ray of Embree and of ours, Embree over ours.
 */
#include "bench_mesh.h"
#include "format/format.h"
#include "math/median.h"
#include "photon/trace/trace.h"
#include "render/render.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <glib/gstdio.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { ROUNDS = 5, PHOTONS = 100000, SIDE = 192 };

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

/* ---- What Embree is asked ---- */

typedef struct asked {
    struct RTCRay ray;
    RTCScene scene;
    bool any; /* whether anything is in the way, or what is nearest */
} asked;

static GArray *recorded; /* NULL: nobody writes down */

static void record(RTCScene of, const struct RTCRay *query, bool any)
{
    const asked one = {*query, of, any};
    if (recorded)
        g_array_append_val(recorded, one);
}

#if RTC_VERSION_MAJOR >= 4
typedef struct RTCIntersectArguments nearest_context;
typedef struct RTCOccludedArguments any_context;
#define PASS(context, query) query, context
#define NO_CONTEXT(type) type *context = NULL
#else
typedef struct RTCIntersectContext nearest_context;
typedef struct RTCIntersectContext any_context;
#define PASS(context, query) context, query
#define NO_CONTEXT(type)                                                                 \
    type none, *context = &none;                                                         \
    rtcInitIntersectContext(context)
#endif

void __real_rtcIntersect1(RTCScene, PASS(nearest_context *, struct RTCRayHit *));
void __real_rtcOccluded1(RTCScene, PASS(any_context *, struct RTCRay *));
void __wrap_rtcIntersect1(RTCScene, PASS(nearest_context *, struct RTCRayHit *));
void __wrap_rtcOccluded1(RTCScene, PASS(any_context *, struct RTCRay *));

void __wrap_rtcIntersect1(RTCScene of,
                          PASS(nearest_context *context, struct RTCRayHit *query))
{
    record(of, &query->ray, false);
    __real_rtcIntersect1(of, PASS(context, query));
}

void __wrap_rtcOccluded1(RTCScene of, PASS(any_context *context, struct RTCRay *query))
{
    record(of, query, true);
    __real_rtcOccluded1(of, PASS(context, query));
}

static void ask_nearest(const asked *one)
{
    NO_CONTEXT(nearest_context);
    struct RTCRayHit query = {.ray = one->ray, .hit.geomID = RTC_INVALID_GEOMETRY_ID};
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    __real_rtcIntersect1(one->scene, PASS(context, &query));
}

static void ask_any(const asked *one)
{
    NO_CONTEXT(any_context);
    struct RTCRay query = one->ray;
    __real_rtcOccluded1(one->scene, PASS(context, &query));
}

static double time_embree(const GArray *rays)
{
    double start = seconds();
    for (guint i = 0; i < rays->len; i++) {
        const asked *one = &g_array_index(rays, asked, i);
        if (one->any)
            ask_any(one);
        else
            ask_nearest(one);
    }
    return seconds() - start;
}

/* ---- What is run ---- */

static double time_photons(const view *v)
{
    const trace_task task = {.scene = v->scene,
                             .how = &v->scene->settings,
                             .w = wavelengths_for_pass(1, 0),
                             .photon_class = PHOTON_INDIRECT,
                             .n_photons = PHOTONS};
    trace_result result;
    double start = seconds();
    if (!photon_trace(&task, false, &result, NULL))
        give_up("the photons can not be traced");
    double time = seconds() - start;
    trace_result_clear(&result);
    return time;
}

static double time_camera(const view *v, int integrator)
{
    settings how = v->scene->settings;
    how.integrator = integrator;
    how.passes = how.spp = how.threads = 1;
    how.photons = PHOTONS;
    g_autoptr(render) r = render_new(v, &how, NULL);
    double start = seconds();
    if (!r || !render_run(r, NULL, NULL, NULL))
        give_up("the scene can not be rendered");
    return seconds() - start;
}

/* @param integrator < 0: photons */
static double time_ours(const view *v, int integrator)
{
    return integrator < 0 ? time_photons(v) : time_camera(v, integrator);
}

/* ---- Scenes ---- */

/* A cave of about so many triangles, all of which rays may meet. */
static char *write_cave(const char *folder, size_t triangles)
{
    static const char text[] =
        "LookAt 0 0 0  1 0 0  0 0 1\n"
        "Camera \"perspective\" \"float fov\" 70\nFilm \"rgb\"\nWorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"
        "Shape \"plymesh\" \"string filename\" \"cave.ply\"\n"
        "AreaLightSource \"diffuse\" \"blackbody L\" 5000 \"bool twosided\" true\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-.1 -.1 .6  .1 -.1 .6  -.1 .1 .6  .1 .1 .6]"
        "\n";
    mesh m = bench_mesh_make(triangles, bench_cave);
    g_autofree char *ply = g_build_filename(folder, "cave.ply", NULL);
    bench_mesh_write(&m, ply);
    mesh_clear(&m);
    char *path = g_build_filename(folder, "cave.pbrt", NULL);
    if (!g_file_set_contents(path, text, -1, NULL))
        give_up("no room for a scene");
    return path;
}

static view *load(const char *path)
{
    g_autoptr(GError) error = NULL;
    const load_options how = {.threads = 1};
    view *v = format_load_view(path, &how, &error);
    if (!v)
        give_up(error->message);
    v->owned->settings.threads = 1;
    view_resize(v, SIDE, SIDE);
    return v;
}

static view *load_cave(size_t triangles)
{
    g_autofree char *folder = g_dir_make_tmp("nephroid-trace-XXXXXX", NULL);
    if (!folder)
        give_up("no folder for a scene");
    g_autofree char *path = write_cave(folder, triangles);
    g_autofree char *ply = g_build_filename(folder, "cave.ply", NULL);
    view *v = load(path);
    g_unlink(path);
    g_unlink(ply);
    g_rmdir(folder);
    return v;
}

static void bench(const char *what, int integrator, const char *which)
{
    size_t triangles = strtoull(which, NULL, 10);
    g_autoptr(view) v = triangles > 0 ? load_cave(triangles) : load(which);
    g_autofree char *name = g_path_get_basename(which);
    g_autoptr(GArray) rays = g_array_new(FALSE, FALSE, sizeof(asked));
    recorded = rays;
    time_ours(v, integrator);
    recorded = NULL;
    float embree[ROUNDS], ours[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        embree[i] = (float)(1e6 * time_embree(rays) / rays->len);
        ours[i] = (float)(1e6 * time_ours(v, integrator) / rays->len);
    }
    double least = (double)median(embree, ROUNDS), whole = (double)median(ours, ROUNDS);
    printf("%s\t%s\t%u\t%.4f\t%.4f\t%.3f\n", what, name, rays->len, least, whole,
           least / whole);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    int integrator = -1;
    if (argc < 3)
        give_up("expected 'photons' or an integrator, and scenes");
    if (strcmp(argv[1], "photons") != 0) {
        settings any = settings_default();
        if (!settings_set(&any, "integrator", argv[1], NULL))
            give_up("no such integrator");
        integrator = any.integrator;
    }
    for (int i = 2; i < argc; i++)
        bench(argv[1], integrator, argv[i]);
    return 0;
}
