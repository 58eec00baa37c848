#include "photon/guide.h"

#include <string.h>

enum {
    BINS = 4, /* an axis' unevenness is judged in quarters */
    MAX_CELLS = 4096,
    MIN_ARRIVALS = 24, /* a cell with fewer is not split */
    MAX_DEPTH = 40,
};

/* Share of photons drawn uniformly, whatever was learned. */
#define DEFENSIVE_SHARE 0.25

/* A cell is split if the fullest and emptiest quarters along some axis differ by this
   share of what it holds. */
#define UNEVEN 0.2

typedef struct guide_node {
    float low[EMISSION_DIMENSIONS], high[EMISSION_DIMENSIONS];
    int child; /* index of the first of two; 0: a leaf */
    int axis;  /* split in the middle of */
    int depth;
    double mass; /* probability, defensive share included */
    /* While learning: arrivals in the leaf, by quarters along each axis. */
    double value[EMISSION_DIMENSIONS][BINS];
    double learned;
    size_t arrivals;
} guide_node;

struct emission_guide {
    GArray *nodes; /* of guide_node; 0 is the root */
};

static guide_node *node_at(const emission_guide *guide, int i)
{
    return &g_array_index(guide->nodes, guide_node, i);
}

static double volume(const guide_node *node)
{
    double v = 1.0;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++)
        v *= (double)(node->high[a] - node->low[a]);
    return v;
}

emission_guide *emission_guide_new(void)
{
    emission_guide *guide = g_new0(emission_guide, 1);
    guide_node root = {.mass = 1.0};
    for (int a = 0; a < EMISSION_DIMENSIONS; a++)
        root.high[a] = 1.0f;
    guide->nodes = g_array_new(FALSE, TRUE, sizeof(guide_node));
    g_array_append_val(guide->nodes, root);
    return guide;
}

void emission_guide_free(emission_guide *guide)
{
    if (!guide)
        return;
    g_array_unref(guide->nodes);
    g_free(guide);
}

size_t emission_guide_cells(const emission_guide *guide)
{
    return (guide->nodes->len + 1) / 2;
}

static float middle(const guide_node *node)
{
    return 0.5f * (node->low[node->axis] + node->high[node->axis]);
}

static int leaf_of(const emission_guide *guide, const float u[EMISSION_DIMENSIONS])
{
    int i = 0;
    for (const guide_node *node = node_at(guide, 0); node->child;
         node = node_at(guide, i))
        i = node->child + (u[node->axis] < middle(node) ? 0 : 1);
    return i;
}

float emission_guide_density(const emission_guide *guide,
                             const float u[EMISSION_DIMENSIONS])
{
    const guide_node *leaf = node_at(guide, leaf_of(guide, u));
    return (float)(leaf->mass / volume(leaf));
}

static void draw_uniform(sampler *random, float u[EMISSION_DIMENSIONS])
{
    light_numbers from = sampler_light(random);
    vec2 direction = sampler_2d(random);
    u[0] = from.light;
    u[1] = from.primitive;
    u[2] = from.place.x;
    u[3] = from.place.y;
    u[4] = direction.x;
    u[5] = direction.y;
}

float emission_guide_draw(const emission_guide *guide, sampler *random,
                          float u[EMISSION_DIMENSIONS])
{
    draw_uniform(random, u);
    if (!guide)
        return 1.0f;
    const guide_node *node = node_at(guide, 0);
    while (node->child) {
        const guide_node *first = node_at(guide, node->child);
        float p = (float)(first->mass / node->mass), *x = &u[node->axis];
        bool second = *x >= p;
        *x = minf(second ? (*x - p) / (1.0f - p) : *x / p, 0x1.fffffep-1f);
        node = first + (second ? 1 : 0);
    }
    for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
        float below = nextafterf(node->high[a], 0.0f);
        u[a] = minf(lerpf(node->low[a], node->high[a], u[a]), below);
    }
    return (float)(node->mass / volume(node));
}

/* ---- Learning ---- */

static void add_record(guide_node *leaf, const emission_record *record)
{
    leaf->learned += (double)record->value;
    leaf->arrivals++;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
        float place = (record->u[a] - leaf->low[a]) / (leaf->high[a] - leaf->low[a]);
        int bin = CLAMP((int)(place * (float)BINS), 0, BINS - 1);
        leaf->value[a][bin] += (double)record->value;
    }
}

/* How unevenly arrivals lie along an axis, 0..1. */
static double unevenness(const guide_node *leaf, int axis)
{
    double low = leaf->value[axis][0], high = low;
    for (int b = 1; b < BINS; b++) {
        low = MIN(low, leaf->value[axis][b]);
        high = MAX(high, leaf->value[axis][b]);
    }
    return leaf->learned > 0.0 ? (high - low) / leaf->learned : 0.0;
}

static int most_uneven_axis(const guide_node *leaf)
{
    int best = 0;
    for (int a = 1; a < EMISSION_DIMENSIONS; a++) {
        if (unevenness(leaf, a) > unevenness(leaf, best))
            best = a;
    }
    return best;
}

static bool should_split(const emission_guide *guide, const guide_node *leaf)
{
    /* with few arrivals unevenness is chance: what n arrivals show by chance is taken off
     */
    double chance = 2.0 / sqrt((double)MAX(leaf->arrivals, 1));
    return !leaf->child && leaf->depth < MAX_DEPTH && leaf->arrivals >= MIN_ARRIVALS &&
           guide->nodes->len + 2 <= 2 * MAX_CELLS &&
           unevenness(leaf, most_uneven_axis(leaf)) > MAX(UNEVEN, chance);
}

static void split(emission_guide *guide, int i)
{
    guide_node parent = *node_at(guide, i);
    parent.axis = most_uneven_axis(&parent);
    parent.child = (int)guide->nodes->len;
    *node_at(guide, i) = parent;
    guide_node half[2] = {{.depth = parent.depth + 1}, {.depth = parent.depth + 1}};
    for (int k = 0; k < 2; k++) {
        memcpy(half[k].low, parent.low, sizeof parent.low);
        memcpy(half[k].high, parent.high, sizeof parent.high);
    }
    half[0].high[parent.axis] = half[1].low[parent.axis] = middle(&parent);
    g_array_append_vals(guide->nodes, half, 2);
}

static void forget(emission_guide *guide)
{
    for (int i = 0; i < (int)guide->nodes->len; i++) {
        guide_node *node = node_at(guide, i);
        memset(node->value, 0, sizeof node->value);
        node->learned = 0.0;
        node->arrivals = 0;
    }
}

/* Splits all leaves that deserve it, once; the records of split leaves go to their
 * halves. */
static bool refine(emission_guide *guide, const emission_record *records, size_t n)
{
    forget(guide);
    for (size_t i = 0; i < n; i++)
        add_record(node_at(guide, leaf_of(guide, records[i].u)), &records[i]);
    bool any = false;
    for (int i = 0, end = (int)guide->nodes->len; i < end; i++) {
        if (should_split(guide, node_at(guide, i))) {
            split(guide, i);
            any = true;
        }
    }
    return any;
}

/* Masses of leaves from what was learned, then of inner nodes from their halves: children
   come after their parents in the array. */
static void set_masses(emission_guide *guide, double total)
{
    for (int i = (int)guide->nodes->len - 1; i >= 0; i--) {
        guide_node *node = node_at(guide, i);
        if (node->child)
            node->mass =
                node_at(guide, node->child)->mass + node_at(guide, node->child + 1)->mass;
        else
            node->mass = DEFENSIVE_SHARE * volume(node) +
                         (1.0 - DEFENSIVE_SHARE) * node->learned / total;
    }
}

void emission_guide_learn(emission_guide *guide, const emission_record *records, size_t n)
{
    double total = 0.0;
    while (refine(guide, records, n)) {
    }
    for (int i = 0; i < (int)guide->nodes->len; i++)
        total += node_at(guide, i)->learned;
    if (total > 0.0)
        set_masses(guide, total);
}
