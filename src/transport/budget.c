#include "transport/budget.h"

#include "transport/path.h"

enum {
    LEAST_PHOTONS = 20000, /* a pass, however small the picture */
    PHOTONS_PER_SAMPLE = 2,
    PAIRS = 1024,
};

/* Fewer photons than this share of all are none, or if nothing else finds the light, so
   many. A caustic that adds a hundredth to the variance is not seen for it. */
#define LEAST_WORTH 0.1

uint64_t caustic_budget(const transport_plan *plan)
{
    const settings *how = &plan->how;
    const film_settings *film = &plan->scene->film;
    int64_t own = how->class_photons[PHOTON_CAUSTIC];
    int64_t samples = (int64_t)film->width * film->height * how->spp;
    int64_t most = MAX(PHOTONS_PER_SAMPLE * samples, LEAST_PHOTONS);
    if (plan->scene->n_casters == 0)
        return 0;
    return (uint64_t)(own > 0 ? own : MIN(how->photons, most));
}

/* A sample of plain path tracing through a place of the film: mean over wavelengths. */
static double path_sample(const path_pass *pass, vec2 raster, sampler random,
                          transport_scratch *scratch)
{
    radiance_sample out = {.groups = NULL};
    spectrum sum = {0};
    vec2 u_lens = sampler_2d(&random);
    ray r = camera_ray(&pass->plan->scene->camera, raster, u_lens, sampler_1d(&random));
    path_radiance(pass, &r, &random, scratch, &out);
    for (int i = 0; i < N_LAYERS; i++) {
        if (i != LAYER_CAUSTIC)
            sum += out.layers[i];
    }
    return (double)spectrum_mean(sum);
}

/* The square of a camera sample's noise, caustics apart: from pairs of samples. */
static double rest_noise(const transport_plan *plan)
{
    const film_settings *film = &plan->scene->film;
    transport_scratch scratch = {0};
    const path_pass pass = {.plan = plan,
                            .w = wavelengths_at(0.5f),
                            .options.deterministic = !plan->how.multiple_samples};
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    double sum = 0.0;
    for (uint32_t i = 0; i < PAIRS; i++) {
        sampler random = sampler_make(key, i);
        vec2 u = sampler_2d(&random);
        vec2 raster = {u.x * (float)film->width, u.y * (float)film->height};
        double a = path_sample(&pass, raster, sampler_split(&random, 0), &scratch);
        double b = path_sample(&pass, raster, sampler_split(&random, 1), &scratch);
        sum += isfinite(a + b) ? 0.5 * (a - b) * (a - b) : 0.0;
    }
    transport_scratch_clear(&scratch);
    return sum / PAIRS;
}

static bool has_delta_lights(const scene *s)
{
    for (unsigned i = 0; i < s->lights->len; i++) {
        if (scene_light(s, (int)i)->kind->is_delta)
            return true;
    }
    return false;
}

void caustic_budget_decide(transport_plan *plan, double noise)
{
    uint64_t *n = &plan->n_photons[PHOTON_CAUSTIC];
    plan->p_blurred = 1.0f;
    if (isinf(noise))
        return;
    double rest = noise > 0.0 ? rest_noise(plan) : 1.0;
    double worth = rest > 0.0 ? fmin(1.0, sqrt(noise / rest)) : 1.0;
    plan->p_blurred = (float)fmax(worth, LEAST_WORTH);
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0)
        return;
    bool needed = noise > 0.0 && has_delta_lights(plan->scene);
    if (worth < LEAST_WORTH)
        worth = needed ? LEAST_WORTH : 0.0;
    *n = worth > 0.0 ? (uint64_t)MAX(worth * (double)*n, 1.0) : 0;
}
