/*
 * "coateddiffuse": pbrt-v4's plastic, a diffuse base under a dielectric coat.
 *
 * The coat may absorb (thickness) but not scatter: an albedo > 0 of the medium in it is
 * refused, and g, which is that medium's, means nothing without it. nsamples steers how
 * noisy pbrt's random walk is; here there is no walk, and no noise. maxdepth ends the
 * series of reflections between base and coat where pbrt's walk would end.
 */
#include "scene/bsdf_models.h"
#include "scene/material_inputs.h"
#include "scene/material_kinds.h"

typedef struct plastic {
    spectrum_input reflectance;
    roughness_input roughness;
    curve *eta;
    coat_table *table;
    int bounces; /* off the base, at most */
} plastic;

static void plastic_free(void *self)
{
    plastic *m = self;
    spectrum_input_clear(&m->reflectance);
    curve_unref(m->eta);
    coat_table_free(m->table);
    g_free(m);
}

static bool check_medium(const params *p, GError **error)
{
    g_autoptr(curve) albedo = NULL;
    float g = 0.0f, most = 0.0f;
    if (!params_curve(p, "albedo", CURVE_ALBEDO, &albedo, error) ||
        !params_float(p, "g", &g, error))
        return false;
    for (float nm = LAMBDA_MIN; albedo && nm <= LAMBDA_MAX; nm += 5.0f)
        most = maxf(most, curve_at(albedo, nm));
    if (most > 1e-4f) {
        error_at(error, params_find(p, "albedo")->place,
                 "parameter 'albedo': a coat that scatters is not supported, expected 0");
        return false;
    }
    if (fabsf(g) > 1.0f) {
        error_at(error, params_find(p, "g")->place,
                 "parameter 'g': expected a number in -1..1, found %g", (double)g);
        return false;
    }
    return true;
}

static bool read_count(const params *p, const char *name, int *out, GError **error)
{
    if (!params_integer(p, name, out, error))
        return false;
    if (*out >= 1)
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a number >= 1, found %d", name, *out);
    return false;
}

static bool read_thickness(const params *p, float *out, GError **error)
{
    *out = 0.01f;
    if (!params_float(p, "thickness", out, error))
        return false;
    if (*out >= 0.0f)
        return true;
    error_at(error, params_find(p, "thickness")->place,
             "parameter 'thickness': expected a number >= 0, found %g", (double)*out);
    return false;
}

static coat_range range_of(const plastic *m, float thickness)
{
    coat_range range = {
        .alpha_max = 1.0f, .eta_min = INFINITY, .eta_max = 0.0f, .thickness = thickness};
    if (roughness_input_is_constant(&m->roughness)) {
        ggx g = roughness_input_eval(&m->roughness, NULL);
        range.alpha_min = minf(g.alpha_x, g.alpha_y);
        range.alpha_max = maxf(g.alpha_x, g.alpha_y);
    }
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f) {
        range.eta_min = minf(range.eta_min, curve_at(m->eta, nm));
        range.eta_max = maxf(range.eta_max, curve_at(m->eta, nm));
    }
    return range;
}

static bool read_coat(plastic *m, const struct scene *s, const params *p, GError **error)
{
    int depth = 10, samples = 1;
    float thickness;
    m->eta = eta_input(p, error);
    if (!m->eta || !roughness_input_init(&m->roughness, s, p, error) ||
        !read_thickness(p, &thickness, error) ||
        !read_count(p, "maxdepth", &depth, error) ||
        !read_count(p, "nsamples", &samples, error) || !check_medium(p, error))
        return false;
    /* The walk meets base and coat in turn. */
    m->bounces = depth / 2 + depth % 2;
    coat_range range = range_of(m, thickness);
    m->table = coat_table_new(&range);
    return true;
}

static void *plastic_create(const struct scene *s, const params *p, GError **error)
{
    plastic *m = g_new0(plastic, 1);
    if (spectrum_input_init(&m->reflectance, s, p, "reflectance", CURVE_ALBEDO,
                            curve_constant(0.5f), error) &&
        read_coat(m, s, p, error))
        return m;
    plastic_free(m);
    return NULL;
}

static void plastic_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                         const bsdf_options *options, bsdf *out)
{
    const plastic *m = self;
    spectrum rho = spectrum_input_eval(&m->reflectance, hit, w);
    rho = spectrum_clamp(rho, 0.0f, 1.0f);
    if (options->deterministic)
        bsdf_make_diffuse(out, rho);
    else
        bsdf_make_coated(out, rho, curve_eval(m->eta, w),
                         roughness_input_eval(&m->roughness, hit), m->table, m->bounces);
}

static unsigned plastic_lobes(const void *self)
{
    const plastic *m = self;
    return roughness_input_classes(&m->roughness) | LOBE_DIFFUSE | LOBE_REFLECTION;
}

const material_kind material_coated_diffuse = {
    .name = "coateddiffuse",
    .parameters = "reflectance eta roughness uroughness vroughness remaproughness "
                  "thickness maxdepth nsamples albedo g",
    .create = plastic_create,
    .free = plastic_free,
    .make_bsdf = plastic_bsdf,
    .possible_lobes = plastic_lobes,
};
