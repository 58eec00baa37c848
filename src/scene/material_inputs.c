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

/* One roughness; absent it is fallback. */
static bool read_roughness(float_input *in, const char *name, const float_input *fallback,
                           const struct scene *s, const params *p, GError **error)
{
    if (!float_input_init(in, s, p, name, fallback->constant, error) ||
        !check_not_negative(p, name, in, error))
        return false;
    if (!params_has(p, name))
        *in = *fallback;
    return true;
}

bool roughness_input_init(roughness_input *in, const char *prefix, const struct scene *s,
                          const params *p, GError **error)
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
    return read_roughness(&both, name, &smooth, s, p, error) &&
           read_roughness(&in->u, u_name, &both, s, p, error) &&
           read_roughness(&in->v, v_name, &both, s, p, error) &&
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

/* ---- Coats ---- */

bool coat_input_medium(const params *p, GError **error)
{
    g_autoptr(curve) albedo = NULL;
    float g = 0.0f, most = 0.0f;
    if (!params_curve(p, "albedo", CURVE_ALBEDO, &albedo, error) ||
        !params_float(p, "g", &g, error))
        return false;
    for (float nm = LAMBDA_MIN; albedo && nm <= LAMBDA_MAX; nm += 5.0f)
        most = maxf(most, curve_at(albedo, nm));
    if (most > 1e-4f) {
        error_at(error, params_find(p, "albedo")->place,
                 "parameter 'albedo': a coat that scatters is not supported, expected 0");
        return false;
    }
    if (fabsf(g) > 1.0f) {
        error_at(error, params_find(p, "g")->place,
                 "parameter 'g': expected a number in -1..1, found %g", (double)g);
        return false;
    }
    return true;
}

bool coat_input_count(const params *p, const char *name, int *out, GError **error)
{
    if (!params_integer(p, name, out, error))
        return false;
    if (*out >= 1)
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a number >= 1, found %d", name, *out);
    return false;
}

bool coat_input_thickness(const params *p, float *out, GError **error)
{
    *out = 0.01f;
    if (!params_float(p, "thickness", out, error))
        return false;
    if (*out >= 0.0f)
        return true;
    error_at(error, params_find(p, "thickness")->place,
             "parameter 'thickness': expected a number >= 0, found %g", (double)*out);
    return false;
}
