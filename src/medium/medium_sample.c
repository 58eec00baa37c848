#include "medium/medium_sample.h"

#include <math.h>

/* The part of all points that are drawn near a pivot, of those that scatter. */
#define NEAR_SHARE 0.5f

/* A ray passes no pivot nearer than at this share of its distance from the origin: closer
   the density would serve one point only. */
#define LEAST_DISTANCE 1e-3f

/* How free paths are distributed. */
typedef struct free_paths {
    spectrum p; /* of each wavelength's density */
    spectrum sigma_s, sigma_t;
    spectrum ends; /* 1 - T(t_max) */
    float t_max;
} free_paths;

static spectrum shares(spectrum throughput)
{
    float sum = spectrum_sum(throughput);
    return sum > 0.0f && isfinite(sum) ? throughput / sum
                                       : spectrum_fill(1.0f / N_WAVELENGTHS);
}

static free_paths free_paths_of(const medium *m, const wavelengths *w,
                                spectrum throughput, float t_max)
{
    free_paths f = {
        .sigma_s = medium_scattering(m, w),
        .sigma_t = medium_extinction(m, w),
        .p = shares(throughput),
        .t_max = t_max,
    };
    for (int i = 0; i < N_WAVELENGTHS; i++)
        f.ends[i] = -expm1f(-f.sigma_t[i] * minf(t_max, FLT_MAX));
    return f;
}

/* Which wavelength's density t is drawn from. What is left of u is uniform again. */
static int choose_wavelength(spectrum p, float *u)
{
    int wavelength = 0;
    while (wavelength < N_WAVELENGTHS - 1 && !(*u < p[wavelength]))
        *u -= p[wavelength++];
    *u = clampf(*u / maxf(p[wavelength], FLT_MIN), 0.0f, 0x1.fffffep-1f);
    return wavelength;
}

/* All of them, and those that end within: a clear wavelength has none. */
static float draw_free(const free_paths *f, float u)
{
    int wavelength = choose_wavelength(f->p, &u);
    float sigma_t = f->sigma_t[wavelength];
    return sigma_t > 0.0f ? -log1pf(-u) / sigma_t : INFINITY;
}

static float draw_within(const free_paths *f, float u)
{
    int wavelength = choose_wavelength(f->p, &u);
    float sigma_t = f->sigma_t[wavelength];
    return sigma_t > 0.0f ? -log1pf(-u * f->ends[wavelength]) / sigma_t : 0.0f;
}

static void leave_clear_wavelengths_out(free_paths *f)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        f->p[i] = f->ends[i] > 0.0f ? f->p[i] : 0.0f;
    f->p = shares(f->p);
}

/* The density at t; from t_max on the probability of getting there. */
static float density_free(const free_paths *f, spectrum transmittance, float t)
{
    return spectrum_sum(f->p *
                        (t < f->t_max ? f->sigma_t * transmittance : transmittance));
}

static float density_within(const free_paths *f, spectrum transmittance)
{
    spectrum density;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        density[i] =
            f->ends[i] > 0.0f ? f->sigma_t[i] * transmittance[i] / f->ends[i] : 0.0f;
    return spectrum_sum(f->p * density);
}

/* What a point at t, or getting to t_max, counts with this density. */
static medium_sample weigh(const free_paths *f, spectrum transmittance, float t,
                           float density)
{
    bool scatters = t < f->t_max && density > 0.0f;
    medium_sample out = {.scatters = scatters, .t = scatters ? t : f->t_max};
    if (density > 0.0f)
        out.weight = (scatters ? f->sigma_s * transmittance : transmittance) / density;
    return out;
}

medium_sample medium_sample_free(const medium *m, const wavelengths *w,
                                 spectrum throughput, float t_max, float u)
{
    const free_paths f = free_paths_of(m, w, throughput, t_max);
    float t = minf(draw_free(&f, u), t_max);
    spectrum transmittance = transmittance_after(f.sigma_t, t);
    return weigh(&f, transmittance, t, density_free(&f, transmittance, t));
}

/* A point that is drawn within but rounded to t_max counts nothing. */
static medium_sample only_within(const free_paths *f, spectrum transmittance, float t,
                                 float density)
{
    return t < f->t_max ? weigh(f, transmittance, t, density)
                        : (medium_sample){.t = f->t_max};
}

medium_sample medium_sample_within(const medium *m, const wavelengths *w,
                                   spectrum throughput, float t_max, float u)
{
    free_paths f = free_paths_of(m, w, throughput, t_max);
    leave_clear_wavelengths_out(&f);
    float t = draw_within(&f, u);
    spectrum transmittance = transmittance_after(f.sigma_t, t);
    return only_within(&f, transmittance, t, density_within(&f, transmittance));
}

/* ---- Near a pivot ---- */

medium_pivot medium_pivot_at(const ray *r, vec3 p, line_span lit)
{
    vec3 to = p - r->origin;
    float t = dot3(to, r->direction), away = length3(to);
    float distance = length3(to - t * r->direction);
    return (medium_pivot){t, maxf(maxf(distance, LEAST_DISTANCE * away), FLT_MIN), lit};
}

/* The angles under which the pivot sees the ends of what it lights, from where the ray is
   nearest. */
typedef struct view {
    float from, to;
} view;

static float angle_at(const medium_pivot *pivot, float t)
{
    return isinf(t) ? 0.5f * PI_F : atanf((t - pivot->t) / pivot->distance);
}

static view view_of(const medium_pivot *pivot)
{
    return (view){angle_at(pivot, pivot->lit.begin), angle_at(pivot, pivot->lit.end)};
}

static float draw_near(const medium_pivot *pivot, float u)
{
    view v = view_of(pivot);
    float t = pivot->t + pivot->distance * tanf(lerpf(v.from, v.to, u));
    return clampf(t, pivot->lit.begin, nextafterf(pivot->lit.end, 0.0f));
}

static float density_near(const medium_pivot *pivot, float t)
{
    view v = view_of(pivot);
    float d = pivot->distance, along = t - pivot->t, angle = v.to - v.from;
    bool lit = t >= pivot->lit.begin && t < pivot->lit.end && angle > 0.0f;
    return lit ? d / (angle * (d * d + along * along)) : 0.0f;
}

medium_sample medium_sample_free_near(const medium *m, const wavelengths *w,
                                      spectrum throughput, float t_max,
                                      const medium_pivot *pivot, float u)
{
    const free_paths f = free_paths_of(m, w, throughput, t_max);
    float near = NEAR_SHARE * spectrum_sum(f.p * f.ends);
    float t = u < near ? draw_near(pivot, u / near)
                       : minf(draw_free(&f, (u - near) / (1.0f - near)), t_max);
    spectrum transmittance = transmittance_after(f.sigma_t, t);
    float density = (1.0f - near) * density_free(&f, transmittance, t);
    density += near * density_near(pivot, t);
    return weigh(&f, transmittance, t, density);
}

medium_sample medium_sample_within_near(const medium *m, const wavelengths *w,
                                        spectrum throughput, float t_max,
                                        const medium_pivot *pivot, float u)
{
    const float near = NEAR_SHARE;
    free_paths f = free_paths_of(m, w, throughput, t_max);
    leave_clear_wavelengths_out(&f);
    float t = u < near ? draw_near(pivot, u / near)
                       : draw_within(&f, (u - near) / (1.0f - near));
    spectrum transmittance = transmittance_after(f.sigma_t, t);
    float density =
        (1.0f - near) * density_within(&f, transmittance) + near * density_near(pivot, t);
    return only_within(&f, transmittance, t, density);
}
