/* The texture that is the same everywhere. */
#include "texture/texture_input.h"
#include "texture/texture_kinds.h"

static void constant_free(void *self)
{
    texture_input_clear(self);
    g_free(self);
}

static void *constant_create(const build_context *context, bool is_spectrum,
                             const params *p, GError **error)
{
    texture_input *in = g_new0(texture_input, 1);
    if (texture_input_init(in, context, p, "value", is_spectrum, 1.0f, error))
        return in;
    constant_free(in);
    return NULL;
}

static float constant_eval_float(const void *self, const surface_hit *hit)
{
    return texture_input_float(self, hit);
}

static spectrum constant_eval_spectrum(const void *self, const surface_hit *hit,
                                       const wavelengths *w, curve_role role)
{
    return texture_input_spectrum(self, hit, w, role);
}

const texture_kind texture_constant = {
    .name = "constant",
    .parameters = "value",
    .create = constant_create,
    .free = constant_free,
    .eval_float = constant_eval_float,
    .eval_spectrum = constant_eval_spectrum,
};
