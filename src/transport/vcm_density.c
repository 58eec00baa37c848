/*
 * How close light vertices lie, place by place: known before the first pass, from a few
 * light subpaths of a pass that no render reaches, so that the weights of a pass do not
 * depend on the vertices they are for.
 */
#include "transport/vcm.h"

#include <float.h>

enum {
    PILOT_PATHS = 20000,
    NEAREST = 16,
    PLACES = 8192, /* at most */
};

#define PILOT_PASS 0xfffffffeu

static photon_map *map_of(const light_paths *paths, unsigned threads, GError **error)
{
    photon_store store = {0};
    if (!photon_store_reserve(&store, paths->n_vertices, error))
        return NULL;
    for (size_t i = 0; i < paths->n_vertices; i++) {
        const light_vertex *v = &paths->vertices[i];
        photon p = {.p = v->hit.p, .wi = v->wi};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_KDTREE, &store, 0.0f, threads, error);
}

/* Vertices of a subpath per square metre around p; 0: too few to tell. */
static float density_at(const photon_map *map, vec3 p, size_t n_paths, photon_hits *hits)
{
    if (!photon_map_nearest(map, p, NEAREST, INFINITY, NULL, hits) || hits->n < NEAREST)
        return 0.0f;
    float furthest2 = 0.0f;
    for (size_t i = 0; i < hits->n; i++)
        furthest2 = maxf(furthest2, hits->distance2[i]);
    float density = NEAREST / (PI_F * furthest2 * (float)n_paths);
    return isfinite(density) ? density : FLT_MAX;
}

static photon_map *keep_places(const photon_map *map, size_t n_paths, GError **error)
{
    const photon_store *from = photon_map_store(map);
    size_t n = MIN(from->n, PLACES);
    photon_store places = {0};
    photon_hits hits = {0};
    if (!photon_store_reserve(&places, n, error))
        return NULL;
    for (size_t i = 0; i < n; i++) {
        photon at = photon_store_get(from, i * from->n / n);
        at.flux = spectrum_fill(density_at(map, at.p, n_paths, &hits));
        photon_store_put(&places, &at);
    }
    photon_hits_clear(&hits);
    return photon_map_build(MAP_KDTREE, &places, 0.0f, 1, error);
}

bool vcm_keep_density(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    transport_counts counts = {0};
    vcm_pass pilot = {
        .plan = plan,
        .scene = plan->scene,
        .w = wavelengths_at(0.5f),
        .index = PILOT_PASS,
        .strategies.merge = true,
        .n_slices = 1,
        .light.n = MIN(plan->n_photons[PHOTON_INDIRECT], PILOT_PATHS),
    };
    if (!vcm_trace_light(&pilot, cancel, &counts, error))
        return false;
    g_autoptr(photon_map) map = map_of(&pilot.light, (unsigned)plan->how.threads, error);
    if (map)
        plan->density = keep_places(map, pilot.light.n, error);
    light_paths_clear(&pilot.light);
    return plan->density != NULL;
}

float vcm_alone_at(const vcm_pass *pass, vec3 p, photon_hits *hits)
{
    const photon_map *density = pass->plan->density;
    if (!density || !photon_map_nearest(density, p, 1, INFINITY, NULL, hits) ||
        hits->n == 0)
        return 1.0f;
    float within =
        pass->ratios.merge * photon_map_store(density)->flux[hits->index[0]][0];
    return 1.0f / (1.0f + fminf(within, 1e6f));
}
