#include "light/light_tree.h"

#include "base/wanted.h"

#include <stdlib.h>

typedef struct tree_node {
    vec3 center, half; /* of its box */
    float radius2, power;
    int child;  /* index of the first of two, 0: a leaf */
    int parent; /* -1: the root */
    int light;  /* of a leaf */
} tree_node;

struct light_tree {
    GArray *nodes;     /* of tree_node, the root first; empty without local lights */
    int *distant;      /* indices of lights that are not local */
    float *irradiance; /* of those */
    int n_distant;
    float total_distant;
    int *place; /* by light: its leaf, or -1 - place in distant */
};

static tree_node *node_at(const light_tree *tree, int i)
{
    return &g_array_index(tree->nodes, tree_node, i);
}

/* ---- Building ---- */

/* A local light on its way into the tree. */
typedef struct tree_item {
    vec3 center;
    const light_bound *bound;
    float key; /* its centre along the axis that is split */
    int light;
} tree_item;

static int by_key(const void *a, const void *b)
{
    const tree_item *x = a, *y = b;
    if (x->key < y->key || x->key > y->key)
        return x->key < y->key ? -1 : 1;
    return x->light - y->light;
}

static void sort_along_widest_axis(tree_item *items, int n)
{
    box3 centers = box3_empty();
    for (int i = 0; i < n; i++)
        centers = box3_with_point(centers, items[i].center);
    vec3 extent = centers.high - centers.low;
    int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0
               : extent[1] >= extent[2]                         ? 1
                                                                : 2;
    for (int i = 0; i < n; i++)
        items[i].key = items[i].center[axis];
    qsort(items, (size_t)n, sizeof *items, by_key);
}

static void fill_node(light_tree *tree, int at, int parent, tree_item *items, int n)
{
    box3 box = box3_empty();
    float power = 0.0f;
    for (int i = 0; i < n; i++) {
        box = box3_union(box, items[i].bound->box);
        power += items[i].bound->power;
    }
    float radius = box3_radius(box);
    *node_at(tree, at) = (tree_node){.center = box3_center(box),
                                     .half = 0.5f * (box.high - box.low),
                                     .radius2 = radius * radius,
                                     .power = power,
                                     .parent = parent,
                                     .light = items[0].light};
    if (n == 1) {
        tree->place[items[0].light] = at;
        return;
    }
    if (!still_wanted(NULL))
        return;
    sort_along_widest_axis(items, n);
    int child = (int)tree->nodes->len;
    g_array_set_size(tree->nodes, (guint)child + 2);
    node_at(tree, at)->child = child;
    fill_node(tree, child, at, items, n / 2);
    fill_node(tree, child + 1, at, items + n / 2, n - n / 2);
}

static void add_distant(light_tree *tree, int light, float irradiance)
{
    tree->place[light] = -1 - tree->n_distant;
    tree->distant[tree->n_distant] = light;
    tree->irradiance[tree->n_distant++] = irradiance;
    tree->total_distant += irradiance;
}

light_tree *light_tree_new(const light_bound *bounds, int n)
{
    light_tree *tree = g_new0(light_tree, 1);
    size_t room = (size_t)MAX(n, 1);
    tree_item *items = g_aligned_alloc0(room, sizeof *items, 16);
    int n_local = 0;
    tree->nodes = g_array_new(FALSE, TRUE, sizeof(tree_node));
    tree->distant = g_new0(int, room);
    tree->irradiance = g_new0(float, room);
    tree->place = g_new0(int, room);
    for (int i = 0; i < n; i++) {
        if (bounds[i].is_local)
            items[n_local++] = (tree_item){
                .center = box3_center(bounds[i].box), .bound = &bounds[i], .light = i};
        else
            add_distant(tree, i, bounds[i].irradiance);
    }
    if (n_local > 0) {
        g_array_set_size(tree->nodes, 1);
        fill_node(tree, 0, -1, items, n_local);
    }
    g_aligned_free(items);
    return tree;
}

void light_tree_free(light_tree *tree)
{
    if (!tree)
        return;
    g_array_unref(tree->nodes);
    g_free(tree->distant);
    g_free(tree->irradiance);
    g_free(tree->place);
    g_free(tree);
}

/* ---- Choosing ---- */

static float worth(const tree_node *node, vec3 ref)
{
    float d2 = length3_2(node->center - ref);
    float nearest2 = maxf(d2, node->radius2);
    return nearest2 > 0.0f ? node->power / (4.0f * PI_F * nearest2) : node->power;
}

/* The probability of going from a node to its first child. */
static float first_share(const light_tree *tree, const tree_node *node, vec3 ref)
{
    float a = worth(node_at(tree, node->child), ref);
    float b = worth(node_at(tree, node->child + 1), ref);
    return a + b > 0.0f ? a / (a + b) : 0.5f;
}

/* The probability that one of the distant lights is chosen rather than a local one. */
static float distant_share(const light_tree *tree, vec3 ref)
{
    float local = tree->nodes->len ? worth(node_at(tree, 0), ref) : 0.0f;
    float total = tree->total_distant + local;
    return total > 0.0f ? tree->total_distant / total : 0.0f;
}

/* Cuts [0,1) at p: *u becomes uniform again in the part it lies in, *probability shrinks.
 */
static bool below(float *u, float p, float *probability)
{
    bool first = *u < p;
    *probability *= first ? p : 1.0f - p;
    *u = minf(first ? *u / p : (*u - p) / (1.0f - p), 0x1.fffffep-1f);
    return first;
}

static int sample_distant(const light_tree *tree, float u, float *probability)
{
    int i = 0;
    float target = u * tree->total_distant;
    while (i + 1 < tree->n_distant && target >= tree->irradiance[i])
        target -= tree->irradiance[i++];
    *probability *= tree->irradiance[i] / tree->total_distant;
    return tree->distant[i];
}

int light_tree_sample(const light_tree *tree, vec3 ref, float u, float *probability)
{
    *probability = 1.0f;
    if (tree->n_distant > 0 && below(&u, distant_share(tree, ref), probability))
        return sample_distant(tree, u, probability);
    if (tree->nodes->len == 0)
        return -1;
    const tree_node *node = node_at(tree, 0);
    while (node->child) {
        bool first = below(&u, first_share(tree, node, ref), probability);
        node = node_at(tree, node->child + (first ? 0 : 1));
    }
    return node->light;
}

float light_tree_probability(const light_tree *tree, vec3 ref, int i)
{
    float share = distant_share(tree, ref);
    int place = tree->place[i];
    if (place < 0)
        return share > 0.0f ? share * tree->irradiance[-1 - place] / tree->total_distant
                            : 0.0f;
    float p = tree->n_distant > 0 ? 1.0f - share : 1.0f;
    for (const tree_node *node = node_at(tree, place); node->parent >= 0;) {
        const tree_node *parent = node_at(tree, node->parent);
        float first = first_share(tree, parent, ref);
        p *= node == node_at(tree, parent->child) ? first : 1.0f - first;
        node = parent;
    }
    return p;
}

typedef struct tree_question {
    const light_tree *tree;
    vec3 ref, place;
    float (*ask)(const void *data, int light);
    const void *data;
} tree_question;

static bool holds(const tree_node *node, vec3 place)
{
    return max_component3(abs3(place - node->center) - node->half) <= 0.0f;
}

/* Below a node that is come to with probability p. */
static float sum_below(const tree_question *q, const tree_node *node, float p)
{
    if (!node->child)
        return p * q->ask(q->data, node->light);
    const tree_node *a = node_at(q->tree, node->child), *b = a + 1;
    bool in_a = holds(a, q->place), in_b = holds(b, q->place);
    if (!in_a && !in_b)
        return 0.0f;
    float first = first_share(q->tree, node, q->ref);
    return (in_a ? sum_below(q, a, p * first) : 0.0f) +
           (in_b ? sum_below(q, b, p * (1.0f - first)) : 0.0f);
}

float light_tree_sum_at(const light_tree *tree, vec3 ref, vec3 place,
                        float (*ask)(const void *data, int light), const void *data)
{
    const tree_question q = {tree, ref, place, ask, data};
    if (tree->nodes->len == 0 || !holds(node_at(tree, 0), place))
        return 0.0f;
    return sum_below(&q, node_at(tree, 0), 1.0f - distant_share(tree, ref));
}
