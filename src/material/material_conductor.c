/*
 * "conductor": a metal by its measured index eta + i k, or by its reflectance at normal
 * incidence.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_inputs.h"
#include "material/material_kinds.h"

typedef struct metal {
    metal_input index;
    roughness_input roughness;
} metal;

static void metal_free(void *self)
{
    metal *m = self;
    metal_input_clear(&m->index);
    g_free(m);
}

static void *metal_create(const build_context *context, const params *p, GError **error)
{
    metal *m = g_new0(metal, 1);
    if (metal_input_init(&m->index, "", context, p, error) &&
        roughness_input_init(&m->roughness, "", context, p, error))
        return m;
    metal_free(m);
    return NULL;
}

static void metal_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                       const bsdf_options *options, bsdf *out)
{
    const metal *m = self;
    spectrum eta, k;
    metal_input_eval(&m->index, hit, w, &eta, &k);
    ggx roughness = {0.0f, 0.0f};
    if (!options->deterministic)
        roughness = roughness_input_eval(&m->roughness, hit);
    bsdf_make_conductor(out, eta, k, roughness);
    if (options->metal_is_followed)
        out->lobes = lobe_followed(out->lobes);
}

static unsigned metal_lobes(const void *self)
{
    const metal *m = self;
    return roughness_input_classes(&m->roughness) | LOBE_REFLECTION;
}

static bool always_metal(const void *self)
{
    (void)self;
    return true;
}

const material_kind material_conductor = {
    .name = "conductor",
    .parameters = "eta k reflectance roughness uroughness vroughness remaproughness",
    .create = metal_create,
    .free = metal_free,
    .make_bsdf = metal_bsdf,
    .possible_lobes = metal_lobes,
    .is_metal = always_metal,
};
