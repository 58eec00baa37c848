/*
 * By the kd-tree over boxes of the photons' balls: the disc that faces a ray lies in the
 * ball, whatever the ray. Leaves are met in order, so sums are the same bits always, and
 * those of a leaf are asked together, a lane each.
 */
#include "photon/volume_map.h"

#include "base/memory.h"
#include "photon/direction.h"
#include "photon/map/kdtree.h"

struct volume_map {
    photon_store owned; /* empty: they are another map's */
    const photon_store *store;
    float *radii; /* as photons are in order */
    kdtree *tree;
};

static volume_map *with_tree(volume_map *map, workers by, GError **error)
{
    const point_arrays points = photon_points(map->store);
    map->tree = kdtree_build(&points, map->radii, by, error);
    if (map->tree)
        return map;
    volume_map_free(map);
    return NULL;
}

/* Room for radii, and for a block behind. */
static bool make_radii(volume_map *map, GError **error)
{
    size_t n = points_padded(map->store->n);
    map->radii = big_alloc(n, sizeof *map->radii, "photons in media", error);
    return map->radii != NULL;
}

static bool put_in_order(volume_map *map, const float *radii, workers by, GError **error)
{
    photon_store *store = &map->owned;
    point_arrays points = photon_points(store);
    size_t *order = kdtree_sort(&points, by, error);
    bool ok = order && make_radii(map, error) &&
              point_arrays_permute(&points, order, by, error);
    store->x = points.x;
    store->y = points.y;
    store->z = points.z;
    for (size_t i = 0; i < store->n && ok; i++)
        map->radii[i] = radii[order[i]];
    ok = ok && photon_store_follow(store, order, by, error);
    big_free(order);
    return ok;
}

volume_map *volume_map_build(photon_store *store, const float *radii, unsigned threads,
                             GError **error)
{
    const workers by = {.threads = threads};
    volume_map *map = g_new0(volume_map, 1);
    map->owned = *store;
    map->store = &map->owned;
    *store = (photon_store){0};
    if (map->owned.n > UINT32_MAX)
        error_set(error, ERROR_FAILED, "%zu photons in media are too many for a map",
                  map->owned.n);
    else if (put_in_order(map, radii, by, error))
        return with_tree(map, by, error);
    volume_map_free(map);
    return NULL;
}

volume_map *volume_map_widened(const volume_map *map, float by, unsigned threads,
                               GError **error)
{
    volume_map *wide = g_new0(volume_map, 1);
    wide->store = map->store;
    if (!make_radii(wide, error)) {
        volume_map_free(wide);
        return NULL;
    }
    for (size_t i = 0; i < map->store->n; i++)
        wide->radii[i] = map->radii[i] * by;
    return with_tree(wide, (workers){.threads = threads}, error);
}

void volume_map_free(volume_map *map)
{
    if (!map)
        return;
    kdtree_free(map->tree);
    big_free(map->radii);
    photon_store_clear(&map->owned);
    g_free(map);
}

const photon_store *volume_map_store(const volume_map *map)
{
    return map->store;
}

size_t volume_map_bytes(const volume_map *map)
{
    return photon_store_bytes(&map->owned) + kdtree_bytes(map->tree) +
           map->store->n * sizeof *map->radii;
}

/* ---- A ray ---- */

/* What it sees, and what all of its photons have in common. */
typedef struct ray_sum {
    const volume_map *map;
    const volume_query *query;
    spectrum sigma_t;
    bool is_grey; /* all wavelengths have the same σt */
    float unit_area;
    spectrum radiance;
    size_t n;
} ray_sum;

/* Photons of a block: how far along the ray, squared distances from it, and of the latter
   those of their rims. */
typedef struct photon_block {
    lane_floats t, distance2, radius2;
} photon_block;

static bool all_alike(spectrum s)
{
    for (int i = 1; i < N_WAVELENGTHS; i++)
        if (s[i] < s[0] || s[i] > s[0])
            return false;
    return true;
}

/* e^(-σt t), in one go where that is grey, and what the solid leaves. */
static spectrum transmittance_over(const ray_sum *sum, float t)
{
    const volume_query *query = sum->query;
    spectrum own = sum->is_grey ? spectrum_fill(expf(-sum->sigma_t[0] * t))
                                : transmittance_after(sum->sigma_t, t);
    return query->solid ? own * medium_transmittance(query->solid, t, query->w) : own;
}

/* Bits of those that are crossed of photons i .. min(i + LANES, end) - 1. */
static unsigned cross(const ray_sum *sum, size_t i, size_t end, photon_block *out)
{
    const photon_store *s = sum->map->store;
    const ray *r = sum->query->ray;
    lane_vec3 to = {load_lanes(s->x + i) - r->origin[0],
                    load_lanes(s->y + i) - r->origin[1],
                    load_lanes(s->z + i) - r->origin[2]};
    lane_floats t = dot3_lanes(to, r->direction);
    lane_floats x = to.x - t * r->direction[0], y = to.y - t * r->direction[1],
                z = to.z - t * r->direction[2];
    lane_floats radius = load_lanes(sum->map->radii + i);
    *out = (photon_block){t, x * x + y * y + z * z, radius * radius};
    return bits_below(out->distance2, out->radius2) & bits_below(fill_lanes(0.0f), t) &
           bits_below(t, fill_lanes(sum->query->length)) & bits_first(end - i);
}

/* What photons from i on send along the ray of what is scattered, sr⁻¹. */
static lane_floats phases(const ray_sum *sum, size_t i)
{
    lane_vec3 wi = lane_directions_of(load_lane_ints(sum->map->store->wi + i));
    lane_floats length = sqrt_lanes(wi.x * wi.x + wi.y * wi.y + wi.z * wi.z);
    lane_floats cosine = -dot3_lanes(wi, sum->query->ray->direction) / length;
    return phase_henyey_greenstein_lanes(sum->query->medium->g, cosine);
}

static void add_photon(ray_sum *sum, size_t i, float t, float weight)
{
    const photon_store *s = sum->map->store;
    spectrum part = transmittance_over(sum, t) * weight * photon_store_flux(s, i);
    sum->radiance += part;
    if (sum->query->n_groups > 0)
        sum->query->groups[s->tag[i]] += part;
    sum->n++;
}

/* Those named by bits of a block of photons from i on. */
static void add_block(ray_sum *sum, size_t i, unsigned bits, const photon_block *block)
{
    const volume_query *query = sum->query;
    const uint32_t home = medium_home(query->medium);
    lane_floats kernels =
        kernel_eval_lanes(&query->kernel, block->distance2 / block->radius2, 1.0f);
    lane_floats weights = phases(sum, i) * kernels / (sum->unit_area * block->radius2);
    for (; bits; bits &= bits - 1u) {
        int lane = __builtin_ctz(bits);
        if (sum->map->store->home[i + (size_t)lane] == home)
            add_photon(sum, i + (size_t)lane, block->t[lane], weights[lane]);
    }
}

/* point_run_visitor. */
static void add_runs(const point_run *runs, size_t n, void *data)
{
    ray_sum *sum = data;
    for (size_t k = 0; k < n; k++)
        for (size_t i = runs[k].begin; i < runs[k].end; i += LANES) {
            photon_block block;
            unsigned bits = cross(sum, i, runs[k].end, &block);
            if (bits)
                add_block(sum, i, bits, &block);
        }
}

spectrum volume_map_radiance(const volume_map *map, const volume_query *query,
                             size_t *n_weighed)
{
    const ray *r = query->ray;
    const point_arrays points = photon_points(map->store);
    ray_sum sum = {
        .map = map,
        .query = query,
        .sigma_t = medium_extinction(query->medium, query->w),
        .unit_area = kernel_area(&query->kernel, 1.0f),
    };
    sum.is_grey = all_alike(sum.sigma_t);
    for (size_t i = 0; i < query->n_groups; i++)
        query->groups[i] = (spectrum){0};
    kdtree_runs_along(map->tree, &points, r->origin, r->direction, query->length,
                      add_runs, &sum);
    *n_weighed = sum.n;
    return sum.radiance;
}
