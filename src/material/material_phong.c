/*
 * "phong": our own, for scenes that are lit the old way: normalised Blinn-Phong with
 * "reflectance" (of the matt part, 0.5), "specular" (of the highlight, 0.04) and
 * "exponent" (100). multiple_samples off leaves the matt part alone.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_kinds.h"

#define MAX_EXPONENT 1e6f

typedef struct shiny {
    spectrum_input reflectance, specular;
    float_input exponent;
} shiny;

static void shiny_free(void *self)
{
    shiny *m = self;
    spectrum_input_clear(&m->reflectance);
    spectrum_input_clear(&m->specular);
    g_free(m);
}

static bool check_exponent(const shiny *m, const params *p, GError **error)
{
    float n = m->exponent.constant;
    if (m->exponent.texture || (n >= 0.0f && n <= MAX_EXPONENT))
        return true;
    error_at(error, params_find(p, "exponent")->place,
             "parameter 'exponent': expected a number in 0..%g, found %g",
             (double)MAX_EXPONENT, (double)n);
    return false;
}

static void *shiny_create(const build_context *context, const params *p, GError **error)
{
    shiny *m = g_new0(shiny, 1);
    if (spectrum_input_init(&m->reflectance, context, p, "reflectance", CURVE_ALBEDO,
                            curve_constant(0.5f), error) &&
        spectrum_input_init(&m->specular, context, p, "specular", CURVE_ALBEDO,
                            curve_constant(0.04f), error) &&
        float_input_init(&m->exponent, context, p, "exponent", 100.0f, error) &&
        check_exponent(m, p, error))
        return m;
    shiny_free(m);
    return NULL;
}

static void shiny_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                       const bsdf_options *options, bsdf *out)
{
    const shiny *m = self;
    spectrum matt = spectrum_input_eval(&m->reflectance, hit, w);
    spectrum specular = spectrum_input_eval(&m->specular, hit, w);
    float n = clampf(float_input_eval(&m->exponent, hit), 0.0f, MAX_EXPONENT);
    matt = spectrum_clamp(matt, 0.0f, 1.0f);
    if (options->deterministic)
        bsdf_make_diffuse(out, matt);
    else
        bsdf_make_phong(out, matt, spectrum_clamp(specular, 0.0f, 1.0f), n);
}

static unsigned shiny_lobes(const void *self)
{
    const shiny *m = self;
    if (m->exponent.texture)
        return LOBE_GLOSSY | LOBE_DIFFUSE | LOBE_REFLECTION;
    bsdf b;
    bsdf_make_phong(&b, (spectrum){0}, (spectrum){0}, m->exponent.constant);
    return b.lobes;
}

const material_kind material_phong = {
    .name = "phong",
    .parameters = "reflectance specular exponent",
    .create = shiny_create,
    .free = shiny_free,
    .make_bsdf = shiny_bsdf,
    .possible_lobes = shiny_lobes,
};
