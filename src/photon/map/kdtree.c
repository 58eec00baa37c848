/*
 * The kd-tree: left-balanced, implicit, sixteen-wide, with boxes instead of planes.
 *
 *   level 2   group 0: boxes of 16 groups below      low.x[16] low.y[16] .. high.z[16]
 *   level 1   group 0 .. 15: boxes of 16 leaves each
 *   level 0   leaf 0: points 0..15 │ leaf 1: 16..31 │ ..          (the points themselves)
 *
 * Group g of a level has groups 16g .. 16g + 15 below it, so there are no pointers; every
 * leaf but the last is full. Four binary splits at the median (in points, rounded to
 * whole subtrees as in Jensen's left-balanced tree) along the widest axis of the points
 * make one level. Points mostly lie on surfaces: boxes are then flat and prune far better
 * than planes, and sixteen are tested at once. 1.6 bytes a point.
 *
 * A search within a radius goes down level by level, with lists of groups in place of a
 * stack: what a group's boxes say is appended without a branch. So does a search for
 * balls that a ray meets: then boxes hold the balls around the points.
 *
 * Bentley, "Multidimensional binary search trees used for associative searching", 1975;
 * Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001.
 */
#include "photon/map/kdtree.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "math/box.h"

#include <float.h>

enum {
    WIDTH = 16,   /* size: of a group; so many lanes fill one vector, or two */
    LEAF = WIDTH, /* points of one */
    MAX_LEVELS = 2 * sizeof(size_t), /* math: of four bits each */
    MAX_STACK = MAX_LEVELS * (WIDTH - 1) + WIDTH,
    OPENED = WIDTH, /* groups that are opened before what is below them */
};

/* The boxes of sixteen subtrees; an absent one is empty, infinitely far from everything.
 */
typedef struct kd_group {
    float low[3][WIDTH], high[3][WIDTH];
} kd_group;

struct kdtree {
    size_t n;
    unsigned n_levels;             /* 1 .. MAX_LEVELS */
    size_t offset[MAX_LEVELS + 1]; /* of a level's first group; level 0 has none */
    size_t n_groups;
    kd_group *groups;
};

/* ---- Building ---- */

/* A point on its way to its place. */
typedef struct kd_item {
    float x[3];
    uint32_t index;
} kd_item;

typedef struct kd_builder {
    kdtree *tree;
    kd_item *items;
    size_t n;
    size_t span; /* points below a full node of the split being made */
    size_t *order;
    const point_arrays *points;
    const float *radii; /* of balls around them; NULL: they are points */
    unsigned n_levels, level;
    const cancel_flag *cancel;
} kd_builder;

/* Moves items below pivot (or_like: or like it) to the front, without branches; returns
 * their number. */
static size_t partition(kd_item *items, size_t n, int axis, float pivot, bool or_like)
{
    size_t below = 0;
    for (size_t i = 0; i < n; i++) {
        kd_item item = items[i];
        items[i] = items[below];
        items[below] = item;
        float x = item.x[axis];
        below += or_like ? !(pivot < x) : x < pivot;
    }
    return below;
}

/* A value of items that should stand near rank, from a sample. */
static float choose_pivot(const kd_item *items, size_t n, int axis, size_t rank)
{
    enum { MOST = 31 }; /* size: of the sample */
    float sample[MOST];
    size_t n_sample = n <= MOST ? 1 : n <= MOST * MOST ? MOST / 4 : MOST; /* size: too */
    for (size_t i = 0; i < n_sample; i++) {
        float x = items[(2 * i + 1) * n / (2 * n_sample)].x[axis];
        size_t j = i;
        for (; j > 0 && sample[j - 1] > x; j--)
            sample[j] = sample[j - 1];
        sample[j] = x;
    }
    return sample[rank * n_sample / n];
}

/* Orders items so that those before rank are not above those from rank on. Goes through
   many of them several times, so it stops between if nobody wants it any more. */
static void split_at(const kd_builder *b, kd_item *items, size_t n, int axis, size_t rank)
{
    while (n > 1 && !cancelled(b->cancel)) {
        float pivot = choose_pivot(items, n, axis, rank);
        size_t below = partition(items, n, axis, pivot, false);
        if (rank < below) {
            n = below;
            continue;
        }
        if (below == 0) {
            below = partition(items, n, axis, pivot, true);
            if (rank < below)
                return;
        }
        items += below;
        rank -= below;
        n -= below;
    }
}

/* In this order a NaN changes nothing. */
static box3 with_point(box3 box, float x, float y, float z)
{
    vec3 p = vec3_make(x, y, z);
    return (box3){min3(p, box.low), max3(p, box.high)};
}

static int widest_axis(const kd_item *items, size_t n)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < n; i++)
        box = with_point(box, items[i].x[0], items[i].x[1], items[i].x[2]);
    vec3 extent = box.high - box.low;
    if (extent[0] >= extent[1] && extent[0] >= extent[2])
        return 0;
    return extent[1] >= extent[2] ? 1 : 2;
}

/* One binary split of a node that has room for span points. */
static void split_node(const kd_builder *b, kd_item *items, size_t n, size_t span)
{
    if (n > span / 2)
        split_at(b, items, n, widest_axis(items, n), span / 2);
}

/* Splits down to leaves. */
static void split_subtree(const kd_builder *b, kd_item *items, size_t n, size_t span)
{
    if (n <= LEAF)
        return;
    split_node(b, items, n, span);
    size_t half = MIN(n, span / 2);
    split_subtree(b, items, half, span / 2);
    split_subtree(b, items + half, n - half, span / 2);
}

static void split_task(size_t node, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    const kd_builder *b = data;
    size_t begin = node * b->span, n = MIN(b->span, b->n - begin);
    if (b->span > ITEMS_AT_ONCE)
        split_node(b, b->items + begin, n, b->span);
    else
        split_subtree(b, b->items + begin, n, b->span);
}

/* Large nodes one level after the other, each level's in parallel; then whole subtrees in
 * parallel. */
static bool split_all(kd_builder *b, workers by, GError **error)
{
    b->cancel = by.cancel;
    b->span = LEAF;
    for (unsigned level = 0; level < b->n_levels; level++)
        b->span *= WIDTH;
    for (;; b->span /= 2) {
        size_t n_nodes = (b->n + b->span - 1) / b->span;
        if (!parallel_work(n_nodes, 1, by, split_task, b, error))
            return false;
        if (b->span <= ITEMS_AT_ONCE)
            return true;
    }
}

static void load_items(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const kd_builder *b = data;
    const point_arrays *s = b->points;
    for (size_t i = begin; i < end; i++)
        b->items[i] = (kd_item){{s->x[i], s->y[i], s->z[i]}, (uint32_t)i};
}

static void store_order(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const kd_builder *b = data;
    for (size_t i = begin; i < end; i++)
        b->order[i] = b->items[i].index;
}

/* Nodes on a level: leaves on level 0, groups above. */
static size_t nodes_on_level(size_t n, unsigned level)
{
    size_t span = LEAF;
    for (; level > 0; level--)
        span *= WIDTH;
    return (n + span - 1) / span;
}

/* Levels of groups over n points, at least one. */
static unsigned levels_over(size_t n)
{
    unsigned levels = 1;
    while (nodes_on_level(n, levels) > 1)
        levels++;
    return levels;
}

size_t *kdtree_sort(const point_arrays *points, workers by, GError **error)
{
    kd_builder b = {.n = points->n, .points = points, .n_levels = levels_over(points->n)};
    b.items = big_alloc(b.n, sizeof *b.items, "sorting points", error);
    if (!b.items)
        return NULL;
    if (parallel_work(b.n, ITEMS_AT_ONCE, by, load_items, &b, error) &&
        split_all(&b, by, error))
        b.order = big_alloc(b.n, sizeof *b.order, "sorting points", error);
    if (b.order && !parallel_work(b.n, ITEMS_AT_ONCE, by, store_order, &b, error))
        g_clear_pointer(&b.order, big_free);
    big_free(b.items);
    return b.order;
}

static box3 leaf_bounds(const kd_builder *b, size_t leaf)
{
    const point_arrays *s = b->points;
    box3 box = box3_empty();
    size_t end = MIN((leaf + 1) * LEAF, s->n);
    for (size_t i = leaf * LEAF; i < end; i++) {
        float r = b->radii ? b->radii[i] : 0.0f;
        box = with_point(box, s->x[i] - r, s->y[i] - r, s->z[i] - r);
        box = with_point(box, s->x[i] + r, s->y[i] + r, s->z[i] + r);
    }
    return box;
}

static box3 group_bounds(const kd_group *group)
{
    box3 box = box3_empty();
    for (int lane = 0; lane < WIDTH; lane++) {
        vec3 low = {group->low[0][lane], group->low[1][lane], group->low[2][lane]};
        vec3 high = {group->high[0][lane], group->high[1][lane], group->high[2][lane]};
        box = box3_union(box, (box3){low, high});
    }
    return box;
}

/* The bounds of a node on the level below the one being filled; empty if there is none.
 */
static box3 child_bounds(const kd_builder *b, size_t child)
{
    if (child >= nodes_on_level(b->n, b->level - 1))
        return box3_empty();
    if (b->level == 1)
        return leaf_bounds(b, child);
    return group_bounds(b->tree->groups + b->tree->offset[b->level - 1] + child);
}

static void fill_groups(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const kd_builder *b = data;
    for (size_t g = begin; g < end; g++) {
        kd_group *group = b->tree->groups + b->tree->offset[b->level] + g;
        for (int lane = 0; lane < WIDTH; lane++) {
            box3 box = child_bounds(b, g * WIDTH + (size_t)lane);
            for (int axis = 0; axis < 3; axis++) {
                group->low[axis][lane] = box.low[axis];
                group->high[axis][lane] = box.high[axis];
            }
        }
    }
}

static void shape_tree(kdtree *tree, size_t n)
{
    tree->n = n;
    tree->n_levels = levels_over(n);
    for (unsigned level = 1; level <= tree->n_levels; level++) {
        tree->offset[level] = tree->n_groups;
        tree->n_groups += nodes_on_level(n, level);
    }
}

kdtree *kdtree_build(const point_arrays *sorted, const float *radii, workers by,
                     GError **error)
{
    kdtree *tree = big_alloc(1, sizeof *tree, "kdtree", error);
    if (!tree)
        return NULL;
    shape_tree(tree, sorted->n);
    tree->groups = big_alloc(tree->n_groups, sizeof *tree->groups, "kdtree", error);
    if (!tree->groups) {
        kdtree_free(tree);
        return NULL;
    }
    kd_builder b = {.tree = tree, .n = sorted->n, .points = sorted, .radii = radii};
    bool done = true;
    for (b.level = 1; b.level <= tree->n_levels && done; b.level++)
        done = parallel_work(nodes_on_level(b.n, b.level), ITEMS_AT_ONCE / (WIDTH * LEAF),
                             by, fill_groups, &b, error);
    if (!done)
        g_clear_pointer(&tree, kdtree_free);
    return tree;
}

void kdtree_free(kdtree *tree)
{
    if (!tree)
        return;
    big_free(tree->groups);
    big_free(tree);
}

size_t kdtree_bytes(const kdtree *tree)
{
    return sizeof *tree + tree->n_groups * sizeof *tree->groups;
}

/* ---- Searching ---- */

/* A subtree still to be visited, and the squared distance to its box. */
typedef struct kd_entry {
    float distance2;
    unsigned level;
    size_t node;
} kd_entry;

/* Squared distances from p to LANES boxes. Each step rounds monotonely, so none exceeds
 * query_distance2 of a point in the box. */
static inline lane_floats box_distances(const kd_group *group, int first, vec3 p)
{
    lane_floats d[3];
    for (int axis = 0; axis < 3; axis++) {
        lane_floats low = load_lanes(group->low[axis] + first) - p[axis];
        lane_floats high = p[axis] - load_lanes(group->high[axis] + first);
        d[axis] = max_lanes(max_lanes(low, high), fill_lanes(0.0f));
    }
    return fused_lanes(d[2], d[2], fused_lanes(d[1], d[1], d[0] * d[0]));
}

/* Pushes the subtrees below `node` that are nearer than limit, the nearest on top. */
static size_t push_sorted(const kdtree *tree, vec3 p, kd_entry node, float limit,
                          kd_entry *stack, size_t top)
{
    const kd_group *group = tree->groups + tree->offset[node.level] + node.node;
    float d2[WIDTH];
    unsigned near = 0;
    for (int i = 0; i < WIDTH; i += LANES) {
        lane_floats distances = box_distances(group, i, p);
        store_lanes(d2 + i, distances);
        near |= bits_below(distances, fill_lanes(limit)) << i;
    }
    size_t bottom = top;
    for (unsigned bits = near; bits; bits &= bits - 1) {
        int lane = __builtin_ctz(bits);
        size_t i = top++;
        for (; i > bottom && stack[i - 1].distance2 < d2[lane]; i--)
            stack[i] = stack[i - 1];
        stack[i] = (kd_entry){d2[lane], node.level - 1, node.node * WIDTH + (size_t)lane};
    }
    return top;
}

void kdtree_nearest(const kdtree *tree, nearest_set *set)
{
    kd_entry stack[MAX_STACK];
    stack[0] = (kd_entry){0.0f, tree->n_levels, 0};
    for (size_t top = 1; top > 0;) {
        kd_entry node = stack[--top];
        if (!(node.distance2 < set->limit))
            continue;
        if (node.level > 0)
            top = push_sorted(tree, set->query->p, node, set->limit, stack, top);
        else
            nearest_add_run(set, node.node * LEAF, MIN((node.node + 1) * LEAF, tree->n));
    }
    nearest_cut(set);
}

/* The nearest so far: hit 0 of the set. */
static void take_nearest(nearest_set *set, size_t leaf, size_t n)
{
    point_hits *hits = set->hits;
    size_t end = MIN((leaf + 1) * LEAF, n);
    for (size_t i = leaf * LEAF; i < end; i += LANES) {
        lane_floats d2;
        unsigned bits = query_nearer(set->query, set->points, i, end, set->limit, &d2);
        float least = bits ? least_lane(d2, bits) : INFINITY;
        for (bits &= ~bits_below(fill_lanes(least), d2); bits; bits &= bits - 1u) {
            size_t place = i + (size_t)__builtin_ctz(bits);
            if (hits->n > 0 &&
                !nearest_before(set, place, least, hits->index[0], hits->distance2[0]))
                continue;
            hits->n = 1;
            hits->index[0] = (uint32_t)place;
            hits->distance2[0] = least;
            set->limit = nextafterf(least, INFINITY);
        }
    }
}

/* A group on the way down to the nearest: how far its subtrees are, and which of them
   are left. */
typedef struct kd_step {
    size_t node;
    unsigned left;
    float d2[WIDTH];
} kd_step;

static void open_step(const kdtree *tree, vec3 p, unsigned level, size_t node,
                      kd_step *step)
{
    const kd_group *group = tree->groups + tree->offset[level] + node;
    step->node = node;
    step->left = (1u << WIDTH) - 1u;
    for (int i = 0; i < WIDTH; i += LANES)
        store_lanes(step->d2 + i, box_distances(group, i, p));
}

/* Takes the nearest subtree that is nearer than limit. @return false: none is left */
static bool next_nearest(kd_step *step, float limit, size_t *node)
{
    float least = limit;
    int lane = -1;
    for (int i = 0; i < WIDTH; i++) {
        bool nearer = (step->left >> i & 1u) && step->d2[i] < least;
        least = nearer ? step->d2[i] : least;
        lane = nearer ? i : lane;
    }
    if (lane < 0)
        return false;
    step->left &= ~(1u << lane);
    *node = step->node * WIDTH + (size_t)lane;
    return true;
}

/* Down to the nearest leaf first; few of the others are ever looked at. */
void kdtree_nearest_one(const kdtree *tree, nearest_set *set)
{
    kd_step steps[MAX_LEVELS + 1];
    unsigned level = tree->n_levels;
    if (level == 0) {
        take_nearest(set, 0, tree->n);
        return;
    }
    open_step(tree, set->query->p, level, 0, &steps[level]);
    while (level <= tree->n_levels) {
        size_t node;
        if (!next_nearest(&steps[level], set->limit, &node)) {
            level++;
        } else if (level == 1) {
            take_nearest(set, node, tree->n);
        } else {
            level--;
            open_step(tree, set->query->p, level, node, &steps[level]);
        }
    }
}

/* A ray that boxes are to meet. */
typedef struct kd_ray {
    vec3 inverse; /* of the direction */
    float length;
} kd_ray;

/* A search for runs. */
typedef struct kd_search {
    const kdtree *tree;
    const point_arrays *points;
    vec3 p;
    float limit;       /* squared */
    const kd_ray *ray; /* from p; NULL: boxes within the limit */
    point_run_visitor visit;
    void *data;
} kd_search;

/* n <= OPENED * WIDTH. Apart, so that what calls itself has a small frame. */
static __attribute__((noinline)) void visit_leaves(const kd_search *s,
                                                   const uint32_t *leaves, size_t n)
{
    point_run runs[OPENED * WIDTH];
    for (size_t i = 0; i < n; i++) {
        size_t begin = (size_t)leaves[i] * LEAF;
        __builtin_prefetch(s->points->x + begin);
        __builtin_prefetch(s->points->y + begin);
        __builtin_prefetch(s->points->z + begin);
        runs[i] = (point_run){begin, MIN(begin + LEAF, s->tree->n)};
    }
    s->visit(runs, n, s->data);
}

/* Bits of LANES boxes that a ray from p meets, none left out by rounding (Ize, "Robust
   BVH Ray Traversal", 2013); an empty one is never met. */
static inline unsigned boxes_met(const kd_group *group, int first, vec3 p,
                                 const kd_ray *ray)
{
    const float rounding = 1.0f + 3.0f * FLT_EPSILON; /* math: of what is multiplied */
    lane_floats begin = fill_lanes(0.0f), end = fill_lanes(ray->length);
    for (int axis = 0; axis < 3; axis++) {
        bool back = ray->inverse[axis] < 0.0f;
        const float *near = back ? group->high[axis] : group->low[axis];
        const float *far = back ? group->low[axis] : group->high[axis];
        lane_floats enters = (load_lanes(near + first) - p[axis]) * ray->inverse[axis];
        lane_floats leaves = (load_lanes(far + first) - p[axis]) * ray->inverse[axis];
        begin = max_lanes(enters, begin);
        end = min_lanes(leaves * rounding, end);
    }
    return bits_below(begin, end);
}

static inline unsigned boxes_wanted(const kd_search *s, const kd_group *group, int first)
{
    if (s->ray)
        return boxes_met(group, first, s->p, s->ray);
    return bits_below(box_distances(group, first, s->p), fill_lanes(s->limit));
}

/* The nodes below n of a level that are wanted, in order; n <= OPENED. Returns their
 * number. */
static inline __attribute__((always_inline)) size_t
open_nodes(const kd_search *s, unsigned level, const uint32_t *nodes, size_t n,
           uint32_t below[OPENED * WIDTH + LANES])
{
    const kd_group *groups = s->tree->groups + s->tree->offset[level];
    size_t n_below = 0;
    for (size_t i = 0; i < n; i++) {
        for (int first = 0; first < WIDTH; first += LANES) {
            n_below += pack_numbers(boxes_wanted(s, groups + nodes[i], first),
                                    nodes[i] * WIDTH + (uint32_t)first, below + n_below);
        }
    }
    return n_below;
}

/* The same n nodes of a level, at most OPENED * WIDTH; leaves are met in order. While
 * they are few, as mostly, it goes down level by level without calls. */
static void visit_nodes(const kd_search *s, unsigned level, const uint32_t *nodes,
                        size_t n)
{
    uint32_t lists[2][OPENED * WIDTH + LANES];
    for (; level > 0 && n <= OPENED; level--) {
        uint32_t *below = lists[level & 1];
        n = open_nodes(s, level, nodes, n, below);
        nodes = below;
    }
    if (level == 0 && n > 0)
        visit_leaves(s, nodes, n);
    for (size_t begin = 0; level > 0 && begin < n; begin += OPENED)
        visit_nodes(s, level, nodes + begin, MIN(OPENED, n - begin));
}

void kdtree_runs(const kdtree *tree, const point_arrays *points, vec3 p, float radius,
                 point_run_visitor visit, void *data)
{
    const kd_search s = {.tree = tree,
                         .points = points,
                         .p = p,
                         .limit = radius * radius,
                         .visit = visit,
                         .data = data};
    visit_nodes(&s, tree->n_levels, (const uint32_t[]){0}, 1);
}

/* Never of zero, so that no product is of zero and infinity. */
static vec3 inverse_of(vec3 direction)
{
    for (int axis = 0; axis < 3; axis++)
        if (fabsf(direction[axis]) < FLT_MIN)
            direction[axis] = copysignf(FLT_MIN, direction[axis]);
    return 1.0f / direction;
}

void kdtree_runs_along(const kdtree *tree, const point_arrays *points, vec3 from,
                       vec3 direction, float length, point_run_visitor visit, void *data)
{
    const kd_ray ray = {inverse_of(direction), length};
    const kd_search s = {.tree = tree,
                         .points = points,
                         .p = from,
                         .ray = &ray,
                         .visit = visit,
                         .data = data};
    visit_nodes(&s, tree->n_levels, (const uint32_t[]){0}, 1);
}
