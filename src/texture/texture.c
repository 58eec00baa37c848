/*
 * Making textures by kind, and the inputs of materials: a constant or a texture each.
 */
#include "texture/texture_kinds.h"

#include "params/build_context.h"
#include "params/kinds.h"

struct texture {
    const texture_kind *kind;
    void *self;
    bool is_spectrum;
    unsigned steps;
};

/* A chain of textures calls as deep as it is long, and where each looks at the one before
 * twice, twenty make a million. What people draw has some tens. */
enum { MOST_STEPS = 1000 };

static const texture_kind *const kinds[] = {
#define TEXTURE(kind, file) &texture_##kind,
#include "texture/texture.def"
#undef TEXTURE
};

const texture_kind *texture_kind_at(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i] : NULL;
}

static const char *name_of(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i]->name : NULL;
}

static bool steps_possible(const texture *t, const params *p, GError **error)
{
    if (t->steps <= MOST_STEPS)
        return true;
    error_at(error, p->place,
             "expected at most %d textures in one, each counted as often as it is used, "
             "found %u",
             MOST_STEPS, t->steps);
    return false;
}

texture *texture_new(const build_context *context, const char *kind, bool is_spectrum,
                     const params *p, GError **error)
{
    int i = kind_find(name_of, "a texture", kind, p->place, error);
    if (i < 0)
        return NULL;
    const texture_kind *k = kinds[i];
    g_autofree char *what = g_strdup_printf("texture '%s'", kind);
    if (!params_known(p, what, k->parameters, NULL, error))
        return NULL;
    void *self = k->create(context, is_spectrum, p, error);
    if (!self)
        return NULL;
    texture *t = g_new0(texture, 1);
    *t = (texture){k, self, is_spectrum, 1 + (k->input_steps ? k->input_steps(self) : 0)};
    if (!steps_possible(t, p, error) || !params_all_used(p, what, error)) {
        texture_free(t);
        return NULL;
    }
    return t;
}

void texture_free(texture *t)
{
    if (!t)
        return;
    t->kind->free(t->self);
    g_free(t);
}

float texture_eval_float(const texture *t, const surface_hit *hit)
{
    return t->kind->eval_float(t->self, hit);
}

spectrum texture_eval_spectrum(const texture *t, const surface_hit *hit,
                               const wavelengths *w, curve_role role)
{
    return t->kind->eval_spectrum(t->self, hit, w, role);
}

unsigned texture_steps(const texture *t)
{
    return t ? t->steps : 0;
}

bool texture_is_spectrum(const texture *t)
{
    return t->is_spectrum;
}

bool texture_is_normal_map(const texture *t)
{
    return t->kind->eval_normal != NULL;
}

void texture_eval_normal(const texture *t, const surface_hit *hit, float rgb[3],
                         vec3 *dpdu, vec3 *dpdv)
{
    t->kind->eval_normal(t->self, hit, rgb, dpdu, dpdv);
}

const char *texture_kind_name(const texture *t)
{
    return t->kind->name;
}

/* The texture that parameter q names, in the table of its type. */
const texture *texture_find(const build_context *context, const param *q,
                            bool is_spectrum, GError **error)
{
    GHashTable *table = !context      ? NULL
                        : is_spectrum ? context->spectrum_textures
                                      : context->float_textures;
    GHashTable *other = !context      ? NULL
                        : is_spectrum ? context->float_textures
                                      : context->spectrum_textures;
    const char *type = is_spectrum ? "spectrum" : "float";
    const texture *t =
        q->n == 1 && table ? g_hash_table_lookup(table, q->strings[0]) : NULL;
    if (t)
        return t;
    if (q->n != 1)
        error_at(error, q->place, "parameter '%s': expected one texture, found %zu",
                 q->name, q->n);
    else if (other && g_hash_table_contains(other, q->strings[0]))
        error_at(error, q->place,
                 "parameter '%s': expected a %s texture, but '%s' is of the other type",
                 q->name, type, q->strings[0]);
    else
        error_at(error, q->place, "parameter '%s': there is no %s texture '%s'", q->name,
                 type, q->strings[0]);
    return NULL;
}

bool spectrum_input_init(spectrum_input *in, const build_context *context,
                         const params *p, const char *name, curve_role role,
                         curve *fallback, GError **error)
{
    *in = (spectrum_input){.role = role};
    const param *q = params_find(p, name);
    if (!q) {
        in->constant = fallback;
        return true;
    }
    curve_unref(fallback);
    if (q->type == PARAM_TEXTURE)
        return (in->texture = texture_find(context, q, true, error)) != NULL;
    return params_curve(p, name, role, &in->constant, error);
}

void spectrum_input_clear(spectrum_input *in)
{
    curve_unref(in->constant);
    *in = (spectrum_input){0};
}

bool spectrum_input_given(const spectrum_input *in)
{
    return in->constant || in->texture;
}

spectrum spectrum_input_eval(const spectrum_input *in, const surface_hit *hit,
                             const wavelengths *w)
{
    if (in->constant)
        return curve_eval(in->constant, w);
    return texture_eval_spectrum(in->texture, hit, w, in->role);
}

bool float_input_init(float_input *in, const build_context *context, const params *p,
                      const char *name, float fallback, GError **error)
{
    *in = (float_input){.constant = fallback};
    const param *q = params_find(p, name);
    if (q && q->type == PARAM_TEXTURE)
        return (in->texture = texture_find(context, q, false, error)) != NULL;
    return params_float(p, name, &in->constant, error);
}

float float_input_eval(const float_input *in, const surface_hit *hit)
{
    if (!in->texture)
        return in->constant;
    return texture_eval_float(in->texture, hit);
}
