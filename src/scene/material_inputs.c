#include "scene/material_inputs.h"

#include "scene/bsdf_models.h"

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

bool roughness_input_init(roughness_input *in, const struct scene *s, const params *p,
                          GError **error)
{
    float_input both;
    in->remap = true;
    if (params_has(p, "roughness") && params_has(p, "uroughness") &&
        params_has(p, "vroughness")) {
        error_at(error, params_find(p, "roughness")->place,
                 "parameter 'roughness' has no effect beside 'uroughness' and "
                 "'vroughness'");
        return false;
    }
    if (!float_input_init(&both, s, p, "roughness", 0.0f, error) ||
        !check_not_negative(p, "roughness", &both, error) ||
        !float_input_init(&in->u, s, p, "uroughness", both.constant, error) ||
        !check_not_negative(p, "uroughness", &in->u, error) ||
        !float_input_init(&in->v, s, p, "vroughness", both.constant, error) ||
        !check_not_negative(p, "vroughness", &in->v, error) ||
        !params_bool(p, "remaproughness", &in->remap, error))
        return false;
    if (!params_has(p, "uroughness"))
        in->u = both;
    if (!params_has(p, "vroughness"))
        in->v = both;
    return true;
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

curve *eta_input(const params *p, GError **error)
{
    curve *eta = NULL;
    if (!params_curve(p, "eta", CURVE_UNBOUNDED, &eta, error))
        return NULL;
    if (!eta)
        return curve_constant(1.5f);
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f)
        if (!(curve_at(eta, nm) > 0.0f)) {
            error_at(error, params_find(p, "eta")->place,
                     "parameter 'eta': expected an index of refraction > 0, found %g at "
                     "%g nm",
                     (double)curve_at(eta, nm), (double)nm);
            curve_unref(eta);
            return NULL;
        }
    return eta;
}
