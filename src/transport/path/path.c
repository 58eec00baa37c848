#include "transport/direct.h"
#include "transport/path/path_walk.h"
#include "transport/photonmap/photonmap.h"

enum { ROULETTE_BOUNCES = 4 };

static radiance_layer layer_of(const camera_path *path)
{
    if (path->n_before > 0)
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

bool path_is_caustic(const camera_path *path)
{
    return path->n_diffuse > 0 && path->n_after > 0;
}

/* True if photons too carry it. */
static bool photons_share(const path_walk *walk, const camera_path *path)
{
    return walk->pass->caustics && path_is_caustic(path);
}

static bool add(path_walk *walk, const camera_path *path, spectrum radiance)
{
    spectrum value = path->at.throughput * radiance;
    if (walk->pass->without_caustics && path_is_caustic(path))
        return false;
    if (!spectrum_is_finite(value)) {
        walk->scratch->n_not_finite++;
        return false;
    }
    walk->out->layers[layer_of(path)] += value;
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

/* Adds what came from one lamp. */
static void add_from(path_walk *walk, const camera_path *path, spectrum radiance,
                     int lamp)
{
    if (add(walk, path, radiance) && walk->out->groups)
        walk->out->groups[scene_light_group(walk->scene, lamp)] +=
            path->at.throughput * radiance;
}

/* What photons leave of the light that the path ran into. */
static float left_by_photons(const path_walk *walk, const camera_path *path,
                             const met_light *met)
{
    const surface_hit *hit = met->hit;
    vec3 d = path->at.ray.direction;
    if (!photons_share(walk, path))
        return 1.0f;
    const caustic_end end = {
        .light = met->light,
        .p = hit ? hit->p : path->from,
        .n = hit ? hit->n_geom : -d,
        .direction = -d,
        .specular = !(path->pdf > 0.0f),
        .pdf_scatter = path->pdf_scatter,
        .pdf_lights = scene_light_pdf(walk->scene, met->light, path->from, d, hit),
    };
    return 1.0f - caustic_share_of(&walk->pass->caustics->share, &end);
}

static void meet_light(void *data, const met_light *met)
{
    path_walk *walk = data;
    const camera_path *path = &walk->path;
    const scattered_from from = {path->from, path->pdf, path->every_light};
    float weight =
        direct_met_weight(walk->scene, walk->how, &from, path->at.ray.direction, met) *
        left_by_photons(walk, path, met);
    add_from(walk, path, met->radiance * weight, met->light);
}

static void meet_surface(void *data, const surface_hit *hit)
{
    const path_walk *walk = data;
    direct_meet(walk->scene, &walk->pass->w, &walk->path.at.ray, hit, meet_light, data);
}

/* Grain shows on what is seen straight or in a mirror. */
static bool samples_every_light(const camera_path *path)
{
    return path->n_diffuse == 0 && !path->by_either;
}

/* The bsdf whatever lane the path has kept: b, or made in room. */
static const bsdf *all_lanes(const path_walk *walk, const camera_path *path,
                             const surface_hit *hit, const bsdf *b, bsdf *room)
{
    const path_pass *pass = walk->pass;
    if (path->at.lane == ALL_LANES)
        return b;
    scene_bsdf(walk->scene, hit, &pass->w, ALL_LANES, &pass->options, room);
    return room;
}

/* Notes a place whose light lights others. */
static void note_lit(const path_walk *walk, const camera_path *path,
                     const surface_hit *hit, const bsdf *b, spectrum radiance)
{
    photon_store *lit = walk->pass->lit;
    vec3 toward = -path->at.ray.direction;
    const photon place = {.p = hit->p,
                          .wi = toward,
                          .flux = path->at.throughput * radiance,
                          .n = face_forward(hit->n_geom, toward)};
    if (path->n_diffuse > 0 && !b->is_phase && lit->n < lit->capacity)
        photon_store_put(lit, &place);
}

void path_sample_lights(path_walk *walk, const camera_path *path, const surface_hit *hit,
                        const bsdf *b)
{
    if (!walk->how->direct_illumination || !(b->lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)))
        return;
    bsdf room;
    camera_path by_diffuse = *path, by_glossy = *path;
    camera_path_count(&by_diffuse, LOBE_DIFFUSE);
    camera_path_count(&by_glossy, LOBE_GLOSSY);
    bool share = (b->lobes & LOBE_GLOSSY) && photons_share(walk, &by_glossy);
    const direct_query query = {
        .scene = walk->scene,
        .w = &walk->pass->w,
        .hit = hit,
        .bsdf = b,
        .wo = -path->at.ray.direction,
        .every_light = samples_every_light(path),
        .shadow_rays = walk->how->shadow_rays,
        .followed = LOBE_ALL,
        .share = share ? &walk->pass->caustics->share : NULL,
        .all_lanes = share ? all_lanes(walk, path, hit, b, &room) : NULL,
    };
    direct_radiance found[FEW_LIGHTS];
    int n = direct_light(&query, walk->random, found, &walk->scratch->shadow_rays);
    for (int i = 0; i < n; i++) {
        add_from(walk, &by_diffuse, found[i].diffuse, found[i].light);
        add_from(walk, &by_glossy, found[i].glossy, found[i].light);
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
    unsigned delta = path->n_diffuse == 0 && photons->has_unmet_lights ? LOBE_GLOSSY : 0;
    camera_path seen = *path;
    if (!(b->lobes & (LOBE_DIFFUSE | delta)) || path_is_caustic(path) ||
        path_is_cut(walk, path, 2))
        return;
    const shading_point at = {hit, b, -path->at.ray.direction, path->n_diffuse > 0};
    if (path_skips_gather(walk, &seen, walk->pass->plan->p_blurred))
        return;
    camera_path_count(&seen, LOBE_DIFFUSE);
    seen.n_after = 1;
    path_add_parts(walk, &seen,
                   photonmap_gather(photons, PHOTON_CAUSTIC, &at, delta, walk->scratch));
}

/* Keeps what the share of photons depends on, where they may have one. */
static void note_density(const path_walk *walk, camera_path *path, const surface_hit *hit,
                         const bsdf *b, const bsdf_sample *next)
{
    bsdf room;
    if (!walk->pass->caustics || path->n_diffuse == 0 || !(next->lobe & LOBE_GLOSSY))
        return;
    const bsdf *all = all_lanes(walk, path, hit, b, &room);
    path->pdf_scatter =
        bsdf_pdf(all, -path->at.ray.direction, next->wi, LOBE_ALL, TRANSPORT_RADIANCE);
}

static bool bounce(path_walk *walk, camera_path *path, const surface_hit *hit,
                   const bsdf *b)
{
    float u_lobe = sampler_1d(walk->random);
    vec2 u = sampler_2d(walk->random);
    bsdf_sample next;
    if (!bsdf_sample_direction(b, -path->at.ray.direction, u_lobe, u, LOBE_ALL,
                               TRANSPORT_RADIANCE, &next))
        return false;
    if (bsdf_has_both(b))
        bsdf_settle_class(b, -path->at.ray.direction, TRANSPORT_RADIANCE,
                          sampler_1d(walk->random), &next);
    note_density(walk, path, hit, b, &next);
    path->looked = path_looks(walk, path, b);
    path->at.throughput *= next.weight;
    path->at.lane = next.lane;
    path->eta2 *= next.eta * next.eta;
    path->pdf = (next.lobe & LOBE_SPECULAR) ? 0.0f : next.pdf;
    path->from = hit->p;
    path->every_light = samples_every_light(path);
    path->by_either = path->looked > 0.0f && bsdf_has_both(b);
    path->at.ray = hit_ray(hit, next.wi);
    path->at.from_eye = false;
    camera_path_count(path, next.lobe);
    if (path->bounces < ROULETTE_BOUNCES)
        return !spectrum_is_black(path->at.throughput);
    float p = minf(1.0f, spectrum_mean(path->at.throughput) * path->eta2);
    if (path->bounces >= LONG_WAY)
        p *= LONG_WAY_SURVIVAL;
    path->at.throughput /= p;
    return sampler_1d(walk->random) < p;
}

/* The eye sees this surface first: its albedo and normal are the picture's there. */
static void note_seen(const path_walk *walk, const surface_hit *hit)
{
    bsdf b;
    const path_pass *pass = walk->pass;
    const camera_path *path = &walk->path;
    if (scene_bsdf(walk->scene, hit, &pass->w, path->at.lane, &pass->options, &b))
        radiance_sample_note(walk->out, hit, &b, -path->at.ray.direction, path->from);
}

/* What the eye's ray meets behind a medium is what the picture shows there. */
static scene_event cross_medium(void *data, float length, const surface_hit *behind,
                                surface_hit *at)
{
    path_walk *walk = data;
    if (behind && walk->path.at.from_eye)
        note_seen(walk, behind);
    return path_meets_medium(walk, &walk->path, length, at) ? EVENT_MEDIUM : EVENT_NONE;
}

/* One more step of the path. @return false if it was the last. */
static bool path_goes_on(path_walk *walk)
{
    const path_pass *pass = walk->pass;
    camera_path *path = &walk->path;
    surface_hit hit;
    bsdf b;
    scene_event event = scene_advance(&walk->who, &path->at, &hit);
    if (event == EVENT_ESCAPE) {
        meet_surface(walk, NULL);
        return false;
    }
    scene_scatterer(walk->scene, &hit, &pass->w, path->at.lane, &pass->options, &b);
    if (event == EVENT_SURFACE && path->at.from_eye && !path->at.ray.media.participating)
        radiance_sample_note(walk->out, &hit, &b, -path->at.ray.direction, path->from);
    if (path_is_cut(walk, path, 1))
        return false;
    camera_path seen = *path;
    if (event == EVENT_SURFACE)
        seen.at.throughput *= path_left_by_spots(walk, path, &hit, &b);
    path_sample_lights(walk, &seen, &hit, &b);
    if (event == EVENT_SURFACE) {
        path_gather_caustics(walk, &seen, &hit, &b);
        path_look_at_spots(walk, path, &hit, &b);
    }
    return bounce(walk, path, &hit, &b);
}

void path_radiance(const void *data, const ray *r, sampler *random,
                   transport_scratch *scratch, radiance_sample *out)
{
    const path_pass *pass = data;
    *out = (radiance_sample){.groups = out->groups};
    path_walk walk = {
        .who = {.scene = pass->plan->scene,
                .w = &pass->w,
                .n_rays = &scratch->camera_rays,
                .path = &walk,
                .cross_medium = cross_medium,
                .meet_light = meet_surface},
        .path = {.at = path_segment_from_eye(r), .eta2 = 1.0f, .from = r->origin},
        .pass = pass,
        .scene = pass->plan->scene,
        .how = &pass->plan->how,
        .random = random,
        .scratch = scratch,
        .out = out,
    };
    while (!cancelled(pass->plan->cancel) && path_goes_on(&walk))
        continue;
}

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    (void)plan;
    (void)cancel;
    (void)error;
    return true;
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    (void)cancel;
    (void)counts;
    (void)error;
    path_pass *pass = g_aligned_alloc0(1, sizeof *pass, 64);
    pass->plan = plan;
    pass->w = scene_wavelengths(plan->scene, &plan->how, index);
    pass->options.deterministic = !plan->how.multiple_samples;
    return pass;
}

static const wavelengths *pass_wavelengths(const void *pass)
{
    return &((const path_pass *)pass)->w;
}

static void end_pass(void *pass)
{
    g_aligned_free(pass);
}

const transport_kind transport_path = {
    .name = "path",
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = path_radiance,
    .pass_wavelengths = pass_wavelengths,
    .end_pass = end_pass,
};
