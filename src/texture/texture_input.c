#include "texture/texture_input.h"

static bool read_spectrum(texture_input *in, const params *p, const char *name,
                          float fallback, GError **error)
{
    static const curve_role roles[] = {CURVE_UNBOUNDED, CURVE_EMISSION, CURVE_ALBEDO};
    for (int i = 0; i < 3; i++) {
        curve **out = &in->by_role[roles[i]];
        g_autoptr(GError) above_one = NULL;
        /* More than one can be no albedo, but still an index; as albedo it is clamped by
         * who uses it. */
        bool albedo = roles[i] == CURVE_ALBEDO;
        if (!params_curve(p, name, roles[i], out, albedo ? &above_one : error)) {
            if (!albedo)
                return false;
            *out = curve_ref(in->by_role[CURVE_UNBOUNDED]);
        }
        if (!*out)
            *out = curve_constant(fallback);
    }
    return true;
}

bool texture_input_init(texture_input *in, const build_context *context, const params *p,
                        const char *name, bool is_spectrum, float fallback,
                        GError **error)
{
    *in = (texture_input){.number = fallback};
    const param *q = params_find(p, name);
    if (q && q->type == PARAM_TEXTURE)
        return (in->texture = texture_find(context, q, is_spectrum, error)) != NULL;
    return is_spectrum ? read_spectrum(in, p, name, fallback, error)
                       : params_float(p, name, &in->number, error);
}

void texture_input_clear(texture_input *in)
{
    for (int role = 0; role < 3; role++)
        curve_unref(in->by_role[role]);
    *in = (texture_input){0};
}

float texture_input_float(const texture_input *in, const surface_hit *hit)
{
    return in->texture ? texture_eval_float(in->texture, hit) : in->number;
}

spectrum texture_input_spectrum(const texture_input *in, const surface_hit *hit,
                                const wavelengths *w, curve_role role)
{
    return in->texture ? texture_eval_spectrum(in->texture, hit, w, role)
                       : curve_eval(in->by_role[role], w);
}
