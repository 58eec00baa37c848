#include "transport/plan/caustics.h"

#include "transport/work.h"

/* Photons of a pass that it is tried with at most: so many that half of them cost
   what the camera's samples do, and in the smallest picture one for each place that is
   asked about. With no bound a render took 1.25 times as long to its error. */
static int64_t most_of_all(int64_t samples)
{
    double half = plan_share(SHARE_HALF) * PHOTON_RAYS;
    return MAX((int64_t)((double)samples * SAMPLE_RAYS / half), MOST_PLACES);
}

/* No fewer blurred gathers than this share: what is weighed by more stands out in the
   picture. */
static double least_share(void)
{
    return plan_share(SHARE_HALF);
}

uint64_t caustics_most(const transport_plan *plan)
{
    const settings *how = &plan->how;
    const film_settings *film = &plan->view->film;
    int64_t own = how->class_photons[PHOTON_CAUSTIC];
    int64_t samples = (int64_t)film->width * film->height * how->spp;
    if (!caustic_casters_are_lit(plan->casters))
        return 0;
    return (uint64_t)(own > 0 ? own : MIN(settings_photons(how), most_of_all(samples)));
}

/* Rays that a camera sample costs more where photons are gathered, however few: so many
   queries, without what looks for edges. */
static double gather_rays(const transport_plan *plan, const path_effort *paths)
{
    double later = fmax(paths->surfaces - 1.0, 0.0) * (double)plan->p_blurred;
    return PHOTON_RAYS * (fmin(paths->surfaces, 1.0) + later);
}

/* The photons of a pass: sending and storing one takes as long as a ray more, weighing it
   against paths as another. */
static double photon_rays(const aim_result *found, double n)
{
    return n * (found->rays + 1.0 + 1.0);
}

static double samples_a_pass(const transport_plan *plan)
{
    return plan_samples(plan) / settings_planned_passes(&plan->how);
}

/* A camera sample of a pass with a share of all photons; what is alike in neighbouring
   pixels weighs so much. */
static plan_cost cost_with(const transport_plan *plan, const aim_result *found,
                           const path_effort *paths, int i, double weight)
{
    double photons = plan_share(i) * (double)plan->n_photons[PHOTON_CAUSTIC];
    return (plan_cost){paths->noise + found->left[i] + weight * found->alike[i],
                       paths->rays + gather_rays(plan, paths) +
                           photon_rays(found, photons) / samples_a_pass(plan)};
}

static double product(plan_cost cost)
{
    return cost.variance * cost.rays;
}

/* Which share of all photons it is with which variance times work is least, if it is
   clearly so, and less than without photons in the picture that is shown, too; N_SHARES:
   none. Chosen by what is shown the share was all in place of half, for 1.0 to 1.4 times
   the error with glass, by a ball and in fog (256 x 256, 1 and 2 s, five seeds). */
static int best_share(transport_plan *plan, const aim_result *found,
                      const path_effort *paths)
{
    const plan_cost without = {paths->noise + paths->bounced + found->noise, paths->rays};
    plan_cost best = cost_with(plan, found, paths, 0, 1.0);
    int share = 0;
    for (int i = 1; i < N_SHARES; i++) {
        plan_cost with = cost_with(plan, found, paths, i, 1.0);
        if (product(with) < product(best)) {
            best = with;
            share = i;
        }
    }
    plan_cost shown = cost_with(plan, found, paths, share, plan_weight_alike(plan));
    bool taken = product(best) < CLEARLY_BETTER * product(without) &&
                 product(shown) < product(without);
    plan_note(plan, "caustic photons", without, shown, taken);
    return taken ? share : N_SHARES;
}

/* Gathers that are seen by way of a diffuse bounce are made as often as keeps their noise
   in step with all other. */
static void decide_blurred(transport_plan *plan, const aim_result *found,
                           const path_effort *paths)
{
    bool noisier = found->noise > paths->noise;
    double ratio = noisier ? 1.0 : sqrt(found->noise / paths->noise);
    plan->p_blurred = (float)fmax(fmax(ratio, found->unseen), least_share());
    plan->p_blurred_in_media = plan->p_blurred / (float)fmax(paths->surfaces - 1.0, 1.0);
}

static void set_share(transport_plan *plan, const aim_result *found, int share)
{
    uint64_t *n = &plan->n_photons[PHOTON_CAUSTIC];
    bool any = share < N_SHARES;
    *n = any ? (uint64_t)MAX(plan_share(share) * (double)*n, 1.0) : 0;
    plan->alike = any ? plan_weight_alike(plan) * found->alike[share] : 0.0;
}

/* Of those tried: what is asked for is sent, and where no path finds the light half at
   least, since what weighs more stands out in the picture. */
static int share_to_send(transport_plan *plan, const aim_result *found,
                         const path_effort *paths)
{
    int share = best_share(plan, found, paths);
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0)
        share = SHARE_ALL;
    else if (found->alone > 0.0)
        share = MIN(share, SHARE_HALF);
    plan->trials[plan->n_trials - 1].taken = share < N_SHARES;
    return share;
}

void caustics_decide(transport_plan *plan, const aim_result *found,
                     const path_effort *paths)
{
    decide_blurred(plan, found, paths);
    set_share(plan, found, share_to_send(plan, found, paths));
    if (plan->n_photons[PHOTON_CAUSTIC] > 0)
        plan->sample_rays += gather_rays(plan, paths);
    plan->photon_rays = photon_rays(found, (double)plan->n_photons[PHOTON_CAUSTIC]) /
                        samples_a_pass(plan);
}

void caustics_settle(transport_plan *plan)
{
    plan->p_blurred = plan->p_blurred_in_media = 1.0f;
    if (plan->how.class_photons[PHOTON_CAUSTIC] == 0 &&
        !scene_has_delta_lights(plan->scene))
        plan->n_photons[PHOTON_CAUSTIC] = 0;
}
