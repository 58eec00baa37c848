/*
 * "conductor": a metal by its measured index eta + i k (copper by default), or by its
 * reflectance at normal incidence, which pbrt-v4 turns into eta = 1 and
 * k = 2 sqrt(r / (1 - r)).
 */
#include "scene/bsdf_models.h"
#include "scene/material_inputs.h"
#include "scene/material_kinds.h"

typedef struct metal {
    spectrum_input eta, k, reflectance;
    roughness_input roughness;
} metal;

static void metal_free(void *self)
{
    metal *m = self;
    spectrum_input_clear(&m->eta);
    spectrum_input_clear(&m->k);
    spectrum_input_clear(&m->reflectance);
    g_free(m);
}

static bool read_index(metal *m, const struct scene *s, const params *p, GError **error)
{
    return spectrum_input_init(&m->eta, s, p, "eta", CURVE_UNBOUNDED,
                               curve_named("metal-Cu-eta"), error) &&
           spectrum_input_init(&m->k, s, p, "k", CURVE_UNBOUNDED,
                               curve_named("metal-Cu-k"), error);
}

static bool read_colour(metal *m, const struct scene *s, const params *p, GError **error)
{
    if (!params_has(p, "reflectance"))
        return read_index(m, s, p, error);
    if (params_has(p, "eta") || params_has(p, "k")) {
        error_at(error, params_find(p, "reflectance")->place,
                 "a conductor has either 'reflectance' or 'eta' and 'k'");
        return false;
    }
    return spectrum_input_init(&m->reflectance, s, p, "reflectance", CURVE_ALBEDO, NULL,
                               error);
}

static void *metal_create(const struct scene *s, const params *p, GError **error)
{
    metal *m = g_new0(metal, 1);
    if (read_colour(m, s, p, error) &&
        roughness_input_init(&m->roughness, "", s, p, error))
        return m;
    metal_free(m);
    return NULL;
}

static void metal_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                       const bsdf_options *options, bsdf *out)
{
    const metal *m = self;
    spectrum eta, k;
    if (spectrum_input_given(&m->reflectance)) {
        spectrum r = spectrum_input_eval(&m->reflectance, hit, w);
        r = spectrum_clamp(r, 0.0f, 0.9999f);
        eta = spectrum_fill(1.0f);
        k = 2.0f * spectrum_sqrt(r / (1.0f - r));
    } else {
        eta = spectrum_input_eval(&m->eta, hit, w);
        k = spectrum_input_eval(&m->k, hit, w);
    }
    ggx roughness = {0.0f, 0.0f};
    if (!options->deterministic)
        roughness = roughness_input_eval(&m->roughness, hit);
    bsdf_make_conductor(out, eta, k, roughness);
}

static unsigned metal_lobes(const void *self)
{
    const metal *m = self;
    return roughness_input_classes(&m->roughness) | LOBE_REFLECTION;
}

const material_kind material_conductor = {
    .name = "conductor",
    .parameters = "eta k reflectance roughness uroughness vroughness remaproughness",
    .create = metal_create,
    .free = metal_free,
    .make_bsdf = metal_bsdf,
    .possible_lobes = metal_lobes,
};
