#include "photon/trace/guide.h"

#include <string.h>

enum {
    /* An axis' unevenness is judged in quarters. With halves and eighths relMSE x time is
       0.96 to 1.05 times as much in scenes/ring, water, ball, prism and cornell-glass
       (128 x 128, 4 and 8 passes, three and nine seeds). */
    BINS = 4,
    MAX_DEPTH = 40, /* a guard: halves stay apart, and densities within floats */
    /* math: of axes */
    N_PAIRS = EMISSION_DIMENSIONS * (EMISSION_DIMENSIONS - 1) / 2,
};

/* A cell is split where the fullest and emptiest quarters along some axis differ by this
   share of what it holds (by what is beyond chance alone, 12 % of photons met what 20 %
   and more did: /guide/flux), */
#define UNEVEN 0.2

/* ... or the squares of two axes by this χ², of 15 degrees of freedom, which chance
   exceeds once in 10⁴. */
#define CHI2_BY_CHANCE 45.0

typedef struct guide_node {
    float low[EMISSION_DIMENSIONS], high[EMISSION_DIMENSIONS];
    int child; /* index of the first of two; 0: a leaf */
    int axis;  /* split in the middle of */
    int depth;
    double mass; /* probability, defensive share included */
} guide_node;

/* What is learned of a node from the arrivals in it. */
typedef struct guide_tally {
    size_t arrivals;
    double flux;
    double by_axis[EMISSION_DIMENSIONS][BINS];
    uint32_t by_pair[N_PAIRS][BINS * BINS];
} guide_tally;

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

static emission_guide *guide_new(void)
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
        float high = node->high[a], x = lerpf(node->low[a], high, u[a]);
        u[a] = x < high ? x : nextafterf(high, 0.0f);
    }
    return (float)(node->mass / volume(node));
}

/* ---- Learning ---- */

/* What is learned of a node. */
typedef struct guide_learned {
    size_t arrivals;
    double importance; /* what its mass shall be in proportion to */
    double share;      /* of all importance, smoothed */
} guide_learned;

static guide_learned *learned_at(GArray *learned, int i)
{
    return &g_array_index(learned, guide_learned, i);
}

static void add_record(const guide_node *leaf, guide_tally *tally,
                       const emission_record *record)
{
    int bin[EMISSION_DIMENSIONS], pair = 0;
    double value = (double)record->value;
    tally->flux += value;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
        float place = (record->u[a] - leaf->low[a]) / (leaf->high[a] - leaf->low[a]);
        bin[a] = CLAMP((int)(place * (float)BINS), 0, BINS - 1);
        tally->by_axis[a][bin[a]] += value;
        for (int b = 0; b < a; b++)
            tally->by_pair[pair++][bin[a] * BINS + bin[b]]++;
    }
}

/* How unevenly arrivals lie along an axis, 0..1. */
static double unevenness(const guide_tally *tally, int axis)
{
    double low = tally->by_axis[axis][0], high = low;
    for (int b = 1; b < BINS; b++) {
        low = MIN(low, tally->by_axis[axis][b]);
        high = MAX(high, tally->by_axis[axis][b]);
    }
    return tally->flux > 0.0 ? (high - low) / tally->flux : 0.0;
}

/* The axis along which arrivals are uneven beyond what so many show by chance. -1: none.
 */
static int uneven_axis(const guide_tally *tally)
{
    double chance = 2.0 / sqrt((double)MAX(tally->arrivals, 1));
    double least = MAX(UNEVEN, chance);
    int axis = -1;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
        double u = unevenness(tally, a);
        if (u > least) {
            least = u;
            axis = a;
        }
    }
    return axis;
}

/* The χ² of arrivals in the squares of two axes. */
static double chi2_of_pair(const guide_tally *tally, int pair)
{
    double expected = (double)tally->arrivals / (BINS * BINS), sum = 0.0;
    for (int i = 0; i < BINS * BINS; i++) {
        double off = (double)tally->by_pair[pair][i] - expected;
        sum += off * off / expected;
    }
    return sum;
}

/* A small thing seen from many places of a light fills a slanted sheet, even along every
   axis and uneven in the squares of two. One of two such axes, or -1. */
static int correlated_axis(const guide_tally *tally)
{
    double most = CHI2_BY_CHANCE;
    int axis = -1, pair = 0;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
        for (int b = 0; b < a; b++, pair++) {
            double chi2 = chi2_of_pair(tally, pair);
            if (chi2 > most) {
                most = chi2;
                axis = a;
            }
        }
    }
    return axis;
}

/* The axis to split a leaf along, or -1. A cell with fewer arrivals than squares tells
   nothing. */
static int axis_to_split(const guide_node *leaf, const guide_tally *tally)
{
    const bool tells = tally->arrivals >= BINS * BINS;
    if (leaf->depth >= MAX_DEPTH || !tells)
        return -1;
    int axis = uneven_axis(tally);
    return axis >= 0 ? axis : correlated_axis(tally);
}

static void split(emission_guide *guide, int i, int axis)
{
    guide_node parent = *node_at(guide, i);
    parent.axis = axis;
    parent.child = (int)guide->nodes->len;
    *node_at(guide, i) = parent;
    guide_node half[2] = {{.depth = parent.depth + 1}, {.depth = parent.depth + 1}};
    for (int k = 0; k < 2; k++) {
        memcpy(half[k].low, parent.low, sizeof parent.low);
        memcpy(half[k].high, parent.high, sizeof parent.high);
    }
    half[0].high[axis] = half[1].low[axis] = middle(&parent);
    g_array_append_vals(guide->nodes, half, 2);
}

/* Moves the records below x along the axis to the front. @return how many. */
static size_t partition(emission_record *records, size_t n, int axis, float x)
{
    size_t below = 0;
    for (size_t i = 0; i < n; i++) {
        if (records[i].u[axis] < x) {
            emission_record r = records[i];
            records[i] = records[below];
            records[below++] = r;
        }
    }
    return below;
}

/* Least variance wants photons in proportion to the root of the mean squared flux: where
   few of many arrive, those few must not be heavy. */
static double importance_of(const guide_node *leaf, const emission_record *records,
                            size_t n)
{
    double square = 0.0; /* integral of the squared flux over the cell */
    for (size_t i = 0; i < n; i++) {
        double value = (double)records[i].value;
        square += value * value * (double)records[i].density;
    }
    return sqrt(volume(leaf) * square);
}

/* Grows the tree below node i, in which the records lie, and learns of it. */
static void grow(emission_guide *guide, GArray *learned, int i, emission_record *records,
                 size_t n)
{
    guide_tally tally = {.arrivals = n};
    for (size_t k = 0; k < n; k++)
        add_record(node_at(guide, i), &tally, &records[k]);
    int axis = axis_to_split(node_at(guide, i), &tally);
    guide_learned of = {.arrivals = n};
    if (axis < 0) {
        of.importance = importance_of(node_at(guide, i), records, n);
    } else {
        split(guide, i, axis);
        g_array_set_size(learned, guide->nodes->len);
        int child = node_at(guide, i)->child;
        size_t below = partition(records, n, axis, middle(node_at(guide, i)));
        grow(guide, learned, child, records, below);
        grow(guide, learned, child + 1, records + below, n - below);
        of.importance = learned_at(learned, child)->importance +
                        learned_at(learned, child + 1)->importance;
    }
    *learned_at(learned, i) = of;
}

/* What n arrivals in both halves say of one of them, by Laplace's rule of succession: a
   half where none of them lay may still hold one in n + 2. */
static double smoothed_share(const guide_learned *parent, const guide_learned *half)
{
    double n = (double)parent->arrivals;
    double seen = n > 0.0 ? half->importance / parent->importance : 0.5;
    double learned = (seen * n + 1.0) / (n + 2.0);
    const double share = (double)DEFENSIVE_SHARE;
    return (1.0 - share) * learned + 0.5 * share;
}

/* Children come after their parents in the array. */
static void set_masses(emission_guide *guide, GArray *learned)
{
    const double share = (double)DEFENSIVE_SHARE;
    learned_at(learned, 0)->share = 1.0;
    for (int i = 0; i < (int)learned->len; i++) {
        guide_node *node = node_at(guide, i);
        const guide_learned *of = learned_at(learned, i);
        node->mass = share * volume(node) + (1.0 - share) * of->share;
        for (int k = 0; k < 2 && node->child; k++) {
            guide_learned *half = learned_at(learned, node->child + k);
            half->share = of->share * smoothed_share(of, half);
        }
    }
}

emission_guide *emission_guide_learn(emission_record *records, size_t n)
{
    emission_guide *guide = guide_new();
    if (n == 0)
        return guide;
    g_autoptr(GArray) learned = g_array_new(FALSE, TRUE, sizeof(guide_learned));
    g_array_set_size(learned, 1);
    grow(guide, learned, 0, records, n);
    set_masses(guide, learned);
    return guide;
}

/* ---- As bytes ---- */

void emission_guide_put(const emission_guide *guide, GByteArray *to)
{
    size_t n = guide ? guide->nodes->len : 0;
    bytes_put_count(to, n);
    for (size_t i = 0; i < n; i++)
        bytes_put(to, node_at(guide, (int)i), 1, sizeof(guide_node));
}

/* Children stand behind their parents: a way down ends. */
static bool node_is_sound(const guide_node *node, int i, size_t n)
{
    bool leads_down =
        node->child == 0 || (node->child > i && (size_t)node->child + 1 < n);
    return leads_down && node->axis >= 0 && node->axis < EMISSION_DIMENSIONS &&
           node->mass > 0.0 && volume(node) > 0.0;
}

emission_guide *emission_guide_get(bytes_reader *from)
{
    size_t n = bytes_get_count(from, sizeof(guide_node));
    if (n == 0)
        return NULL;
    g_autoptr(emission_guide) guide = guide_new();
    g_array_set_size(guide->nodes, (guint)n);
    for (size_t i = 0; i < n; i++) {
        bytes_get(from, node_at(guide, (int)i), 1, sizeof(guide_node));
        from->failed |= !node_is_sound(node_at(guide, (int)i), (int)i, n);
    }
    return from->failed ? NULL : g_steal_pointer(&guide);
}
