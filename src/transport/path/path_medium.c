/*
 * A camera path in a participating medium: it is scattered at points drawn by the
 * medium's extinction (Pharr et al. 2023, chapter 14) and by how near lights are, and on
 * its way it sees what photons left in the medium.
 */
#include "transport/direct.h"
#include "transport/path/path_walk.h"
#include "transport/photonmap/photonmap_medium.h"

/* What photons that scattered in the medium send along the ray: the caustics that the
   path would have to find by a point of its own there. As at surfaces (path.c), where a
   path came by way of glass or metal from a diffuse bounce they were counted before. */
static void gather_in_medium(path_walk *walk, const camera_path *path, float length)
{
    const photonmap_pass *photons = walk->pass->caustics;
    camera_path seen = *path;
    if (!photons || path_is_caustic(path) || path_is_cut(walk, path, 2) ||
        path_skips_gather(walk, &seen, walk->pass->plan->p_blurred_in_media))
        return;
    camera_path_count_medium(&seen);
    camera_path_count(&seen, LOBE_DIFFUSE);
    seen.n_after = 1;
    path_add_parts(walk, &seen,
                   photonmap_gather_medium(photons, PHOTON_CAUSTIC, &path->at.ray, length,
                                           walk->scratch));
}

bool path_meets_medium(path_walk *walk, camera_path *path, float length, surface_hit *hit)
{
    const medium *m = scene_medium(walk->scene, path->at.ray.media.participating);
    const wavelengths *w = &walk->pass->w;
    if (!medium_scatters(m)) {
        path->at.throughput *= medium_transmittance(m, length, w);
        return false;
    }
    gather_in_medium(walk, path, length);
    medium_pivot pivot;
    bool near = direct_pivot(walk->scene, w, &path->at.ray, length, walk->random, &pivot);
    float u = sampler_1d(walk->random);
    medium_sample next =
        near ? medium_sample_free_near(m, w, path->at.throughput, length, &pivot, u)
             : medium_sample_free(m, w, path->at.throughput, length, u);
    path->at.throughput *= next.weight;
    if (!next.scatters)
        return false;
    *hit = hit_in_medium(&path->at.ray, next.t);
    camera_path_count_medium(path);
    return true;
}
