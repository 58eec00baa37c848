#include "transport/work.h"

double plan_rays_of_photons(const transport_counts *counts)
{
    double rays = (double)counts->photon_rays;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        rays += (double)counts->emitted[c];
    return rays;
}

double plan_rays_of_search(const transport_scratch *scratch)
{
    const estimate_scratch *maps = &scratch->estimate;
    return (double)(scratch->camera_rays + scratch->shadow_rays) +
           (double)maps->n_queries + LOOK_RAYS * (double)maps->n_looks;
}

double plan_rays_of_weighed(double n)
{
    return 0.5 * LOOK_RAYS * n / N_WAVELENGTHS;
}

double plan_rays_of(const transport_scratch *scratch)
{
    return plan_rays_of_search(scratch) +
           plan_rays_of_weighed((double)scratch->estimate.n_weighed);
}

void plan_note_photons(transport_plan *plan, double n, double rays)
{
    plan->planning += rays;
    plan->n_tried += n;
    plan->tried_rays += rays + n;
}

double plan_photon_rays(const transport_plan *plan)
{
    return plan->n_tried > 0.0 ? plan->tried_rays / plan->n_tried : PHOTON_RAYS;
}

double plan_samples(const transport_plan *plan)
{
    const film_settings *film = &plan->view->film;
    return (double)film->width * (double)film->height * (double)plan->how.spp *
           settings_planned_passes(&plan->how);
}

void plan_ask(transport_plan *plan, double n_photons)
{
    plan->work = SAMPLE_RAYS * plan_samples(plan) +
                 PHOTON_RAYS * n_photons * settings_planned_passes(&plan->how);
}

double plan_grant(const transport_plan *plan, double shares)
{
    return shares * TRIAL_SHARE * plan->work;
}

uint32_t plan_trials_for(const transport_plan *plan, double shares, double rays_each,
                         uint32_t most)
{
    double n = plan_grant(plan, shares) / rays_each;
    return (uint32_t)CLAMP(n, (double)LEAST_TRIALS, shares * (double)most);
}

bool plan_takes_noise_out(const transport_plan *plan)
{
    return settings_takes_noise_out(&plan->how, settings_planned_passes(&plan->how));
}

double plan_weight_alike(const transport_plan *plan)
{
    return plan_takes_noise_out(plan) ? BLOTCHES : 1.0;
}

bool plan_is_tiny(const transport_plan *plan)
{
    return plan_grant(plan, 1.0) < LEAST_TRIALS * 2.0 * SAMPLE_RAYS;
}

void plan_note(transport_plan *plan, const char *what, plan_cost without, plan_cost with,
               bool taken)
{
    if (plan->n_trials < MOST_PLAN_TRIALS)
        plan->trials[plan->n_trials++] = (plan_trial){what, without, with, taken};
}
