/* The texture that is the same everywhere. */
#include "scene/texture_kinds.h"

typedef struct constant {
    float number;
    curve *by_role[3]; /* an rgb value means another curve by its role */
} constant;

static void constant_free(void *self)
{
    constant *c = self;
    for (int role = 0; role < 3; role++)
        curve_unref(c->by_role[role]);
    g_free(c);
}

static bool read_spectrum(constant *c, const params *p, GError **error)
{
    static const curve_role roles[] = {CURVE_UNBOUNDED, CURVE_EMISSION, CURVE_ALBEDO};
    for (int i = 0; i < 3; i++) {
        curve **out = &c->by_role[roles[i]];
        g_autoptr(GError) above_one = NULL;
        /* More than one can be no albedo, but still an index; as albedo it is clamped by
         * who uses it. */
        bool albedo = roles[i] == CURVE_ALBEDO;
        if (!params_curve(p, "value", roles[i], out, albedo ? &above_one : error)) {
            if (!albedo)
                return false;
            *out = curve_ref(c->by_role[CURVE_UNBOUNDED]);
        }
        if (!*out)
            *out = curve_constant(1.0f);
    }
    return true;
}

static void *constant_create(const struct scene *s, bool is_spectrum, const params *p,
                             GError **error)
{
    (void)s;
    constant *c = g_new0(constant, 1);
    c->number = 1.0f;
    bool ok = is_spectrum ? read_spectrum(c, p, error)
                          : params_float(p, "value", &c->number, error);
    if (ok)
        return c;
    constant_free(c);
    return NULL;
}

static float constant_eval_float(const void *self, const surface_hit *hit)
{
    (void)hit;
    const constant *c = self;
    return c->number;
}

static spectrum constant_eval_spectrum(const void *self, const surface_hit *hit,
                                       const wavelengths *w, curve_role role)
{
    (void)hit;
    const constant *c = self;
    return curve_eval(c->by_role[role], w);
}

const texture_kind texture_constant = {
    .name = "constant",
    .create = constant_create,
    .free = constant_free,
    .eval_float = constant_eval_float,
    .eval_spectrum = constant_eval_spectrum,
};
