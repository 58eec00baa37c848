/*
 * Asking the maps of a pass: what radius a place has, and what photons say of it.
 */
#include "transport/photonmap/photonmap.h"

#include "base/clock.h"

double photonmap_radius(double radius, double alpha, uint32_t pass)
{
    double r2 = radius * radius;
    for (uint32_t i = 1; i <= pass; i++)
        r2 *= ((double)i - 1.0 + alpha) / (double)i;
    return sqrt(r2);
}

estimate_options photonmap_estimate_options(const settings *how, photon_class c,
                                            double radius)
{
    size_t nearest = (size_t)how->class_nearest[c];
    bool unbounded = nearest > 0 && !(how->radius > 0.0);
    return (estimate_options){
        .kernel = {(kernel_choice)how->class_kernel[c], (float)how->class_cone_k[c]},
        .nearest = nearest,
        .radius = unbounded ? INFINITY : (float)radius,
        .flatten = (float)how->flatten,
        .lobes = photon_gathered_lobes(how),
    };
}

/* A place further from its radius' own place than that radius reaches is emptier still.
 */
static float local_radius(const photonmap_pass *pass, photon_class c, vec3 p,
                          point_hits *hits)
{
    const radius_cache *radii = pass->plan->radius_cache[c];
    float typical = pass->estimates[c].radius;
    if (!radii || pass->estimates[c].nearest > 0)
        return typical;
    float distance = 0.0f, r = radius_cache_at(radii, p, -1.0f, &distance, hits);
    if (r < 0.0f)
        return typical;
    float shrunk = typical / (float)pass->plan->radius[c];
    return minf(maxf(r, distance) * shrunk,
                WIDEST_OVER_TYPICAL * typical);
}

estimate_options photonmap_options_at(const photonmap_pass *pass, photon_class c, vec3 p,
                                      point_hits *hits)
{
    estimate_options options = pass->estimates[c];
    options.radius = local_radius(pass, c, p, hits);
    return options;
}

/* Turns a bsdf with the surface that it is of. */
static void turn_bsdf(const transform *by, vec3 n_geom, bsdf *b)
{
    vec3 n = face_forward(normalize3(transform_normal(by, b->shading.n)), n_geom);
    if (dot3(b->shading.n, b->n_geom) < 0.0f)
        n = -n;
    b->shading = frame_from_tangent(n, transform_vector(by, b->shading.s));
    b->n_geom = n_geom;
}

/* What the map of a slice says: of what moves or turns, where its photons are kept. */
static spectrum gather_at(const photonmap_pass *pass, const photon_map *map,
                          const shading_point *at, const estimate_options *options,
                          transport_scratch *scratch)
{
    const scene *s = pass->scene;
    bool moves = scene_hit_moves(s, at->hit);
    if (!moves && !at->hit->camera_facing)
        return photon_estimate(map, at->hit->p, at->bsdf, at->wo, options,
                               &scratch->estimate, NULL);
    surface_hit hit = *at->hit;
    bsdf turned = *at->bsdf;
    vec3 wo = at->wo;
    if (moves) {
        transform by = scene_motion_to(s, &hit, options->time);
        instance_move_hit(&by, &hit);
        hit.time = options->time;
        turn_bsdf(&by, hit.n_geom, &turned);
        wo = normalize3(transform_vector(&by, wo));
    }
    const flat_curve flat = {s, &hit};
    estimate_options there = *options;
    there.curve = hit.camera_facing ? &flat : NULL;
    return photon_estimate(map, scene_hit_place(s, &hit), &turned, wo, &there,
                           &scratch->estimate, NULL);
}

float photonmap_slice_time(const photonmap_pass *pass, int slice)
{
    return pass->scene->moves ? time_of_slice(slice, pass->n_slices) : 0.0f;
}

spectrum photonmap_gather(const photonmap_pass *pass, photon_class c,
                          const shading_point *at, unsigned delta_lobes,
                          transport_scratch *scratch)
{
    int slice = time_slice(at->hit->time, pass->n_slices);
    const photon_map *map = pass->maps[slice][c];
    if (!map) {
        for (size_t i = 0; i < scratch->estimate.n_groups; i++)
            scratch->estimate.groups[i] = (spectrum){0};
        return (spectrum){0};
    }
    estimate_options options =
        photonmap_options_at(pass, c, at->hit->p, &scratch->estimate.hits);
    options.scene = pass->how->edges && !at->blurred ? pass->scene : NULL;
    options.shares_looks = at->in_pixel;
    options.time = photonmap_slice_time(pass, slice);
    options.delta_lobes = delta_lobes ? delta_lobes | LOBE_ANY_SIDE : 0;
    int64_t start = scratch->timed ? clock_microseconds() : 0;
    spectrum radiance = gather_at(pass, map, at, &options, scratch);
    if (scratch->timed)
        scratch->time_gather += clock_microseconds() - start;
    return radiance;
}
