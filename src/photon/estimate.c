/*
 * The radiance estimate.
 *
 *   within a radius   runs of the map ─► test eight ─► κ of eight ─┐
 *   k nearest         hits of the map ─────────────► κ of eight ───┴► block ─► weigh
 *
 * Finding photons is nearly free, weighing them is where the time goes: so photons within
 * a fixed radius are never listed, they go from the test by way of a small block into the
 * sum while they are warm. On a Lambertian surface, the common case, what is left for
 * each is one multiplication of eight wavelengths; f and the normalisation come after the
 * sum.
 *
 * What is around the disc (neighbourhood.h) is looked at when the first photons are in
 * the block: where there are none nobody looks, and where only a part of the disc is
 * surface in sight the photons are found again, of that part, before any is weighed.
 */
#include "photon/estimate.h"

#include "base/memory.h"
#include "photon/neighbourhood.h"
#include "photon/photon_query.h"

/* math: Photons arrive in proportion to |wi·n_geom|, so without a limit on |wi·n| /
 * |wi·n_geom| the variance would not be finite. Any large number serves: the light that
 * is cut off is below half its inverse. */
#define MAX_GRAZING_RATIO 1000.0f

enum { BLOCK = 256 }; /* size: of photons that are weighed at a time */

typedef struct gather gather;

struct gather {
    photon_query query;
    const estimate_options *options;
    const bsdf *b;
    vec3 wo;
    float r2, inv_r2;
    /* Of photons begin .. end - 1 of the block. */
    spectrum (*weigh)(const gather *g, size_t begin, size_t end);
    size_t n_block; /* photons in the block below */
    uint32_t index[BLOCK + 2 * LANES];
    float weight[BLOCK + 2 * LANES]; /* κ; before that d² */
    spectrum sum;
    spectrum *groups; /* the sum, apart by tags */
    size_t n_groups;
    size_t n;   /* weighed */
    bool looks; /* around the disc, once a photon is found */
    estimate_scratch *scratch;
    const looked_disc *around; /* what was seen; NULL: nothing yet */
    looked_disc own;           /* seen by this one */
    const neighbourhood *hood; /* if set, photons out of its sight are left out */
};

/* ---- Weighing a block ---- */

/* Σ κ Φ, in four sums: one alone would wait for itself. */
static spectrum weigh_plain(const gather *g, size_t begin, size_t end)
{
    const packed_flux *flux = g->query.store->packed;
    const uint32_t *index = g->index;
    const float *weight = g->weight;
    spectrum a = {0}, b = {0}, c = {0}, d = {0};
    size_t i = begin;
    for (; i + 4 <= end; i += 4) {
        a += weight[i] * flux_unpack(flux + index[i]);
        b += weight[i + 1] * flux_unpack(flux + index[i + 1]);
        c += weight[i + 2] * flux_unpack(flux + index[i + 2]);
        d += weight[i + 3] * flux_unpack(flux + index[i + 3]);
    }
    for (; i < end; i++)
        a += weight[i] * flux_unpack(flux + index[i]);
    return (a + b) + (c + d);
}

/* |wi·n| / |wi·n_geom|; of a curve, over what it showed to the light. wi need not be
   unit. */
static float cosine_ratio(const gather *g, vec3 wi)
{
    const bsdf *b = g->b;
    const flat_curve *flat = g->options->curve;
    float shown = flat ? hit_cosine(flat->hit, wi) : fabsf(dot3(wi, b->n_geom));
    return fminf(fabsf(dot3(wi, b->shading.n)) / shown, MAX_GRAZING_RATIO);
}

/* Σ κ Φ |wi·n| / |wi·n_geom|, of those on the same side of both normals */
static spectrum weigh_bent(const gather *g, size_t begin, size_t end)
{
    const photon_store *s = g->query.store;
    spectrum sum = {0};
    for (size_t i = begin; i < end; i++) {
        vec3 wi = direction_octahedron(s->wi[g->index[i]]);
        float weight = g->weight[i] * cosine_ratio(g, wi);
        if (dot3(wi, g->b->shading.n) * dot3(wi, g->b->n_geom) > 0.0f)
            sum += weight * flux_unpack(s->packed + g->index[i]);
    }
    return sum;
}

/* Σ f κ Φ |wi·n| / |wi·n_geom| */
static spectrum weigh_bsdf(const gather *g, size_t begin, size_t end)
{
    const estimate_options *options = g->options;
    spectrum sum = {0};
    for (size_t i = begin; i < end; i++) {
        const photon_store *store = g->query.store;
        uint32_t packed = store->wi[g->index[i]];
        vec3 wi = direction_unpack(packed);
        bool delta = direction_flags(packed) & PHOTON_FROM_DELTA;
        unsigned lobes = options->lobes | (delta ? options->delta_lobes : 0);
        spectrum f = bsdf_eval(g->b, g->wo, wi, lobes, TRANSPORT_RADIANCE);
        if (!spectrum_is_black(f))
            sum += g->weight[i] * cosine_ratio(g, wi) * f *
                   flux_unpack(store->packed + g->index[i]);
    }
    return sum;
}

/* One by one, each also into the sum of its tag. */
static void weigh_by_tag(gather *g)
{
    for (size_t i = 0; i < g->n_block; i++) {
        spectrum part = g->weigh(g, i, i + 1);
        g->groups[g->query.store->tag[g->index[i]]] += part;
        g->sum += part;
    }
}

/* The root of r2, or next to it, whose square is not above r2: what lies at r2 is out of
   reach, as the k-th of the nearest is. */
static float root_within(float r2)
{
    float r = sqrtf(r2);
    return r * r > r2 ? nextafterf(r, 0.0f) : r;
}

static const looked_disc *look_around(gather *g)
{
    const estimate_options *options = g->options;
    looked_around *looked = options->shares_looks ? &g->scratch->looked : NULL;
    float share = options->looked_share > 0.0f ? options->looked_share : 1.0f;
    const neighbourhood hood = {.scene = options->scene,
                                .p = g->query.at.p,
                                .n = g->query.at.n,
                                .radius = root_within(g->r2) * share,
                                .time = options->time};
    const looked_disc *seen =
        looked ? looked_around_find(looked, &hood, &options->kernel) : NULL;
    if (seen)
        return seen;
    g->own = disc_look(&hood, &options->kernel);
    g->scratch->n_looks += g->own.hood.n_looks;
    if (looked)
        looked_around_put(looked, &g->own);
    return &g->own;
}

/* Of a disc that is not whole photons are found again, of the part that is in sight. */
static bool is_found_again(const gather *g)
{
    return g->around && !g->around->whole && !g->hood;
}

static void flush(gather *g)
{
    if (g->looks && !g->around && g->n_block > 0)
        g->around = look_around(g);
    if (is_found_again(g))
        g->n_block = 0;
    if (g->n_groups)
        weigh_by_tag(g);
    else
        g->sum += g->weigh(g, 0, g->n_block);
    g->n += g->n_block;
    g->n_block = 0;
}

/* ---- Finding ---- */

/* Of photons in the block that are within the radius, weight[] holding d², keeps those
 * that are accepted, and gives them their weights. */
static inline __attribute__((always_inline)) void weigh_block(gather *g,
                                                              const photon_query *query)
{
    const kernel kappa = g->options->kernel;
    const float inv_r2 = g->inv_r2;
    const bool selects = photon_query_selects(query);
    const neighbourhood *hood = g->hood;
    size_t n = g->n_block, kept = 0;
    for (size_t i = 0; i < n; i++)
        __builtin_prefetch(query->store->packed + g->index[i]);
    memset(g->index + n, 0, LANES * sizeof *g->index);
    for (size_t i = 0; i < n; i += LANES) {
        unsigned bits = bits_first(n - i);
        lane_floats weight = kernel_eval_lanes(&kappa, load_lanes(g->weight + i), inv_r2);
        if (selects)
            bits = photon_query_accepted_of(query, g->index + i, bits);
        if (hood)
            bits = neighbourhood_sees_of(hood, &query->points, g->index + i, bits);
        kept += pack_lane_pairs(weight, g->index + i, bits, g->weight + kept,
                                g->index + kept);
    }
    g->n_block = kept;
    flush(g);
}

/* Runs of photons, within the fixed radius, by the query, a copy: what does not change
 * must not seem to when the block is written to. What the caller knows of it falls out of
 * the loop. */
static inline __attribute__((always_inline)) void
gather_by(gather *g, photon_query query, const point_run *runs, size_t n)
{
    const float r2 = g->r2;
    size_t n_block = 0;
    for (const point_run *run = runs; run < runs + n; run++) {
        for (size_t i = run->begin; i < run->end; i += LANES) {
            lane_floats d2;
            unsigned bits = query_nearer(&query.at, &query.points, i, run->end, r2, &d2);
            if (HAS_WIDE_LANES || bits)
                n_block += pack_lanes(d2, bits, (uint32_t)i, g->weight + n_block,
                                      g->index + n_block);
            if (n_block >= BLOCK) {
                g->n_block = n_block;
                weigh_block(g, &query);
                n_block = 0;
                if (is_found_again(g))
                    return;
            }
        }
    }
    g->n_block = n_block;
    weigh_block(g, &query);
}

static void gather_runs(const point_run *runs, size_t n, void *data)
{
    gather *g = data;
    gather_by(g, g->query, runs, n);
}

/* The common kinds: on surfaces that do not transmit, ... */
static void gather_runs_one_sided(const point_run *runs, size_t n, void *data)
{
    gather *g = data;
    photon_query query = g->query;
    query.one_sided = true;
    query.at.flat = false;
    query.face = 0;
    query.normal = query.curve = NULL;
    gather_by(g, query, runs, n);
}

/* ... and where photons keep normals. */
static void gather_runs_alike(const point_run *runs, size_t n, void *data)
{
    gather *g = data;
    photon_query query = g->query;
    query.one_sided = true;
    query.face = 0;
    query.curve = NULL;
    gather_by(g, query, runs, n);
}

static point_run_visitor visitor_for(const photon_query *query)
{
    if (!query->one_sided || query->face || query->curve)
        return gather_runs;
    return query->normal || query->at.flat ? gather_runs_alike : gather_runs_one_sided;
}

/* Photons listed in hits. */
static void gather_hits(gather *g, const point_hits *hits)
{
    for (size_t begin = 0; begin < hits->n; begin += BLOCK) {
        g->n_block = MIN(BLOCK, hits->n - begin);
        memcpy(g->index, hits->index + begin, g->n_block * sizeof *g->index);
        for (size_t i = 0; i < g->n_block; i += LANES) {
            lane_floats distance2 = load_lanes(hits->distance2 + begin + i);
            store_lanes(g->weight + i,
                        kernel_eval_lanes(&g->options->kernel, distance2, g->inv_r2));
        }
        flush(g);
    }
}

static void set_radius2(gather *g, float r2)
{
    g->r2 = r2;
    g->inv_r2 = 1.0f / r2;
}

static void gather_within(gather *g, const photon_map *map)
{
    float radius = g->options->radius;
    set_radius2(g, radius * radius);
    point_index_runs(photon_map_index(map), g->query.at.p, radius, visitor_for(&g->query),
                     g);
}

/* Index of the furthest hit. */
static size_t furthest(const point_hits *hits)
{
    size_t last = 0;
    for (size_t i = 1; i < hits->n; i++)
        last = hits->distance2[i] > hits->distance2[last] ? i : last;
    return last;
}

/* How far the k nearest are looked for. A thin curve may hold fewer: of it, as far as lie
   so many of all. */
static bool search_radius(const gather *g, const photon_map *map, size_t k,
                          point_hits *hits, float *radius)
{
    photon_query any = g->query;
    any.curve = NULL;
    *radius = g->options->radius;
    if (!g->options->curve)
        return true;
    if (!photon_map_query_nearest(map, &any, k, *radius, hits))
        return false;
    if (hits->n == k)
        *radius = minf(*radius, sqrtf(hits->distance2[furthest(hits)]));
    hits->n = 0;
    return true;
}

static bool gather_nearest(gather *g, const photon_map *map)
{
    const estimate_options *options = g->options;
    point_hits *hits = &g->scratch->hits;
    float radius = options->radius;
    hits->n = 0;
    size_t k = MIN(options->nearest, g->query.store->n);
    if (k > 0 && (!search_radius(g, map, k, hits, &radius) ||
                  !photon_map_query_nearest(map, &g->query, k, radius, hits)))
        return false;
    set_radius2(g, radius * radius);
    bool all_found = hits->n == options->nearest;
    if (hits->n > 0 && (all_found || isinf(radius))) {
        size_t last = furthest(hits);
        set_radius2(g, hits->distance2[last]);
        hits->n--;
        hits->index[last] = hits->index[hits->n];
        hits->distance2[last] = hits->distance2[hits->n];
    }
    gather_hits(g, hits);
    return true;
}

/* ---- The estimate ---- */

static bool gather_once(gather *g, const photon_map *map)
{
    g->n_block = g->n = 0;
    g->sum = (spectrum){0};
    for (size_t i = 0; i < g->n_groups; i++)
        g->groups[i] = (spectrum){0};
    bool done = true;
    if (g->options->nearest)
        done = gather_nearest(g, map);
    else
        gather_within(g, map);
    flush(g);
    g->scratch->n_weighed += g->n * (g->weigh == weigh_bsdf ? N_WAVELENGTHS : 1);
    return done;
}

/* The photons again, of the part of the disc that is surface in sight. */
static bool gather_part(gather *g, const photon_map *map)
{
    const estimate_options *options = g->options;
    estimate_options within = *options;
    g->hood = &g->around->hood;
    within.nearest = 0;
    within.radius = g->hood->radius;
    g->options = &within;
    g->query.at.flat = true;
    g->query.at.inv_flatten = 1.0f / NEIGHBOURHOOD_FLATTEN;
    bool done = gather_once(g, map);
    g->options = options;
    g->hood = NULL;
    return done;
}

static void scale_groups(estimate_scratch *scratch, spectrum factor)
{
    for (size_t i = 0; i < scratch->n_groups; i++)
        scratch->groups[i] *= factor;
}

/* Σ over the photons around the point; zero when there are none or memory is refused. */
static spectrum estimate(gather *g, const photon_map *map, estimate_info *info)
{
    const estimate_options *options = g->options;
    estimate_scratch *scratch = g->scratch;
    g->groups = scratch->groups;
    g->n_groups = scratch->n_groups;
    g->looks = options->scene && !options->curve;
    g->around = NULL;
    g->hood = NULL;
    bool done = gather_once(g, map);
    float radius = root_within(g->r2), area = kernel_area(&options->kernel, g->r2);
    if (options->curve && g->n > 0 && isfinite(radius))
        area = flat_curve_area(options->curve, g->query.at.p, radius, &options->kernel);
    if (g->around)
        area *= g->around->coverage;
    if (is_found_again(g))
        done = gather_part(g, map) && done;
    scratch->n_queries++;
    scratch->failed |= !done;
    if (info)
        *info = (estimate_info){.n_photons = g->n, .radius = radius};
    bool usable = done && g->n > 0 && area > 0.0f;
    scale_groups(scratch, spectrum_fill(usable ? 1.0f / area : 0.0f));
    return usable ? g->sum / area : (spectrum){0};
}

static bool is_bent(const bsdf *b, const estimate_options *options)
{
    float cosine = dot3(b->shading.n, b->n_geom);
    return options->curve || cosine < 1.0f - 1e-6f; /* math: or by rounding alone */
}

/* True if all the lobes in use are rho/pi. */
static bool is_lambertian(const bsdf *b, unsigned lobes)
{
    return b->lambertian && (lobes & LOBE_DIFFUSE) && (lobes & LOBE_REFLECTION) &&
           !(lobes & b->lobes & LOBE_GLOSSY);
}

spectrum photon_estimate(const photon_map *map, vec3 p, const bsdf *b, vec3 wo,
                         const estimate_options *options, estimate_scratch *scratch,
                         estimate_info *info)
{
    unsigned lobes = options->lobes | options->delta_lobes;
    bool lambertian = is_lambertian(b, options->lobes) && is_lambertian(b, lobes);
    bool bent = is_bent(b, options);
    bool transmits = lobes & b->lobes & LOBE_TRANSMISSION;
    int face = dot3(b->n_geom, wo) < 0.0f ? -1 : 1;
    const flat_curve *flat = options->curve;
    photon_filter filter = {
        .n = face < 0 ? -b->n_geom : b->n_geom,
        .one_sided = !transmits,
        .face = transmits ? face : 0,
        .flatten = options->flatten,
        .curve = flat ? scene_curve_of(flat->scene, flat->hit) : 0,
    };
    gather g;
    g.query = photon_query_of(photon_map_store(map), p, &filter);
    g.options = options;
    g.scratch = scratch;
    g.b = b;
    g.wo = wo;
    g.weigh = lambertian ? bent ? weigh_bent : weigh_plain : weigh_bsdf;
    spectrum sum = estimate(&g, map, info);
    if (!lambertian)
        return sum;
    scale_groups(scratch, b->rho * INV_PI_F);
    return sum * b->rho * INV_PI_F;
}

spectrum photon_irradiance(const photon_map *map, vec3 p, vec3 n_geom,
                           const estimate_options *options, estimate_scratch *scratch,
                           estimate_info *info)
{
    photon_filter filter = {.n = n_geom, .one_sided = true, .flatten = options->flatten};
    gather g;
    g.query = photon_query_of(photon_map_store(map), p, &filter);
    g.options = options;
    g.scratch = scratch;
    g.weigh = weigh_plain;
    return estimate(&g, map, info);
}

bool estimate_scratch_init(estimate_scratch *scratch, size_t n_groups, GError **error)
{
    *scratch = (estimate_scratch){.n_groups = n_groups};
    if (n_groups > 0)
        scratch->groups =
            big_alloc(n_groups, sizeof *scratch->groups, "light groups", error);
    return n_groups == 0 || scratch->groups;
}

void estimate_scratch_clear(estimate_scratch *scratch)
{
    point_hits_clear(&scratch->hits);
    big_free(scratch->groups);
    scratch->groups = NULL;
}
