/*
 * Bright spots as lights: from surfaces of a camera path a ray is sent to a place that is
 * brightly lit, as to a point on a light, and what photons and light sampling say of it
 * there is weighed against what the path finds by scattering (photon/spots.h). So a room
 * that is lit by what the sun throws through its window is no noisier than one with a
 * light there.
 */
#include "transport/direct.h"
#include "transport/path/path_walk.h"
#include "transport/path/spot_trial.h"
#include "transport/work.h"

/* A look at a spot: the surface that the ray met, and how likely it was sent there. */
typedef struct look {
    vec3 wi;
    surface_hit hit;
    bsdf bsdf;
    spectrum transmittance;
    float pdf, pdf_scatter; /* solid angle; of looking, and of following the path */
} look;

static const photon_spots *spots_of(const path_walk *walk, float time)
{
    return walk->pass->spots[time_slice(time, walk->pass->n_slices)];
}

/* How much what is looked at counts in the picture. */
static float importance(const camera_path *path)
{
    return minf(1.0f, spectrum_mean(path->at.throughput) * path->eta2);
}

/* What a path meets after a glossy bounce behind a diffuse one is counted elsewhere
   (path.c), so behind a diffuse bounce surfaces that have a glossy lobe do not look. */
float path_looks(const path_walk *walk, const camera_path *path, const bsdf *b)
{
    const path_pass *pass = walk->pass;
    bool looks = pass->p_spots > 0.0f && !b->is_phase &&
                 (b->lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)) &&
                 (path->n_diffuse == 0 || !(b->lobes & LOBE_GLOSSY)) &&
                 !path_is_cut(walk, path, 3);
    return looks ? pass->trial ? 1.0f : pass->p_spots * importance(path) : 0.0f;
}

/* Glossy lobes count differently behind a diffuse and a glossy bounce: where the surface
   before has both, it is up to chance which of them it was. */
static bool is_seen_alike(bool by_either, const bsdf *b)
{
    return !by_either || !(b->lobes & LOBE_GLOSSY);
}

/* Follows a ray to the first surface that scatters. */
static bool meet_surface(path_walk *walk, const camera_path *path,
                         const surface_hit *from, look *out)
{
    const path_pass *pass = walk->pass;
    path_segment sight = {.ray = hit_ray(from, out->wi),
                          .throughput = spectrum_fill(1.0f)};
    const scene_traveller who = {
        .scene = walk->scene, .w = &pass->w, .n_rays = &walk->scratch->shadow_rays};
    if (scene_advance(&who, &sight, &out->hit) != EVENT_SURFACE)
        return false;
    out->transmittance = sight.throughput;
    return scene_bsdf(walk->scene, &out->hit, &pass->w, path->at.wavelength,
                      &pass->options, &out->bsdf);
}

/* The tree of spots is as dear to ask as a map is twice. Told so, a pass with looks takes
   1.26 to 1.91 times as long, and by the clock 1.32 to 1.83 (seven scenes with caustics,
   192 x 192, 8 passes); asked as a map is, it was told 1.16 to 1.55. By a window, where
   most of what is asked lies beside the spots, it is 3.5 for 2.2. */
static void count_question(path_walk *walk)
{
    walk->scratch->estimate.n_queries += 2;
}

/* Of a look from p at q. */
static float density(path_walk *walk, const photon_spots *spots, vec3 p, vec3 wi, vec3 q)
{
    count_question(walk);
    return photon_spots_pdf(spots, p, wi, q);
}

static bool look_at_spot(path_walk *walk, const camera_path *path, const surface_hit *hit,
                         const bsdf *b, const light_numbers *u, look *out)
{
    int spot;
    const photon_spots *spots = spots_of(walk, hit->time);
    vec3 wo = -path->at.ray.direction;
    count_question(walk);
    if (!spots ||
        !photon_spots_sample(spots, hit->p, u->light, u->place, &spot, &out->wi))
        return false;
    out->pdf_scatter = bsdf_pdf(b, wo, out->wi, LOBE_ALL, TRANSPORT_RADIANCE);
    if (!(out->pdf_scatter > 0.0f) || !meet_surface(walk, path, hit, out) ||
        !is_seen_alike(bsdf_has_both(b), &out->bsdf) ||
        !photon_spots_landed(spots, spot, hit->p, out->wi, out->hit.p))
        return false;
    out->pdf = density(walk, spots, hit->p, out->wi, out->hit.p);
    return true;
}

/* Turns the path into one that has come to the spot by scattering; u, uniform in [0,1),
   chooses the lobe. */
static camera_path path_to(const camera_path *path, const look *seen, const bsdf *b,
                           float u)
{
    const vec3 wo = -path->at.ray.direction;
    camera_path to = *path;
    spectrum f;
    unsigned lobe = bsdf_choose_class(b, wo, seen->wi, TRANSPORT_RADIANCE, u, &f);
    float cosine = fabsf(dot3(seen->wi, b->shading.n));
    to.at.throughput *= f * seen->transmittance * (cosine / seen->pdf);
    to.at.ray.direction = seen->wi;
    to.by_either = bsdf_has_both(b);
    camera_path_count(&to, lobe);
    return to;
}

/* Notes what a look finds before it is weighed. */
static void note_look(const path_walk *walk, const radiance_sample *before,
                      const look *seen, float importance, float weight)
{
    spectrum found = {0};
    for (int i = 0; i < N_LAYERS; i++) {
        spectrum part = walk->out->layers[i] - before->layers[i];
        found += part;
        walk->out->layers[i] = before->layers[i] + part * weight;
    }
    const spot_look note = {
        .importance = (double)importance,
        .pdf = (double)seen->pdf,
        .pdf_scatter = (double)seen->pdf_scatter,
        .value = (double)spectrum_mean(found),
    };
    spot_trial_note(walk->pass->trial, &note);
}

/* Looks, and adds what is seen. @param u its `primitive` is below p, the probability */
static void look_aside(path_walk *walk, const camera_path *path, const surface_hit *hit,
                       const bsdf *b, const light_numbers *u, float p)
{
    const bool tries = walk->pass->trial;
    const radiance_sample before = *walk->out;
    look seen;
    if (!look_at_spot(walk, path, hit, b, u, &seen))
        return;
    camera_path to = path_to(path, &seen, b, u->primitive / p);
    float weight = (1.0f - followed_weight(seen.pdf_scatter, seen.pdf * p)) / p;
    to.at.throughput *= tries ? 1.0f : weight;
    path_sample_lights(walk, &to, &seen.hit, &seen.bsdf);
    path_gather_caustics(walk, &to, &seen.hit, &seen.bsdf);
    if (tries)
        note_look(walk, &before, &seen, importance(path), weight);
}

/* What a look cost, or weighing what scattering found beside it. */
static void note_cost(const path_walk *walk, double before, float share)
{
    if (walk->pass->trial)
        walk->pass->trial->rays += (plan_rays_of(walk->scratch) - before) * (double)share;
}

void path_look_at_spots(path_walk *walk, const camera_path *path, const surface_hit *hit,
                        const bsdf *b)
{
    float p = path_looks(walk, path, b);
    if (!(p > 0.0f))
        return;
    const light_numbers u = sampler_light(walk->random);
    if (!(u.primitive < p))
        return;
    double before = plan_rays_of(walk->scratch);
    look_aside(walk, path, hit, b, &u, p);
    note_cost(walk, before, importance(path));
}

float path_weight_beside_spots(path_walk *walk, const camera_path *path,
                               const surface_hit *hit, const bsdf *b)
{
    const photon_spots *spots = path->looked > 0.0f ? spots_of(walk, hit->time) : NULL;
    if (!spots || !(path->pdf > 0.0f) || !is_seen_alike(path->by_either, b))
        return 1.0f;
    double before = plan_rays_of(walk->scratch);
    float pdf = density(walk, spots, path->from, path->at.ray.direction, hit->p);
    note_cost(walk, before, 1.0f);
    return followed_weight(path->pdf, pdf * path->looked);
}
