/*
 * Photon maps: time to build and to answer, one thread. With nanoflann installed every
 * row says how many times faster we are than the bare search of its tree: also where we
 * weigh what is found. What is asked: bench_places.h.
 *
 *   bench_map [photons, default 1000000] [queries, default 32768] [rows with this text]
 *
 * Who answers takes turns, five times; what is printed is the median.
 */
#include "bench_places.h"
#include "bsdf/bsdf_models.h"
#include "math/median.h"
#include "photon/estimate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef HAVE_NANOFLANN
#include "nanoflann.h"
#endif

/* What is measured: one query of some kind. */
typedef struct task {
    const char *name;
    float reach;    /* over the place's radius: 1 or 2 */
    size_t nearest; /* 0: within the radius */
    bool estimate;  /* weigh them, or only find them */
} task;

static const task tasks[] = {
    {"within, about 50", 1.0f, 0, false},  {"estimate of about 50", 1.0f, 0, true},
    {"within, about 200", 2.0f, 0, false}, {"estimate of about 200", 2.0f, 0, true},
    {"nearest 50", 1.0f, 50, false},       {"estimate of nearest 50", 1.0f, 50, true},
    {"nearest 200", 2.0f, 200, false},
};

enum { N_TASKS = G_N_ELEMENTS(tasks), TURNS = 5, N_KINDS = 2, PEER = N_KINDS, N_WHO };

static const map_choice choices[N_KINDS] = {MAP_KDTREE, MAP_GRID};

/* Who answers. */
typedef struct bench {
    places asked;
    photon_map *maps[2][N_KINDS]; /* made for a reach of 1 and of 2 */
#ifdef HAVE_NANOFLANN
    peer_tree *peer;
#endif
    double build[N_WHO];
    point_hits hits;
    estimate_scratch scratch;
    bsdf wall;
    double sink; /* what is computed must be used */
    size_t found[N_WHO];
} bench;

/* Seconds this thread has worked: others use the machine too. */
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool has_peer(const bench *b)
{
    return b->build[PEER] > 0.0;
}

/* ---- Answers: how many were found ---- */

static size_t answer_peer(bench *b, const task *t, const place *at)
{
#ifdef HAVE_NANOFLANN
    const float p[3] = {at->p[0], at->p[1], at->p[2]};
    return t->nearest ? peer_nearest(b->peer, p, t->nearest)
                      : peer_within(b->peer, p, t->reach * at->radius);
#else
    (void)b, (void)t, (void)at;
    return 0;
#endif
}

static size_t answer(bench *b, const photon_map *map, const task *t, const place *at)
{
    float radius = t->nearest ? INFINITY : t->reach * at->radius;
    if (t->estimate) {
        const estimate_options o = {.kernel = {KERNEL_CONE, 1.0f},
                                    .nearest = t->nearest,
                                    .radius = radius,
                                    .flatten = 1.0f,
                                    .lobes = LOBE_GATHERED};
        estimate_info info;
        b->wall.shading.n = b->wall.n_geom = at->n;
        spectrum l = photon_estimate(map, at->p, &b->wall, at->n, &o, &b->scratch, &info);
        b->sink += (double)l[0];
        return info.n_photons;
    }
    if (t->nearest)
        photon_map_nearest(map, at->p, t->nearest, radius, NULL, &b->hits);
    else
        photon_map_within(map, at->p, radius, NULL, &b->hits);
    return b->hits.n;
}

/* Seconds a query. Those for the nearest are slow, a few do. */
static double time_task(bench *b, int who, const task *t)
{
    double begin = now();
    size_t found = 0, n = t->nearest ? b->asked.n / 8 : b->asked.n;
    for (size_t i = 0; i < n; i++)
        found += who == PEER
                     ? answer_peer(b, t, &b->asked.at[i])
                     : answer(b, b->maps[t->reach > 1.0f][who], t, &b->asked.at[i]);
    b->found[who] = found;
    return (now() - begin) / (double)n;
}

/* ---- Building ---- */

static void build_all(bench *b)
{
    for (int i = 0; i < 2 * N_KINDS; i++) {
        photon_store store = places_photons(&b->asked);
        float radius = (float)(1 + i / N_KINDS) * b->asked.typical;
        double begin = now();
        photon_map **map = &b->maps[i / N_KINDS][i % N_KINDS];
        *map = photon_map_build(choices[i % N_KINDS], &store, radius,
                                (workers){.threads = 1}, NULL);
        b->build[i % N_KINDS] = now() - begin;
        if (!*map)
            exit(3);
    }
#ifdef HAVE_NANOFLANN
    double begin = now();
    b->peer = peer_build(b->asked.xyz, b->asked.n_photons);
    b->build[PEER] = now() - begin;
#endif
}

static void clear(bench *b)
{
    for (int i = 0; i < 2 * N_KINDS; i++)
        photon_map_free(b->maps[i / N_KINDS][i % N_KINDS]);
#ifdef HAVE_NANOFLANN
    peer_free(b->peer);
#endif
    point_hits_clear(&b->hits);
    estimate_scratch_clear(&b->scratch);
    places_clear(&b->asked);
}

/* ---- Printing ---- */

static void print_row(const char *name, const char *unit, double scale,
                      const double t[N_WHO])
{
    printf("%-24s %9.3f %9.3f %9.3f %-3s", name, scale * t[0], scale * t[1],
           scale * t[PEER], unit);
    if (t[PEER] > 0.0)
        printf("  %6.1fx %6.1fx", t[PEER] / t[0], t[PEER] / t[1]);
}

static void print_task(bench *b, const task *t)
{
    float turns[N_WHO][TURNS];
    double middle[N_WHO];
    for (int turn = 0; turn < TURNS; turn++)
        for (int who = 0; who < N_WHO; who++)
            turns[who][turn] = (float)time_task(b, who, t);
    for (int who = 0; who < N_WHO; who++)
        middle[who] = (double)median(turns[who], TURNS);
    if (!has_peer(b))
        middle[PEER] = 0.0;
    print_row(t->name, "us", 1e6, middle);
    size_t n = t->nearest ? b->asked.n / 8 : b->asked.n;
    printf("   (%.1f found)\n", (double)b->found[1] / (double)n);
}

/* What a query pays for its radius. */
static void print_radii(bench *b)
{
    double begin = now();
    for (size_t i = 0; i < b->asked.n; i++)
        b->sink +=
            (double)radius_cache_at(b->asked.radii, b->asked.at[i].p, 0, NULL, &b->hits);
    printf("%-24s %9.3f us\n", "radius of the place",
           1e6 * (now() - begin) / (double)b->asked.n);
}

static void run(bool in_pixel_order, size_t n_photons, size_t n_queries, const char *only)
{
    bench b = {.asked = places_make(in_pixel_order, n_photons, n_queries)};
    b.wall = (bsdf){.wavelength = ALL_WAVELENGTHS};
    bsdf_make_diffuse(&b.wall, spectrum_fill(0.5f));
    build_all(&b);
    printf("%-24s %9s %9s %9s      nanoflann over\n",
           in_pixel_order ? "IN PIXEL ORDER" : "IN NO ORDER", "kdtree", "grid",
           "nanoflann");
    print_row("build", "ms", 1e3, b.build);
    printf("   (%.1f, %.1f B a photon)\n",
           (double)photon_map_bytes(b.maps[0][0]) / (double)n_photons,
           (double)photon_map_bytes(b.maps[0][1]) / (double)n_photons);
    for (size_t i = 0; i < N_TASKS; i++)
        if (strstr(tasks[i].name, only))
            print_task(&b, &tasks[i]);
    if (b.asked.radii)
        print_radii(&b);
    printf("(%g)\n", b.sink);
    clear(&b);
}

int main(int argc, char **argv)
{
    size_t n_photons = argc > 1 ? (size_t)atof(argv[1]) : 1000000;
    size_t n_queries = argc > 2 ? (size_t)atof(argv[2]) : 32768;
    const char *only = argc > 3 ? argv[3] : "";
    run(true, n_photons, n_queries, only);
    run(false, n_photons, n_queries, only);
    return 0;
}
