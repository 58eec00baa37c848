#include "transport/plan/path_trial.h"

#include "transport/plan/trial.h"
#include "transport/work.h"

/* A sample of plain path tracing: of caustics that are left out what came by way of
   another bounce stands apart. */
typedef struct path_sample {
    double light, bounced;
} path_sample;

static path_sample sample_path(const path_pass *pass, vec2 raster, sampler random,
                               transport_scratch *scratch)
{
    looked_around_forget(&scratch->estimate.looked);
    trial_light found =
        trial_sample(path_radiance, pass, pass->plan, raster, random, scratch);
    double bounced = pass->without_caustics ? found.caustic : 0.0;
    return (path_sample){found.all - bounced, bounced};
}

/* Two samples of a place. */
typedef struct sample_pair {
    vec2 raster;
    path_sample a, b;
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
    bool refused; /* memory was */
} pair_piece;

/* With so much of what was bounced. */
static double variance_of(const sample_pair *pair, double share)
{
    double off = pair->a.light - pair->b.light;
    off += share * (pair->a.bounced - pair->b.bounced);
    return 0.5 * off * off;
}

static sample_pair try_pair(const path_pass *pass, uint64_t key, size_t i,
                            point_hits *hits, transport_scratch *scratch)
{
    sampler random = sampler_make(key, i);
    sample_pair pair = {.raster = trial_place(pass->plan, &random)};
    if (pass->trial)
        pass->trial->weight =
            sketch_weight(pass->plan->sketch, pair.raster, SIZE_MAX, hits);
    pair.a = sample_path(pass, pair.raster, sampler_split(&random, 0), scratch);
    pair.b = sample_path(pass, pair.raster, sampler_split(&random, 1), scratch);
    return pair;
}

static void try_pairs(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const pair_trial *all = data;
    pair_piece *piece = &all->pieces[begin / LEAST_TRIALS];
    path_pass pass = *all->pass;
    transport_scratch scratch = {0};
    point_hits hits = {0};
    pass.without_lights = true;
    if (pass.lit)
        pass.lit = piece->lit = g_array_new(FALSE, FALSE, sizeof(lit_place));
    if (pass.trial)
        pass.trial = &piece->looks;
    for (size_t i = begin; i < end; i++)
        all->pairs[i] = try_pair(&pass, all->key, i, &hits, &scratch);
    piece->camera_rays = scratch.camera_rays;
    piece->shadow_rays = scratch.shadow_rays;
    piece->refused = hits.refused;
    point_hits_clear(&hits);
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

/* What all pieces say. @return false if memory was refused */
static bool join_pieces(transport_plan *plan, const pair_trial *all, size_t n,
                        path_effort *out)
{
    double camera_rays = 0.0, shadow_rays = 0.0, samples = 2.0 * out->n;
    bool refused = false;
    for (size_t i = 0; i < n; i++) {
        const pair_piece *piece = &all->pieces[i];
        camera_rays += (double)piece->camera_rays;
        shadow_rays += (double)piece->shadow_rays;
        refused |= piece->refused;
        join_notes(all->pass, piece);
        if (piece->lit)
            g_array_unref(piece->lit);
    }
    plan->planning += camera_rays + shadow_rays;
    out->rays = (camera_rays + shadow_rays) / samples;
    out->surfaces = camera_rays / samples;
    return !refused;
}

/* As many pairs as the shares allow, each of so many rays. */
static bool try_effort(transport_plan *plan, const path_pass *pass, uint64_t salt,
                       double shares, double rays, const cancel_flag *cancel,
                       path_effort *out, GError **error)
{
    out->n = plan_trials_for(plan, shares, rays, MOST_PLACES);
    out->pairs = g_new0(sample_pair, out->n);
    size_t n_pieces = (out->n + LEAST_TRIALS - 1) / LEAST_TRIALS;
    g_autofree pair_piece *pieces = g_new0(pair_piece, n_pieces);
    uint64_t key = hash_mix((uint64_t)plan->how.seed, salt);
    pair_trial all = {pass, key, pieces, out->pairs};
    const workers by = {(unsigned)plan->how.threads, cancel};
    bool ok = parallel_work(out->n, LEAST_TRIALS, by, try_pairs, &all, error);
    bool joined = join_pieces(plan, &all, n_pieces, out);
    return ok && (joined || point_hits_refuse(error));
}

static bool make_sketch(transport_plan *plan, const sample_pair *pairs, uint32_t n,
                        GError **error)
{
    g_autofree vec2 *places = g_new(vec2, n);
    g_autofree float *brightness = g_new(float, n);
    for (uint32_t i = 0; i < n; i++) {
        places[i] = pairs[i].raster;
        const path_sample *a = &pairs[i].a, *b = &pairs[i].b;
        brightness[i] = (float)(0.5 * (a->light + a->bounced + b->light + b->bounced));
    }
    plan->sketch = sketch_new(places, brightness, n, error);
    return plan->sketch;
}

/* The variance of a sample, relative to what the sketch says is there; a pair that is in
   it does not tell of itself. */
static bool measure_noise(const sketch *s, bool is_sketched, path_effort *of,
                          GError **error)
{
    point_hits hits = {0};
    square_sum plain = {0}, all = {0};
    for (uint32_t i = 0; i < of->n; i++) {
        const sample_pair *pair = &of->pairs[i];
        size_t itself = is_sketched ? i : SIZE_MAX;
        double weight = sketch_weight(s, pair->raster, itself, &hits);
        square_add(&plain, weight * variance_of(pair, 0.0));
        square_add(&all, weight * variance_of(pair, 1.0));
    }
    of->noise = square_total(&plain) / of->n;
    of->bounced = fmax(square_total(&all) / of->n - of->noise, 0.0);
    bool refused = hits.refused;
    point_hits_clear(&hits);
    return !refused || point_hits_refuse(error);
}

bool path_effort_weigh(const transport_plan *plan, path_effort *effort, GError **error)
{
    return measure_noise(plan->sketch, true, effort, error);
}

void path_effort_clear(path_effort *effort)
{
    g_clear_pointer(&effort->pairs, g_free);
}

bool path_noise_measure(transport_plan *plan, const path_pass *pass,
                        const cancel_flag *cancel, GError **error)
{
    g_auto(path_effort) effort = {0};
    if (!try_effort(plan, pass, 0x6e6f697365u, 0.5, 2.0 * plan->sample_rays, cancel,
                    &effort, error) ||
        !measure_noise(plan->sketch, false, &effort, error))
        return false;
    plan->path_noise = effort.noise;
    return true;
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
    if (!try_effort(plan, &pass, 0x627564676574u, 0.5, 2.0 * SAMPLE_RAYS, cancel, out,
                    error) ||
        !make_sketch(plan, out->pairs, out->n, error))
        return false;
    plan->lit = g_array_steal(lit, &plan->n_lit);
    return true;
}

/* ---- What bright spots are worth ---- */

/* Of two paths that look from each surface, about as long as two that do not. */
static double pair_rays(const transport_plan *plan)
{
    return 2.0 * 2.0 * fmax(plan->sample_rays, 1.0);
}

bool spots_fit(const transport_plan *plan)
{
    return plan_grant(plan, 1.0) >= LEAST_TRIALS * pair_rays(plan);
}

/* The error of the picture with that noise of paths, times work. */
static double product(const transport_plan *plan, plan_cost cost)
{
    return (cost.variance + plan->alike) * cost.rays;
}

/* What looks take away is added up without the chance of missing it, where the variance
   of paths that do not look would hang on the few that do not; what photons leave alike
   in neighbouring pixels stays, and only more passes take it away. */
void spots_choose_share(transport_plan *plan, const spot_trial *trial, double noise,
                        uint32_t n_pairs)
{
    double each = 1.0 / (2.0 * n_pairs), rest = fmax(noise - trial->with[0] * each, 0.0);
    plan_cost without = {rest + trial->without * each,
                         plan->sample_rays + plan->photon_rays};
    plan_cost best = {rest + trial->with[0] * each, without.rays + trial->rays * each};
    double least = CLEARLY_BETTER * product(plan, without);
    for (int i = 0; i < N_SHARES; i++) {
        double share = plan_share(i);
        plan_cost with = {rest + trial->with[i] * each,
                          without.rays + share * trial->rays * each};
        if (product(plan, with) >= least)
            continue;
        least = product(plan, with);
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
    g_auto(path_effort) effort = {0};
    path_pass trying = *pass;
    spot_trial trial = {0};
    trying.trial = &trial;
    trying.p_spots = 1.0f;
    if (!try_effort(plan, &trying, 0x73706f7473u, 1.0, pair_rays(plan), cancel, &effort,
                    error) ||
        !measure_noise(plan->sketch, false, &effort, error))
        return false;
    spots_choose_share(plan, &trial, effort.noise, effort.n);
    return true;
}
