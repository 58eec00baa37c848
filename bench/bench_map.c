/*
 * Photon maps: time to build and to answer, one thread, photons on the faces of a unit
 * box, queries on them in no order. With nanoflann installed every row says how many
 * times faster we are than its tree.
 *
 *   bench_map [photons, default 1000000] [queries, default 20000]
 */
#include "bsdf/bsdf_models.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/estimate.h"

#include <glib.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef HAVE_NANOFLANN
#include "nanoflann.h"
#endif

/* A query's point and normal, on a face of the box. */
typedef struct place {
    vec3 p, n;
} place;

typedef struct bench {
    size_t n_photons, n_queries;
    place *queries;
    float *xyz;
    photon_store store;
    photon_hits hits;
    estimate_scratch scratch;
    bsdf wall;
    double sink; /* what is computed must be used */
} bench;

static place random_place(sampler *s)
{
    vec3 p = {0}, n = {0};
    unsigned face = (unsigned)(6.0f * sampler_1d(s));
    unsigned axis = face / 2;
    vec2 u = sampler_2d(s);
    p[axis] = (float)(face % 2);
    p[(axis + 1) % 3] = u.x;
    p[(axis + 2) % 3] = u.y;
    n[axis] = face % 2 ? -1.0f : 1.0f;
    return (place){p, n};
}

static void make_photons(bench *b)
{
    if (!photon_store_reserve(&b->store, b->n_photons, NULL))
        exit(3);
    b->xyz = g_new(float, 3 * b->n_photons);
    for (size_t i = 0; i < b->n_photons; i++) {
        sampler s = sampler_make(1, hash_mix(i, 0));
        place at = random_place(&s);
        frame f = frame_from_normal(at.n);
        photon p = {.p = at.p, .flux = spectrum_fill(1.0f / (float)b->n_photons)};
        p.wi = frame_to_world(&f, warp_cosine_hemisphere(sampler_2d(&s)));
        photon_store_put(&b->store, &p);
        for (int axis = 0; axis < 3; axis++)
            b->xyz[3 * i + (size_t)axis] = at.p[axis];
    }
}

static void make_queries(bench *b)
{
    b->queries = aligned_alloc(64, b->n_queries * sizeof *b->queries);
    for (size_t i = 0; i < b->n_queries; i++) {
        sampler s = sampler_make(2, i);
        b->queries[i] = random_place(&s);
    }
}

static photon_store copy_store(const photon_store *from)
{
    photon_store copy = {0};
    if (!photon_store_reserve(&copy, from->n, NULL))
        exit(3);
    for (size_t i = 0; i < from->n; i++) {
        copy.x[i] = from->x[i];
        copy.y[i] = from->y[i];
        copy.z[i] = from->z[i];
        copy.wi[i] = from->wi[i];
        copy.flux[i] = from->flux[i];
    }
    copy.n = from->n;
    return copy;
}

/* Seconds this thread has worked: others use the machine too. */
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- What is measured: one query of some kind; returns what it found ---- */

typedef struct task {
    const char *name;
    float radius;   /* of 53 or 213 photons if there are a million */
    size_t nearest; /* 0: within the radius */
    bool estimate;  /* weigh them, or only find them */
} task;

static const task tasks[] = {
    {"within, about 53", 0.0101f, 0, false},
    {"estimate of about 53", 0.0101f, 0, true},
    {"within, about 213", 0.0202f, 0, false},
    {"estimate of about 213", 0.0202f, 0, true},
    {"nearest 50", INFINITY, 50, false},
    {"estimate of nearest 50", INFINITY, 50, true},
    {"nearest 200", INFINITY, 200, false},
};

enum { N_TASKS = G_N_ELEMENTS(tasks) };

static float task_radius(const bench *b, const task *t)
{
    return t->radius * sqrtf(1e6f / (float)b->n_photons);
}

/* What answers the queries. */
typedef struct answerer {
    const photon_map *map; /* NULL: the peer */
    const void *peer;
} answerer;

static void answer_peer(bench *b, const void *peer, const task *t, vec3 p)
{
#ifdef HAVE_NANOFLANN
    const float at[3] = {p[0], p[1], p[2]};
    size_t n = t->nearest ? peer_nearest(peer, at, t->nearest)
                          : peer_within(peer, at, task_radius(b, t));
    b->sink += (double)n;
#else
    (void)b, (void)peer, (void)t, (void)p;
#endif
}

static void answer(bench *b, const photon_map *map, const task *t, place at)
{
    estimate_options o = {.kernel = {KERNEL_CONE, 1.0f},
                          .nearest = t->nearest,
                          .radius = task_radius(b, t),
                          .flatten = 1.0f,
                          .lobes = LOBE_GATHERED};
    if (t->estimate) {
        b->wall.shading.n = b->wall.n_geom = at.n;
        spectrum l = photon_estimate(map, at.p, &b->wall, at.n, &o, &b->scratch, NULL);
        b->sink += (double)l[0];
    } else if (t->nearest) {
        photon_map_nearest(map, at.p, t->nearest, o.radius, NULL, &b->hits);
    } else {
        photon_map_within(map, at.p, o.radius, NULL, &b->hits);
    }
}

/* Seconds a query: the best of several batches. */
static double time_task(bench *b, answerer who, const task *t, size_t n)
{
    enum { BATCHES = 10 };
    double best = HUGE_VAL;
    for (size_t batch = 0; batch < BATCHES; batch++) {
        size_t first = n * batch / BATCHES, end = n * (batch + 1) / BATCHES;
        double begin = now();
        for (size_t i = first; i < end; i++) {
            if (who.map)
                answer(b, who.map, t, b->queries[i]);
            else
                answer_peer(b, who.peer, t, b->queries[i].p);
        }
        double seconds = now() - begin;
        best = fmin(best, seconds / (double)(end - first));
    }
    return best;
}

/* Build time and a time for each task; zero where there is none. */
typedef struct times {
    double build, task[N_TASKS];
} times;

static times time_nanoflann(bench *b)
{
    times t = {0};
#ifdef HAVE_NANOFLANN
    double begin = now();
    peer_tree *tree = peer_build(b->xyz, b->n_photons);
    t.build = now() - begin;
    for (size_t i = 0; i < N_TASKS; i++)
        t.task[i] = time_task(b, (answerer){NULL, tree}, &tasks[i], b->n_queries);
    peer_free(tree);
#else
    (void)b;
#endif
    return t;
}

static times time_map(bench *b, map_choice choice)
{
    times t;
    photon_store store = copy_store(&b->store);
    double begin = now();
    photon_map *map =
        photon_map_build(choice, &store, task_radius(b, &tasks[0]), 1, NULL);
    t.build = now() - begin;
    size_t n = choice == MAP_LIST ? MIN(b->n_queries, 10) : b->n_queries;
    for (size_t i = 0; i < N_TASKS; i++)
        t.task[i] = time_task(b, (answerer){map, NULL}, &tasks[i], n);
    photon_map_free(map);
    return t;
}

static void print_row(const char *name, const char *unit, double scale, const double t[4])
{
    printf("%-24s %9.3f %9.3f %9.3f %9.3f %-3s", name, scale * t[0], scale * t[1],
           scale * t[2], scale * t[3], unit);
    if (t[3] > 0.0)
        printf("  %6.1fx %6.1fx", t[3] / t[1], t[3] / t[2]);
    printf("\n");
}

int main(int argc, char **argv)
{
    bench b = {.n_photons = argc > 1 ? (size_t)atof(argv[1]) : 1000000,
               .n_queries = argc > 2 ? (size_t)atof(argv[2]) : 20000};
    b.wall = (bsdf){.wavelength = ALL_WAVELENGTHS};
    bsdf_make_diffuse(&b.wall, spectrum_fill(0.5f));
    make_photons(&b);
    make_queries(&b);
    times t[4] = {time_map(&b, MAP_LIST), time_map(&b, MAP_KDTREE),
                  time_map(&b, MAP_GRID), time_nanoflann(&b)};
    printf("%-24s %9s %9s %9s %9s      nanoflann over\n", "", "list", "kdtree", "grid",
           "nanoflann");
    print_row("build", "ms", 1e3,
              (double[]){t[0].build, t[1].build, t[2].build, t[3].build});
    for (size_t i = 0; i < N_TASKS; i++)
        print_row(tasks[i].name, "us", 1e6,
                  (double[]){t[0].task[i], t[1].task[i], t[2].task[i], t[3].task[i]});
    printf("(%g)\n", b.sink);
    return 0;
}
