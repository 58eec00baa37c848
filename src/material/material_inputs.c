#include "material/material_inputs.h"

#include "bsdf/bsdf_models.h"
#include "material/material.h"

#include <string.h>

static bool check_not_negative(const params *p, const char *name, const float_input *in,
                               GError **error)
{
    if (in->texture || in->constant >= 0.0f)
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a number >= 0, found %g", name,
             (double)in->constant);
    return false;
}

/* One roughness; absent it is fallback. */
static bool read_roughness(float_input *in, const char *name, const float_input *fallback,
                           const build_context *context, const params *p, GError **error)
{
    if (!float_input_init(in, context, p, name, fallback->constant, error) ||
        !check_not_negative(p, name, in, error))
        return false;
    if (!params_has(p, name))
        *in = *fallback;
    return true;
}

bool roughness_input_init(roughness_input *in, const char *prefix,
                          const build_context *context, const params *p, GError **error)
{
    const float_input smooth = {0};
    float_input both;
    g_autofree char *name = g_strconcat(prefix, "roughness", NULL);
    g_autofree char *u_name = g_strconcat(prefix, "uroughness", NULL);
    g_autofree char *v_name = g_strconcat(prefix, "vroughness", NULL);
    in->remap = true;
    if (params_has(p, name) && params_has(p, u_name) && params_has(p, v_name)) {
        error_at(error, params_find(p, name)->place,
                 "parameter '%s' has no effect beside '%s' and '%s'", name, u_name,
                 v_name);
        return false;
    }
    return read_roughness(&both, name, &smooth, context, p, error) &&
           read_roughness(&in->u, u_name, &both, context, p, error) &&
           read_roughness(&in->v, v_name, &both, context, p, error) &&
           params_bool(p, "remaproughness", &in->remap, error);
}

ggx roughness_input_eval(const roughness_input *in, const surface_hit *hit)
{
    float u = maxf(0.0f, float_input_eval(&in->u, hit));
    float v = maxf(0.0f, float_input_eval(&in->v, hit));
    return in->remap ? ggx_make(sqrtf(u), sqrtf(v)) : ggx_make(u, v);
}

bool roughness_input_is_constant(const roughness_input *in)
{
    return !in->u.texture && !in->v.texture;
}

unsigned roughness_input_classes(const roughness_input *in)
{
    if (!roughness_input_is_constant(in))
        return LOBE_SPECULAR | LOBE_GLOSSY | LOBE_DIFFUSE;
    return ggx_class(roughness_input_eval(in, NULL));
}

curve *eta_input(const params *p, const char *name, GError **error)
{
    curve *eta = NULL;
    if (!params_curve(p, name, CURVE_UNBOUNDED, &eta, error))
        return NULL;
    if (!eta)
        return curve_constant(1.5f);
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f)
        if (!(curve_at(eta, nm) > 0.0f)) {
            error_at(error, params_find(p, name)->place,
                     "parameter '%s': expected an index of refraction > 0, found %g at "
                     "%g nm",
                     name, (double)curve_at(eta, nm), (double)nm);
            curve_unref(eta);
            return NULL;
        }
    return eta;
}

/* ---- Metals ---- */

bool metal_input_init(metal_input *in, const char *prefix, const build_context *context,
                      const params *p, GError **error)
{
    g_autofree char *eta = g_strconcat(prefix, "eta", NULL);
    g_autofree char *k = g_strconcat(prefix, "k", NULL);
    *in = (metal_input){0};
    if (!params_has(p, "reflectance"))
        return spectrum_input_init(&in->eta, context, p, eta, CURVE_UNBOUNDED,
                                   curve_named("metal-Cu-eta"), error) &&
               spectrum_input_init(&in->k, context, p, k, CURVE_UNBOUNDED,
                                   curve_named("metal-Cu-k"), error);
    if (!params_has(p, eta) && !params_has(p, k))
        return spectrum_input_init(&in->reflectance, context, p, "reflectance",
                                   CURVE_ALBEDO, NULL, error);
    error_at(error, params_find(p, "reflectance")->place,
             "a conductor has either 'reflectance' or '%s' and '%s'", eta, k);
    return false;
}

void metal_input_clear(metal_input *in)
{
    spectrum_input_clear(&in->eta);
    spectrum_input_clear(&in->k);
    spectrum_input_clear(&in->reflectance);
}

void metal_input_eval(const metal_input *in, const surface_hit *hit, const wavelengths *w,
                      spectrum *eta, spectrum *k)
{
    if (!spectrum_input_given(&in->reflectance)) {
        *eta = spectrum_input_eval(&in->eta, hit, w);
        *k = spectrum_input_eval(&in->k, hit, w);
        return;
    }
    spectrum r = spectrum_input_eval(&in->reflectance, hit, w);
    r = spectrum_clamp(r, 0.0f, 0.9999f);
    *eta = spectrum_fill(1.0f);
    *k = 2.0f * spectrum_sqrt(r / (1.0f - r));
}

/* ---- Coats ---- */

/* |g| of 1 is a mirror's direction, which no walk could join. */
#define MOST_FORWARD 0.999f

static bool read_g(coat_input *in, const build_context *context, const params *p,
                   GError **error)
{
    if (!float_input_init(&in->g, context, p, "g", 0.0f, error))
        return false;
    if (in->g.texture || fabsf(in->g.constant) <= 1.0f)
        return true;
    error_at(error, params_find(p, "g")->place,
             "parameter 'g': expected a number in -1..1, found %g",
             (double)in->g.constant);
    return false;
}

static bool read_count(const params *p, const char *name, int *out, GError **error)
{
    if (!params_integer(p, name, out, error))
        return false;
    if (*out >= 1)
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a number >= 1, found %d", name, *out);
    return false;
}

bool coat_input_init(coat_input *in, const build_context *context, const params *p,
                     GError **error)
{
    *in = (coat_input){.max_depth = 10, .n_walks = 1};
    return float_input_init(&in->thickness, context, p, "thickness", 0.01f, error) &&
           check_not_negative(p, "thickness", &in->thickness, error) &&
           spectrum_input_init(&in->albedo, context, p, "albedo", CURVE_ALBEDO,
                               curve_constant(0.0f), error) &&
           read_g(in, context, p, error) &&
           read_count(p, "maxdepth", &in->max_depth, error) &&
           read_count(p, "nsamples", &in->n_walks, error);
}

void coat_input_clear(coat_input *in)
{
    spectrum_input_clear(&in->albedo);
}

bool coat_input_is_plain(const coat_input *in)
{
    if (in->thickness.texture || in->albedo.texture)
        return false;
    float most = 0.0f;
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f)
        most = maxf(most, curve_at(in->albedo.constant, nm));
    return !(most > 0.0f);
}

void coat_input_eval(const coat_input *in, const surface_hit *hit, const wavelengths *w,
                     const bsdf_options *options, coat_layers *out)
{
    out->thickness = maxf(0.0f, float_input_eval(&in->thickness, hit));
    out->g = clampf(float_input_eval(&in->g, hit), -MOST_FORWARD, MOST_FORWARD);
    out->albedo = spectrum_clamp(spectrum_input_eval(&in->albedo, hit, w), 0.0f, 1.0f);
    out->max_depth = in->max_depth;
    out->n_walks = MAX(in->n_walks, options->least_walks);
    float first = w->lambda[0];
    memcpy(&out->seed, &first, sizeof out->seed);
}
