#include "transport/plan/gather.h"

#include "transport/photonmap/aim.h"
#include "transport/plan/gather_costs.h"
#include "transport/visible.h"
#include "transport/work.h"

/* ---- The plan that it would be ---- */

/* Bounds on bounces bound different paths where photons meet the eye's. */
static bool may_gather(const transport_plan *plan)
{
    const settings *how = &plan->how;
    return how->gather_indirect && how->direct_illumination &&
           how->max_backward_bounces < 0 && how->max_forward_bounces < 0 &&
           scene_is_lit(plan->scene) && gather_trial_granted(plan);
}

/* Photons as of photon mapping, but all of them together take no longer than the camera,
   unless the caustics alone have more without gathering: of those there are no fewer.
   By what indirect ones take, not twice SAMPLE_RAYS each, what is shown has .8 of the
   squared error through two windows, where few land, and 1.01 in eleven rooms (256 x 256,
   2 s, three seeds). With twice as many there were fewer passes of the camera's noise:
   shown errors at equal time are 1.11 of that in five fogs (128 x 128, .5 to 2 s), 1.01
   in eleven rooms (256 x 256, .7 and 2 s); as rendered .74 and .90. By what trials say of
   both kinds of noise and their costs, the number that would be best as rendered is .6
   to 1.5 of this in six rooms, .2 to 1.9 in six fogs. */
static void set_photons(const transport_plan *plan, transport_plan *to)
{
    double passes = settings_planned_passes(&plan->how);
    double rays = plan->sample_rays * plan_samples(plan) / passes;
    double each = plan->price[PHOTON_INDIRECT];
    to->how.photons = MIN(settings_photons(&plan->how), (int64_t)(rays / each));
    photonmap_share_photons(to);
    uint64_t *caustic = &to->n_photons[PHOTON_CAUSTIC];
    *caustic = MAX(*caustic, plan->n_photons[PHOTON_CAUSTIC]);
}

/* What auto does not read is as usual. */
static void set_usual(settings *how)
{
    const settings usual = settings_default();
    const int c = PHOTON_INDIRECT;
    how->final_gather = usual.final_gather;
    how->class_photons[c] = usual.class_photons[c];
    how->class_nearest[c] = usual.class_nearest[c];
    how->class_kernel[c] = usual.class_kernel[c];
    how->class_cone_k[c] = usual.class_cone_k[c];
}

/* The plan that it would be; what it shares with the one that is stays that one's. */
static bool plan_to_gather(transport_plan *plan, transport_plan *out,
                           const cancel_flag *cancel, GError **error)
{
    plan_look(plan);
    if (!aim_photons(plan, PHOTON_INDIRECT, cancel, error))
        return false;
    *out = *plan;
    set_usual(&out->how);
    out->uses_mis = false;
    out->p_spots = 0.0f;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        out->radius_cache[c] = out->radius_cache_in_media[c] = NULL;
        out->radius[c] = out->radius_in_media[c] = 0.0;
    }
    set_photons(plan, out);
    return photonmap_choose_radii(out, cancel, error);
}

/* ---- Deciding ---- */

static void free_radii(transport_plan *plan)
{
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_clear_pointer(&plan->radius_cache[c], radius_cache_free);
        g_clear_pointer(&plan->radius_cache_in_media[c], radius_cache_free);
    }
}

static void take(transport_plan *plan, gather_trial *t)
{
    double per_sample = settings_planned_passes(&plan->how) / plan_samples(plan);
    transport_plan *from = &t->plan;
    free_radii(plan);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        plan->n_photons[c] = from->n_photons[c];
        plan->radius[c] = from->radius[c];
        plan->radius_in_media[c] = from->radius_in_media[c];
        plan->radius_cache[c] = g_steal_pointer(&from->radius_cache[c]);
        plan->radius_cache_in_media[c] = g_steal_pointer(&from->radius_cache_in_media[c]);
    }
    set_usual(&plan->how);
    plan->uses_mis = false;
    plan->p_spots = 0.0f;
    plan->gathers = true;
    plan->sample_rays = gather_trial_sample_rays(t);
    plan->photon_rays = t->photon_rays * per_sample;
}

/* What maps must beat: of noise that stays paths' is even and disturbs least; where it is
   taken out, that is in the costs, unless there is no time for it. */
static double least_of_paths(const transport_plan *plan, plan_cost paths, bool fit)
{
    double least = fit && plan_takes_noise_out(plan) ? 1.0 : CLEARLY_BETTER;
    return least * paths.variance * paths.rays;
}

/* The trial of a plan to gather. */
static bool compare(transport_plan *plan, const path_pass *paths, gather_trial *t,
                    const cancel_flag *cancel, GError **error)
{
    if (!plan_to_gather(plan, &t->plan, cancel, error) ||
        !gather_trial_run(t, plan, paths, cancel, error))
        return false;
    plan_cost without, with;
    bool fit = gather_costs(plan, t, &without, &with);
    bool pays = with.variance * with.rays < least_of_paths(plan, without, fit);
    plan_note(plan, "gathered indirect light", without, with, pays);
    if (pays)
        take(plan, t);
    return true;
}

bool gather_decide(transport_plan *plan, const path_pass *paths,
                   const cancel_flag *cancel, GError **error)
{
    if (!may_gather(plan))
        return true;
    gather_trial *t = g_aligned_alloc0(1, sizeof *t, 64);
    bool ok = compare(plan, paths, t, cancel, error);
    gather_trial_clear(t);
    free_radii(&t->plan);
    g_aligned_free(t);
    return ok;
}
