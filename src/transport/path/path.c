#include "transport/direct.h"
#include "transport/path/path_walk.h"
#include "transport/photonmap/photonmap.h"

/* MIS weight of a light that the path ran into, beside the photons that found it. */
static float weight_beside_photons(const path_walk *walk, const camera_path *path,
                                   const met_light *met)
{
    const surface_hit *hit = met->hit;
    vec3 d = path->at.ray.direction;
    if (!path_photons_share(walk, path))
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
    return 1.0f - caustic_mis_weight(&walk->pass->caustics->mis, &end);
}

/* Straight, or by specular bounces alone since the last glossy one. */
static bool sees_light(const camera_path *path)
{
    return path->n_diffuse == 0 && !(path->pdf > 0.0f);
}

static void meet_light(void *data, const met_light *met)
{
    path_walk *walk = data;
    const camera_path *path = &walk->path;
    if (path->lights_met || (walk->pass->without_lights && sees_light(path)))
        return;
    const scattered_from from = {path->from, path->pdf, path->every_light};
    float weight =
        direct_met_weight(walk->scene, walk->how, &from, path->at.ray.direction, met) *
        weight_beside_photons(walk, path, met);
    path_add_from(walk, path, met->radiance * weight, met->light);
    radiance_sample_light(walk->out, &path->at, met->radiance * weight);
}

static void meet_surface(void *data, const surface_hit *hit)
{
    const path_walk *walk = data;
    direct_meet(walk->scene, &walk->pass->w, &walk->path.at.ray, hit, meet_light, data);
}

/* Keeps what the photons' MIS weight depends on, where they may have one. */
static void note_density(const path_walk *walk, camera_path *path, const surface_hit *hit,
                         const bsdf *b, const bsdf_sample *next)
{
    bsdf room;
    if (!walk->pass->caustics || path->n_diffuse == 0 || !(next->lobe & LOBE_GLOSSY))
        return;
    const bsdf *all = path_all_wavelengths(walk, path, hit, b, &room);
    path->pdf_scatter =
        bsdf_pdf(all, -path->at.ray.direction, next->wi, LOBE_ALL, TRANSPORT_RADIANCE);
}

static void leave(path_walk *walk, camera_path *path, const surface_hit *hit,
                  const bsdf *b, const bsdf_sample *next, float probability)
{
    note_density(walk, path, hit, b, next);
    path->looked = path_looks(walk, path, b);
    path_segment_leave(&path->at, hit, next, probability);
    path->eta2 *= next->eta * next->eta;
    path->pdf = (next->lobe & LOBE_SPECULAR) ? 0.0f : next->pdf;
    path->from = hit->p;
    path->lights_met = false;
    path->every_light = path_samples_every_light(path);
    path->by_either = path->looked > 0.0f && bsdf_has_both(b);
    camera_path_count(path, next->lobe);
}

/* Through a pane, as light that is sampled comes: it comes from where it scattered last.
   Spots are not looked at through panes. */
static void leave_straight(camera_path *path, const surface_hit *hit,
                           const bsdf_sample *next, float probability)
{
    path_segment_leave(&path->at, hit, next, probability);
    path->lights_met = false;
    path->looked = 0.0f;
    path->bounces++;
    path->n_before += path->n_diffuse == 0;
}

/* By lobes that are followed with some probability. */
static bool bounce(path_walk *walk, camera_path *path, const surface_hit *hit,
                   const bsdf *b, unsigned lobes, float probability)
{
    float u_lobe = sampler_1d(walk->random);
    vec2 u = sampler_2d(walk->random);
    bsdf_sample next;
    if (!bsdf_sample_direction(b, -path->at.ray.direction, u_lobe, u, lobes,
                               TRANSPORT_RADIANCE, &next))
        return false;
    if (bsdf_has_both(b))
        bsdf_settle_class(b, -path->at.ray.direction, TRANSPORT_RADIANCE,
                          sampler_1d(walk->random), &next);
    if (next.straight)
        leave_straight(path, hit, &next, probability);
    else
        leave(walk, path, hit, b, &next, probability);
    if (path->bounces < ROULETTE_BOUNCES)
        return !spectrum_is_black(path->at.throughput);
    float p = minf(most_survival(path->bounces),
                   spectrum_mean(path->at.throughput) * path->eta2);
    path->at.throughput /= p;
    path->at.certain = false;
    return sampler_1d(walk->random) < p;
}

/* The first surface that is not specular guides the denoiser. */
static void note_guide(const path_walk *walk, camera_path *path, const surface_hit *hit,
                       const bsdf *b)
{
    path->guided = path->guided ||
                   radiance_sample_guide(walk->out, hit, b, -path->at.ray.direction,
                                         walk->eye, spectrum_mean(path->at.throughput));
}

/* If the eye sees this surface first, its albedo and normal are the picture's there. */
static void note_seen(path_walk *walk, const surface_hit *hit)
{
    bsdf b;
    const path_pass *pass = walk->pass;
    camera_path *path = &walk->path;
    if (!scene_bsdf(walk->scene, hit, &pass->w, path->at.wavelength, &pass->options, &b))
        return;
    if (path->at.eye)
        radiance_sample_note(walk->out, hit, &b, -path->at.ray.direction, path->from);
    note_guide(walk, path, hit, &b);
}

/* Whether chance may hide lights that there may be behind the path's medium. */
static bool may_hide_lights(const path_walk *walk, const surface_hit *behind)
{
    const medium *m = scene_medium(walk->scene, walk->path.at.ray.media.participating);
    bool may_shine = !behind || behind->light != NO_INDEX || behind->material == NO_INDEX;
    return walk->pass->sees_lights && may_shine && medium_scatters(m);
}

/* Lights in sight are met by as much as media let through, whatever becomes of the path:
   met by the chance that it comes through they would be as noisy as they are bright, and
   nothing takes that out, for they are not filtered. */
static void meet_lights_behind(path_walk *walk, const surface_hit *behind)
{
    camera_path *path = &walk->path;
    const path_segment here = path->at;
    scene_traveller straight = walk->who;
    surface_hit hit;
    if (path->lights_met || !path->at.certain || !may_hide_lights(walk, behind))
        return;
    straight.cross_medium = NULL;
    if (scene_advance(&straight, &path->at, &hit) == EVENT_ESCAPE)
        meet_surface(walk, NULL);
    path->at = here;
    path->lights_met = true;
}

/* What the eye's ray meets behind a medium is what the picture shows there. */
static scene_event cross_medium(void *data, float length, const surface_hit *behind,
                                surface_hit *at)
{
    path_walk *walk = data;
    if (behind && (walk->path.at.eye || !walk->path.guided))
        note_seen(walk, behind);
    meet_lights_behind(walk, behind);
    return path_meets_medium(walk, &walk->path, length, at) ? EVENT_MEDIUM : EVENT_NONE;
}

static bool path_goes_on(path_walk *walk);

static void follow(path_walk *walk)
{
    while (!cancelled(walk->pass->plan->cancel) && path_goes_on(walk))
        continue;
}

/* Goes on by one side of glass, for roulette as if that was all. */
static bool bounce_by(path_walk *walk, camera_path *path, const surface_hit *hit,
                      const bsdf *b, unsigned side, float probability)
{
    float before = spectrum_mean(path->at.throughput) * path->eta2;
    bool goes_on = bounce(walk, path, hit, b, LOBE_SPECULAR | side, probability);
    path->eta2 = before / spectrum_mean(path->at.throughput);
    return goes_on;
}

/* Follows the other side of glass, if so, and goes on with the usual one. */
static bool part(path_walk *walk, camera_path *path, const surface_hit *hit,
                 const bsdf *b)
{
    const path_sides sides = path_part(path->bounces, b, -path->at.ray.direction);
    const camera_path here = *path;
    sampler *outer = walk->random, own = sampler_split(outer, 0);
    walk->random = &own;
    bool both = sampler_1d(&own) < sides.p_both;
    if (both && bounce_by(walk, path, hit, b, sides.other, sides.p_both))
        follow(walk);
    walk->random = outer;
    *path = here;
    bool goes_on = bounce_by(walk, path, hit, b, sides.usual, 1.0f);
    float scale = both ? sides.beside : sides.alone;
    path->at.throughput *= scale;
    path->eta2 /= scale;
    return goes_on;
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
    scene_scatterer(walk->scene, &hit, &pass->w, path->at.wavelength, &pass->options, &b);
    if (event == EVENT_SURFACE && path->at.eye && !path->at.ray.media.participating)
        radiance_sample_note(walk->out, &hit, &b, -path->at.ray.direction, path->from);
    if (event == EVENT_SURFACE)
        note_guide(walk, path, &hit, &b);
    if (path_is_cut(walk, path, 1))
        return false;
    camera_path seen = *path;
    if (event == EVENT_SURFACE)
        seen.at.throughput *= path_weight_beside_spots(walk, path, &hit, &b);
    path_sample_lights(walk, &seen, &hit, &b);
    if (event == EVENT_SURFACE) {
        path_gather_caustics(walk, &seen, &hit, &b);
        path_look_at_spots(walk, path, &hit, &b);
    }
    return path_is_parted(&path->at, path->bounces, &b)
               ? part(walk, path, &hit, &b)
               : bounce(walk, path, &hit, &b, LOBE_ALL, 1.0f);
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
        .path = {.at = path_segment_from_eye(pass->plan->view, r),
                 .eta2 = 1.0f,
                 .from = r->origin},
        .pass = pass,
        .scene = pass->plan->scene,
        .how = &pass->plan->how,
        .random = random,
        .scratch = scratch,
        .out = out,
        .eye = r->origin,
    };
    follow(&walk);
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
    pass->sees_lights = scene_has_lights_to_see(plan->scene);
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
