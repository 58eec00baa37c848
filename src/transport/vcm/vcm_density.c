/*
 * How close light vertices lie, place by place: known before the first pass, from a few
 * light subpaths of a pass that no render reaches, so that the weights of a pass do not
 * depend on the vertices they are for.
 */
#include "base/memory.h"
#include "transport/vcm/vcm.h"
#include "transport/work.h"

static bool nearest(const void *vertices, vec3 p, point_hits *hits)
{
    return point_set_nearest(vertices, p, RADIUS_NEAREST, INFINITY, hits);
}

static float distance_itself(const void *data, vec3 p, float distance, point_hits *hits)
{
    (void)data, (void)p, (void)hits;
    return distance;
}

/* Radii at places of some of the points. */
static radius_cache *radii_among(const vec3 *points, size_t n, unsigned threads,
                                 const cancel_flag *cancel, GError **error)
{
    g_autoptr(point_set) index = point_set_build(points, n, threads, error);
    if (!index)
        return NULL;
    size_t n_places = MIN(n, MOST_PLACES);
    vec3 *places = g_aligned_alloc0(MAX(n_places, 1), sizeof *places, 16);
    for (size_t i = 0; i < n_places; i++)
        places[i] = points[point_set_number(index, radius_place(i, n))];
    const radius_source source = {nearest, distance_itself, index, false, cancel};
    radius_cache *cache = radius_cache_build(places, n_places, &source, threads, error);
    g_aligned_free(places);
    return cache;
}

static bool keep_radii(transport_plan *plan, const light_paths *paths, GError **error)
{
    size_t n = paths->n_vertices;
    vec3 *points = big_alloc(n, sizeof *points, "light vertices", error);
    if (!points)
        return false;
    for (size_t i = 0; i < n; i++)
        points[i] = scene_restore_hit(plan->scene, &paths->vertices[i].hit).p;
    plan->n_vertex_paths = paths->n;
    plan->vertex_radii =
        radii_among(points, n, (unsigned)plan->how.threads, plan->cancel, error);
    big_free(points);
    return plan->vertex_radii != NULL;
}

bool vcm_keep_density(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    transport_counts counts = {0};
    vcm_pass pilot = {
        .plan = plan,
        .scene = plan->scene,
        .w = scene_trial_wavelengths(plan->scene, 0),
        .index = plan_trial_pass(TRIAL_VERTICES),
        .strategies.merge = true,
        .n_slices = 1,
        .light.n = MIN(plan->n_photons[PHOTON_INDIRECT],
                       plan_trials_for(plan, 0.5, PHOTON_RAYS, MOST_PILOTS)),
    };
    bool traced = vcm_trace_light(&pilot, cancel, &counts, error);
    plan_note_photons(plan, (double)pilot.light.n, (double)counts.photon_rays);
    bool kept = traced && keep_radii(plan, &pilot.light, error);
    light_paths_clear(&pilot.light);
    return kept;
}
