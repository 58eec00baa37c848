/* "diffuse": Lambert's law with a reflectance (pbrt-v4: 0.5 by default). */
#include "bsdf/bsdf_models.h"
#include "material/material_kinds.h"

typedef struct diffuse {
    spectrum_input reflectance;
} diffuse;

static void diffuse_free(void *self)
{
    diffuse *d = self;
    spectrum_input_clear(&d->reflectance);
    g_free(d);
}

static void *diffuse_create(const build_context *context, const params *p, GError **error)
{
    diffuse *d = g_new0(diffuse, 1);
    if (spectrum_input_init(&d->reflectance, context, p, "reflectance", CURVE_ALBEDO,
                            curve_constant(0.5f), error))
        return d;
    diffuse_free(d);
    return NULL;
}

static void diffuse_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                         const bsdf_options *options, bsdf *out)
{
    (void)options;
    const diffuse *d = self;
    spectrum rho = spectrum_input_eval(&d->reflectance, hit, w);
    bsdf_make_diffuse(out, spectrum_clamp(rho, 0.0f, 1.0f));
}

static unsigned diffuse_lobes(const void *self)
{
    (void)self;
    return LOBE_DIFFUSE | LOBE_REFLECTION;
}

const material_kind material_diffuse = {
    .name = "diffuse",
    .parameters = "reflectance",
    .create = diffuse_create,
    .free = diffuse_free,
    .make_bsdf = diffuse_bsdf,
    .possible_lobes = diffuse_lobes,
};
