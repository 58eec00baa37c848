#include "transport/budget.h"

#include "transport/visible.h"

enum {
    LEAST_PHOTONS = 20000, /* a pass, however small the picture */
    PHOTONS_PER_SAMPLE = 2,
    VISIBLE_POINTS = 512,
};

/* From this share of the light in sight on, a caustic is worth all photons. */
#define FULL_SHARE 0.001

/* A gather behind a diffuse bounce is one of many that a pixel averages, and is left to
   chance where it brings little: its probability over the share of light. */
#define BLURRED_PER_SHARE 4.0
#define LEAST_BLURRED 0.1

/* Fewer photons than this share of all are none, or if nothing else finds the light, so
   many. */
#define LEAST_WORTH 0.02

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

/* Irradiance at a visible point straight from the lights, by one sample. */
static double direct_irradiance(const scene *s, const visible_point *at, sampler *random)
{
    const wavelengths w = wavelengths_at(0.5f);
    light_numbers u = sampler_light(random);
    int index;
    light_sample to;
    if (!scene_sample_light(s, &w, at->p, u.light, u.primitive, u.place, &index, &to))
        return 0.0;
    float cosine = dot3(to.wi, at->n);
    const surface_hit here = {.p = at->p, .n_geom = at->n, .material = NO_INDEX};
    ray shadow = hit_ray_to(&here, to.wi, to.distance);
    if (!(cosine > 0.0f) || scene_occluded(s, &shadow))
        return 0.0;
    return (double)(spectrum_mean(to.radiance) * cosine / to.pdf);
}

/* Flux straight from the lights on what the camera sees. */
static double direct_flux(const transport_plan *plan)
{
    visible_point points[VISIBLE_POINTS];
    size_t n = find_visible_points(plan, VISIBLE_POINTS, points);
    const film_settings *film = &plan->scene->film;
    double pixels_each = (double)film->width * film->height / VISIBLE_POINTS, sum = 0.0;
    uint64_t key = hash_mix((uint64_t)plan->how.seed, 0x627564676574u);
    for (size_t i = 0; i < n; i++) {
        sampler random = sampler_make(key, i);
        double area = (double)(points[i].pixel * points[i].pixel) * pixels_each;
        sum += area * direct_irradiance(plan->scene, &points[i], &random);
    }
    return sum;
}

static bool has_delta_lights(const scene *s)
{
    for (unsigned i = 0; i < s->lights->len; i++) {
        if (scene_light(s, (int)i)->kind->is_delta)
            return true;
    }
    return false;
}

void caustic_budget_decide(transport_plan *plan, double flux)
{
    uint64_t *n = &plan->n_photons[PHOTON_CAUSTIC];
    plan->p_blurred = 1.0f;
    if (isinf(flux))
        return;
    double share = flux > 0.0 ? flux / (flux + direct_flux(plan)) : 0.0;
    double worth = fmin(1.0, sqrt(share / FULL_SHARE));
    plan->p_blurred = (float)CLAMP(BLURRED_PER_SHARE * share, LEAST_BLURRED, 1.0);
    if (plan->how.class_photons[PHOTON_CAUSTIC] > 0)
        return;
    bool needed = flux > 0.0 && has_delta_lights(plan->scene);
    if (worth < LEAST_WORTH)
        worth = needed ? LEAST_WORTH : 0.0;
    *n = worth > 0.0 ? (uint64_t)MAX(worth * (double)*n, 1.0) : 0;
}
