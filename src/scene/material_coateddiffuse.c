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
    m->eta = eta_input(p, "eta", error);
    if (!m->eta || !roughness_input_init(&m->roughness, "", s, p, error) ||
        !coat_input_thickness(p, &thickness, error) ||
        !coat_input_count(p, "maxdepth", &depth, error) ||
        !coat_input_count(p, "nsamples", &samples, error) || !coat_input_medium(p, error))
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
