/*
 * The camera path of photon mapping: Whitted recursion over the lobes that can be
 * followed (specular and glossy), and at each surface what the maps and the lights have
 * to say about the others (Whitted 1980; Jensen 2001, §8).
 *
 * Both sides of glass are followed until roulette begins, later one of them by chance. A
 * light met after a glossy bounce is shared with light sampling by multiple importance
 * sampling.
 */
#include "transport/direct.h"
#include "transport/photonmap/photonmap_medium.h"

/* Shared by all branches of one camera ray. */
typedef struct camera_tree {
    const photonmap_pass *pass;
    sampler *random;
    transport_scratch *scratch;
    radiance_sample *out;
    uint32_t n_branches;
    vec3 eye; /* where the camera ray began */
} camera_tree;

/* One branch: a ray, and what its radiance counts in the pixel. */
typedef struct camera_branch {
    path_segment at;
    unsigned n_followed;
    float eta2; /* product of squared relative indices: takes refraction's scale out of
                   roulette */
    float glossy_pdf; /* pdf_solid_angle of a glossy direction; 0: specular or from the
                         camera */
    vec3 from;        /* the point the ray left; what it went straight through apart */
    bool guided;      /* it has met what the denoiser is guided by */
} camera_branch;

/* A branch on its way to the next surface. */
typedef struct branch_step {
    camera_tree *tree;
    camera_branch *branch;
} branch_step;

/* How many times the branch may still scatter, the gathering of photons counted;
   negative: as often as it likes. */
static int64_t events_left(const camera_tree *tree, const camera_branch *branch)
{
    int64_t limit = tree->pass->how->max_backward_bounces;
    return limit < 0 ? limit : MAX(limit - branch->n_followed, 0);
}

static bool add(camera_tree *tree, const camera_branch *branch, radiance_layer layer,
                spectrum radiance)
{
    spectrum value = branch->at.throughput * radiance;
    if (!spectrum_is_finite(value)) {
        tree->scratch->n_not_finite++;
        return false;
    }
    bool apart = tree->pass->caustics_apart && layer == LAYER_CAUSTIC;
    tree->out->layers[branch->n_followed && !apart ? LAYER_SPECULAR : layer] += value;
    return true;
}

/* Adds what came from one light. */
static void add_from(camera_tree *tree, const camera_branch *branch, radiance_layer layer,
                     spectrum radiance, int source)
{
    if (add(tree, branch, layer, radiance) && tree->out->groups)
        tree->out->groups[scene_light_group(tree->pass->scene, source)] +=
            branch->at.throughput * radiance;
}

/* Adds what came from many, in parts by their groups. */
static void add_parts(camera_tree *tree, const camera_branch *branch,
                      radiance_layer layer, spectrum radiance, const spectrum *parts)
{
    if (!add(tree, branch, layer, radiance) || !tree->out->groups)
        return;
    for (int i = 0; i < tree->pass->scene->n_light_groups; i++)
        tree->out->groups[i] += branch->at.throughput * parts[i];
}

static void meet_light(void *data, const met_light *met)
{
    const branch_step *step = data;
    const camera_branch *branch = step->branch;
    const photonmap_pass *pass = step->tree->pass;
    const scattered_from from = {branch->from, branch->glossy_pdf, true};
    float weight =
        direct_met_weight(pass->scene, pass->how, &from, branch->at.ray.direction, met);
    add_from(step->tree, branch, LAYER_EMISSION, met->radiance * weight, met->light);
    radiance_sample_light(step->tree->out, &branch->at, met->radiance * weight);
}

static void meet_surface(void *data, const surface_hit *hit)
{
    const branch_step *step = data;
    const photonmap_pass *pass = step->tree->pass;
    direct_meet(pass->scene, &pass->w, &step->branch->at.ray, hit, meet_light, data);
}

/* The probability that each side of the followed lobes is followed. */
static void plan_sides(const camera_tree *tree, const camera_branch *branch,
                       const bsdf *b, float p[2])
{
    const vec3 wo = -branch->at.ray.direction;
    bool split = branch->n_followed + 1 < ROULETTE_BOUNCES;
    bool both = (b->lobes & LOBE_ANY_SIDE) == LOBE_ANY_SIDE;
    p[0] = (b->lobes & LOBE_REFLECTION) ? 1.0f : 0.0f;
    p[1] = (b->lobes & LOBE_TRANSMISSION) ? 1.0f : 0.0f;
    if (split || !both)
        return;
    const unsigned classes = tree->pass->followed & ~(unsigned)LOBE_ANY_SIDE;
    float reflected = spectrum_mean(bsdf_albedo(b, wo, classes | LOBE_REFLECTION));
    float transmitted = spectrum_mean(bsdf_albedo(b, wo, classes | LOBE_TRANSMISSION));
    p[0] = reflected + transmitted > 0.0f ? reflected / (reflected + transmitted) : 0.5f;
    p[0] = clampf(p[0], DEFENSIVE_SHARE, 1.0f - DEFENSIVE_SHARE);
    p[1] = 1.0f - p[0];
}

static void meet_environment(void *data, const met_light *met)
{
    const branch_step *step = data;
    add_from(step->tree, step->branch, LAYER_DIRECT, met->radiance, met->light);
}

static void shade_direct(camera_tree *tree, camera_branch *branch, const surface_hit *hit,
                         const bsdf *b, const float p_follow[2])
{
    const photonmap_pass *pass = tree->pass;
    if (!(b->lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)))
        return;
    const direct_query query = {
        .scene = pass->scene,
        .w = &pass->w,
        .hit = hit,
        .bsdf = b,
        .wo = -branch->at.ray.direction,
        .every_light = true,
        .shadow_rays = pass->how->shadow_rays,
        .options = &pass->options,
        .most_panes = pass->how->max_forward_bounces,
        .followed = pass->followed,
        .looked = LOBE_DIFFUSE & ~pass->followed,
        .by_side = true,
        .p_side = {p_follow[0], p_follow[1]},
    };
    direct_radiance found[FEW_LIGHTS];
    int n = direct_light(&query, tree->random, found, &tree->scratch->shadow_rays);
    for (int i = 0; i < n; i++) {
        add_from(tree, branch, LAYER_DIRECT, found[i].diffuse, found[i].light);
        add_from(tree, branch, LAYER_SPECULAR, found[i].glossy, found[i].light);
    }
    branch_step step = {tree, branch};
    direct_environments(&query, tree->random, meet_environment, &step,
                        &tree->scratch->shadow_rays);
}

/* What the photons of one class give at a point. */
static void add_gathered(camera_tree *tree, const camera_branch *branch,
                         radiance_layer layer, photon_class c, const shading_point *at,
                         unsigned delta)
{
    spectrum radiance = photonmap_gather(tree->pass, c, at, delta, tree->scratch);
    add_parts(tree, branch, layer, radiance, tree->scratch->estimate.groups);
}

/* delta: lobes by which photons from delta lights count too. */
static void shade_indirect(camera_tree *tree, const camera_branch *branch,
                           const shading_point *at, unsigned delta)
{
    const photonmap_pass *pass = tree->pass;
    if (!has_lobes(at->bsdf, pass->gathered | delta))
        return;
    float importance = spectrum_mean(branch->at.throughput) * branch->eta2;
    int64_t left = events_left(tree, branch);
    if (!pass->how->final_gather || left == 1) { /* the last is to gather here */
        add_gathered(tree, branch, LAYER_INDIRECT, PHOTON_INDIRECT, at, delta);
        return;
    }
    spectrum radiance = final_gather(pass, at, importance, left < 0 ? left : left - 1,
                                     tree->random, tree->scratch);
    add_parts(tree, branch, LAYER_INDIRECT, radiance, tree->scratch->gathered);
}

/* Everything that ends at this surface: direct, caustic and indirect light. */
static void shade(camera_tree *tree, camera_branch *branch, const surface_hit *hit,
                  const bsdf *b, const float p_follow[2])
{
    const photonmap_pass *pass = tree->pass;
    const shading_point at = {
        .hit = hit, .bsdf = b, .wo = -branch->at.ray.direction, .in_pixel = true};
    bool needs_glossy = pass->how->photon_lobes == PHOTON_LOBES_NEEDED;
    unsigned delta = needs_glossy && pass->has_delta_lights ? LOBE_GLOSSY : 0;
    bool gathers = has_lobes(b, pass->gathered | delta);
    if (pass->how->direct_illumination)
        shade_direct(tree, branch, hit, b, p_follow);
    else if (gathers)
        add_gathered(tree, branch, LAYER_DIRECT, PHOTON_DIRECT, &at, delta);
    if (gathers)
        add_gathered(tree, branch, LAYER_CAUSTIC, PHOTON_CAUSTIC, &at, delta);
    shade_indirect(tree, branch, &at, settings_one_map(pass->how) ? delta : 0);
}

/* What light that is scattered in the medium sends along the branch's ray; what comes
   from behind it is multiplied by its transmittance. */
static scene_event shade_medium(void *data, float length, const surface_hit *behind,
                                surface_hit *at)
{
    (void)behind;
    (void)at;
    const branch_step *step = data;
    camera_tree *tree = step->tree;
    camera_branch *branch = step->branch;
    const photonmap_pass *pass = tree->pass;
    const medium *m = scene_medium(pass->scene, branch->at.ray.media.participating);
    camera_branch seen = *branch; /* by way of it */
    seen.n_followed++;
    const bool samples_lights = pass->how->direct_illumination;
    static const radiance_layer layers[N_PHOTON_CLASSES] = {LAYER_DIRECT, LAYER_INDIRECT,
                                                            LAYER_CAUSTIC};
    const medium_look look = {&branch->at.ray, length, branch->at.throughput,
                              branch->at.wavelength, true};
    const spectrum *parts = tree->scratch->estimate.groups;
    const bool scatters = events_left(tree, branch) != 0;
    if (scatters && samples_lights) {
        spectrum direct =
            photonmap_direct_in_medium(pass, &look, tree->random, tree->scratch);
        add_parts(tree, &seen, LAYER_DIRECT, direct, parts);
        tree->out->scattered += seen.at.throughput * direct;
    }
    for (int c = samples_lights ? PHOTON_INDIRECT : PHOTON_DIRECT;
         scatters && c < N_PHOTON_CLASSES; c++) {
        spectrum radiance = photonmap_gather_medium(
            pass, (photon_class)c, &branch->at.ray, length, tree->scratch);
        add_parts(tree, &seen, layers[c], radiance, parts);
    }
    branch->at.throughput *= medium_transmittance(m, length, &pass->w);
    return EVENT_NONE;
}

/* Turns the branch into what follows by a lobe on the given sides. */
static bool bounce(camera_tree *tree, camera_branch *branch, const surface_hit *hit,
                   const bsdf *b, unsigned sides, float probability)
{
    float u_lobe = sampler_1d(tree->random);
    vec2 u = sampler_2d(tree->random);
    bsdf_sample next;
    unsigned lobes = (tree->pass->followed & ~(unsigned)LOBE_ANY_SIDE) | sides;
    vec3 wo = -branch->at.ray.direction;
    if (!bsdf_sample_direction(b, wo, u_lobe, u, lobes, TRANSPORT_RADIANCE, &next))
        return false;
    path_segment_leave(&branch->at, hit, &next, probability);
    branch->eta2 *= next.eta * next.eta;
    if (!next.straight) {
        branch->glossy_pdf = (next.lobe & LOBE_GLOSSY) ? next.pdf * probability : 0.0f;
        branch->from = hit->p;
    }
    branch->n_followed++;
    return !spectrum_is_black(branch->at.throughput);
}

static bool survives(camera_tree *tree, camera_branch *branch)
{
    if (branch->n_followed < ROULETTE_BOUNCES)
        return true;
    float p = minf(most_survival(branch->n_followed),
                   spectrum_mean(branch->at.throughput) * branch->eta2);
    if (!(sampler_1d(tree->random) < p))
        return false;
    branch->at.throughput /= p;
    branch->at.certain = false;
    return true;
}

static void follow(camera_tree *tree, camera_branch branch);

/* Goes on by the lobes that can be followed. @return false if there is nothing to follow.
 */
static bool go_on(camera_tree *tree, camera_branch *branch, const surface_hit *hit,
                  const bsdf *b, const float p_follow[2])
{
    if (!has_lobes(b, tree->pass->followed) || !survives(tree, branch))
        return false;
    if (p_follow[0] >= 1.0f && p_follow[1] >= 1.0f) {
        camera_branch reflected = *branch;
        sampler *outer = tree->random, own = sampler_split(outer, tree->n_branches++);
        tree->random = &own;
        if (bounce(tree, &reflected, hit, b, LOBE_REFLECTION, 1.0f))
            follow(tree, reflected);
        tree->random = outer;
        return bounce(tree, branch, hit, b, LOBE_TRANSMISSION, 1.0f);
    }
    bool reflect = p_follow[0] >= 1.0f || sampler_1d(tree->random) < p_follow[0];
    return bounce(tree, branch, hit, b, reflect ? LOBE_REFLECTION : LOBE_TRANSMISSION,
                  p_follow[reflect ? 0 : 1]);
}

static void follow(camera_tree *tree, camera_branch branch)
{
    const photonmap_pass *pass = tree->pass;
    branch_step step = {tree, &branch};
    const scene_traveller who = {.scene = pass->scene,
                                 .w = &pass->w,
                                 .n_rays = &tree->scratch->camera_rays,
                                 .path = &step,
                                 .cross_medium = shade_medium,
                                 .meet_light = meet_surface};
    surface_hit hit;
    while (!cancelled(pass->plan->cancel)) {
        bsdf b;
        float p_follow[2];
        if (scene_advance(&who, &branch.at, &hit) == EVENT_ESCAPE) {
            meet_surface(&step, NULL);
            return;
        }
        scene_bsdf(pass->scene, &hit, &pass->w, branch.at.wavelength, &pass->options, &b);
        if (branch.at.eye)
            radiance_sample_note(tree->out, &hit, &b, -branch.at.ray.direction,
                                 branch.from);
        branch.guided =
            branch.guided ||
            radiance_sample_guide(tree->out, &hit, &b, -branch.at.ray.direction,
                                  tree->eye, spectrum_mean(branch.at.throughput));
        if (events_left(tree, &branch) == 0)
            return;
        plan_sides(tree, &branch, &b, p_follow);
        shade(tree, &branch, &hit, &b, p_follow);
        if (!go_on(tree, &branch, &hit, &b, p_follow))
            return;
    }
}

void photonmap_radiance(const void *pass, const ray *r, sampler *random,
                        transport_scratch *scratch, radiance_sample *out)
{
    const photonmap_pass *from = pass;
    *out = (radiance_sample){.groups = out->groups};
    camera_tree tree = {
        .pass = pass, .random = random, .scratch = scratch, .out = out, .eye = r->origin};
    follow(&tree, (camera_branch){
                      .at = path_segment_from_eye(from->plan->view, r),
                      .eta2 = 1.0f,
                      .from = r->origin,
                  });
}
