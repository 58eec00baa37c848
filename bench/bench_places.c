#include "bench_places.h"

#include "math/frame.h"
#include "math/median.h"
#include "math/sampler.h"
#include "math/warp.h"

#include <stdlib.h>

enum {
    PILOT_SHARE = 50, /* of photons, one is in the pilot */
    TILE = 16,        /* pixels, of a rendered picture */
    TILES_A_ROW = 32,
};

static const vec3 light = {0.5f, 0.5f, 0.8f};
static const vec3 eye = {0.5f, 0.02f, 0.5f};

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
    return (place){p, n, 0.0f};
}

/* Where a ray from within the box leaves it. */
static place cast(vec3 from, vec3 direction)
{
    place at = {0};
    float nearest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        float wall = direction[axis] > 0.0f ? 1.0f : 0.0f;
        float t = (wall - from[axis]) / direction[axis];
        if (!(fabsf(direction[axis]) > 0.0f) || !(t < nearest))
            continue;
        nearest = t;
        at.n = (vec3){0};
        at.n[axis] = direction[axis] > 0.0f ? -1.0f : 1.0f;
        at.p = from + t * direction;
        at.p[axis] = wall;
    }
    return at;
}

static photon make_photon(const places *of, uint64_t key, size_t i)
{
    sampler s = sampler_make(key, hash_mix(i, 0));
    photon p = {.flux = spectrum_fill(1.0f / (float)of->n_photons)};
    if (of->in_pixel_order) {
        p.wi = -warp_sphere(sampler_2d(&s));
        p.p = cast(light, -p.wi).p;
    } else {
        place at = random_place(&s);
        frame f = frame_from_normal(at.n);
        p.p = at.p;
        p.wi = frame_to_world(&f, warp_cosine_hemisphere(sampler_2d(&s)));
    }
    return p;
}

static photon_store make_photons(const places *of, uint64_t key, size_t n)
{
    photon_store store = {0};
    if (!photon_store_reserve(&store, n, NULL))
        exit(3);
    for (size_t i = 0; i < n; i++) {
        photon p = make_photon(of, key, i);
        photon_store_put(&store, &p);
    }
    return store;
}

/* ---- Radii of places ---- */

typedef struct pilot {
    photon_map *map;
    float scale;
} pilot;

static bool nearest(const void *data, vec3 p, point_hits *hits)
{
    const pilot *by = data;
    return photon_map_nearest(by->map, p, RADIUS_NEAREST, INFINITY, NULL, hits);
}

static float scaled(const void *data, vec3 p, float distance, point_hits *hits)
{
    (void)p, (void)hits;
    return ((const pilot *)data)->scale * distance;
}

static void make_radii(places *of)
{
    size_t n = MAX(of->n_photons / PILOT_SHARE, RADIUS_NEAREST);
    photon_store store = make_photons(of, 3, n);
    pilot by = {
        photon_map_build(MAP_KDTREE, &store, 0.0f, (workers){.threads = 1}, NULL),
        sqrtf((float)PLACE_WANTED / RADIUS_NEAREST * (float)n / (float)of->n_photons)};
    size_t n_places = MIN(n, MOST_PLACES);
    vec3 *at = aligned_alloc(64, (n_places * sizeof *at + 63) / 64 * 64);
    for (size_t i = 0; i < n_places; i++)
        at[i] = photon_store_get(photon_map_store(by.map), radius_place(i, n)).p;
    const radius_source source = {nearest, scaled, &by, NULL};
    of->radii = radius_cache_build(at, n_places, &source, 1, NULL);
    photon_map_free(by.map);
    free(at);
}

/* ---- Queries ---- */

/* Every so many tiles of the picture one. */
static place pixel_place(size_t i, size_t n)
{
    const size_t all = TILES_A_ROW * TILES_A_ROW, tiles = MAX(n / (TILE * TILE), 1);
    size_t tile = i / (TILE * TILE) * all / tiles % all, at = i % (TILE * TILE);
    float x = (float)(tile % TILES_A_ROW * TILE + at % TILE);
    float y = (float)(tile / TILES_A_ROW * TILE + at / TILE);
    float middle = 0.5f * TILES_A_ROW * TILE - 0.5f;
    return cast(eye, vec3_make((x - middle) / middle, 1.0f, (middle - y) / middle));
}

static void make_queries(places *of)
{
    float *radii = g_new(float, of->n);
    point_hits hits = {0};
    of->at = aligned_alloc(64, of->n * sizeof *of->at);
    for (size_t i = 0; i < of->n; i++) {
        sampler s = sampler_make(2, i);
        of->at[i] = of->in_pixel_order ? pixel_place(i, of->n) : random_place(&s);
        /* of the area of the box */
        radii[i] = sqrtf(6.0f * PLACE_WANTED / (PI_F * (float)of->n_photons));
        if (of->radii)
            radii[i] = radius_cache_at(of->radii, of->at[i].p, radii[i], NULL, &hits);
        of->at[i].radius = radii[i];
    }
    of->typical = median(radii, of->n);
    point_hits_clear(&hits);
    g_free(radii);
}

places places_make(bool in_pixel_order, size_t n_photons, size_t n)
{
    places made = {.in_pixel_order = in_pixel_order, .n_photons = n_photons, .n = n};
    made.photons = make_photons(&made, 1, n_photons);
    made.xyz = g_new(float, 3 * n_photons);
    for (size_t i = 0; i < n_photons; i++) {
        made.xyz[3 * i] = made.photons.x[i];
        made.xyz[3 * i + 1] = made.photons.y[i];
        made.xyz[3 * i + 2] = made.photons.z[i];
    }
    if (in_pixel_order)
        make_radii(&made);
    make_queries(&made);
    return made;
}

void places_clear(places *from)
{
    photon_store_clear(&from->photons);
    radius_cache_free(from->radii);
    g_free(from->xyz);
    free(from->at);
}

photon_store places_photons(const places *from)
{
    photon_store copy = {0};
    if (!photon_store_reserve(&copy, from->n_photons, NULL))
        exit(3);
    photon_store_copy(&copy, 0, &from->photons);
    copy.n = from->n_photons;
    return copy;
}
