#include "transport/plan/path_trial.h"

#include "transport/plan/trial.h"
#include "transport/work.h"

/* A sample of plain path tracing. */
static double path_sample(const path_pass *pass, vec2 raster, sampler random,
                          transport_scratch *scratch)
{
    looked_around_forget(&scratch->estimate.looked);
    return trial_sample(path_radiance, pass, pass->plan, raster, random, scratch).all;
}

/* Two samples of a place. */
typedef struct sample_pair {
    vec2 raster;
    double a, b;
} sample_pair;

/* Pairs of samples at random places, without the lights that are seen: at their edges and
   through fog noise is as bright as they are, and nothing that is decided takes it away.
   And what is noted meanwhile: all by pieces of LEAST_TRIALS of them, so that any number
   of threads finds the same. */
typedef struct pair_trial {
    const path_pass *pass;
    uint64_t key;
    struct pair_piece *pieces;
    sample_pair *pairs; /* one each */
} pair_trial;

typedef struct pair_piece {
    uint64_t camera_rays, shadow_rays;
    spot_trial looks;
    GArray *lit;
} pair_piece;

/* What all pieces say. */
typedef struct pair_result {
    double variance; /* of a sample */
    uint64_t camera_rays, shadow_rays;
} pair_result;

static double variance_of(const sample_pair *pair)
{
    return 0.5 * (pair->a - pair->b) * (pair->a - pair->b);
}

static sample_pair try_pair(const path_pass *pass, uint64_t key, size_t i,
                            transport_scratch *scratch)
{
    sampler random = sampler_make(key, i);
    sample_pair pair = {.raster = trial_place(pass->plan, &random)};
    pair.a = path_sample(pass, pair.raster, sampler_split(&random, 0), scratch);
    pair.b = path_sample(pass, pair.raster, sampler_split(&random, 1), scratch);
    return pair;
}

static void try_pairs(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const pair_trial *all = data;
    pair_piece *piece = &all->pieces[begin / LEAST_TRIALS];
    path_pass pass = *all->pass;
    transport_scratch scratch = {0};
    pass.without_lights = true;
    if (pass.lit)
        pass.lit = piece->lit = g_array_new(FALSE, FALSE, sizeof(lit_place));
    if (pass.trial)
        pass.trial = &piece->looks;
    for (size_t i = begin; i < end; i++)
        all->pairs[i] = try_pair(&pass, all->key, i, &scratch);
    piece->camera_rays = scratch.camera_rays;
    piece->shadow_rays = scratch.shadow_rays;
    transport_scratch_clear(&scratch);
}

/* Adds what was noted to what the pass notes into. */
static void join_notes(const path_pass *pass, const pair_piece *piece)
{
    if (pass->trial)
        spot_trial_add(pass->trial, &piece->looks);
    if (pass->lit && piece->lit)
        g_array_append_vals(pass->lit, piece->lit->data,
                            MIN(piece->lit->len, MOST_PLACES - pass->lit->len));
}

/* n pairs of samples at random places. */
static bool run_pairs(const path_pass *pass, uint64_t key, uint32_t n, sample_pair *pairs,
                      const cancel_flag *cancel, pair_result *out, GError **error)
{
    size_t n_pieces = (n + LEAST_TRIALS - 1) / LEAST_TRIALS;
    pair_trial all = {pass, key, g_new0(pair_piece, n_pieces), pairs};
    const workers by = {(unsigned)pass->plan->how.threads, cancel};
    bool ok = parallel_work(n, LEAST_TRIALS, by, try_pairs, &all, error);
    *out = (pair_result){0};
    for (size_t i = 0; i < n_pieces; i++) {
        const pair_piece *piece = &all.pieces[i];
        out->camera_rays += piece->camera_rays;
        out->shadow_rays += piece->shadow_rays;
        join_notes(pass, piece);
        if (piece->lit)
            g_array_unref(piece->lit);
    }
    for (uint32_t i = 0; i < n; i++)
        out->variance += variance_of(&pairs[i]) / n;
    g_free(all.pieces);
    return ok;
}

static bool make_sketch(transport_plan *plan, const sample_pair *pairs, uint32_t n,
                        GError **error)
{
    g_autofree vec2 *places = g_new(vec2, n);
    g_autofree float *brightness = g_new(float, n);
    for (uint32_t i = 0; i < n; i++) {
        places[i] = pairs[i].raster;
        brightness[i] = (float)(0.5 * (pairs[i].a + pairs[i].b));
    }
    plan->sketch = sketch_new(places, brightness, n, error);
    return plan->sketch;
}

/* The variance of a sample relative to what its neighbours say is there. */
static bool measure_noise(const sketch *s, const sample_pair *pairs, uint32_t n,
                          double *noise, GError **error)
{
    point_hits hits = {0};
    square_sum sum = {0};
    for (uint32_t i = 0; i < n; i++)
        square_add(&sum,
                   variance_of(&pairs[i]) * sketch_weight(s, pairs[i].raster, i, &hits));
    *noise = square_total(&sum) / n;
    bool refused = hits.refused;
    point_hits_clear(&hits);
    return !refused || point_hits_refuse(error);
}

/* Of n pairs. */
static path_effort effort_of(const pair_result *found, uint32_t n)
{
    return (path_effort){
        .rays = (double)(found->camera_rays + found->shadow_rays) / (2.0 * n),
        .surfaces = (double)found->camera_rays / (2.0 * n),
    };
}

bool path_effort_measure(transport_plan *plan, const cancel_flag *cancel,
                         path_effort *out, GError **error)
{
    g_autoptr(GArray) lit = g_array_new(FALSE, FALSE, sizeof *plan->lit);
    const path_pass pass = {.plan = plan,
                            .lit = plan->how.bright_spots ? lit : NULL,
                            .without_caustics = true,
                            .w = scene_trial_wavelengths(plan->scene, 0),
                            .options.deterministic = !plan->how.multiple_samples};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    uint32_t n = plan_trials_for(plan, 0.5, 2.0 * SAMPLE_RAYS, MOST_PLACES);
    pair_result found;
    g_autofree sample_pair *pairs = g_new0(sample_pair, n);
    if (!run_pairs(&pass, key, n, pairs, cancel, &found, error))
        return false;
    plan->planning += (double)(found.camera_rays + found.shadow_rays);
    *out = effort_of(&found, n);
    if (!make_sketch(plan, pairs, n, error) ||
        !measure_noise(plan->sketch, pairs, n, &out->noise, error))
        return false;
    plan->lit = g_array_steal(lit, &plan->n_lit);
    return true;
}

/* ---- What bright spots are worth ---- */

/* Paths that look from each surface. */
static bool run_spot_trial(transport_plan *plan, const path_pass *pass, uint32_t n_pairs,
                           const cancel_flag *cancel, spot_trial *trial, double *noise,
                           GError **error)
{
    path_pass trying = *pass;
    pair_result found;
    g_autofree sample_pair *pairs = g_new0(sample_pair, n_pairs);
    trying.trial = trial;
    trying.p_spots = 1.0f;
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x73706f7473u);
    if (!run_pairs(&trying, key, n_pairs, pairs, cancel, &found, error))
        return false;
    plan->planning += (double)(found.camera_rays + found.shadow_rays);
    *noise = found.variance;
    return true;
}

/* Of two paths that look from each surface, about as long as two that do not. */
static double pair_rays(const transport_plan *plan)
{
    return 2.0 * 2.0 * fmax(plan->sample_rays, 1.0);
}

bool spots_fit(const transport_plan *plan)
{
    return plan_grant(plan, 1.0) >= LEAST_TRIALS * pair_rays(plan);
}

/* The share of surfaces that had best look. What looks take away is added up without the
   chance of missing it, where the variance of paths that do not look would hang on the
   few that do not. */
static void choose_share(transport_plan *plan, const spot_trial *trial, double noise,
                         uint32_t n_pairs)
{
    double each = 1.0 / (2.0 * n_pairs), rest = fmax(noise - trial->with[0] * each, 0.0);
    plan_cost without = {rest + trial->without * each,
                         plan->sample_rays + plan->photon_rays};
    plan_cost best = {rest + trial->with[0] * each, without.rays + trial->rays * each};
    double least = CLEARLY_BETTER * without.variance * without.rays;
    for (int i = 0; i < N_SHARES; i++) {
        double share = plan_share(i);
        plan_cost with = {rest + trial->with[i] * each,
                          without.rays + share * trial->rays * each};
        if (with.variance * with.rays >= least)
            continue;
        least = with.variance * with.rays;
        best = with;
        plan->p_spots = (float)share;
    }
    if (plan->p_spots > 0.0f)
        plan->path_noise *= best.variance / without.variance;
    plan_note(plan, "bright spots", without, best, plan->p_spots > 0.0f);
}

bool spots_decide(transport_plan *plan, const path_pass *pass, const cancel_flag *cancel,
                  GError **error)
{
    uint32_t n = plan_trials_for(plan, 1.0, pair_rays(plan), MOST_PLACES);
    spot_trial trial = {0};
    double noise;
    if (!run_spot_trial(plan, pass, n, cancel, &trial, &noise, error))
        return false;
    choose_share(plan, &trial, noise, n);
    return true;
}
