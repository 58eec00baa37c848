/*
 * "mix": one of two materials at each point, by chance, the second with probability
 * "amount". The chance is a hash of the point, so that it is the same for photons and the
 * eye, and on any thread.
 */
#include "material/material_kinds.h"
#include "math/sampler.h"
#include "params/build_context.h"

#include <string.h>

typedef struct mixture {
    const material *parts[2]; /* of the scene */
    float_input amount;
} mixture;

static const material *find_part(const build_context *context, const param *q,
                                 const char *name, GError **error)
{
    const material *part = context ? g_hash_table_lookup(context->materials, name) : NULL;
    if (part && !material_interior(part))
        return part;
    if (part) {
        error_at(
            error, q->place,
            "parameter 'materials': '%s' fills space with a medium, which can not be "
            "mixed",
            name);
        return NULL;
    }
    error_at(error, q->place,
             "parameter 'materials': expected the name of a material made before, found "
             "'%s'",
             name);
    return NULL;
}

static bool read_parts(mixture *m, const build_context *context, const params *p,
                       GError **error)
{
    const param *q = params_find(p, "materials");
    if (!q || q->type != PARAM_STRING || q->n != 2) {
        error_at(error, q ? q->place : p->place,
                 "a mix needs \"string materials\" with two names");
        return false;
    }
    for (int i = 0; i < 2; i++)
        if (!(m->parts[i] = find_part(context, q, q->strings[i], error)))
            return false;
    return true;
}

static void *mixture_create(const build_context *context, const params *p, GError **error)
{
    mixture *m = g_new0(mixture, 1);
    if (read_parts(m, context, p, error) &&
        float_input_init(&m->amount, context, p, "amount", 0.5f, error))
        return m;
    g_free(m);
    return NULL;
}

/* Uniform in [0, 1), by where the point is. */
static float chance_of(vec3 p)
{
    uint64_t bits[2];
    memcpy(bits, &p, sizeof bits);
    bits[1] &= 0xffffffffu; /* the unused lane */
    return (float)(hash_mix(hash_mix(bits[0], bits[1]), 0x6d69u) >> 40) * 0x1p-24f;
}

static void mixture_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                         const bsdf_options *options, bsdf *out)
{
    const mixture *m = self;
    bool second = chance_of(hit->p) < float_input_eval(&m->amount, hit);
    const material *part = m->parts[second];
    if (part->bump)
        out->shading = bump_frame(part->bump, hit);
    part->kind->make_bsdf(part->self, hit, w, options, out);
}

static unsigned mixture_lobes(const void *self)
{
    const mixture *m = self;
    return m->parts[0]->kind->possible_lobes(m->parts[0]->self) |
           m->parts[1]->kind->possible_lobes(m->parts[1]->self);
}

const material_kind material_mix = {
    .name = "mix",
    .parameters = "materials amount",
    .create = mixture_create,
    .free = g_free,
    .make_bsdf = mixture_bsdf,
    .possible_lobes = mixture_lobes,
};
