#include "transport/plan/path_trial.h"

#include "transport/plan/work.h"

/* A sample of plain path tracing through a place of the film: mean over wavelengths. */
static double path_sample(const path_pass *pass, vec2 raster, sampler random,
                          transport_scratch *scratch)
{
    radiance_sample out = {.groups = NULL};
    spectrum sum = {0};
    vec2 u_lens = sampler_2d(&random);
    ray r = camera_ray(&pass->plan->view->camera, raster, u_lens, sampler_1d(&random));
    looked_around_forget(&scratch->estimate.looked);
    path_radiance(pass, &r, &random, scratch, &out);
    for (int i = 0; i < N_LAYERS; i++)
        sum += out.layers[i];
    return (double)spectrum_mean(sum);
}

/* The variance of a sample, from pairs of them at random places. */
static double variance_of_pairs(const path_pass *pass, uint64_t key, uint32_t n,
                                transport_scratch *scratch)
{
    const film_settings *film = &pass->plan->view->film;
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

path_effort path_effort_measure(transport_plan *plan)
{
    g_autoptr(GArray) lit = g_array_new(FALSE, FALSE, sizeof *plan->lit);
    transport_scratch scratch = {0};
    const path_pass pass = {.plan = plan,
                            .lit = plan->how.bright_spots ? lit : NULL,
                            .without_caustics = true,
                            .w = scene_trial_wavelengths(plan->scene, 0),
                            .options.deterministic = !plan->how.multiple_samples};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    uint32_t n = plan_trials_for(plan, 1.0, 2.0 * SAMPLE_RAYS, MOST_PLACES);
    path_effort out = {.noise = variance_of_pairs(&pass, key, n, &scratch)};
    double rays = (double)(scratch.camera_rays + scratch.shadow_rays);
    plan->planning += rays;
    out.rays = rays / (2.0 * n);
    out.surfaces = (double)scratch.camera_rays / (2.0 * n);
    transport_scratch_clear(&scratch);
    plan->lit = g_array_steal(lit, &plan->n_lit);
    return out;
}

/* ---- What bright spots are worth ---- */

/* Paths that look from each surface. @return the variance of one. */
static double run_spot_trial(transport_plan *plan, const path_pass *pass,
                             spot_trial *trial, uint32_t n_pairs)
{
    transport_scratch scratch = {0};
    path_pass trying = *pass;
    trying.trial = trial;
    trying.p_spots = 1.0f;
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x73706f7473u);
    double noise = variance_of_pairs(&trying, key, n_pairs, &scratch);
    plan->planning += (double)(scratch.camera_rays + scratch.shadow_rays);
    transport_scratch_clear(&scratch);
    return noise;
}

/* Of two paths that look from each surface, about as long as two that do not. */
static double pair_rays(const transport_plan *plan)
{
    return 2.0 * 2.0 * fmax(plan->sample_rays, 1.0);
}

bool spots_fit(const transport_plan *plan)
{
    return plan_grant(plan, 1.0) >= LEAST_TRIALS * pair_rays(plan);
}

/* What looks take away is added up without the chance of missing it, where the variance
   of paths that do not look would hang on the few that do not. */
void spots_decide(transport_plan *plan, const path_pass *pass)
{
    uint32_t n = plan_trials_for(plan, 1.0, pair_rays(plan), MOST_PLACES);
    spot_trial trial = {0};
    double noise = run_spot_trial(plan, pass, &trial, n), each = 1.0 / (2.0 * n);
    double rest = fmax(noise - trial.with[0] * each, 0.0);
    plan_cost without = {rest + trial.without * each,
                         plan->sample_rays + plan->photon_rays};
    plan_cost best = {rest + trial.with[0] * each, without.rays + trial.rays * each};
    double least = CLEARLY_BETTER * without.variance * without.rays;
    for (int i = 0; i < N_SHARES; i++) {
        double share = plan_share(i);
        plan_cost with = {rest + trial.with[i] * each,
                          without.rays + share * trial.rays * each};
        if (with.variance * with.rays >= least)
            continue;
        least = with.variance * with.rays;
        best = with;
        plan->p_spots = (float)share;
    }
    plan_note(plan, "bright spots", without, best, plan->p_spots > 0.0f);
}
