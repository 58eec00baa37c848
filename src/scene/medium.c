/*
 * Beer-Lambert's law, and free paths.
 */
#include "scene/medium.h"

#include <float.h>
#include <math.h>

static spectrum coefficient(const medium *m, const curve *c, const wavelengths *w)
{
    return c ? curve_eval(c, w) * m->scale : (spectrum){0};
}

spectrum medium_extinction(const medium *m, const wavelengths *w)
{
    return coefficient(m, m->absorption, w) + coefficient(m, m->scattering, w);
}

/* Over an endless way what is extinguished at all is gone, and 0 * FLT_MAX is 0. */
static spectrum transmittance(spectrum sigma_t, float t)
{
    return spectrum_exp(sigma_t * -minf(t, FLT_MAX));
}

spectrum medium_transmittance(const medium *m, float t, const wavelengths *w)
{
    spectrum out = spectrum_fill(1.0f);
    if (m->absorption || m->scattering)
        out = transmittance(medium_extinction(m, w), t);
    if (m->color) {
        spectrum color = curve_eval(m->color, w);
        for (int i = 0; i < N_LANES; i++)
            out[i] *= powf(color[i], t / m->distance);
    }
    return out;
}

/* ---- Free paths ---- */

/* Which wavelength's density t is drawn from, and each one's probability of that. What is
   left of u is uniform again. */
static int choose_lane(spectrum carried, float *u, spectrum *p)
{
    float sum = spectrum_sum(carried);
    *p = sum > 0.0f && isfinite(sum) ? carried / sum : spectrum_fill(1.0f / N_LANES);
    int lane = 0;
    while (lane < N_LANES - 1 && !(*u < (*p)[lane]))
        *u -= (*p)[lane++];
    *u = clampf(*u / maxf((*p)[lane], FLT_MIN), 0.0f, 0x1.fffffep-1f);
    return lane;
}

medium_sample medium_sample_free(const medium *m, const wavelengths *w, spectrum carried,
                                 float t_max, float u)
{
    spectrum p, sigma_s = coefficient(m, m->scattering, w),
                sigma_t = medium_extinction(m, w);
    int lane = choose_lane(carried, &u, &p);
    float t = sigma_t[lane] > 0.0f ? -log1pf(-u) / sigma_t[lane] : INFINITY;
    bool scatters = t < t_max;
    spectrum left = transmittance(sigma_t, scatters ? t : t_max);
    float density = spectrum_sum(p * (scatters ? sigma_t * left : left));
    if (!(density > 0.0f))
        return (medium_sample){.t = t_max};
    return (medium_sample){
        .scatters = scatters,
        .t = scatters ? t : t_max,
        .weight = (scatters ? sigma_s * left : left) / density,
    };
}

/* 1 - T(t_max) */
static spectrum lost(spectrum sigma_t, float t_max)
{
    for (int i = 0; i < N_LANES; i++)
        sigma_t[i] = -expm1f(-sigma_t[i] * minf(t_max, FLT_MAX));
    return sigma_t;
}

medium_sample medium_sample_within(const medium *m, const wavelengths *w,
                                   spectrum carried, float t_max, float u)
{
    spectrum p, sigma_s = coefficient(m, m->scattering, w),
                sigma_t = medium_extinction(m, w);
    spectrum ends = lost(sigma_t, t_max), density = {0};
    for (int i = 0; i < N_LANES; i++) /* a clear lane has no path that ends within */
        carried[i] = ends[i] > 0.0f ? carried[i] : 0.0f;
    int lane = choose_lane(carried, &u, &p);
    float t = sigma_t[lane] > 0.0f ? -log1pf(-u * ends[lane]) / sigma_t[lane] : 0.0f;
    spectrum left = transmittance(sigma_t, t);
    for (int i = 0; i < N_LANES; i++)
        density[i] = ends[i] > 0.0f ? sigma_t[i] * left[i] / ends[i] : 0.0f;
    float sum = spectrum_sum(p * density);
    return (medium_sample){
        .scatters = sum > 0.0f && t<t_max, .t = t, .weight = sum> 0.0f
                        ? sigma_s * left / sum
                        : (spectrum){0},
    };
}
