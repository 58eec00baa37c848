#include "transport/plan/gather.h"

#include "transport/photonmap/photonmap.h"
#include "transport/plan/trial.h"
#include "transport/visible.h"
#include "transport/work.h"

#include <math.h>

/* What maps blur below the size of their discs no map shows, and paths only when their
   noise is gone. So much at least is its relative square, over that of the radius in
   radii of the scene: .04 to .26 in five rooms (Cornell boxes without and with glass,
   glossy, papered, a glass ball; 2 to 16 passes, 128 x 128). */
#define UNSEEN_BIAS 0.1

/* What two maps and two paths say of a place of the film. */
typedef struct gather_place {
    double path[2], smooth[2]; /* each with a sampler of its own */
    double near[2], twice[2];  /* all with the first one */
    double beside;             /* as smooth[0], of the next pixel */
    double seen;               /* with the caustics that those leave out */
    double lone;               /* square of what one photon adds, times its disc, m² */
    double area;               /* of a pixel, m² */
    double first_rays;         /* of a pixel's first sample */
    double later_rays;         /* of another one, which shares the first one's looks */
    double path_rays;          /* of a path */
    double all_rays;
} gather_place;

/* The trial of gathering. */
typedef struct gather_trial {
    transport_plan plan; /* of photons, as it would be */
    transport_plan few[2];
    photonmap_pass *maps[2];
    /* The same with wider discs: near and twice with area times as much of them and four
       times that, smooth with fewer times, in which there are as many photons as in the
       plan's; and priced as smooth, but looked around as the plan's. */
    photonmap_pass *near[2], *twice[2], *smooth, *priced;
    double area;
    double fewer;                             /* photons than the plan's, over them */
    double photon_rays;                       /* of a whole pass */
    double first_rays, later_rays, path_rays; /* means of the places' */
    uint32_t n;                               /* places */
    gather_place *places;
} gather_trial;

/* Places that are asked by all threads. */
typedef struct gather_task {
    gather_trial *trial;
    const transport_plan *plan;
    const path_pass *paths;
    uint64_t key;
    uint32_t first;
} gather_task;

/* Mean squared errors of a sample, relative to what is there; of a whole picture; and of
   a pixel that shows the next one. */
typedef struct gather_errors {
    double path, samples, photons, bias2, contrast;
} gather_errors;

/* Samples of a place: by maps, and by paths. */
enum { N_SAMPLES = 1 + 7 + 2 }; /* math: as many */

/* ---- Trial passes ---- */

/* Bounds on bounces bound different paths where photons meet the eye's. */
static bool may_gather(const transport_plan *plan)
{
    const settings *how = &plan->how;
    return how->gather_indirect && how->direct_illumination &&
           how->max_backward_bounces < 0 && how->max_forward_bounces < 0 &&
           scene_is_lit(plan->scene) &&
           plan_grant(plan, 1.0) >= LEAST_TRIALS * N_SAMPLES * SAMPLE_RAYS;
}

/* Photons as of photon mapping, but all of them together take no longer than the camera,
   unless the caustics alone have more without gathering: of those there are no fewer. */
static void set_photons(const transport_plan *plan, transport_plan *to)
{
    double passes = settings_planned_passes(&plan->how);
    double rays = plan->sample_rays * plan_samples(plan) / passes;
    to->how.photons = MIN(settings_photons(&plan->how), (int64_t)(rays / PHOTON_RAYS));
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

static double n_photons(const transport_plan *plan)
{
    double n = 0.0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += (double)plan->n_photons[c];
    return n;
}

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

/* ---- Trial samples ---- */

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

/* Square of the light that a photon of the plan's, as bright as they are when sent, adds
   around the first surface, times the area of its disc. */
static double lone_photon(const gather_trial *t, const trial_light *at, point_hits *hits)
{
    const int c = PHOTON_INDIRECT;
    double sent = (double)t->plan.n_photons[c];
    double flux = distribution_total(&t->plan.scene->light_power) / fmax(sent, 1.0);
    double r = (double)photonmap_options_at(t->maps[0], c, at->p, hits).radius;
    double disc = M_PI * r * r;
    double added = flux * at->albedo / (M_PI * disc);
    return at->area > 0.0 && disc > 0.0 ? added * added * disc : 0.0;
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
        at->seen += 0.5 * found.all;
        at->lone += 0.5 * lone_photon(all->trial, &found, &scratch->estimate.hits);
        at->area += 0.5 * found.area;
    }
    vec2 beside = {raster.x + 1.0f, raster.y};
    at->beside = sample(photonmap_radiance, smooth, all->plan, beside, by[0], scratch);
}

/* What gathering takes at a place, as if there were all photons. */
static void find_price(const gather_task *all, vec2 raster, sampler random,
                       transport_scratch *scratch, gather_place *at)
{
    const photonmap_pass *pass = all->trial->priced;
    double before = plan_rays_of(scratch);
    looked_around_forget(&scratch->estimate.looked);
    sample(photonmap_radiance, pass, all->plan, raster, random, scratch);
    double between = plan_rays_of(scratch);
    at->first_rays = between - before;
    if (all->plan->how.spp == 1)
        return;
    vec2 u = sampler_2d(&random);
    vec2 beside = {raster.x + u.x - 0.5f, raster.y + u.y - 0.5f};
    sample(photonmap_radiance, pass, all->plan, beside, random, scratch);
    at->later_rays = plan_rays_of(scratch) - between;
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
    for (int k = 0; k < 2; k++) {
        const photonmap_pass *near = t->near[k], *twice = t->twice[k];
        at->near[k] = sample(photonmap_radiance, near, plan, raster, by[0], scratch);
        at->twice[k] = sample(photonmap_radiance, twice, plan, raster, by[0], scratch);
    }
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

/* Of a pixel's samples the first looks for edges. */
static double rays_of_sample(const transport_plan *plan, const gather_trial *t)
{
    double spp = (double)plan->how.spp;
    return (t->first_rays + (spp - 1.0) * t->later_rays) / spp;
}

/* ---- What they say ---- */

static double mean_of(const gather_trial *t)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < t->n; i++)
        sum += t->places[i].seen;
    return sum / t->n;
}

/* A sum of squares, and the two largest of them. */
typedef struct square_sum {
    double sum, loudest, second;
} square_sum;

static void square_add(square_sum *to, double square)
{
    to->sum += square;
    to->second = fmax(to->second, fmin(square, to->loudest));
    to->loudest = fmax(to->loudest, square);
}

/* With the loudest no louder than the next: one path that met a lamp by a rare way may be
   louder than all others, and tells nothing of them (a coffee maker: 2.1 with it, 0.02
   without, of 17 places). Left out of paths alone, it makes those of few places too good:
   of 16 in a Cornell box .32 becomes .08, where .21 is true. */
static double square_total(const square_sum *of)
{
    return of->sum - of->loudest + of->second;
}

/* How far both paths are from what the map sees. */
static double off_map(const gather_place *at)
{
    double seen = (at->smooth[0] + at->smooth[1]) / 2.0;
    return (fabs(at->path[0] - seen) + fabs(at->path[1] - seen)) / 2.0;
}

/* How far maps are off, as products tell of two of them that have nothing in common. */
typedef struct bias_sum {
    double products, squares;
} bias_sum;

static void bias_add(bias_sum *to, double product)
{
    to->products += product;
    to->squares += product * product;
}

/* As far as it is known from chance. */
static double seen_bias(const bias_sum *of)
{
    return fmax(of->products - sqrt(of->squares), 0.0);
}

static double unseen_bias(const transport_plan *plan)
{
    double share = plan->radius[PHOTON_INDIRECT] / (double)plan->scene->radius;
    return UNSEEN_BIAS * share * share;
}

/* Sums over the places. */
typedef struct gather_sums {
    square_sum path, sample, photons;
    bias_sum bias;
    double off, beside;
    double lone, area;
} gather_sums;

/* One of n places. */
static void add_place(gather_sums *to, const gather_place *at, double weight, double n)
{
    double w = weight / n, half = 0.5 * w;
    double paths = at->path[0] - at->path[1], photons = at->near[0] - at->near[1];
    double samples = at->smooth[0] - at->smooth[1];
    square_add(&to->path, half * paths * paths);
    square_add(&to->sample, half * samples * samples);
    square_add(&to->photons, half * photons * photons);
    bias_add(&to->bias, w * (at->twice[0] - at->near[0]) * (at->twice[1] - at->near[1]));
    to->lone += w * at->lone;
    to->area += at->area / n;
    to->off += off_map(at) * sqrt(weight) / n;
    double off = at->beside - 0.5 * (at->smooth[0] + at->smooth[1]);
    to->beside += w * off * off;
}

/* Variance of photons too rare for few maps to hold one: by Laplace's rule of succession
   the next one that is sent is such a one with a chance of one over all that were; it
   lands anywhere in the picture. */
static double unseen_photons(const gather_trial *t, double lone, double pixel_area)
{
    const int c = PHOTON_INDIRECT;
    const film_settings *film = &t->plan.view->film;
    double tried = (double)t->few[0].n_photons[c] + (double)t->few[1].n_photons[c];
    double seen = pixel_area * (double)film->width * (double)film->height;
    double arrive = (double)t->plan.n_photons[c] / fmax(tried, 1.0);
    return lone > 0.0 ? arrive * lone / seen : 0.0;
}

/* Where neither path found the light that photons came from their difference tells
   nothing, but how far they are off the map does: its mean, since its square is as much
   at the mercy of one place as theirs. Fewer photons have as many times the variance. */
static gather_errors errors_of(const gather_trial *t)
{
    gather_sums sums = {0};
    double mean = mean_of(t);
    for (uint32_t i = 0; i < t->n && mean > 0.0; i++)
        add_place(&sums, &t->places[i], relative_weight(t->places[i].seen, mean), t->n);
    return (gather_errors){
        .path = fmax(square_total(&sums.path), sums.off * sums.off),
        .samples = square_total(&sums.sample),
        .photons = square_total(&sums.photons) * t->area / t->fewer +
                   unseen_photons(t, sums.lone, sums.area),
        .bias2 = seen_bias(&sums.bias) / t->area + unseen_bias(&t->plan),
        /* Without the noise of one sample and of the mean of two. */
        .contrast = fmax(sums.beside - (1.0 + 0.5) * sums.sample.sum, 0.0),
    };
}

/* Of so many passes whose radii shrink the variance is, and the bias, over that of the
   first. */
static double variance_of_passes(double alpha, double passes)
{
    return tgamma(alpha) * pow(passes, 1.0 - alpha) / (2.0 - alpha) / passes;
}

static double bias_of_passes(double alpha, double passes)
{
    return pow(passes, alpha - 1.0) / tgamma(1.0 + alpha);
}

/* Squared error of n samples a pixel times n, which are told within a factor of two: of
   the pixels for which half as many do not suffice all may stay empty, and show the next.
 */
static double variance_of_samples(double variance, const gather_errors *e, double n)
{
    double empty = fmax(1.0 - 0.5 * n, 0.0);
    return fmin(n, 1.0) * variance + n * empty * e->contrast;
}

/* Squared error of the picture times the samples of a pixel, comparable to the variance
   of one of them; there is time for so many passes by maps. Noise that is taken out of
   less than one pass, where paths have one, or less than theirs, stays as well as not. */
static double error_of(const transport_plan *plan, const gather_errors *e, double in_time)
{
    double passes = settings_planned_passes(&plan->how), alpha = plan->how.alpha;
    double spp = (double)plan->how.spp, bias = bias_of_passes(alpha, passes);
    double alike =
        e->photons * variance_of_passes(alpha, passes) + e->bias2 * bias * bias;
    bool short_of_time = in_time < fmin(passes, 1.0);
    double weight = plan_weight_alike(plan);
    double weight_of_grain = short_of_time ? weight : 1.0;
    return weight_of_grain * variance_of_samples(e->samples, e, in_time * spp) +
           weight * passes * spp * alike;
}

static bool gathering_pays(transport_plan *plan, const gather_trial *t)
{
    const gather_errors e = errors_of(t);
    double passes = settings_planned_passes(&plan->how), spp = (double)plan->how.spp;
    plan_cost without, with;
    without.rays = t->path_rays + plan->photon_rays;
    without.variance = variance_of_samples(e.path, &e, passes * spp);
    with.rays = rays_of_sample(plan, t) + t->photon_rays * passes / plan_samples(plan);
    with.variance = error_of(plan, &e, passes * without.rays / with.rays);
    bool pays = with.variance * with.rays < without.variance * without.rays;
    plan_note(plan, "gathered indirect light", without, with, pays);
    return pays;
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
    plan->sample_rays = rays_of_sample(plan, t);
    plan->photon_rays = t->photon_rays * per_sample;
}

static void gather_trial_clear(gather_trial *t)
{
    free_widened(t->smooth);
    free_widened(t->priced);
    for (int i = 0; i < 2; i++) {
        free_widened(t->near[i]);
        free_widened(t->twice[i]);
        if (t->maps[i])
            transport_photonmap.end_pass(t->maps[i]);
    }
    free_radii(&t->plan);
    g_free(t->places);
}

bool gather_decide(transport_plan *plan, const path_pass *paths,
                   const cancel_flag *cancel, GError **error)
{
    if (!may_gather(plan))
        return true;
    gather_trial *t = g_aligned_alloc0(1, sizeof *t, 64);
    bool ok = plan_to_gather(plan, &t->plan, cancel, error);
    double n = n_photons(&t->plan);
    double most =
        plan_trials_for(plan, 0.5, 2.0 * plan_photon_rays(&t->plan), UINT32_MAX);
    t->fewer = fmax(n / most, 1.0);
    for (int i = 0; i < 2 && ok; i++)
        ok = send_few(t, i, cancel, error);
    plan->planning = t->plan.planning;
    ok = ok && run_places(t, plan, paths, cancel, error);
    if (ok && gathering_pays(plan, t))
        take(plan, t);
    gather_trial_clear(t);
    g_aligned_free(t);
    return ok;
}
