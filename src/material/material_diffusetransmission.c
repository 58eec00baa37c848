/*
 * "diffusetransmission": a leaf or a curtain, which scatters light to both sides by
 * Lambert's law. pbrt-v4's defaults are a quarter to each; "scale" multiplies both. Where
 * the two together exceed one they are brought down to it.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_kinds.h"

typedef struct leaf {
    spectrum_input reflectance, transmittance;
    float scale;
} leaf;

static void leaf_free(void *self)
{
    leaf *m = self;
    spectrum_input_clear(&m->reflectance);
    spectrum_input_clear(&m->transmittance);
    g_free(m);
}

static bool read_scale(leaf *m, const params *p, GError **error)
{
    m->scale = 1.0f;
    if (!params_float(p, "scale", &m->scale, error))
        return false;
    if (m->scale >= 0.0f)
        return true;
    error_at(error, params_find(p, "scale")->place,
             "parameter 'scale': expected a number >= 0, found %g", (double)m->scale);
    return false;
}

static void *leaf_create(const build_context *context, const params *p, GError **error)
{
    leaf *m = g_new0(leaf, 1);
    if (spectrum_input_init(&m->reflectance, context, p, "reflectance", CURVE_ALBEDO,
                            curve_constant(0.25f), error) &&
        spectrum_input_init(&m->transmittance, context, p, "transmittance", CURVE_ALBEDO,
                            curve_constant(0.25f), error) &&
        read_scale(m, p, error))
        return m;
    leaf_free(m);
    return NULL;
}

static void leaf_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                      const bsdf_options *options, bsdf *out)
{
    (void)options;
    const leaf *m = self;
    spectrum r = m->scale * spectrum_input_eval(&m->reflectance, hit, w);
    spectrum t = m->scale * spectrum_input_eval(&m->transmittance, hit, w);
    bsdf_make_diffuse_transmission(out, spectrum_clamp(r, 0.0f, 1.0f),
                                   spectrum_clamp(t, 0.0f, 1.0f));
}

static unsigned leaf_lobes(const void *self)
{
    (void)self;
    return LOBE_DIFFUSE | LOBE_ANY_SIDE;
}

const material_kind material_diffuse_transmission = {
    .name = "diffusetransmission",
    .parameters = "reflectance transmittance scale",
    .create = leaf_create,
    .free = leaf_free,
    .make_bsdf = leaf_bsdf,
    .possible_lobes = leaf_lobes,
};
