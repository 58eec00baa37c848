/*
 * "coatedconductor": pbrt-v4's lacquered metal. Parameters of the coat begin with
 * "interface.", those of the metal with "conductor."; "reflectance" is the metal's at
 * normal incidence without the coat, in place of its index.
 *
 * As for coateddiffuse the coat may absorb but not scatter: an albedo > 0 is refused, and
 * maxdepth and nsamples, which end and repeat pbrt's random walk, are checked but there
 * is no walk: the series goes on without end.
 */
#include "scene/bsdf_models.h"
#include "scene/material_inputs.h"
#include "scene/material_kinds.h"

typedef struct lacquered {
    spectrum_input eta, k, reflectance;
    roughness_input coat, metal;
    curve *coat_eta;
    float thickness;
    coat_table *table;
} lacquered;

static void lacquered_free(void *self)
{
    lacquered *m = self;
    spectrum_input_clear(&m->eta);
    spectrum_input_clear(&m->k);
    spectrum_input_clear(&m->reflectance);
    curve_unref(m->coat_eta);
    coat_table_free(m->table);
    g_free(m);
}

static bool read_metal(lacquered *m, const struct scene *s, const params *p,
                       GError **error)
{
    bool by_colour = params_has(p, "reflectance");
    if (by_colour && (params_has(p, "conductor.eta") || params_has(p, "conductor.k"))) {
        error_at(error, params_find(p, "reflectance")->place,
                 "a conductor has either 'reflectance' or 'eta' and 'k'");
        return false;
    }
    if (by_colour)
        return spectrum_input_init(&m->reflectance, s, p, "reflectance", CURVE_ALBEDO,
                                   NULL, error);
    return spectrum_input_init(&m->eta, s, p, "conductor.eta", CURVE_UNBOUNDED,
                               curve_named("metal-Cu-eta"), error) &&
           spectrum_input_init(&m->k, s, p, "conductor.k", CURVE_UNBOUNDED,
                               curve_named("metal-Cu-k"), error);
}

static coat_range range_of(const lacquered *m)
{
    coat_range range = {.alpha_max = 1.0f,
                        .eta_min = INFINITY,
                        .eta_max = 0.0f,
                        .thickness = m->thickness};
    if (roughness_input_is_constant(&m->coat)) {
        ggx g = roughness_input_eval(&m->coat, NULL);
        range.alpha_min = minf(g.alpha_x, g.alpha_y);
        range.alpha_max = maxf(g.alpha_x, g.alpha_y);
    }
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f) {
        range.eta_min = minf(range.eta_min, curve_at(m->coat_eta, nm));
        range.eta_max = maxf(range.eta_max, curve_at(m->coat_eta, nm));
    }
    return range;
}

static void *lacquered_create(const struct scene *s, const params *p, GError **error)
{
    int depth = 10, samples = 1;
    lacquered *m = g_new0(lacquered, 1);
    m->coat_eta = eta_input(p, "interface.eta", error);
    if (m->coat_eta && read_metal(m, s, p, error) &&
        roughness_input_init(&m->coat, "interface.", s, p, error) &&
        roughness_input_init(&m->metal, "conductor.", s, p, error) &&
        coat_input_thickness(p, &m->thickness, error) &&
        coat_input_count(p, "maxdepth", &depth, error) &&
        coat_input_count(p, "nsamples", &samples, error) && coat_input_medium(p, error)) {
        coat_range range = range_of(m);
        m->table = coat_table_new(&range);
        return m;
    }
    lacquered_free(m);
    return NULL;
}

static void lacquered_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                           const bsdf_options *options, bsdf *out)
{
    const lacquered *m = self;
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
    if (options->deterministic) {
        bsdf_make_conductor(out, eta, k, (ggx){0.0f, 0.0f});
        return;
    }
    const coated_metal from = {.eta = eta,
                               .k = k,
                               .coat_eta = spectrum_mean(curve_eval(m->coat_eta, w)),
                               .thickness = m->thickness,
                               .coat = roughness_input_eval(&m->coat, hit),
                               .metal = roughness_input_eval(&m->metal, hit),
                               .table = m->table};
    bsdf_make_coated_conductor(out, &from);
}

static unsigned lacquered_lobes(const void *self)
{
    const lacquered *m = self;
    return roughness_input_classes(&m->coat) | roughness_input_classes(&m->metal) |
           LOBE_DIFFUSE | LOBE_REFLECTION;
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
};
