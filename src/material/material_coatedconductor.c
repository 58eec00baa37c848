/*
 * "coatedconductor": pbrt-v4's lacquered metal. Parameters of the coat begin with
 * "interface.", those of the metal with "conductor."; "reflectance" is the metal's at
 * normal incidence without the coat, in place of its index.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_inputs.h"
#include "material/material_kinds.h"

typedef struct lacquered {
    metal_input index;
    roughness_input face, metal;
    curve *eta;
    coat_input coat;
} lacquered;

static void lacquered_free(void *self)
{
    lacquered *m = self;
    metal_input_clear(&m->index);
    curve_unref(m->eta);
    coat_input_clear(&m->coat);
    g_free(m);
}

static void *lacquered_create(const build_context *context, const params *p,
                              GError **error)
{
    lacquered *m = g_new0(lacquered, 1);
    m->eta = eta_input(p, "interface.eta", error);
    if (m->eta && metal_input_init(&m->index, "conductor.", context, p, error) &&
        roughness_input_init(&m->face, "interface.", context, p, error) &&
        roughness_input_init(&m->metal, "conductor.", context, p, error) &&
        coat_input_init(&m->coat, context, p, error))
        return m;
    lacquered_free(m);
    return NULL;
}

static void lacquered_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                           const bsdf_options *options, bsdf *out)
{
    const lacquered *m = self;
    coat_layers from = {.is_metal = true, .is_followed = options->metal_is_followed};
    metal_input_eval(&m->index, hit, w, &from.metal_eta, &from.metal_k);
    if (options->deterministic) {
        bsdf_make_conductor(out, from.metal_eta, from.metal_k, (ggx){0.0f, 0.0f});
        return;
    }
    from.eta = spectrum_mean(curve_eval(m->eta, w));
    from.coat = roughness_input_eval(&m->face, hit);
    from.base = roughness_input_eval(&m->metal, hit);
    coat_input_eval(&m->coat, hit, w, options, &from);
    bsdf_make_layered(out, &from);
}

static unsigned lacquered_lobes(const void *self)
{
    const lacquered *m = self;
    if (!roughness_input_is_constant(&m->face) || !roughness_input_is_constant(&m->metal))
        return LOBE_SPECULAR | LOBE_GLOSSY | LOBE_DIFFUSE | LOBE_REFLECTION;
    float cloudy = coat_input_is_plain(&m->coat) ? 0.0f : 1.0f;
    const coat_layers layers = {.is_metal = true,
                                .albedo = spectrum_fill(cloudy),
                                .eta = curve_at(m->eta, 550.0f),
                                .coat = roughness_input_eval(&m->face, NULL),
                                .base = roughness_input_eval(&m->metal, NULL)};
    bsdf example;
    bsdf_make_layered(&example, &layers);
    return example.lobes;
}

static bool always_metal(const void *self)
{
    (void)self;
    return true;
}

const material_kind material_coated_conductor = {
    .name = "coatedconductor",
    .parameters = "interface.roughness interface.uroughness interface.vroughness "
                  "interface.eta thickness conductor.eta conductor.k reflectance "
                  "conductor.roughness conductor.uroughness conductor.vroughness "
                  "remaproughness maxdepth nsamples albedo g",
    .create = lacquered_create,
    .free = lacquered_free,
    .make_bsdf = lacquered_bsdf,
    .possible_lobes = lacquered_lobes,
    .is_metal = always_metal,
};
