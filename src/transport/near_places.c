#include "transport/near_places.h"

#include "math/box.h"

#include <float.h>

/* Places that may be nearest. */
typedef struct cell {
    size_t n; /* 0: the tree is asked */
    uint32_t which[];
} cell;

struct near_places {
    size_t n;
    const vec3 *places; /* borrowed */
    point_set *tree;
    vec3 low, size;         /* of the box around all; of a cell */
    size_t n_cells[3];      /* along each axis */
    _Atomic(cell *) *cells; /* NULL: not asked for yet; owned */
};

/* @return cells in all, if they were so wide */
static size_t count_cells(near_places *near, vec3 extent, float wide)
{
    size_t n_all = 1;
    for (int axis = 0; axis < 3; axis++) {
        near->n_cells[axis] = 1 + (size_t)(extent[axis] / wide);
        n_all *= near->n_cells[axis];
    }
    return n_all;
}

/* Twice as many as places or some more; a box that is flat has one layer of them, and one
   that is no more than a point one cell. */
static void make_cells(near_places *near)
{
    box3 box = near->n > 0 ? box3_empty() : (box3){0};
    for (size_t i = 0; i < near->n; i++)
        box = box3_with_point(box, near->places[i]);
    const vec3 extent = box.high - box.low;
    near->low = box.low;
    float wide = maxf(maxf(extent[0], extent[1]), extent[2]);
    size_t n_all = count_cells(near, extent, wide > 0.0f ? wide : 1.0f);
    while (wide > FLT_MIN && n_all < 2 * near->n) {
        wide *= (float)M_SQRT1_2;
        n_all = count_cells(near, extent, wide);
    }
    for (int axis = 0; axis < 3; axis++)
        near->size[axis] = extent[axis] / (float)near->n_cells[axis];
    near->cells = g_new0(_Atomic(cell *), n_all);
}

near_places *near_places_build(const vec3 *places, size_t n, GError **error)
{
    g_autoptr(near_places) near = g_aligned_alloc0(1, sizeof *near, 16);
    near->n = n;
    near->places = places;
    make_cells(near);
    near->tree = point_set_build(places, n, 1, error);
    return near->tree ? g_steal_pointer(&near) : NULL;
}

void near_places_free(near_places *near)
{
    if (!near)
        return;
    size_t n_all = near->n_cells[0] * near->n_cells[1] * near->n_cells[2];
    for (size_t i = 0; i < n_all; i++)
        g_free(near->cells[i]);
    g_free(near->cells);
    point_set_free(near->tree);
    g_aligned_free(near);
}

/* @return false: p lies outside the box */
static bool find_cell(const near_places *near, vec3 p, size_t at[3])
{
    for (int axis = 0; axis < 3; axis++) {
        float from = p[axis] - near->low[axis];
        float cells = (float)near->n_cells[axis];
        float place = near->size[axis] > 0.0f ? from / near->size[axis] : from;
        if (!(place >= 0.0f && place <= cells))
            return false;
        at[axis] = MIN((size_t)place, near->n_cells[axis] - 1);
    }
    return true;
}

/* Of the places in hits. */
static cell *list_places(const near_places *near, const point_hits *hits)
{
    size_t n = hits->n * hits->n <= near->n ? hits->n : 0;
    cell *c = g_malloc(sizeof *c + n * sizeof *c->which);
    c->n = n;
    for (size_t i = 0; i < n; i++)
        c->which[i] = hits->index[i];
    return c;
}

/* @return NULL: memory was refused */
static cell *make_cell(const near_places *near, const size_t at[3], point_hits *hits)
{
    const float rounding = 1.0f + sqrtf(FLT_EPSILON); /* and more than enough */
    vec3 centre;
    for (int axis = 0; axis < 3; axis++)
        centre[axis] = near->low[axis] + ((float)at[axis] + 0.5f) * near->size[axis];
    if (!point_set_nearest(near->tree, centre, 1, INFINITY, hits) || hits->n == 0)
        return NULL;
    float reach = sqrtf(hits->distance2[0]) + length3(near->size);
    if (!point_set_within(near->tree, centre, rounding * reach, hits))
        return NULL;
    return list_places(near, hits);
}

static const cell *cell_at(const near_places *near, const size_t at[3], point_hits *hits)
{
    size_t i = (at[2] * near->n_cells[1] + at[1]) * near->n_cells[0] + at[0];
    cell *c = atomic_load_explicit(&near->cells[i], memory_order_acquire), *none = NULL;
    if (c)
        return c;
    c = make_cell(near, at, hits);
    if (!c || atomic_compare_exchange_strong(&near->cells[i], &none, c))
        return c;
    g_free(c);
    return none;
}

static near_place nearest_of(const near_places *near, const cell *c, vec3 p)
{
    near_place best = {SIZE_MAX, INFINITY};
    for (size_t i = 0; i < c->n; i++) {
        float d2 = length3_2(near->places[c->which[i]] - p);
        best = d2 < best.distance2 ? (near_place){c->which[i], d2} : best;
    }
    return best;
}

bool near_places_find(const near_places *near, vec3 p, near_place *found,
                      point_hits *hits)
{
    size_t at[3];
    const cell *c = find_cell(near, p, at) ? cell_at(near, at, hits) : NULL;
    if (c && c->n > 0) {
        *found = nearest_of(near, c, p);
        return true;
    }
    if (!point_set_nearest(near->tree, p, 1, INFINITY, hits) || hits->n == 0)
        return false;
    *found = (near_place){hits->index[0], hits->distance2[0]};
    return true;
}
