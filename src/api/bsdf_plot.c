/*
 * A material's scattering in the plane of incidence, as numbers for a polar diagram.
 *
 *      light ╲  │  ╱ 45°          angles from the normal, to the right
 *             ╲ │ ╱
 *      ────────╲│╱──────── 90°
 *               │
 *              180°               beyond the surface
 *
 * Spectra are seen under D65 and turned into linear sRGB, so that a white material has
 * the same value three times. A bare sphere of directions is queried: textures are taken
 * at (0.5, 0.5).
 */
#include "api/objects.h"

#include "color/curve.h"

#include <math.h>

enum {
    OFFSETS = 8,      /* sets of wavelengths averaged */
    LEAST_ANGLES = 4, /* that make a plot */
    MOST_ANGLES = 1 << 20,
    RAY_SAMPLES = 256, /* to find mirrored and refracted light */
    WALKS = 128,       /* through coats */
};

/* Nearer to the horizon nothing comes in, degrees. */
#define MOST_INCIDENCE 89.0

/* What all directions of one set of wavelengths share. */
typedef struct plot_query {
    wavelengths w;
    spectrum white;
    bsdf bsdf;
    vec3 light; /* to where the light comes from, unit */
} plot_query;

static surface_hit flat_hit(void)
{
    return (surface_hit){.n_geom = vec3_make(0, 0, 1),
                         .n = vec3_make(0, 0, 1),
                         .dpdu = vec3_make(1, 0, 0),
                         .uv = {0.5f, 0.5f},
                         .t = 1.0f,
                         .light = NO_INDEX};
}

static vec3 direction_at(double degrees)
{
    double a = degrees * G_PI / 180.0;
    return vec3_make((float)sin(a), 0.0f, (float)cos(a));
}

static void plot_query_init(plot_query *q, const material *m, double incidence,
                            int offset)
{
    const bsdf_options options = {.least_walks = WALKS};
    const surface_hit hit = flat_hit();
    g_autoptr(curve) d65 = curve_named("stdillum-D65");
    q->w = wavelengths_at(((float)offset + 0.5f) / OFFSETS);
    q->white = curve_eval(d65, &q->w) / curve_photometric(d65);
    q->light = direction_at(-incidence);
    material_bsdf(m, &hit, &q->w, ALL_WAVELENGTHS, &options, &q->bsdf);
}

static void add_color(const plot_query *q, spectrum value, float share, float rgb[3])
{
    float xyz[3], one[3];
    spectrum_to_xyz(&q->w, value * q->white, xyz);
    color_space_from_xyz(color_space_srgb(), xyz, one);
    for (int k = 0; k < 3; k++)
        rgb[k] += share * one[k];
}

static void add_spread(const plot_query *q, NephBsdfPlot *plot)
{
    for (size_t i = 0; i < plot->n; i++) {
        vec3 out = direction_at(360.0 * (double)i / (double)plot->n);
        spectrum f = bsdf_eval(&q->bsdf, q->light, out, LOBE_ALL, TRANSPORT_IMPORTANCE);
        add_color(q, f, 1.0f / OFFSETS, plot->rgb + 3 * i);
    }
}

/* Light that keeps one direction: summed apart for each side, [0] reflected. */
typedef struct ray_sum {
    float rgb[3];
    double x, z; /* Σ of directions, by weight */
} ray_sum;

static void add_rays(const plot_query *q, ray_sum sums[2])
{
    for (int i = 0; i < RAY_SAMPLES; i++) {
        bsdf_sample s;
        vec2 u = {fmodf(0.754877f * (float)i, 1.0f), fmodf(0.569840f * (float)i, 1.0f)};
        float choice = ((float)i + 0.5f) / RAY_SAMPLES;
        if (!bsdf_sample_direction(&q->bsdf, q->light, choice, u, LOBE_ALL,
                                   TRANSPORT_IMPORTANCE, &s) ||
            !(s.lobe & LOBE_SPECULAR))
            continue;
        ray_sum *sum = &sums[s.lobe & LOBE_TRANSMISSION ? 1 : 0];
        double weight = (double)spectrum_mean(s.weight);
        add_color(q, s.weight, 1.0f / (OFFSETS * RAY_SAMPLES), sum->rgb);
        sum->x += weight * (double)s.wi[0];
        sum->z += weight * (double)s.wi[2];
    }
}

static void finish(NephBsdfPlot *plot, const ray_sum sums[2])
{
    for (size_t i = 0; i < 3 * plot->n; i++)
        plot->rgb[i] = fmaxf(plot->rgb[i], 0.0f);
    for (int side = 0; side < 2; side++) {
        if (!(hypot(sums[side].x, sums[side].z) > 0.0))
            continue;
        NephBsdfRay *out = &plot->rays[plot->n_rays++];
        out->angle = atan2(sums[side].x, sums[side].z) * 180.0 / G_PI;
        if (out->angle < 0.0)
            out->angle += 360.0;
        for (int k = 0; k < 3; k++)
            out->rgb[k] = fmaxf(sums[side].rgb[k], 0.0f);
    }
}

NephBsdfPlot *neph_bsdf_plot(const NephScene *s, size_t i, double incidence, size_t n,
                             GError **error)
{
    if (i >= s->scene->materials->len) {
        error_set(error, ERROR_USAGE, "material %zu: the scene has %u", i,
                  s->scene->materials->len);
        return NULL;
    }
    if (!(incidence >= 0.0 && incidence <= MOST_INCIDENCE) || n < LEAST_ANGLES ||
        n > MOST_ANGLES) {
        error_set(error, ERROR_USAGE,
                  "a plot needs an incidence of 0 to %g degrees and %d to %d directions",
                  MOST_INCIDENCE, LEAST_ANGLES, MOST_ANGLES);
        return NULL;
    }
    NephBsdfPlot *plot = g_new0(NephBsdfPlot, 1);
    *plot = (NephBsdfPlot){.incidence = incidence, .n = n, .rgb = g_new0(float, 3 * n)};
    ray_sum sums[2] = {0};
    for (int offset = 0; offset < OFFSETS; offset++) {
        plot_query q;
        plot_query_init(&q, s->scene->materials->pdata[i], incidence, offset);
        add_spread(&q, plot);
        add_rays(&q, sums);
    }
    finish(plot, sums);
    return plot;
}

void neph_bsdf_plot_free(NephBsdfPlot *plot)
{
    if (!plot)
        return;
    g_free(plot->rgb);
    g_free(plot);
}
