/*
 * How close light vertices lie, place by place: known before the first pass, from a few
 * light subpaths of a pass that no render reaches, so that the weights of a pass do not
 * depend on the vertices they are for.
 */
#include "transport/places.h"
#include "transport/plan/work.h"
#include "transport/vcm/vcm.h"

#include <float.h>

/* id: a pass that no render reaches. */
#define PILOT_PASS 0xfffffffeu

static photon_map *map_of(const scene *s, const light_paths *paths, unsigned threads,
                          GError **error)
{
    photon_store store = {0};
    if (!photon_store_reserve(&store, paths->n_vertices, error))
        return NULL;
    for (size_t i = 0; i < paths->n_vertices; i++) {
        const light_vertex *v = &paths->vertices[i];
        photon p = {.p = scene_restore_hit(s, &v->hit).p, .wi = kept_hit_wo(&v->hit)};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_KDTREE, &store, 0.0f, threads, error);
}

/* Vertices of a subpath per square metre around p; 0: too few to tell. */
static float density_at(const void *data, vec3 p, float distance, photon_hits *hits)
{
    (void)p, (void)hits;
    const light_paths *paths = data;
    if (!(distance > 0.0f))
        return 0.0f;
    float density = PLACES_NEAREST / (PI_F * square(distance) * (float)paths->n);
    return isfinite(density) ? density : FLT_MAX;
}

bool vcm_keep_density(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    transport_counts counts = {0};
    vcm_pass pilot = {
        .plan = plan,
        .scene = plan->scene,
        .w = scene_trial_wavelengths(plan->scene, 0),
        .index = PILOT_PASS,
        .strategies.merge = true,
        .n_slices = 1,
        .light.n = MIN(plan->n_photons[PHOTON_INDIRECT],
                       plan_trials_for(plan, 0.5, PHOTON_RAYS, MOST_PILOTS)),
    };
    if (!vcm_trace_light(&pilot, cancel, &counts, error))
        return false;
    plan->planning += (double)counts.photon_rays;
    g_autoptr(photon_map) map =
        map_of(plan->scene, &pilot.light, (unsigned)plan->how.threads, error);
    if (map)
        plan->density = places_keep(map, (unsigned)plan->how.threads, density_at,
                                    &pilot.light, error);
    light_paths_clear(&pilot.light);
    return plan->density != NULL;
}
