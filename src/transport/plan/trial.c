#include "transport/plan/trial.h"

#include <math.h>

vec2 trial_place(const transport_plan *plan, sampler *random)
{
    const film_settings *film = &plan->view->film;
    vec2 u = sampler_2d(random);
    return (vec2){u.x * (float)film->width, u.y * (float)film->height};
}

static double mean_of(spectrum s)
{
    double mean = (double)spectrum_mean(s);
    return isfinite(mean) ? mean : 0.0;
}

void square_add(square_sum *to, double square)
{
    to->sum += square;
    to->second = fmax(to->second, fmin(square, to->loudest));
    to->loudest = fmax(to->loudest, square);
}

double square_total(const square_sum *of)
{
    return of->sum - of->loudest + of->second;
}

trial_light trial_sample(radiance_function *radiance, const void *pass,
                         const transport_plan *plan, vec2 raster, sampler random,
                         transport_scratch *scratch)
{
    radiance_sample out = {.groups = NULL};
    spectrum sum = {0};
    vec2 u_lens = sampler_2d(&random);
    ray r = camera_ray(&plan->view->camera, raster, u_lens, sampler_1d(&random));
    radiance(pass, &r, &random, scratch, &out);
    for (unsigned i = 0; i < N_LAYERS; i++)
        sum += i == LAYER_EMISSION ? spectrum_fill(0.0f) : out.layers[i];
    const light_guide *seen = &out.guide;
    sum -= seen->lights + seen->glints;
    float share = seen->weight > 0.0f ? 1.0f / seen->weight : 0.0f;
    float depth = seen->depth * share;
    const camera *c = &plan->view->camera;
    return (trial_light){
        .all = mean_of(sum),
        .caustic = mean_of(out.layers[LAYER_CAUSTIC]),
        .scattered = mean_of(out.scattered),
        .albedo = mean_of(seen->albedo * share),
        .area = depth > 0.0f ? (double)camera_pixel_area(c, depth) : 0.0,
        .p = r.origin + depth * r.direction,
    };
}
