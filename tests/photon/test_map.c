/*
 * map: kdtree and grid find the same photons as the list, to the bit, whatever the
 * photons, the radius and the filter; builds do not depend on the number of threads;
 * refused memory is an error.
 */
#include "base/memory.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/photon_map.h"

#include <glib.h>
#include <stdlib.h>

/* ---- Fields of photons ---- */

typedef vec3 (*field_place)(sampler *s);

static vec3 place_cube(sampler *s)
{
    return vec3_make(sampler_1d(s), sampler_1d(s), sampler_1d(s));
}

/* Half of the photons in a tenth of a millimetre. */
static vec3 place_clustered(sampler *s)
{
    vec3 p = place_cube(s);
    return sampler_1d(s) < 0.5f ? p : vec3_make(0.3f, 0.4f, 0.5f) + 1e-4f * p;
}

static vec3 place_planar(sampler *s)
{
    return vec3_make(sampler_1d(s), sampler_1d(s), 0.25f);
}

static vec3 place_collinear(sampler *s)
{
    return vec3_make(0.5f, sampler_1d(s), 0.5f);
}

/* Six places only. */
static vec3 place_duplicate(sampler *s)
{
    return vec3_make(floorf(3.0f * sampler_1d(s)), floorf(2.0f * sampler_1d(s)), 0.5f);
}

/* A lattice: distances tie everywhere. */
static vec3 place_lattice(sampler *s)
{
    return vec3_make(floorf(9.0f * sampler_1d(s)) / 8, floorf(9.0f * sampler_1d(s)) / 8,
                     floorf(9.0f * sampler_1d(s)) / 8);
}

static vec3 place_same(sampler *s)
{
    (void)s;
    return vec3_make(0.1f, 0.2f, 0.3f);
}

/* A lit millimetre in a dark square kilometre, and scales from 1e-3 to 1e6. */
static vec3 place_landscape(sampler *s)
{
    vec3 p = place_cube(s);
    float scale = powf(10.0f, -3.0f + 9.0f * sampler_1d(s));
    return sampler_1d(s) < 0.5f ? 1e-3f * p : scale * p;
}

static vec3 place_far_away(sampler *s)
{
    return vec3_make(1e6f, -1e6f, 1e6f) + place_cube(s);
}

/* Some have coordinates that are no place at all. They are never found and harm none. */
static vec3 place_broken(sampler *s)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, 3e38f};
    vec3 p = place_cube(s);
    float chance = sampler_1d(s);
    if (chance < 0.1f)
        p[(int)(30.0f * chance)] = odd[(int)(4.0f * sampler_1d(s))];
    return p;
}

static const struct {
    const char *name;
    field_place place;
} fields[] = {
    {"cube", place_cube},           {"clustered", place_clustered},
    {"planar", place_planar},       {"collinear", place_collinear},
    {"duplicate", place_duplicate}, {"lattice", place_lattice},
    {"same", place_same},           {"landscape", place_landscape},
    {"far-away", place_far_away},   {"broken", place_broken},
};

/* Some photons are exact copies of others, some differ in flux only. */
static photon field_photon(field_place place, uint64_t key, uint32_t i)
{
    sampler s = sampler_make(key, i / 2);
    photon p = {.p = place(&s), .wi = warp_sphere(sampler_2d(&s)), .flags = i / 2 % 4};
    p.flux = spectrum_fill(sampler_1d(&s));
    if (i % 2 && i % 8 < 6) {
        sampler own = sampler_make(key + 1, i);
        p.p = i % 8 < 4 ? place(&own) : p.p;
        p.flux[3] += sampler_1d(&own);
    }
    return p;
}

/* @param empty what the photons keep */
static photon_store fill_store(photon_store empty, field_place place, uint32_t n)
{
    photon_store store = empty;
    g_assert_true(photon_store_reserve(&store, n, NULL));
    for (uint32_t i = 0; i < n; i++) {
        photon p = field_photon(place, 11, i);
        sampler own = sampler_make(17, i);
        p.n = warp_sphere(sampler_2d(&own));
        p.home = i % 3;
        photon_store_put(&store, &p);
    }
    return store;
}

static photon_store make_store(field_place place, uint32_t n)
{
    return fill_store((photon_store){0}, place, n);
}

static photon_map *build_map(map_choice choice, photon_store *store, float radius,
                             unsigned threads)
{
    GError *error = NULL;
    photon_map *map =
        photon_map_build(choice, store, radius, (workers){.threads = threads}, &error);
    g_assert_no_error(error);
    g_assert_null(store->x);
    return map;
}

/* The same of a copy of the store. */
static photon_map *build_copy(map_choice choice, const photon_store *store, float radius,
                              unsigned threads)
{
    photon_store copy = {0};
    size_t n = store->n;
    g_assert_true(photon_store_reserve(&copy, n, NULL));
    memcpy(copy.x, store->x, n * sizeof *copy.x);
    memcpy(copy.y, store->y, n * sizeof *copy.y);
    memcpy(copy.z, store->z, n * sizeof *copy.z);
    memcpy(copy.wi, store->wi, n * sizeof *copy.wi);
    memcpy(copy.flux, store->flux, n * sizeof *copy.flux);
    copy.n = n;
    return build_map(choice, &copy, radius, threads);
}

/* ---- Comparing what two maps find ---- */

typedef struct found {
    float distance2, x, y, z;
    uint32_t wi;
    float flux0, flux3;
} found;

static int compare_found(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(found));
}

/* Hits without the map's order, sorted by bits. */
static found *sorted_hits(const photon_map *map, const point_hits *hits)
{
    const photon_store *s = photon_map_store(map);
    found *all = g_new0(found, hits->n + 1);
    for (size_t i = 0; i < hits->n; i++) {
        size_t j = hits->index[i];
        g_assert_cmpuint(j, <, s->n);
        spectrum flux = photon_store_flux(s, j);
        all[i] = (found){hits->distance2[i], s->x[j], s->y[j], s->z[j],
                         s->wi[j],           flux[0], flux[3]};
    }
    qsort(all, hits->n, sizeof *all, compare_found);
    return all;
}

static void assert_same_hits(const photon_map *a, const point_hits *hits_a,
                             const photon_map *b, const point_hits *hits_b)
{
    g_assert_cmpuint(hits_a->n, ==, hits_b->n);
    g_autofree found *found_a = sorted_hits(a, hits_a);
    g_autofree found *found_b = sorted_hits(b, hits_b);
    g_assert_cmpmem(found_a, hits_a->n * sizeof(found), found_b,
                    hits_b->n * sizeof(found));
}

/* The list and another map of the same photons, and their hits. */
typedef struct pair {
    photon_map *list, *other;
    point_hits list_hits, other_hits;
    size_t n_found;
} pair;

static void compare_within(pair *maps, vec3 p, float radius, const photon_filter *filter)
{
    g_assert_true(photon_map_within(maps->list, p, radius, filter, &maps->list_hits));
    g_assert_true(photon_map_within(maps->other, p, radius, filter, &maps->other_hits));
    assert_same_hits(maps->list, &maps->list_hits, maps->other, &maps->other_hits);
    maps->n_found += maps->list_hits.n;
}

static void compare_nearest(pair *maps, vec3 p, size_t k, float radius,
                            const photon_filter *filter)
{
    point_hits *a = &maps->list_hits, *b = &maps->other_hits;
    g_assert_true(photon_map_nearest(maps->list, p, k, radius, filter, a));
    g_assert_true(photon_map_nearest(maps->other, p, k, radius, filter, b));
    assert_same_hits(maps->list, a, maps->other, b);
    g_assert_cmpuint(a->n, <=, k);
    maps->n_found += a->n;
}

/* Queries at photons, near them and anywhere; with and without a filter. */
static void compare_maps(pair *maps, field_place place, float extent)
{
    static const size_t counts[] = {1, 2, 7, 50, 200, 100000};
    static const float radii[] = {0.0f, 1e-6f, 1e-3f, 0.02f, 0.1f, 0.3f, 2.0f, 1e9f};
    static const float flatten[] = {1.0f, 0.3f, 0.001f};
    for (uint32_t i = 0; i < 20; i++) {
        sampler s = sampler_make(77, i);
        vec3 p = field_photon(place, 11, i).p;
        if (i % 3)
            p += (i % 3 == 1 ? 0.01f : 1.5f) * extent * warp_sphere(sampler_2d(&s));
        photon_filter filter = {warp_sphere(sampler_2d(&s)), i % 4 > 1,
                                flatten[i % 5 % 3], (int)(i % 7 % 3) - 1, i % 11 < 4};
        const photon_filter *used = i % 2 ? &filter : NULL;
        for (size_t r = 0; r < G_N_ELEMENTS(radii); r++) {
            compare_within(maps, p, radii[r] * extent, used);
            compare_nearest(maps, p, counts[(i + r) % 6], radii[r] * extent, used);
        }
        compare_nearest(maps, p, counts[i % 6], INFINITY, used);
    }
}

static void clear_pair(pair *maps)
{
    photon_map_free(maps->list);
    photon_map_free(maps->other);
    point_hits_clear(&maps->list_hits);
    point_hits_clear(&maps->other_hits);
}

static void test_same_as_list(map_choice choice)
{
    static const uint32_t sizes[] = {1, 2, 15, 16, 17, 129, 900};
    static const float radii[] = {0.0f, 0.1f, 1e-4f};
    for (size_t f = 0; f < G_N_ELEMENTS(fields); f++) {
        field_place place = fields[f].place;
        float extent = place == place_landscape ? 10.0f : 1.0f;
        for (size_t n = 0; n < G_N_ELEMENTS(sizes); n++) {
            photon_store store = make_store(place, sizes[n]);
            pair maps = {.list = build_copy(MAP_LIST, &store, 0, 1)};
            for (size_t r = 0; r < G_N_ELEMENTS(radii); r++) {
                photon_map_free(maps.other);
                maps.other = build_copy(choice, &store, radii[r] * extent, 1);
                compare_maps(&maps, place, extent);
            }
            g_assert_true(maps.n_found > 40 || sizes[n] < 15);
            clear_pair(&maps);
            photon_store_clear(&store);
        }
    }
}

static void test_kdtree_same_as_list(void)
{
    test_same_as_list(MAP_KDTREE);
}

static void test_grid_same_as_list(void)
{
    test_same_as_list(MAP_GRID);
}

/* A hashed grid whose queries meet two hundred rows: some wrap round, some overlap. */
static void test_grid_hashed_rows(void)
{
    photon_store store = make_store(place_cube, 4000);
    pair maps = {.list = build_copy(MAP_LIST, &store, 0, 1),
                 .other = build_copy(MAP_GRID, &store, 0.01f, 1)};
    for (uint32_t i = 0; i < 1500; i++)
        compare_within(&maps, field_photon(place_cube, 12, i).p, 0.07f, NULL);
    g_assert_cmpuint(maps.n_found, >, 5000);
    clear_pair(&maps);
    photon_store_clear(&store);
}

/* Photons of one cell keep the order of the store. */
static void test_grid_keeps_order(void)
{
    enum { N = 70000 };
    photon_store store = make_store(place_same, N);
    for (uint32_t i = 0; i < N; i++)
        store.wi[i] = i;
    g_autoptr(photon_map) map = build_map(MAP_GRID, &store, 0.1f, 2);
    for (uint32_t i = 0; i < N; i++)
        g_assert_cmpuint(photon_map_store(map)->wi[i], ==, i);
}

/* What the list finds, straight from the definition. */
static void test_list_by_definition(void)
{
    enum { N = 500 };
    photon_store store = make_store(place_cube, N);
    g_autoptr(photon_map) list = build_map(MAP_LIST, &store, 0, 1);
    point_hits hits = {0};
    vec3 p = vec3_make(0.4f, 0.5f, 0.6f), n = normalize3(vec3_make(1, 2, 2));
    photon_filter filter = {.n = n, .one_sided = true, .flatten = 0.5f};
    g_assert_true(photon_map_within(list, p, 0.3f, &filter, &hits));
    size_t expected = 0, nearer = 0, as_near = 0;
    for (size_t i = 0; i < N; i++) {
        photon q = photon_store_get(photon_map_store(list), i);
        bool near = length3(q.p - p) < 0.3f && fabsf(dot3(q.p - p, n)) < 0.15f;
        expected += near && dot3(q.wi, n) > 0.0f;
    }
    g_assert_cmpuint(hits.n, ==, expected);
    g_assert_cmpuint(expected, >, 5);
    g_assert_true(photon_map_nearest(list, p, 40, INFINITY, NULL, &hits));
    float last = 0.0f;
    for (size_t i = 0; i < hits.n; i++)
        last = fmaxf(last, hits.distance2[i]);
    for (size_t i = 0; i < N; i++) {
        float d2 = length3_2(photon_store_get(photon_map_store(list), i).p - p);
        nearer += d2 < last * (1.0f - 1e-6f);
        as_near += d2 < last * (1.0f + 1e-6f);
    }
    g_assert_cmpuint(hits.n, ==, 40);
    g_assert_cmpuint(nearer, <, 40);
    g_assert_cmpuint(as_near, >=, 40);
    point_hits_clear(&hits);
}

/* Of a curve only its photons, however they lie; else only those on no curve, of surfaces
   that lie alike, and on one side of a thin wall not those on its other side. */
static void test_curves_by_definition(void)
{
    enum { N = 2000 };
    static const map_choice kinds[] = {MAP_LIST, MAP_KDTREE, MAP_GRID};
    vec3 p = vec3_make(0.4f, 0.5f, 0.6f), n = normalize3(vec3_make(1, 2, 2));
    for (uint32_t i = 0; i < 18; i++) {
        photon_filter filter = {.n = n, .one_sided = i < 9, .flatten = 1, .curve = i % 3};
        if (filter.curve) { /* has no plane: these say nothing */
            filter.flatten = 0.01f;
            filter.face = 1;
        }
        photon_store store =
            fill_store((photon_store){.oriented = true, .homed = true}, place_cube, N);
        size_t expected = 0;
        for (size_t k = 0; k < N; k++) {
            photon q = photon_store_get(&store, k);
            float turned = dot3(q.n, n);
            bool alike = q.home || (filter.one_sided ? turned : fabsf(turned)) > 0.5f;
            bool above = !filter.one_sided || dot3(q.wi, n) > 0.0f;
            expected +=
                length3(q.p - p) < 0.3f && above && alike && q.home == filter.curve;
        }
        g_autoptr(photon_map) map = build_map(kinds[i / 3 % 3], &store, 0.1f, 2);
        point_hits hits = {0};
        g_assert_true(photon_map_within(map, p, 0.3f, &filter, &hits));
        g_assert_cmpuint(hits.n, ==, expected);
        g_assert_cmpuint(expected, >, 5);
        g_assert_true(photon_map_nearest(map, p, expected - 3, 1.0f, &filter, &hits));
        for (size_t k = 0; k < hits.n; k++) {
            g_assert_cmpfloat(hits.distance2[k], <, 0.09f);
            g_assert_cmpuint(photon_map_store(map)->home[hits.index[k]], ==, i % 3);
        }
        point_hits_clear(&hits);
    }
}

/* Of a surface seen from behind, only photons on faces that lie alike. */
static void test_faces_by_definition(void)
{
    enum { N = 500 };
    photon_store store = make_store(place_cube, N);
    g_autoptr(photon_map) list = build_map(MAP_LIST, &store, 0, 1);
    const photon_store *kept = photon_map_store(list);
    point_hits hits = {0};
    vec3 p = vec3_make(0.4f, 0.5f, 0.6f), n = normalize3(vec3_make(1, 2, 2));
    for (int face = -1; face <= 1; face += 2) {
        photon_filter filter = {.n = n, .flatten = 1, .face = face};
        size_t expected = 0;
        g_assert_true(photon_map_within(list, p, 0.3f, &filter, &hits));
        for (size_t i = 0; i < N; i++) {
            photon q = photon_store_get(kept, i);
            bool above = dot3(q.wi, n) > 0.0f, behind = q.flags & PHOTON_BEHIND;
            vec3 own = above != behind ? n : -n;
            expected += length3(q.p - p) < 0.3f && dot3(own, n) * (float)face > 0.0f;
        }
        g_assert_cmpuint(hits.n, ==, expected);
        g_assert_cmpuint(expected, >, 5);
    }
    point_hits_clear(&hits);
}

/* Of a sheet, whose triangles are wound each its own way, all photons. */
static void test_sheet(void)
{
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        photon_store store = make_store(place_planar, 500);
        g_autoptr(photon_map) map = build_map(choice, &store, 0.1f, 1);
        point_hits hits = {0};
        photon_filter filter = {.n = vec3_make(0, 0, 1), .flatten = 1};
        vec3 p = vec3_make(0.4f, 0.5f, 0.25f);
        g_assert_true(photon_map_within(map, p, 0.3f, &filter, &hits));
        size_t all = hits.n;
        filter.face = 1;
        g_assert_true(photon_map_within(map, p, 0.3f, &filter, &hits));
        g_assert_cmpuint(hits.n, ==, all);
        g_assert_cmpuint(all, >, 50);
        point_hits_clear(&hits);
    }
}

static void test_empty(void)
{
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        photon_store none = {0};
        g_autoptr(photon_map) map =
            photon_map_build(choice, &none, 0.1f, (workers){.threads = 1}, NULL);
        g_assert_nonnull(map);
        point_hits hits = {.n = 5};
        g_assert_true(photon_map_within(map, vec3_make(0, 0, 0), 1, NULL, &hits));
        g_assert_cmpuint(hits.n, ==, 0);
        g_assert_true(photon_map_nearest(map, vec3_make(0, 0, 0), 9, 1, NULL, &hits));
        g_assert_cmpuint(hits.n, ==, 0);
        point_hits_clear(&hits);
    }
}

/* ---- Parallel building, memory ---- */

static void assert_same_store(const photon_store *a, const photon_store *b)
{
    g_assert_cmpuint(a->n, ==, b->n);
    g_assert_cmpmem(a->x, a->n * sizeof *a->x, b->x, b->n * sizeof *b->x);
    g_assert_cmpmem(a->y, a->n * sizeof *a->y, b->y, b->n * sizeof *b->y);
    g_assert_cmpmem(a->z, a->n * sizeof *a->z, b->z, b->n * sizeof *b->z);
    g_assert_cmpmem(a->wi, a->n * sizeof *a->wi, b->wi, b->n * sizeof *b->wi);
    g_assert_cmpmem(a->packed, a->n * sizeof *a->packed, b->packed,
                    b->n * sizeof *b->packed);
}

static void test_parallel_is_serial(void)
{
    enum { N = 100000 };
    static const field_place places[] = {place_cube, place_clustered, place_lattice,
                                         place_landscape};
    for (size_t f = 0; f < G_N_ELEMENTS(places); f++) {
        photon_store store = make_store(places[f], N);
        for (map_choice choice = MAP_KDTREE; choice <= MAP_GRID; choice++) {
            g_autoptr(photon_map) one = build_copy(choice, &store, 0.02f, 1);
            for (unsigned threads = 2; threads <= 5; threads += 3) {
                g_autoptr(photon_map) many = build_copy(choice, &store, 0.02f, threads);
                assert_same_store(photon_map_store(one), photon_map_store(many));
                g_assert_cmpuint(photon_map_bytes(one), ==, photon_map_bytes(many));
            }
        }
        photon_store_clear(&store);
    }
}

static void test_memory(void)
{
    enum { N = 20000 };
    static const double extra[] = {
        [MAP_LIST] = 0.1, [MAP_KDTREE] = 2.0, [MAP_GRID] = 4.1};
    for (size_t f = 0; f < G_N_ELEMENTS(fields); f++) {
        photon_store store = make_store(fields[f].place, N);
        for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
            g_autoptr(photon_map) map = build_copy(choice, &store, 0.001f, 1);
            double each = (double)photon_map_bytes(map) / N;
            g_assert_cmpfloat(each, >=, 40.0);
            g_assert_cmpfloat(each, <=, 40.1 + extra[choice]);
        }
        photon_store_clear(&store);
    }
}

/* While it is built a map takes at most twice what it keeps. */
static void test_peak(void)
{
    enum { N = 100000 };
    static const field_place places[] = {place_cube, place_planar, place_landscape};
    for (size_t i = 0; i < 9; i++) {
        map_choice choice = (map_choice)(MAP_LIST + i / 3);
        photon_store store = make_store(places[i % 3], N);
        g_autoptr(photon_map) map = build_copy(choice, &store, 0.01f, 1);
        size_t kept = photon_map_bytes(map), own = photon_store_bytes(&store);
        size_t others = memory_limit() - memory_left() - own;
        memory_set_limit(others + 2 * kept);
        g_autoptr(photon_map) again = build_map(choice, &store, 0.01f, 1);
        memory_set_limit(0);
        g_assert_cmpuint(photon_map_bytes(again), ==, kept);
    }
}

/* Refuses the n-th allocation of a build, for every n until the build succeeds. */
static void test_build_refused(void)
{
    for (map_choice choice = MAP_KDTREE; choice <= MAP_GRID; choice++) {
        for (unsigned n = 1;; n++) {
            g_assert_cmpuint(n, <, 30);
            photon_store store = make_store(place_cube, 100);
            g_autoptr(GError) error = NULL;
            big_alloc_fail_at(n);
            g_autoptr(photon_map) map =
                photon_map_build(choice, &store, 0.1f, (workers){.threads = 1}, &error);
            big_alloc_fail_at(0);
            g_assert_null(store.x);
            if (map)
                break;
            g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        }
    }
}

static void test_query_refused(void)
{
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        photon_store store = make_store(place_cube, 500);
        g_autoptr(photon_map) map = build_map(choice, &store, 0.1f, 1);
        for (unsigned n = 1; n <= 2; n++) {
            point_hits hits = {0};
            big_alloc_fail_at(n);
            g_assert_false(photon_map_within(map, place_same(NULL), 9, NULL, &hits));
            big_alloc_fail_at(n);
            g_assert_false(photon_map_nearest(map, place_same(NULL), 9, 9, NULL, &hits));
            g_assert_true(photon_map_within(map, place_same(NULL), 9, NULL, &hits));
            g_assert_cmpuint(hits.n, ==, 500);
            point_hits_clear(&hits);
        }
    }
}

/* A flag that is set the n-th time that work shows a pulse. */
typedef struct late_cancel {
    cancel_flag flag;
    int n, seen;
} late_cancel;

static void count_down(void *data)
{
    late_cancel *late = data;
    if (++late->seen == late->n)
        atomic_store(&late->flag.set, true);
}

static photon_map *build_until(map_choice choice, late_cancel *late, GError **error)
{
    enum { N = 100000 };
    photon_store store = make_store(place_cube, N);
    late->flag.progress = count_down;
    late->flag.progress_data = late;
    return photon_map_build(choice, &store, 0.05f, (workers){1, &late->flag}, error);
}

/* Whenever it is asked to, sorting ends, and gives back what it took. */
static void test_cancelled(void)
{
    static const map_choice choices[] = {MAP_KDTREE, MAP_GRID};
    size_t before = memory_forget_most();
    for (size_t i = 0; i < G_N_ELEMENTS(choices); i++) {
        late_cancel never = {.n = -1};
        photon_map *map = build_until(choices[i], &never, NULL);
        g_assert_nonnull(map);
        photon_map_free(map);
        g_assert_cmpint(never.seen, >, 8);
        for (int n = 1; n < never.seen / 2; n += 1 + n / 4) {
            late_cancel late = {.n = n};
            g_autoptr(GError) error = NULL;
            g_assert_null(build_until(choices[i], &late, &error));
            g_assert_cmpint(error->code, ==, ERROR_CANCELLED);
        }
        g_assert_cmpuint(memory_forget_most(), ==, before);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/map/list/by-definition", test_list_by_definition);
    g_test_add_func("/map/curves-by-definition", test_curves_by_definition);
    g_test_add_func("/map/list/faces", test_faces_by_definition);
    g_test_add_func("/map/sheet", test_sheet);
    g_test_add_func("/map/kdtree/same-as-list", test_kdtree_same_as_list);
    g_test_add_func("/map/grid/same-as-list", test_grid_same_as_list);
    g_test_add_func("/map/grid/hashed-rows", test_grid_hashed_rows);
    g_test_add_func("/map/grid/keeps-order", test_grid_keeps_order);
    g_test_add_func("/map/empty", test_empty);
    g_test_add_func("/map/parallel-is-serial", test_parallel_is_serial);
    g_test_add_func("/map/memory", test_memory);
    g_test_add_func("/map/peak", test_peak);
    g_test_add_func("/map/build-refused", test_build_refused);
    g_test_add_func("/map/query-refused", test_query_refused);
    g_test_add_func("/map/cancelled", test_cancelled);
    return g_test_run();
}
