/*
 * What a camera path finds where it is: light from sampled lights, photons of caustics,
 * and into which layer of the picture they go.
 */
#include "transport/path/path_walk.h"

#include "transport/direct.h"
#include "transport/photonmap/photonmap.h"

static radiance_layer layer_of(const path_walk *walk, const camera_path *path)
{
    bool is_seen_caustic = path->n_diffuse == 1 && path->n_after > 0;
    if (path->n_before > 0 && !(walk->pass->caustics_apart && is_seen_caustic))
        return LAYER_SPECULAR;
    if (path->n_diffuse == 0)
        return LAYER_EMISSION;
    if (path->n_diffuse > 1)
        return LAYER_INDIRECT;
    return path->n_after > 0 ? LAYER_CAUSTIC : LAYER_DIRECT;
}

void camera_path_count(camera_path *path, unsigned lobe)
{
    path->bounces++;
    if (lobe & LOBE_DIFFUSE) {
        path->n_diffuse++;
        path->n_after = 0;
    } else if (path->n_diffuse > 0) {
        path->n_after++;
    } else {
        path->n_before++;
    }
}

void camera_path_count_medium(camera_path *path)
{
    path->n_before += path->n_diffuse == 0;
    path->guided = true;
}

bool path_is_caustic(const camera_path *path)
{
    return path->n_diffuse > 0 && path->n_after > 0;
}

bool path_photons_share(const path_walk *walk, const camera_path *path)
{
    return walk->pass->caustics && path_is_caustic(path);
}

static bool add(path_walk *walk, const camera_path *path, spectrum radiance)
{
    spectrum value = path->at.throughput * radiance;
    bool apart = walk->pass->without_caustics && path_is_caustic(path);
    if (apart && path->n_diffuse == 1)
        return false;
    if (!spectrum_is_finite(value)) {
        walk->scratch->n_not_finite++;
        return false;
    }
    walk->out->layers[apart ? LAYER_CAUSTIC : layer_of(walk, path)] += value;
    return true;
}

void path_add_parts(path_walk *walk, const camera_path *path, spectrum radiance)
{
    if (!add(walk, path, radiance) || !walk->out->groups)
        return;
    for (int i = 0; i < walk->scene->n_light_groups; i++)
        walk->out->groups[i] += path->at.throughput * walk->scratch->estimate.groups[i];
}

bool path_is_cut(const path_walk *walk, const camera_path *path, unsigned more)
{
    int64_t limit = walk->how->max_backward_bounces;
    return limit >= 0 && path->bounces + more > limit;
}

/* Panes that light may come through to a surface which has been come to; negative: any.
 */
static int64_t panes_left(const path_walk *walk, const camera_path *path)
{
    int64_t limit = walk->how->max_backward_bounces;
    return limit < 0 ? limit : MAX(limit - (int64_t)path->bounces - 1, 0);
}

void path_add_from(path_walk *walk, const camera_path *path, spectrum radiance,
                   int source)
{
    if (add(walk, path, radiance) && walk->out->groups)
        walk->out->groups[scene_light_group(walk->scene, source)] +=
            path->at.throughput * radiance;
}

bool path_samples_every_light(const camera_path *path)
{
    return path->n_diffuse == 0 && !path->by_either;
}

const bsdf *path_all_wavelengths(const path_walk *walk, const camera_path *path,
                                 const surface_hit *hit, const bsdf *b, bsdf *room)
{
    const path_pass *pass = walk->pass;
    if (path->at.wavelength == ALL_WAVELENGTHS)
        return b;
    scene_bsdf(walk->scene, hit, &pass->w, ALL_WAVELENGTHS, &pass->options, room);
    return room;
}

/* Notes a place whose light lights others. */
static void note_lit(const path_walk *walk, const camera_path *path,
                     const surface_hit *hit, const bsdf *b, spectrum radiance)
{
    GArray *lit = walk->pass->lit;
    const vec3 p = hit->p, n = face_forward(hit->n_geom, -path->at.ray.direction);
    const lit_place place = {.p = {p[0], p[1], p[2]},
                             .n = {n[0], n[1], n[2]},
                             .power = spectrum_mean(path->at.throughput * radiance)};
    if (path->n_diffuse > 0 && !b->is_phase && lit->len < MOST_PLACES)
        g_array_append_val(lit, place);
}

/* Adds what a lobe sends on of one light. */
static void add_scattered(path_walk *walk, const camera_path *path, spectrum radiance,
                          int source, unsigned lobe)
{
    camera_path by = *path;
    camera_path_count(&by, lobe);
    path_add_from(walk, &by, radiance, source);
}

void path_sample_lights(path_walk *walk, const camera_path *path, const surface_hit *hit,
                        const bsdf *b)
{
    if (!walk->how->direct_illumination || !(b->lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)))
        return;
    bsdf room;
    bool share = (b->lobes & LOBE_GLOSSY) && walk->pass->caustics && path->n_diffuse > 0;
    const direct_query query = {
        .scene = walk->scene,
        .w = &walk->pass->w,
        .hit = hit,
        .bsdf = b,
        .wo = -path->at.ray.direction,
        .every_light = path_samples_every_light(path),
        .shadow_rays = walk->how->shadow_rays,
        .options = &walk->pass->options,
        .most_panes = panes_left(walk, path),
        .followed = LOBE_ALL,
        .mis = share ? &walk->pass->caustics->mis : NULL,
        .all_wavelengths = share ? path_all_wavelengths(walk, path, hit, b, &room) : NULL,
    };
    direct_radiance found[FEW_LIGHTS];
    int n = direct_light(&query, walk->random, found, &walk->scratch->shadow_rays);
    for (int i = 0; i < n; i++) {
        if (b->lobes & LOBE_DIFFUSE)
            add_scattered(walk, path, found[i].diffuse, found[i].light, LOBE_DIFFUSE);
        if (b->lobes & LOBE_GLOSSY)
            add_scattered(walk, path, found[i].glossy, found[i].light, LOBE_GLOSSY);
        if (walk->pass->lit)
            note_lit(walk, path, hit, b, found[i].diffuse + found[i].glossy);
    }
}

bool path_skips_gather(path_walk *walk, camera_path *path, float p_blurred)
{
    float p = path->n_diffuse > 0 ? p_blurred : 1.0f;
    if (p < 1.0f && !(sampler_1d(walk->random) < p))
        return true;
    path->at.throughput /= p;
    return false;
}

/* What the caustic map says of this surface; a photon there has scattered once at least.
   Where a path came by way of glass or metal from a diffuse surface, photons have gone
   the same way and were counted there. Light that a lobe of n_diffuse > 0 would take from
   photons of delta lights on glossy lobes has been counted at the diffuse surface
   before. */
void path_gather_caustics(path_walk *walk, const camera_path *path,
                          const surface_hit *hit, const bsdf *b)
{
    const photonmap_pass *photons = walk->pass->caustics;
    if (!photons)
        return;
    unsigned delta = path->n_diffuse == 0 && photons->has_delta_lights ? LOBE_GLOSSY : 0;
    camera_path seen = *path;
    if (!(b->lobes & (LOBE_DIFFUSE | delta)) || path_is_caustic(path) ||
        path_is_cut(walk, path, 2))
        return;
    const bool blurred = path->n_diffuse > 0;
    const shading_point at = {hit, b, -path->at.ray.direction, blurred, !blurred};
    if (path_skips_gather(walk, &seen, walk->pass->plan->p_blurred))
        return;
    camera_path_count(&seen, LOBE_DIFFUSE);
    seen.n_after = 1;
    path_add_parts(walk, &seen,
                   photonmap_gather(photons, PHOTON_CAUSTIC, &at, delta, walk->scratch));
}
