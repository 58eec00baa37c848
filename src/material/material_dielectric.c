/*
 * "dielectric": glass, water and the like, smooth or rough, and "thindielectric": a pane.
 * eta is a number or a spectrum; light disperses where it differs between wavelengths.
 * Solid glass may be coloured (see medium.h), which pbrt-v4 has media for.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_inputs.h"
#include "material/material_kinds.h"
#include "medium/medium.h"

typedef struct glass {
    curve *eta;
    roughness_input roughness;
    spectrum_input tint; /* times the light that passes; not given: 1 */
    medium *interior;    /* NULL: clear */
} glass;

static void glass_free(void *self)
{
    glass *g = self;
    curve_unref(g->eta);
    spectrum_input_clear(&g->tint);
    medium_free(g->interior);
    g_free(g);
}

static void *glass_create(const build_context *context, const params *p, GError **error)
{
    glass *g = g_new0(glass, 1);
    g->eta = eta_input(p, "eta", error);
    if (g->eta && roughness_input_init(&g->roughness, "", context, p, error) &&
        spectrum_input_init(&g->tint, context, p, "tint", CURVE_ALBEDO, NULL, error) &&
        medium_read(p, &g->interior, error))
        return g;
    glass_free(g);
    return NULL;
}

static void glass_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                       const bsdf_options *options, bsdf *out)
{
    const glass *g = self;
    spectrum eta = curve_eval(g->eta, w);
    bool disperses = !curve_is_constant(g->eta);
    if (options->deterministic)
        bsdf_make_refractor(out, eta, disperses);
    else if (spectrum_input_given(&g->tint))
        bsdf_make_tinted_dielectric(
            out, eta, disperses, roughness_input_eval(&g->roughness, hit),
            spectrum_clamp(spectrum_input_eval(&g->tint, hit, w), 0.0f, 1.0f));
    else
        bsdf_make_dielectric(out, eta, disperses,
                             roughness_input_eval(&g->roughness, hit));
}

static unsigned glass_lobes(const void *self)
{
    const glass *g = self;
    if (!roughness_input_is_constant(&g->roughness))
        return LOBE_SPECULAR | LOBE_GLOSSY | LOBE_ANY_SIDE;
    return ggx_glass_class(roughness_input_eval(&g->roughness, NULL)) | LOBE_ANY_SIDE;
}

static const medium *glass_interior(const void *self)
{
    const glass *g = self;
    return g->interior;
}

static bool glass_encloses(const void *self)
{
    (void)self;
    return true;
}

static void *pane_create(const build_context *context, const params *p, GError **error)
{
    (void)context;
    glass *g = g_new0(glass, 1);
    g->eta = eta_input(p, "eta", error);
    if (g->eta)
        return g;
    glass_free(g);
    return NULL;
}

static void pane_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                      const bsdf_options *options, bsdf *out)
{
    (void)hit;
    const glass *g = self;
    if (options->deterministic)
        bsdf_make_clear(out);
    else
        bsdf_make_thin_dielectric(out, curve_eval(g->eta, w));
}

static unsigned pane_lobes(const void *self)
{
    (void)self;
    return LOBE_SPECULAR | LOBE_ANY_SIDE;
}

static bool is_pane(const void *self)
{
    (void)self;
    return true;
}

const material_kind material_dielectric = {
    .name = "dielectric",
    .parameters =
        "eta roughness uroughness vroughness remaproughness tint " MEDIUM_PARAMETERS,
    .create = glass_create,
    .free = glass_free,
    .make_bsdf = glass_bsdf,
    .possible_lobes = glass_lobes,
    .interior = glass_interior,
    .encloses = glass_encloses,
};

const material_kind material_thin_dielectric = {
    .name = "thindielectric",
    .parameters = "eta",
    .create = pane_create,
    .free = glass_free,
    .make_bsdf = pane_bsdf,
    .possible_lobes = pane_lobes,
    .is_pane = is_pane,
};
