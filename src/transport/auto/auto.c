#include "transport/auto/auto.h"

#include "transport/auto/aim.h"
#include "transport/auto/budget.h"
#include "transport/path/path.h"
#include "transport/photonmap/photonmap.h"
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

enum {
    MOST_LIT = 8192, /* places */
    /* Pictures of so few samples are done before it is known where to look. */
    LEAST_SAMPLES = 1 << 15,
};

/* Sends trial photons, and from what they bring decides how many a pass has. */
static bool plan_photons(transport_plan *plan, const path_effort *paths,
                         const cancel_flag *cancel, GError **error)
{
    aim_result found = {.noise = (double)INFINITY};
    const aim_effort effort = {
        .samples = caustic_planned_samples(plan),
        .least_noise = caustic_least_noise(plan, paths),
    };
    if (!aim_caustics(plan, &effort, &found, cancel, error)) {
        g_free(found.boost);
        return false;
    }
    plan->boost = found.boost;
    plan->share.boost = found.boost;
    caustic_budget_decide(plan, &found, paths);
    return true;
}

/* Spots of the places that light sampling found lit and of the pass' photons. */
static bool find_spots(path_pass *pass, GError **error)
{
    const photonmap_pass *photons = pass->caustics;
    float radius = photons ? photons->estimates[PHOTON_CAUSTIC].radius : 0.0f;
    GError *failed = NULL;
    pass->n_slices = photons ? photons->n_slices : 1;
    for (int i = 0; i < pass->n_slices && !failed; i++) {
        const spot_source sources[] = {
            {.places =
                 photons ? photon_map_store(photons->maps[i][PHOTON_CAUSTIC]) : NULL,
             .least = isfinite(radius) ? radius : 0.0f},
            {.places = pass->plan->lit.n > 0 ? &pass->plan->lit : NULL},
        };
        pass->spots[i] = photon_spots_new(sources, G_N_ELEMENTS(sources), &failed);
    }
    if (failed)
        g_propagate_error(error, failed);
    return !failed;
}

static void free_spots(path_pass *pass)
{
    for (int i = 0; i < pass->n_slices; i++)
        photon_spots_free(pass->spots[i]);
}

/* Without photons, spots are the same in all passes. */
static bool plan_spots(transport_plan *plan, const path_effort *paths, GError **error)
{
    path_pass *pass = transport_path.begin_pass(plan, 0, NULL, NULL, NULL);
    plan->sample_rays = paths->rays;
    bool found = plan->lit.n == 0 || find_spots(pass, error);
    plan->p_spots = found && plan->lit.n > 0 ? spots_decide(pass, 0) : 0.0f;
    free_spots(pass);
    transport_path.end_pass(pass);
    return found;
}

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    bool many = plan->how.bright_spots && caustic_planned_samples(plan) >= LEAST_SAMPLES;
    plan->n_photons[PHOTON_CAUSTIC] = caustic_budget(plan);
    if (plan->n_photons[PHOTON_CAUSTIC] == 0 && !many)
        return true;
    plan->lit.oriented = true;
    if (many && !photon_store_reserve(&plan->lit, MOST_LIT, error))
        return false;
    path_effort paths = path_effort_measure(plan, many ? &plan->lit : NULL);
    if (plan->n_photons[PHOTON_CAUSTIC] > 0) {
        plan->shares = true;
        plan->share = trial_share(plan);
        if (!plan_photons(plan, &paths, cancel, error))
            return false;
    }
    return plan->n_photons[PHOTON_CAUSTIC] == 0
               ? plan_spots(plan, &paths, error)
               : photonmap_choose_radii(plan, cancel, error);
}

static void end_pass(void *data)
{
    path_pass *pass = data;
    if (pass->caustics)
        transport_photonmap.end_pass(pass->caustics);
    free_spots(pass);
    transport_path.end_pass(pass);
}

/* Traces the pass' photons, and asks them where to look. */
static bool send_photons(path_pass *pass, uint32_t index, const cancel_flag *cancel,
                         transport_counts *counts, GError **error)
{
    const transport_plan *plan = pass->plan;
    pass->caustics = transport_photonmap.begin_pass(plan, index, cancel, counts, error);
    if (!pass->caustics || (plan->how.bright_spots && !find_spots(pass, error)))
        return false;
    if (plan->how.bright_spots)
        pass->p_spots = spots_decide(pass, index);
    return true;
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    path_pass *pass = transport_path.begin_pass(plan, index, cancel, counts, error);
    bool ok = true;
    if (plan->n_photons[PHOTON_CAUSTIC] > 0)
        ok = send_photons(pass, index, cancel, counts, error);
    else if (plan->p_spots > 0.0f)
        ok = find_spots(pass, error);
    if (ok && plan->n_photons[PHOTON_CAUSTIC] == 0)
        pass->p_spots = plan->p_spots;
    if (ok)
        return pass;
    end_pass(pass);
    return NULL;
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
    .photons = &photonmap_photons,
};
