#include "render/plan.h"

#include "transport/photonmap/photonmap.h"

transport_plan render_first_plan(const transport_plan *plan)
{
    transport_plan first = *plan;
    if (plan->how.first_spp == 0 || plan->how.first_spp >= plan->how.spp)
        return first;
    double share = (double)plan->how.first_spp / (double)plan->how.spp;
    first.how.spp = plan->how.first_spp;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        if (plan->n_photons[c] > 0)
            first.n_photons[c] = MAX((uint64_t)((double)plan->n_photons[c] * share), 1);
    return first;
}

render_plan render_plan_of(const transport_plan *plan)
{
    render_plan out = {
        .integrator = (integrator_choice)plan->how.integrator,
        .radius_is_set = plan->how.radius > 0.0,
        .p_spots = (double)plan->p_spots,
        .p_blurred = plan->uses_mis ? (double)plan->p_blurred : 1.0,
        .time_slices = time_slices_of(plan->scene, &plan->how),
        .work = plan->work,
        .planning = plan->planning,
        .n_trials = plan->n_trials,
    };
    if (plan->uses_mis && plan->n_photons[PHOTON_CAUSTIC] > 0)
        out.discs = (double)caustic_discs(plan, plan->radius[PHOTON_CAUSTIC]);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        out.photons[c] = plan->n_photons[c];
        out.guided[c] = plan->n_photons[c] > 0 && plan->guide[c];
        out.radius[c] = plan->n_photons[c] > 0 ? plan->radius[c] : 0.0;
    }
    for (int i = 0; i < plan->n_trials; i++)
        out.trials[i] = plan->trials[i];
    return out;
}

char *render_plan_digest(const render_plan *plan)
{
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "%d %d %d", (int)plan->integrator, plan->radius_is_set,
                           plan->time_slices);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_string_append_printf(out, " %" G_GUINT64_FORMAT " %a %d", plan->photons[c],
                               plan->radius[c], plan->guided[c]);
    g_string_append_printf(out, " %a %a %a %a", plan->discs, plan->p_spots,
                           plan->p_blurred, plan->work);
    for (int i = 0; i < plan->n_trials; i++)
        g_string_append_printf(out, " %a %a %d", plan->trials[i].without.variance,
                               plan->trials[i].with.variance, plan->trials[i].taken);
    return g_string_free(out, FALSE);
}
