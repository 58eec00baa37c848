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
    spectrum value = path->beta * radiance;
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
        walk->out->groups[i] += path->beta * walk->scratch->estimate.groups[i];
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
        walk->out->groups[scene_light_group(walk->scene, lamp)] += path->beta * radiance;
}

/* Weight of a light that the path ran into. hit NULL: an environment. */
static float met_light_weight(const path_walk *walk, const camera_path *path, int lamp,
                              const surface_hit *hit)
{
    if (!(path->pdf > 0.0f) || !walk->how->direct_illumination)
        return 1.0f;
    if (!walk->how->shadow_rays)
        return 0.0f;
    float pdf = direct_light_pdf(walk->scene, path->every_light, lamp, path->from,
                                 path->ray.direction, hit);
    return followed_weight(path->pdf, pdf);
}

/* What photons leave of the light of a lamp that the path ran into. hit NULL: an
   environment. */
static float left_by_photons(const path_walk *walk, const camera_path *path, int lamp,
                             const surface_hit *hit)
{
    vec3 d = path->ray.direction;
    if (!photons_share(walk, path))
        return 1.0f;
    const caustic_end end = {
        .light = lamp,
        .p = hit ? hit->p : path->from,
        .n = hit ? hit->n_geom : -d,
        .direction = -d,
        .specular = !(path->pdf > 0.0f),
        .pdf_scatter = path->pdf_scatter,
        .pdf_lights = scene_light_pdf(walk->scene, lamp, path->from, d, hit),
    };
    return 1.0f - caustic_share_of(&walk->pass->caustics->share, &end);
}

static void meet_lamp(path_walk *walk, const camera_path *path, const surface_hit *hit)
{
    spectrum radiance =
        scene_emitted(walk->scene, hit, -path->ray.direction, &walk->pass->w);
    if (spectrum_is_black(radiance))
        return;
    float weight = met_light_weight(walk, path, hit->light, hit) *
                   left_by_photons(walk, path, hit->light, hit);
    add_from(walk, path, radiance * weight, hit->light);
}

static void meet_sky(path_walk *walk, const camera_path *path)
{
    const scene *s = walk->scene;
    for (int i = 0; i < s->n_environments; i++) {
        int index = s->environments[i];
        const light *l = scene_light(s, index);
        spectrum radiance = l->kind->environment(l->self, path->ray.origin,
                                                 path->ray.direction, &walk->pass->w);
        float weight = met_light_weight(walk, path, index, NULL) *
                       left_by_photons(walk, path, index, NULL);
        add_from(walk, path, radiance * weight, index);
    }
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
    if (path->lane == ALL_LANES)
        return b;
    scene_bsdf(walk->scene, hit, &pass->w, ALL_LANES, &pass->options, room);
    return room;
}

/* Notes a place whose light lights others. */
static void note_lit(const path_walk *walk, const camera_path *path,
                     const surface_hit *hit, const bsdf *b, spectrum radiance)
{
    photon_store *lit = walk->pass->lit;
    vec3 toward = -path->ray.direction;
    const photon place = {.p = hit->p,
                          .wi = toward,
                          .flux = path->beta * radiance,
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
        .wo = -path->ray.direction,
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
    path->beta /= p;
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
    const shading_point at = {hit, b, -path->ray.direction, path->n_diffuse > 0};
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
        bsdf_pdf(all, -path->ray.direction, next->wi, LOBE_ALL, TRANSPORT_RADIANCE);
}

static bool bounce(path_walk *walk, camera_path *path, const surface_hit *hit,
                   const bsdf *b)
{
    float u_lobe = sampler_1d(walk->random);
    vec2 u = sampler_2d(walk->random);
    bsdf_sample next;
    if (!bsdf_sample_direction(b, -path->ray.direction, u_lobe, u, LOBE_ALL,
                               TRANSPORT_RADIANCE, &next))
        return false;
    if (bsdf_has_both(b))
        bsdf_settle_class(b, -path->ray.direction, TRANSPORT_RADIANCE,
                          sampler_1d(walk->random), &next);
    note_density(walk, path, hit, b, &next);
    path->looked = path_looks(walk, path, b);
    path->beta *= next.weight;
    path->lane = next.lane;
    path->eta2 *= next.eta * next.eta;
    path->pdf = (next.lobe & LOBE_SPECULAR) ? 0.0f : next.pdf;
    path->from = hit->p;
    path->every_light = samples_every_light(path);
    path->by_either = path->looked > 0.0f && bsdf_has_both(b);
    path->ray = hit_ray(hit, next.wi);
    camera_path_count(path, next.lobe);
    if (path->bounces < ROULETTE_BOUNCES)
        return !spectrum_is_black(path->beta);
    float p = minf(1.0f, spectrum_mean(path->beta) * path->eta2);
    if (path->bounces >= LONG_WAY)
        p *= LONG_WAY_SURVIVAL;
    path->beta /= p;
    return sampler_1d(walk->random) < p;
}

/* The surface that the path meets next. */
static bool meet_surface(path_walk *walk, const camera_path *path, surface_hit *hit)
{
    walk->scratch->camera_rays++;
    return path->bounces == 0 ? scene_see(walk->scene, &path->ray, hit)
                              : scene_intersect(walk->scene, &path->ray, hit);
}

/* What the eye's ray meets behind a medium is what the picture shows there. */
static void note_through_medium(path_walk *walk, const camera_path *path,
                                const surface_hit *hit)
{
    bsdf b;
    const path_pass *pass = walk->pass;
    if (path->bounces == 0 &&
        scene_bsdf(walk->scene, hit, &pass->w, path->lane, &pass->options, &b))
        radiance_sample_note(walk->out, hit, &b, -path->ray.direction, path->from);
}

/* What becomes of a path on its way to the next surface. */
typedef enum path_way {
    WAY_ENDS,    /* it leaves the scene */
    WAY_PASSES,  /* it meets an interface, and goes on behind it */
    WAY_SCATTERS /* at a surface or in a medium */
} path_way;

/* Takes the path to where it is scattered next. @param hit,b set where it is */
static path_way come_to_scatterer(path_walk *walk, camera_path *path, surface_hit *hit,
                                  bsdf *b)
{
    const path_pass *pass = walk->pass;
    bool met = meet_surface(walk, path, hit);
    if (path->ray.medium) {
        surface_hit within;
        if (met)
            note_through_medium(walk, path, hit);
        float length = scene_medium_end(walk->scene, &path->ray, met ? hit->t : INFINITY);
        if (path_meets_medium(walk, path, length, &within, b)) {
            *hit = within;
            return WAY_SCATTERS;
        }
    }
    if (!met) {
        meet_sky(walk, path);
        return WAY_ENDS;
    }
    bool seen = path->bounces == 0 && !path->ray.medium;
    path->beta *= hit_transmittance(hit, &pass->w);
    meet_lamp(walk, path, hit);
    if (!scene_bsdf(walk->scene, hit, &pass->w, path->lane, &pass->options, b)) {
        path->ray = hit_ray(hit, path->ray.direction);
        return WAY_PASSES;
    }
    if (seen)
        radiance_sample_note(walk->out, hit, b, -path->ray.direction, path->from);
    return WAY_SCATTERS;
}

/* One more step of the path. @return false if it was the last. */
static bool path_goes_on(path_walk *walk, camera_path *path)
{
    surface_hit hit;
    bsdf b;
    path_way way = come_to_scatterer(walk, path, &hit, &b);
    if (way != WAY_SCATTERS)
        return way == WAY_PASSES;
    if (path_is_cut(walk, path, 1))
        return false;
    camera_path seen = *path;
    if (!b.is_phase)
        seen.beta *= path_left_by_spots(walk, path, &hit, &b);
    path_sample_lights(walk, &seen, &hit, &b);
    if (!b.is_phase) {
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
    path_walk walk = {pass, pass->plan->scene, &pass->plan->how, random, scratch, out};
    camera_path path = {.ray = *r,
                        .beta = spectrum_fill(1.0f),
                        .lane = ALL_LANES,
                        .eta2 = 1.0f,
                        .from = r->origin};
    while (!cancelled(pass->plan->cancel) && path_goes_on(&walk, &path))
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
