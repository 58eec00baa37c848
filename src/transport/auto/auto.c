#include "transport/auto/auto.h"

#include "transport/path/path.h"
#include "transport/photonmap/photonmap.h"
#include "transport/plan/caustics.h"
#include "transport/plan/gather.h"
#include "transport/visible.h"
#include "transport/work.h"

/* The share of trial photons, as of a pass with a radius of a few pixels. */
static caustic_mis trial_mis(transport_plan *plan)
{
    double own = plan->how.radius, radius = own > 0.0 ? own : sharp_radius(plan);
    return (caustic_mis){.casters = plan->casters, .discs = caustic_discs(plan, radius)};
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
            {.photons =
                 photons ? photon_map_store(photons->maps[i][PHOTON_CAUSTIC]) : NULL,
             .least = isfinite(radius) ? radius : 0.0f},
            {.places = pass->plan->lit, .n_places = pass->plan->n_lit},
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

static void end_pass(void *data)
{
    path_pass *pass = data;
    if (pass->caustics)
        transport_photonmap.end_pass(pass->caustics);
    free_spots(pass);
    transport_path.end_pass(pass);
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    path_pass *pass = transport_path.begin_pass(plan, index, cancel, counts, error);
    bool ok = true;
    if (plan->gathers || plan->n_photons[PHOTON_CAUSTIC] > 0) {
        pass->caustics =
            transport_photonmap.begin_pass(plan, index, cancel, counts, error);
        ok = pass->caustics;
    }
    pass->p_spots = plan->p_spots;
    if (ok && plan->p_spots > 0.0f)
        ok = find_spots(pass, error);
    if (ok)
        return pass;
    end_pass(pass);
    return NULL;
}

/* ---- Planning ---- */

/* What paths do, and with which photons and how many they are helped best. */
static bool try_photons(transport_plan *plan, path_effort *paths,
                        const cancel_flag *cancel, GError **error)
{
    aim_result found = {0};
    if (!path_effort_measure(plan, cancel, paths, error))
        return false;
    plan->sample_rays = paths->rays;
    if (!aim_caustics(plan, &found, cancel, error)) {
        g_free(found.boost);
        return false;
    }
    plan->boost = found.boost;
    plan->mis.boost = found.boost;
    if (!path_effort_weigh(plan, paths, error))
        return false;
    if (plan->n_photons[PHOTON_CAUSTIC] > 0)
        caustics_decide(plan, &found, paths);
    plan->path_noise = paths->noise;
    if (plan->n_photons[PHOTON_CAUSTIC] == 0)
        plan->path_noise += paths->bounced + found.noise;
    return true;
}

/* A pass with few photons, whose radii are as much larger. */
static transport_plan small_pass(const transport_plan *plan)
{
    transport_plan small = *plan;
    uint64_t *n = &small.n_photons[PHOTON_CAUSTIC];
    small.how.seed = (int64_t)(hash_mix((uint64_t)plan->how.seed, 0x736d616c6cu) >> 1);
    *n = MIN(*n, plan_trials_for(plan, 0.5, plan_photon_rays(plan), MOST_PILOTS));
    double fewer = (double)plan->n_photons[PHOTON_CAUSTIC] / (double)MAX(*n, 1);
    small.radius[PHOTON_CAUSTIC] *= sqrt(fewer);
    small.radius_in_media[PHOTON_CAUSTIC] *= cbrt(fewer);
    small.radius_cache[PHOTON_CAUSTIC] = NULL;
    small.radius_cache_in_media[PHOTON_CAUSTIC] = NULL;
    return small;
}

/* Whether there may be bright spots to look at, and it can be known what they are worth.
 */
static bool may_look(const transport_plan *plan)
{
    bool sends = plan->n_photons[PHOTON_CAUSTIC] > 0;
    return plan->how.bright_spots && spots_fit(plan) && (sends || plan->n_lit > 0);
}

/* With a small pass as it would be: whether and how often paths look at bright spots, and
   whether photons had better carry indirect light altogether. */
static bool try_pass(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    transport_plan small = small_pass(plan);
    transport_counts counts = {0};
    small.p_spots = may_look(plan) ? 1.0f : 0.0f;
    path_pass *pass = begin_pass(&small, 0, cancel, &counts, error);
    if (!pass)
        return false;
    plan_note_photons(plan, (double)counts.emitted[PHOTON_CAUSTIC],
                      (double)counts.photon_rays);
    pass->p_spots = 0.0f;
    bool ok = plan->n_photons[PHOTON_CAUSTIC] == 0 ||
              path_noise_measure(plan, pass, cancel, error);
    ok = ok && (small.p_spots == 0.0f || spots_decide(plan, pass, cancel, error));
    pass->p_spots = plan->p_spots;
    ok = ok && gather_decide(plan, pass, cancel, error);
    end_pass(pass);
    return ok;
}

/* Photons a pass that somebody wants, whatever the plan would send: work that was asked
   for, as far as a trial of half a share can use it. */
static double photons_wanted(const settings *how)
{
    int64_t own = how->class_photons[PHOTON_CAUSTIC];
    return (double)MIN(own > 0 ? own : MAX(how->photons, 0), MOST_PILOTS / 2);
}

/* In this order, since each trial asks what those before it have decided. */
static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    g_auto(path_effort) paths = {0};
    if (!transport_plan_find_casters(plan, error))
        return false;
    plan_ask(plan, photons_wanted(&plan->how));
    plan->n_photons[PHOTON_CAUSTIC] = caustics_most(plan);
    plan->uses_mis = plan->n_photons[PHOTON_CAUSTIC] > 0;
    if (plan_is_tiny(plan))
        caustics_settle(plan);
    if (plan->uses_mis)
        plan->mis = trial_mis(plan);
    if (!plan_is_tiny(plan) && !try_photons(plan, &paths, cancel, error))
        return false;
    if (plan->n_photons[PHOTON_CAUSTIC] > 0 &&
        !photonmap_choose_radii(plan, cancel, error))
        return false;
    return plan_is_tiny(plan) || try_pass(plan, cancel, error);
}

static void auto_radiance(const void *data, const ray *r, sampler *random,
                          transport_scratch *scratch, radiance_sample *out)
{
    const path_pass *pass = data;
    if (pass->plan->gathers)
        photonmap_radiance(pass->caustics, r, random, scratch, out);
    else
        path_radiance(pass, r, random, scratch, out);
}

static const wavelengths *pass_wavelengths(const void *pass)
{
    return transport_path.pass_wavelengths(pass);
}

const transport_kind transport_auto = {
    .name = "auto",
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = auto_radiance,
    .pass_wavelengths = pass_wavelengths,
    .end_pass = end_pass,
    .photons = &photonmap_photons,
};
