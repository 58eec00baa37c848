#include "transport/budget.h"

#include "transport/path.h"

enum {
    LEAST_PHOTONS = 20000, /* a pass, however small the picture */
    PHOTONS_PER_SAMPLE = 2,
    MAX_PAIRS = 1024,
    LEAST_PAIRS = 128,
    SAMPLES_PER_PAIR = 256, /* planned: a measurement is a small part of the work */
};

/* What photons cost in rays of a path: to send one and to sort it into the map; to gather
   at the first surface, where the disc is probed, and at later ones. */
#define COST_PHOTON 1.5
#define COST_FIRST_GATHER 4.0
#define COST_BLURRED_GATHER 2.0

/* All this is known within a factor of two or so, and noise that is even disturbs least:
   photons must be better by so much. */
#define CLEARLY_BETTER 0.7

/* No fewer photons than this share of all, if there are any; and no fewer blurred gathers
   than this share. */
#define LEAST_WORTH 0.1

double caustic_planned_samples(const transport_plan *plan)
{
    const film_settings *film = &plan->scene->film;
    return (double)film->width * (double)film->height * (double)plan->how.spp *
           (double)settings_planned_passes(&plan->how);
}

uint64_t caustic_budget(const transport_plan *plan)
{
    const settings *how = &plan->how;
    const film_settings *film = &plan->scene->film;
    int64_t own = how->class_photons[PHOTON_CAUSTIC];
    int64_t samples = (int64_t)film->width * film->height * how->spp;
    int64_t most = MAX(PHOTONS_PER_SAMPLE * samples, LEAST_PHOTONS);
    if (plan->scene->n_casters == 0)
        return 0;
    return (uint64_t)(own > 0 ? own : MIN(settings_photons(how), most));
}

/* ---- What paths do ---- */

/* A sample of plain path tracing through a place of the film: mean over wavelengths. */
static double path_sample(const path_pass *pass, vec2 raster, sampler random,
                          transport_scratch *scratch)
{
    radiance_sample out = {.groups = NULL};
    spectrum sum = {0};
    vec2 u_lens = sampler_2d(&random);
    ray r = camera_ray(&pass->plan->scene->camera, raster, u_lens, sampler_1d(&random));
    path_radiance(pass, &r, &random, scratch, &out);
    for (int i = 0; i < N_LAYERS; i++)
        sum += out.layers[i];
    return (double)spectrum_mean(sum);
}

/* The noise is that of pairs of samples. */
path_effort path_effort_measure(const transport_plan *plan)
{
    const film_settings *film = &plan->scene->film;
    transport_scratch scratch = {0};
    const path_pass pass = {.plan = plan,
                            .without_caustics = true,
                            .w = wavelengths_at(0.5f),
                            .options.deterministic = !plan->how.multiple_samples};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    double sum = 0.0, pairs = caustic_planned_samples(plan) / SAMPLES_PER_PAIR;
    uint32_t n = (uint32_t)CLAMP(pairs, LEAST_PAIRS, MAX_PAIRS);
    for (uint32_t i = 0; i < n; i++) {
        sampler random = sampler_make(key, i);
        vec2 u = sampler_2d(&random);
        vec2 raster = {u.x * (float)film->width, u.y * (float)film->height};
        double a = path_sample(&pass, raster, sampler_split(&random, 0), &scratch);
        double b = path_sample(&pass, raster, sampler_split(&random, 1), &scratch);
        sum += isfinite(a + b) ? 0.5 * (a - b) * (a - b) : 0.0;
    }
    path_effort out = {
        .noise = sum / n,
        .rays = (double)(scratch.camera_rays + scratch.shadow_rays) / (2.0 * n),
        .surfaces = (double)scratch.camera_rays / (2.0 * n),
    };
    transport_scratch_clear(&scratch);
    return out;
}

/* ---- What photons are worth ---- */

static bool has_unmet_lights(const scene *s)
{
    for (unsigned i = 0; i < s->lights->len; i++) {
        if (scene_light(s, (int)i)->is_unmet)
            return true;
    }
    return false;
}

/* Rays that a camera sample costs more where photons are gathered, however few. */
static double gather_rays(const path_effort *paths)
{
    double later = fmax(paths->surfaces - 1.0, 0.0);
    return fmin(paths->surfaces, 1.0) * COST_FIRST_GATHER + later * COST_BLURRED_GATHER;
}

double caustic_least_noise(const transport_plan *plan, const path_effort *paths)
{
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0 || has_unmet_lights(plan->scene))
        return 0.0;
    return paths->noise * gather_rays(paths) / fmax(paths->rays, 1.0);
}

/* The share of all photons with which variance times work is least; 0: none. */
static double best_share(const transport_plan *plan, const aim_result *found,
                         const path_effort *paths)
{
    double samples =
        caustic_planned_samples(plan) / (double)settings_planned_passes(&plan->how);
    double each = COST_PHOTON * (double)plan->n_photons[PHOTON_CAUSTIC] / samples;
    double by_paths = (paths->noise + found->noise) * paths->rays;
    double least = CLEARLY_BETTER * by_paths, best = 0.0;
    for (int i = 0; i < AIM_SHARES; i++) {
        double share = aim_share(i);
        double work = paths->rays + gather_rays(paths) + share * each;
        double product = (paths->noise + found->left[i]) * work;
        if (product < least) {
            least = product;
            best = share;
        }
    }
    return best;
}

void caustic_budget_decide(transport_plan *plan, const aim_result *found,
                           const path_effort *paths)
{
    uint64_t *n = &plan->n_photons[PHOTON_CAUSTIC];
    plan->p_blurred = 1.0f;
    if (isinf(found->noise))
        return;
    bool noisier = found->noise > paths->noise;
    double ratio = noisier ? 1.0 : sqrt(found->noise / paths->noise);
    plan->p_blurred = (float)fmax(ratio, LEAST_WORTH);
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0)
        return;
    double share = best_share(plan, found, paths);
    if (found->noise > 0.0 && has_unmet_lights(plan->scene))
        share = fmax(share, LEAST_WORTH);
    *n = share > 0.0 ? (uint64_t)MAX(share * (double)*n, 1.0) : 0;
}
