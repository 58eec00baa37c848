/*
 * near_places: the place that a search of all of them finds, for places that fill a box,
 * lie on a plane or a line, in clusters, on one another, few or none; asked from inside
 * and outside the box, by several threads at once.
 */
#include "base/parallel.h"
#include "math/sampler.h"
#include "transport/near_places.h"

enum { MOST = 4096, N_ASKED = 20000 };

static float number(uint64_t i, uint64_t of)
{
    return (float)(hash_mix(i, of) >> 40) * 0x1p-24f;
}

static vec3 anywhere(uint64_t i)
{
    return vec3_make(number(i, 1), number(i, 2), number(i, 3));
}

typedef enum spread { BOX, PLANE, LINE, CLUSTERS, ONE_PLACE, N_SPREADS } spread;

static vec3 place_of(spread how, uint64_t i)
{
    vec3 p = anywhere(i);
    switch (how) {
    case PLANE:
        return vec3_make(p[0], 0.3f, 2.0f * p[2]);
    case LINE:
        return vec3_make(0.1f, p[1], 7.0f);
    case CLUSTERS:
        return anywhere(i % 5 + 1000000) * 100.0f + 0.01f * p;
    case ONE_PLACE:
        return vec3_make(1.0f, 2.0f, 3.0f);
    default:
        return p;
    }
}

static vec3 asked_of(spread how, uint64_t i)
{
    vec3 beside = 0.05f * (anywhere(i + MOST) - 0.5f);
    return i % 3 == 0 ? 3.0f * anywhere(i) - 1.0f : place_of(how, i + 77) + beside;
}

static float least_distance2(const vec3 *places, size_t n, vec3 p)
{
    float least = INFINITY;
    for (size_t i = 0; i < n; i++)
        least = minf(least, length3_2(places[i] - p));
    return least;
}

typedef struct asking {
    spread how;
    const vec3 *places;
    size_t n;
    const near_places *near;
} asking;

static void ask(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const asking *a = data;
    point_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        const vec3 p = asked_of(a->how, i);
        near_place found;
        float expected = least_distance2(a->places, a->n, p);
        g_assert_true(near_places_find(a->near, p, &found, &hits));
        float d2 = length3_2(a->places[found.which] - p);
        g_assert_cmpfloat(fabsf(d2 - expected), <=, 1e-5f * expected);
        g_assert_cmpfloat(fabsf(found.distance2 - expected), <=, 1e-5f * expected);
    }
    point_hits_clear(&hits);
}

static void test_against_all(void)
{
    static const size_t sizes[] = {1, 2, 17, 300, MOST};
    static vec3 places[MOST];
    for (spread how = BOX; how < N_SPREADS; how++) {
        for (size_t i = 0; i < MOST; i++)
            places[i] = place_of(how, i);
        for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
            size_t n = sizes[i], n_asked = n == MOST ? N_ASKED / 10 : N_ASKED;
            g_autoptr(near_places) near = near_places_build(places, n, NULL);
            asking a = {how, places, n, near};
            parallel_for(n_asked, 64, 4, NULL, ask, &a);
        }
    }
}

static void test_none(void)
{
    point_hits hits = {0};
    near_place found;
    g_autoptr(near_places) near = near_places_build(NULL, 0, NULL);
    g_assert_false(near_places_find(near, vec3_make(0, 0, 0), &found, &hits));
    point_hits_clear(&hits);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/near-places/against-all", test_against_all);
    g_test_add_func("/near-places/none", test_none);
    return g_test_run();
}
