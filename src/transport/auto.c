#include "transport/auto.h"

#include "transport/aim.h"
#include "transport/budget.h"
#include "transport/path.h"
#include "transport/photonmap.h"
#include "transport/visible.h"

/* Before radii are known: so many pixels, for the share that trial photons take. */
#define TRIAL_PIXELS 4.0

/* The share of trial photons, as of a pass with a radius of a few pixels. */
static caustic_share trial_share(const transport_plan *plan)
{
    double radius = plan->how.radius;
    if (!(radius > 0.0))
        radius = TRIAL_PIXELS * (double)visible_pixel(plan);
    if (!(radius > 0.0))
        radius = 0.01 * (double)plan->scene->radius;
    return (caustic_share){.scene = plan->scene, .discs = caustic_discs(plan, radius)};
}

/* Sends trial photons, and from what they bring decides how many a pass has. */
static bool plan_photons(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    aim_result found = {.noise = (double)INFINITY};
    const path_effort paths = path_effort_measure(plan);
    const aim_effort effort = {
        .samples = caustic_planned_samples(plan),
        .least_noise = caustic_least_noise(plan, &paths),
    };
    if (!aim_caustics(plan, &effort, &found, cancel, error)) {
        g_free(found.boost);
        return false;
    }
    plan->boost = found.boost;
    plan->share.boost = found.boost;
    caustic_budget_decide(plan, &found, &paths);
    return true;
}

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    plan->n_photons[PHOTON_CAUSTIC] = caustic_budget(plan);
    if (plan->n_photons[PHOTON_CAUSTIC] == 0)
        return true;
    plan->shares = true;
    plan->share = trial_share(plan);
    if (!plan_photons(plan, cancel, error))
        return false;
    return plan->n_photons[PHOTON_CAUSTIC] == 0 ||
           photonmap_choose_radii(plan, cancel, error);
}

static void end_pass(void *data)
{
    path_pass *pass = data;
    if (pass->caustics)
        transport_photonmap.end_pass(pass->caustics);
    transport_path.end_pass(pass);
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    path_pass *pass = transport_path.begin_pass(plan, index, cancel, counts, error);
    if (!pass || plan->n_photons[PHOTON_CAUSTIC] == 0)
        return pass;
    pass->caustics = transport_photonmap.begin_pass(plan, index, cancel, counts, error);
    if (!pass->caustics) {
        end_pass(pass);
        return NULL;
    }
    return pass;
}

static const wavelengths *pass_wavelengths(const void *pass)
{
    return transport_path.pass_wavelengths(pass);
}

const transport_kind transport_auto = {
    .name = "auto",
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = path_radiance,
    .pass_wavelengths = pass_wavelengths,
    .end_pass = end_pass,
};
