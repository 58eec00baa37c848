#include "transport/plan/gather_trial.h"

#include "transport/plan/trial.h"
#include "transport/visible.h"
#include "transport/work.h"

#include <math.h>

/* Samples of a place: by maps, and by paths. */
enum { N_SAMPLES = 1 + 7 + 2 }; /* math: as many */

/* Places that are asked by all threads. */
typedef struct gather_task {
    gather_trial *trial;
    const transport_plan *plan;
    const path_pass *paths;
    uint64_t key;
    uint32_t first;
} gather_task;

/* ---- Maps ---- */

static void free_widened(photonmap_pass *pass)
{
    for (int i = 0; pass && i < pass->n_slices; i++)
        for (int c = 0; c < N_PHOTON_CLASSES; c++)
            volume_map_free(pass->in_media[i][c]);
    g_aligned_free(pass);
}

static bool widen_in_media(const photonmap_pass *pass, double by, photonmap_pass *out,
                           GError **error)
{
    unsigned threads = (unsigned)pass->how->threads;
    bool ok = true;
    for (int i = 0; i < pass->n_slices; i++)
        for (int c = 0; c < N_PHOTON_CLASSES; c++) {
            volume_map **wide = &out->in_media[i][c];
            if ((*wide = ok ? pass->in_media[i][c] : NULL)) {
                *wide = volume_map_widened(*wide, (float)by, threads, error);
                ok = *wide;
            }
        }
    return ok;
}

/* A pass with wider radii, its photons lent. NULL: out of memory */
static photonmap_pass *widened(const photonmap_pass *pass, double by, GError **error)
{
    photonmap_pass *out = g_aligned_alloc0(1, sizeof *out, 64);
    *out = *pass;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        out->estimates[c].radius *= (float)by;
    if (widen_in_media(pass, by, out, error))
        return out;
    free_widened(out);
    return NULL;
}

/* A pass of few photons. */
static bool send_few(gather_trial *t, int i, const cancel_flag *cancel, GError **error)
{
    transport_plan *few = &t->few[i];
    transport_counts counts = {0};
    *few = t->plan;
    few->how.seed =
        (int64_t)(hash_mix((uint64_t)t->plan.how.seed, 0x676174686572u + (uint64_t)i) >>
                  1);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        if (few->n_photons[c] > 0)
            few->n_photons[c] = (uint64_t)MAX((double)few->n_photons[c] / t->fewer, 1.0);
    t->maps[i] = transport_photonmap.begin_pass(few, 0, cancel, &counts, error);
    if (!t->maps[i])
        return false;
    double rays = plan_rays_of_photons(&counts);
    t->maps[i]->caustics_apart = true;
    t->photon_rays += 0.5 * rays * t->fewer;
    plan_note_photons(&t->plan, rays - (double)counts.photon_rays,
                      (double)counts.photon_rays);
    return true;
}

static double n_photons(const transport_plan *plan)
{
    double n = 0.0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += (double)plan->n_photons[c];
    return n;
}

/* Adds what photons carry, squared, mean over wavelengths. @return how many */
static double add_squares(const photon_store *store, double *sum)
{
    for (size_t i = 0; i < store->n; i++) {
        double flux = (double)spectrum_mean(photon_store_flux(store, i));
        *sum += flux * flux;
    }
    return (double)store->n;
}

/* What a photon of the plan's carries: in the mean square as the few that arrived do, or
   as it is sent where none did. */
static double flux_of_photon(const gather_trial *t)
{
    const int c = PHOTON_INDIRECT;
    double n = 0.0, sum = 0.0;
    for (int k = 0; k < 2; k++) {
        const photonmap_pass *pass = t->maps[k];
        for (int i = 0; i < pass->n_slices; i++) {
            if (pass->maps[i][c])
                n += add_squares(photon_map_store(pass->maps[i][c]), &sum);
            if (pass->in_media[i][c])
                n += add_squares(volume_map_store(pass->in_media[i][c]), &sum);
        }
    }
    if (n > 0.0)
        return sqrt(sum / n) / t->fewer;
    double power = distribution_total(&t->plan.scene->light_power);
    return power / fmax((double)t->plan.n_photons[c], 1.0);
}

/* As many in both as half of the grant pays for. */
static bool send_both(gather_trial *t, transport_plan *plan, const cancel_flag *cancel,
                      GError **error)
{
    double n = n_photons(&t->plan);
    double most =
        plan_trials_for(plan, 0.5, 2.0 * plan_photon_rays(&t->plan), UINT32_MAX);
    t->fewer = fmax(n / most, 1.0);
    bool ok = send_few(t, 0, cancel, error) && send_few(t, 1, cancel, error);
    plan->planning = t->plan.planning;
    if (ok)
        t->flux = flux_of_photon(t);
    return ok;
}

/* ---- Places ---- */

/* Without the caustics that either way are photons'. */
static double without_shared(const transport_plan *plan, const trial_light *of)
{
    return of->all - (plan->n_photons[PHOTON_CAUSTIC] > 0 ? of->caustic : 0.0);
}

static double sample(radiance_function *radiance, const void *pass,
                     const transport_plan *plan, vec2 raster, sampler random,
                     transport_scratch *scratch)
{
    trial_light found = trial_sample(radiance, pass, plan, raster, random, scratch);
    return without_shared(plan, &found);
}

/* Square of the light that one photon adds around what is seen, times the area of its
   disc. */
static double lone_photon(const gather_trial *t, const trial_light *at, point_hits *hits)
{
    double r =
        (double)photonmap_options_at(t->maps[0], PHOTON_INDIRECT, at->p, hits).radius;
    double on = M_PI * r * r, added = t->flux * at->albedo / (M_PI * on);
    return at->area > 0.0 && on > 0.0 ? added * added * on : 0.0;
}

/* What the smooth map sees, by two samplers, and beside it. */
static void see(const gather_task *all, vec2 raster, const sampler by[2],
                transport_scratch *scratch, gather_place *at)
{
    const photonmap_pass *smooth = all->trial->smooth;
    for (int k = 0; k < 2; k++) {
        trial_light found =
            trial_sample(photonmap_radiance, smooth, all->plan, raster, by[k], scratch);
        at->smooth[k] = without_shared(all->plan, &found);
        at->scattered[k] = found.scattered;
        at->seen += 0.5 * found.all;
        at->lone += 0.5 * lone_photon(all->trial, &found, &scratch->estimate.hits);
        at->area += 0.5 * found.area;
    }
    vec2 beside = {raster.x + 1.0f, raster.y};
    at->beside = sample(photonmap_radiance, smooth, all->plan, beside, by[0], scratch);
}

/* What gathering takes at a place, as if there were all photons, but for weighing them.
 */
static void find_price(const gather_task *all, vec2 raster, sampler random,
                       transport_scratch *scratch, gather_place *at)
{
    const photonmap_pass *pass = all->trial->priced;
    double before = plan_rays_of_search(scratch);
    looked_around_forget(&scratch->estimate.looked);
    sample(photonmap_radiance, pass, all->plan, raster, random, scratch);
    double between = plan_rays_of_search(scratch);
    at->first_rays = between - before;
    if (all->plan->how.spp == 1)
        return;
    vec2 u = sampler_2d(&random);
    vec2 beside = {raster.x + u.x - 0.5f, raster.y + u.y - 0.5f};
    sample(photonmap_radiance, pass, all->plan, beside, random, scratch);
    at->later_rays = plan_rays_of_search(scratch) - between;
}

/* What the narrower discs say there, and what weighing their photons takes where there
   are as many as the plan's: those of wide ones reach beyond walls, and hold fewer. */
static void see_near(const gather_task *all, vec2 raster, sampler random,
                     transport_scratch *scratch, gather_place *at)
{
    const gather_trial *t = all->trial;
    for (int k = 0; k < 2; k++) {
        const photonmap_pass *near = t->near[k], *twice = t->twice[k];
        uint64_t before = scratch->estimate.n_weighed;
        at->near[k] =
            sample(photonmap_radiance, near, all->plan, raster, random, scratch);
        double weighed = (double)(scratch->estimate.n_weighed - before) * t->area;
        at->weigh_rays += 0.5 * plan_rays_of_weighed(weighed);
        at->twice[k] =
            sample(photonmap_radiance, twice, all->plan, raster, random, scratch);
    }
}

/* Asks at a place. What is looked at for one map counts for all; paths look for edges
   anew. */
static void ask(const gather_task *all, uint32_t i, transport_scratch *scratch)
{
    const gather_trial *t = all->trial;
    const transport_plan *plan = all->plan;
    gather_place *at = &t->places[i];
    sampler random = sampler_make(all->key, i);
    const vec2 raster = trial_place(plan, &random);
    const sampler by[2] = {sampler_split(&random, 0), sampler_split(&random, 1)};
    double before = plan_rays_of(scratch);
    find_price(all, raster, by[0], scratch, at);
    looked_around_forget(&scratch->estimate.looked);
    see(all, raster, by, scratch, at);
    see_near(all, raster, by[0], scratch, at);
    double between = plan_rays_of(scratch);
    for (int k = 0; k < 2; k++) {
        looked_around_forget(&scratch->estimate.looked);
        at->path[k] = sample(path_radiance, all->paths, plan, raster, by[k], scratch);
    }
    double after = plan_rays_of(scratch);
    at->path_rays = 0.5 * (after - between);
    at->all_rays += after - before;
}

static void ask_some(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const gather_task *all = data;
    transport_scratch scratch = {0};
    for (size_t i = begin; i < end; i++)
        ask(all, all->first + (uint32_t)i, &scratch);
    transport_scratch_clear(&scratch);
}

/* As many places as the grant allows, by what the first of them cost. */
static uint32_t count_places(const gather_trial *t, const transport_plan *plan)
{
    double each = 0.0;
    for (int i = 0; i < LEAST_TRIALS; i++)
        each += t->places[i].all_rays;
    return plan_trials_for(plan, 1.0, each / LEAST_TRIALS, MOST_PLACES);
}

static void sum_rays(gather_trial *t, transport_plan *plan)
{
    for (uint32_t i = 0; i < t->n; i++) {
        t->first_rays += t->places[i].first_rays / t->n;
        t->later_rays += t->places[i].later_rays / t->n;
        t->weigh_rays += t->places[i].weigh_rays / t->n;
        t->path_rays += t->places[i].path_rays / t->n;
        plan->planning += t->places[i].all_rays;
    }
}

static bool widen_all(gather_trial *t, GError **error)
{
    t->area = sqrt(t->fewer);
    t->smooth = widened(t->maps[0], sqrt(t->fewer), error);
    t->priced = t->smooth ? widened(t->smooth, 1.0, error) : NULL;
    bool ok = t->priced;
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        t->priced->estimates[c].looked_share = (float)(1.0 / sqrt(t->fewer));
    for (int i = 0; i < 2 && ok; i++) {
        t->near[i] = widened(t->maps[i], sqrt(t->area), error);
        t->twice[i] = t->near[i] ? widened(t->near[i], 2.0, error) : NULL;
        ok = t->twice[i];
    }
    return ok;
}

static bool run_places(gather_trial *t, transport_plan *plan, const path_pass *paths,
                       const cancel_flag *cancel, GError **error)
{
    const workers by = {(unsigned)plan->how.threads, cancel};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x706c61636573u);
    path_pass apart = *paths;
    apart.caustics_apart = true;
    gather_task task = {t, plan, &apart, key, 0};
    t->places = g_new0(gather_place, MOST_PLACES);
    if (!widen_all(t, error))
        return false;
    ask_some(0, LEAST_TRIALS, 0, &task);
    t->n = count_places(t, plan);
    task.first = LEAST_TRIALS;
    if (!parallel_work(t->n - task.first, LEAST_TRIALS, by, ask_some, &task, error))
        return false;
    sum_rays(t, plan);
    return true;
}

/* ---- The trial ---- */

bool gather_trial_granted(const transport_plan *plan)
{
    return plan_grant(plan, 1.0) >= LEAST_TRIALS * N_SAMPLES * SAMPLE_RAYS;
}

bool gather_trial_run(gather_trial *t, transport_plan *plan, const path_pass *paths,
                      const cancel_flag *cancel, GError **error)
{
    return send_both(t, plan, cancel, error) && run_places(t, plan, paths, cancel, error);
}

double gather_trial_sample_rays(const gather_trial *t)
{
    double spp = (double)t->plan.how.spp;
    return (t->first_rays + (spp - 1.0) * t->later_rays) / spp + t->weigh_rays;
}

void gather_trial_clear(gather_trial *t)
{
    free_widened(t->smooth);
    free_widened(t->priced);
    for (int i = 0; i < 2; i++) {
        free_widened(t->near[i]);
        free_widened(t->twice[i]);
        if (t->maps[i])
            transport_photonmap.end_pass(t->maps[i]);
    }
    g_free(t->places);
}
