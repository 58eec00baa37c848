/*
 * "coateddiffuse": pbrt-v4's plastic, a diffuse base under a dielectric coat.
 *
 * A coat that only absorbs, and is as thick everywhere, needs no walk: its mean is known
 * in closed form (bsdf_coated.c), so nsamples, which is over how many walks pbrt
 * averages, makes no difference there. Coats with particles in them are walked through.
 */
#include "bsdf/bsdf_models.h"
#include "material/material_inputs.h"
#include "material/material_kinds.h"

typedef struct plastic {
    spectrum_input reflectance;
    roughness_input roughness;
    curve *eta;
    coat_input coat;
    coat_table *table; /* NULL: the coat is walked through */
} plastic;

static void plastic_free(void *self)
{
    plastic *m = self;
    spectrum_input_clear(&m->reflectance);
    curve_unref(m->eta);
    coat_input_clear(&m->coat);
    coat_table_free(m->table);
    g_free(m);
}

static coat_range range_of(const plastic *m)
{
    coat_range range = {.alpha_max = 1.0f,
                        .eta_min = INFINITY,
                        .eta_max = 0.0f,
                        .thickness = m->coat.thickness.constant};
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

static bool is_brushed(ggx g)
{
    return fabsf(g.alpha_x - g.alpha_y) > 0.01f * maxf(g.alpha_x, g.alpha_y);
}

static bool has_closed_form(const plastic *m)
{
    const roughness_input *r = &m->roughness;
    return coat_input_is_plain(&m->coat) &&
           !(roughness_input_is_constant(r) && is_brushed(roughness_input_eval(r, NULL)));
}

static void *plastic_create(const build_context *context, const params *p, GError **error)
{
    plastic *m = g_new0(plastic, 1);
    m->eta = eta_input(p, "eta", error);
    if (m->eta &&
        spectrum_input_init(&m->reflectance, context, p, "reflectance", CURVE_ALBEDO,
                            curve_constant(0.5f), error) &&
        roughness_input_init(&m->roughness, "", context, p, error) &&
        coat_input_init(&m->coat, context, p, error)) {
        coat_range range = range_of(m);
        if (has_closed_form(m))
            m->table = coat_table_new(&range);
        return m;
    }
    plastic_free(m);
    return NULL;
}

static void plastic_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                         const bsdf_options *options, bsdf *out)
{
    const plastic *m = self;
    spectrum rho = spectrum_input_eval(&m->reflectance, hit, w);
    rho = spectrum_clamp(rho, 0.0f, 1.0f);
    if (options->deterministic) {
        bsdf_make_diffuse(out, rho);
        return;
    }
    ggx roughness = roughness_input_eval(&m->roughness, hit);
    if (m->table && !is_brushed(roughness)) {
        /* The walk meets base and coat in turn. */
        int bounces = m->coat.max_depth / 2 + m->coat.max_depth % 2;
        bsdf_make_coated(out, rho, curve_eval(m->eta, w), roughness.alpha_x, m->table,
                         bounces);
        return;
    }
    coat_layers from = {.rho = rho, .coat = roughness};
    from.eta = spectrum_mean(curve_eval(m->eta, w));
    coat_input_eval(&m->coat, hit, w, options, &from);
    bsdf_make_layered(out, &from);
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
