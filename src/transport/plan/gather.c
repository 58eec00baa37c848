#include "transport/plan/gather.h"

#include "transport/photonmap/photonmap.h"
#include "transport/plan/work.h"
#include "transport/visible.h"

#include <math.h>

/* Squared error that is alike in neighbouring pixels weighs as much as so many times that
   of grain where noise is taken out. Of paths' grain that took 4.7 (glass and mirror
   balls), 5.5 (papered), 8.4, 8.6 (24 lamps), 13 (glossy) and 14 (Cornell box) times as
   much as of photon maps' error, 128 x 128, 4 passes, two seeds. Made with one of the two
   throughout, pictures of 2 to 32 passes had 1.2 to 2.4 times as much time x relMSE by
   maps in six rooms (Cornell box, glossy, papered, 24 lamps, a glass ball, water), .4 to
   1.0 with glass and mirror balls, .3 to .5 by a lamp in a bulb of glass. Of 108 trials
   in the six 22 chose maps with 8, 14 with 12. */
#define BLOTCHES 12.0

/* What two maps and two paths say of a place of the film. */
typedef struct gather_place {
    double path[2];
    double map[2];    /* each with a sampler of its own */
    double carried;   /* by photons, of map[0], at most */
    double other;     /* of the second map, with the sampler of the first one */
    double path_rays; /* of a path */
    double all_rays;
} gather_place;

/* The trial of gathering. */
typedef struct gather_trial {
    transport_plan plan; /* of photons, as it would be */
    transport_plan few[2];
    photonmap_pass *maps[2];
    double fewer;       /* photons than the plan's, over them */
    double stored;      /* photons of a map */
    double photon_rays; /* of a whole pass */
    double first_rays;  /* of a pixel's first sample */
    double later_rays;  /* of another one, which shares the first one's looks */
    double path_rays;   /* of a path */
    uint32_t n;         /* places */
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

/* Mean squared errors of a sample, relative to what is there; and of a whole picture. */
typedef struct gather_errors {
    double path, samples, photons, bias2;
} gather_errors;

/* Samples of a place: by maps map[] and other, and two by paths. */
enum { N_SAMPLES = 2 + 1 + 2 }; /* math: as many */

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

static bool widen_in_media(photonmap_pass *pass, double by, GError **error)
{
    unsigned threads = (unsigned)pass->how->threads;
    bool ok = true;
    for (int i = 0; i < pass->n_slices; i++)
        for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
            if (pass->in_media[i][c])
                ok = volume_map_widen(pass->in_media[i][c], (float)by, threads, error);
    return ok;
}

/* All radii of both maps. */
static bool widen(gather_trial *t, double by, GError **error)
{
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < N_PHOTON_CLASSES; c++)
            t->maps[i]->estimates[c].radius *= (float)by;
        if (!widen_in_media(t->maps[i], by, error))
            return false;
    }
    return true;
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
    t->photon_rays += 0.5 * rays * t->fewer;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        t->stored += 0.5 * (double)counts.stored[c];
    plan_note_photons(&t->plan, rays - (double)counts.photon_rays,
                      (double)counts.photon_rays);
    return true;
}

/* ---- Trial samples ---- */

typedef void radiance_function(const void *pass, const ray *r, sampler *random,
                               transport_scratch *scratch, radiance_sample *out);

/* The mean over wavelengths of layers among these bits. */
static double mean_of_layers(const radiance_sample *sample, unsigned layers)
{
    spectrum sum = {0};
    for (unsigned i = 0; i < N_LAYERS; i++)
        if (layers >> i & 1)
            sum += sample->layers[i];
    double mean = (double)spectrum_mean(sum);
    return isfinite(mean) ? mean : 0.0;
}

/* Of what is compared: not the caustics that either way are photons'. */
static unsigned compared_layers(const transport_plan *plan)
{
    const unsigned all = (1u << N_LAYERS) - 1;
    return plan->n_photons[PHOTON_CAUSTIC] > 0 ? all & ~(1u << LAYER_CAUSTIC) : all;
}

/* What is compared.
   @param carried NULL, or gets what of it is neither a lamp nor its direct light */
static double sample(radiance_function *radiance, const void *pass,
                     const transport_plan *plan, vec2 raster, sampler random,
                     transport_scratch *scratch, double *carried)
{
    radiance_sample out = {.groups = NULL};
    vec2 u_lens = sampler_2d(&random);
    ray r = camera_ray(&plan->view->camera, raster, u_lens, sampler_1d(&random));
    unsigned layers = compared_layers(plan);
    radiance(pass, &r, &random, scratch, &out);
    if (carried)
        *carried =
            mean_of_layers(&out, layers & ~(1u << LAYER_EMISSION | 1u << LAYER_DIRECT));
    return mean_of_layers(&out, layers);
}

/* A place of the film. */
static vec2 raster_of(const transport_plan *plan, sampler *random)
{
    const film_settings *film = &plan->view->film;
    vec2 u = sampler_2d(random);
    return (vec2){u.x * (float)film->width, u.y * (float)film->height};
}

/* A second sample of the pixel. */
static double later_rays(const gather_task *all, vec2 raster, sampler random,
                         transport_scratch *scratch)
{
    double before = plan_rays_of(scratch);
    vec2 u = sampler_2d(&random);
    vec2 beside = {raster.x + u.x - 0.5f, raster.y + u.y - 0.5f};
    sample(photonmap_radiance, all->trial->maps[0], all->plan, beside, random, scratch,
           NULL);
    return plan_rays_of(scratch) - before;
}

/* With the radii of the plan, before they are widened: discs that hold few photons now
   will hold them then, and be looked around. Of few places: these differ less by that
   than by what they bring. @return rays that it took */
static double find_price(const gather_task *all)
{
    gather_trial *t = all->trial;
    transport_scratch scratch = {0};
    const uint32_t n = LEAST_TRIALS / 2;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        t->maps[0]->estimates[c].looks_anyway = true;
    for (uint32_t i = 0; i < n; i++) {
        sampler random = sampler_make(all->key, i);
        vec2 raster = raster_of(all->plan, &random);
        double before = plan_rays_of(&scratch);
        looked_around_forget(&scratch.estimate.looked);
        sample(photonmap_radiance, t->maps[0], all->plan, raster,
               sampler_split(&random, 0), &scratch, NULL);
        t->first_rays += (plan_rays_of(&scratch) - before) / n;
        if (all->plan->how.spp > 1)
            t->later_rays +=
                later_rays(all, raster, sampler_split(&random, 2), &scratch) / n;
    }
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        t->maps[0]->estimates[c].looks_anyway = false;
    double took = plan_rays_of(&scratch);
    transport_scratch_clear(&scratch);
    return took;
}

/* Asks both maps at a place, where what is looked at for the first counts for all, and
   paths, which look for edges anew. */
static void ask_maps(const gather_task *all, uint32_t i, transport_scratch *scratch)
{
    const gather_trial *t = all->trial;
    const transport_plan *plan = all->plan;
    gather_place *at = &t->places[i];
    sampler random = sampler_make(all->key, i);
    vec2 raster = raster_of(plan, &random);
    double before = plan_rays_of(scratch);
    looked_around_forget(&scratch->estimate.looked);
    at->map[0] = sample(photonmap_radiance, t->maps[0], plan, raster,
                        sampler_split(&random, 0), scratch, &at->carried);
    at->map[1] = sample(photonmap_radiance, t->maps[1], plan, raster,
                        sampler_split(&random, 1), scratch, NULL);
    at->other = sample(photonmap_radiance, t->maps[1], plan, raster,
                       sampler_split(&random, 0), scratch, NULL);
    double between = plan_rays_of(scratch);
    for (unsigned k = 0; k < 2; k++) {
        looked_around_forget(&scratch->estimate.looked);
        at->path[k] = sample(path_radiance, all->paths, plan, raster,
                             sampler_split(&random, k), scratch, NULL);
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
        ask_maps(all, all->first + (uint32_t)i, &scratch);
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
        t->path_rays += t->places[i].path_rays / t->n;
        plan->planning += t->places[i].all_rays;
    }
}

static bool run_places(gather_trial *t, transport_plan *plan, const path_pass *paths,
                       const cancel_flag *cancel, GError **error)
{
    const workers by = {(unsigned)plan->how.threads, cancel};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x706c61636573u);
    gather_task task = {t, plan, paths, key, 0};
    t->places = g_new0(gather_place, MOST_PLACES);
    plan->planning += find_price(&task);
    if (!widen(t, sqrt(t->fewer), error))
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

/* A place counts by how bright it is, and the picture is. */
static double weight_of(const gather_place *at, double mean)
{
    double here = (at->map[0] + at->map[1]) / 2.0;
    return 1.0 / (here * here + mean * mean);
}

static double mean_of(const gather_trial *t)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < t->n; i++)
        sum += (t->places[i].map[0] + t->places[i].map[1]) / 2.0;
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

/* How far both paths are from what the maps see. */
static double off_maps(const gather_place *at)
{
    double seen = (at->map[0] + at->map[1]) / 2.0;
    return (fabs(at->path[0] - seen) + fabs(at->path[1] - seen)) / 2.0;
}

/* How far maps are off what paths find, as products of two pairs tell that have nothing
   in common. */
typedef struct bias_sum {
    double products, squares;
} bias_sum;

static void bias_add(bias_sum *to, double product)
{
    to->products += product;
    to->squares += product * product;
}

/* The square of the plan's bias, as far as it is known from chance. The plan's radii are
   smaller, and the bias with their square; but near the rim of a medium, where a disc
   is in it in part, with the radius. */
static double bias_square(const bias_sum *of, const gather_trial *t)
{
    double grows = scene_has_media(t->plan.scene) ? t->fewer : t->fewer * t->fewer;
    return fmax(of->products - sqrt(of->squares), 0.0) / grows;
}

/* Sums over the places. */
typedef struct gather_sums {
    square_sum path, both, photons;
    bias_sum bias;
    double off, carried;
} gather_sums;

/* One of n places. */
static void add_place(gather_sums *to, const gather_place *at, double weight, double n)
{
    double w = weight / n, half = 0.5 * w;
    double paths = at->path[0] - at->path[1], maps = at->map[0] - at->map[1];
    double same_way = at->map[0] - at->other;
    square_add(&to->path, half * paths * paths);
    square_add(&to->both, half * maps * maps);
    square_add(&to->photons, half * same_way * same_way);
    bias_add(&to->bias, w * (at->path[0] - at->map[0]) * (at->path[1] - at->map[1]));
    to->off += off_maps(at) * sqrt(weight) / n;
    to->carried += w * at->carried * at->carried;
}

/* Where neither path found the light that photons came from their difference tells
   nothing, but how far they are off the maps does: its mean, since its square is as much
   at the mercy of one place as theirs. What all places see of a map may differ little by
   chance, but what n photons carry is known no better than within an n-th of its square.
 */
static gather_errors errors_of(const gather_trial *t)
{
    gather_sums sums = {0};
    double mean = mean_of(t);
    for (uint32_t i = 0; i < t->n && mean > 0.0; i++)
        add_place(&sums, &t->places[i], weight_of(&t->places[i], mean), t->n);
    double photons = square_total(&sums.photons);
    return (gather_errors){
        .path = fmax(square_total(&sums.path), sums.off * sums.off),
        .samples = fmax(square_total(&sums.both) - photons, 0.0),
        .photons = fmax(photons, sums.carried / fmax(t->stored, 1.0)),
        .bias2 = bias_square(&sums.bias, t),
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

/* Noise is taken out of two passes or more. */
static double weight_of_blotches(const transport_plan *plan)
{
    bool filtered = plan->how.denoise && settings_planned_passes(&plan->how) >= 2.0;
    return filtered ? BLOTCHES : 1.0;
}

/* Squared error of the picture times the samples of a pixel: comparable to the variance
   of one of them. */
static double error_of(const transport_plan *plan, const gather_errors *e)
{
    double passes = settings_planned_passes(&plan->how), alpha = plan->how.alpha;
    double bias = bias_of_passes(alpha, passes);
    double alike =
        e->photons * variance_of_passes(alpha, passes) + e->bias2 * bias * bias;
    return e->samples + weight_of_blotches(plan) * passes * (double)plan->how.spp * alike;
}

static bool gathering_pays(transport_plan *plan, const gather_trial *t)
{
    double per_sample = settings_planned_passes(&plan->how) / plan_samples(plan);
    const gather_errors e = errors_of(t);
    plan_cost without = {e.path, t->path_rays + plan->photon_rays};
    plan_cost with = {error_of(plan, &e),
                      rays_of_sample(plan, t) + t->photon_rays * per_sample};
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
    for (int i = 0; i < 2; i++)
        if (t->maps[i])
            transport_photonmap.end_pass(t->maps[i]);
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
