#include "transport/auto/budget.h"

#include "transport/photonmap/photonmap.h"

enum {
    LEAST_PHOTONS = 20000, /* a pass, however small the picture */
    PHOTONS_PER_SAMPLE = 2,
    MAX_PAIRS = 1024,
    LEAST_PAIRS = 128,
    SAMPLES_PER_PAIR = 256,      /* planned: a measurement is a small part of the work */
    SAMPLES_PER_SPOT_TRIAL = 32, /* of a pass */
    LEAST_SPOT_TRIALS = 32,      /* pairs */
    MAX_SPOT_TRIALS = 256,
};

/* What photons cost in rays of a path: to send one and to sort it into the map; to gather
   at the first surface, where the disc is probed, and at later ones. */
#define COST_PHOTON 1.5
#define COST_FIRST_GATHER 4.0
#define COST_BLURRED_GATHER 2.0
#define COST_LOOK 4.0

/* All this is known within a factor of two or so, and noise that is even disturbs least:
   photons must be better by so much. */
#define CLEARLY_BETTER 0.7

/* Looking aside at bright spots must pay by more: where it does not, paths are left as
   they are. */
#define MUCH_BETTER 0.6

/* No fewer photons than this share of all, if there are any; and no fewer blurred gathers
   than this share. */
#define LEAST_WORTH 0.1

double caustic_planned_samples(const transport_plan *plan)
{
    const film_settings *film = &plan->scene->film;
    return (double)film->width * (double)film->height * (double)plan->how.spp *
           settings_planned_passes(&plan->how);
}

uint64_t caustic_budget(const transport_plan *plan)
{
    const settings *how = &plan->how;
    const film_settings *film = &plan->scene->film;
    int64_t own = how->class_photons[PHOTON_CAUSTIC];
    int64_t samples = (int64_t)film->width * film->height * how->spp;
    int64_t most = MAX(PHOTONS_PER_SAMPLE * samples, LEAST_PHOTONS);
    if (!scene_may_cast_caustics(plan->scene))
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

/* The variance of a sample, from pairs of them at random places. */
static double variance_of_pairs(const path_pass *pass, uint64_t key, uint32_t n,
                                transport_scratch *scratch)
{
    const film_settings *film = &pass->plan->scene->film;
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        sampler random = sampler_make(key, i);
        vec2 u = sampler_2d(&random);
        vec2 raster = {u.x * (float)film->width, u.y * (float)film->height};
        double a = path_sample(pass, raster, sampler_split(&random, 0), scratch);
        double b = path_sample(pass, raster, sampler_split(&random, 1), scratch);
        sum += isfinite(a + b) ? 0.5 * (a - b) * (a - b) : 0.0;
    }
    return sum / n;
}

path_effort path_effort_measure(const transport_plan *plan, photon_store *lit)
{
    transport_scratch scratch = {0};
    const path_pass pass = {.plan = plan,
                            .lit = lit,
                            .without_caustics = true,
                            .w = scene_trial_wavelengths(plan->scene, 0),
                            .options.deterministic = !plan->how.multiple_samples};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    double pairs = caustic_planned_samples(plan) / SAMPLES_PER_PAIR;
    uint32_t n = (uint32_t)CLAMP(pairs, LEAST_PAIRS, MAX_PAIRS);
    path_effort out = {.noise = variance_of_pairs(&pass, key, n, &scratch)};
    out.rays = (double)(scratch.camera_rays + scratch.shadow_rays) / (2.0 * n);
    out.surfaces = (double)scratch.camera_rays / (2.0 * n);
    transport_scratch_clear(&scratch);
    return out;
}

/* ---- What photons are worth ---- */

/* Rays that a camera sample costs more where photons are gathered, however few. */
static double gather_rays(const path_effort *paths)
{
    double later = fmax(paths->surfaces - 1.0, 0.0);
    return fmin(paths->surfaces, 1.0) * COST_FIRST_GATHER + later * COST_BLURRED_GATHER;
}

double caustic_least_noise(const transport_plan *plan, const path_effort *paths)
{
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0 ||
        scene_has_unmet_lights(plan->scene))
        return 0.0;
    return paths->noise * gather_rays(paths) / fmax(paths->rays, 1.0);
}

/* The share of all photons with which variance times work is least; 0: none. */
static double best_share(const transport_plan *plan, const aim_result *found,
                         const path_effort *paths)
{
    double samples = caustic_planned_samples(plan) / settings_planned_passes(&plan->how);
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
    plan->p_blurred = plan->p_blurred_in_media = 1.0f;
    plan->sample_rays = paths->rays + gather_rays(paths);
    if (isinf(found->noise))
        return;
    bool noisier = found->noise > paths->noise;
    double ratio = noisier ? 1.0 : sqrt(found->noise / paths->noise);
    plan->p_blurred = (float)fmax(fmax(ratio, found->unseen), LEAST_WORTH);
    plan->p_blurred_in_media = plan->p_blurred / (float)fmax(paths->surfaces - 1.0, 1.0);
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0)
        return;
    double share = best_share(plan, found, paths);
    if (found->noise + found->unseen > 0.0 && scene_has_unmet_lights(plan->scene))
        share = fmax(share, LEAST_WORTH);
    *n = share > 0.0 ? (uint64_t)MAX(share * (double)*n, 1.0) : 0;
}

/* ---- What bright spots are worth ---- */

/* What scattering finds alone, and what is left where both share by the power heuristic,
   is known for each place that was looked at. */
void spot_trial_note(spot_trial *trial, const spot_look *look)
{
    double p = look->pdf, q = look->pdf_scatter;
    double x2 = look->value * p * look->value * p;
    if (!isfinite(x2) || !(q > 0.0) || !(p > 0.0))
        return;
    trial->without += x2 / q / p;
    for (int i = 0; i < SPOT_SHARES; i++) {
        double looked = p * look->importance * aim_share(i);
        double w = q * q / (q * q + looked * looked);
        trial->with[i] += x2 * (w * w / q + (1.0 - w) * (1.0 - w) / looked) / p;
    }
}

/* Paths that look from each surface. @return the variance of one. */
static double run_spot_trial(const path_pass *pass, uint32_t index, spot_trial *trial,
                             uint32_t n_pairs)
{
    const transport_plan *plan = pass->plan;
    transport_scratch scratch = {0};
    path_pass trying = *pass;
    trying.trial = trial;
    trying.p_spots = 1.0f;
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x73706f7473u);
    double noise = variance_of_pairs(&trying, hash_mix(key, index), n_pairs, &scratch);
    transport_scratch_clear(&scratch);
    return noise;
}

/* What looks take away is added up without the chance of missing it, where the variance
   of paths that do not look would hang on the few that do not. */
float spots_decide(const path_pass *pass, uint32_t index)
{
    const transport_plan *plan = pass->plan;
    double samples = caustic_planned_samples(plan) / settings_planned_passes(&plan->how);
    uint32_t n = (uint32_t)CLAMP(samples / SAMPLES_PER_SPOT_TRIAL / 2.0,
                                 LEAST_SPOT_TRIALS, MAX_SPOT_TRIALS);
    spot_trial trial = {0};
    double noise = run_spot_trial(pass, index, &trial, n), each = 1.0 / (2.0 * n);
    double rest = fmax(noise - trial.with[0] * each, 0.0);
    double least = MUCH_BETTER * (rest + trial.without * each) * plan->sample_rays;
    double best = 0.0;
    for (int i = 0; i < SPOT_SHARES; i++) {
        double share = aim_share(i);
        double work = plan->sample_rays + share * COST_LOOK * trial.looks * each;
        double product = (rest + trial.with[i] * each) * work;
        if (product < least) {
            least = product;
            best = share;
        }
    }
    return (float)best;
}
