/*
 * "mix": one of two materials at each point, by chance, the second with probability
 * "amount". The chance is a hash of the point, so that it is the same for photons and the
 * eye, and on any thread.
 */
#include "material/material_kinds.h"
#include "math/sampler.h"
#include "params/build_context.h"

#include <string.h>

/* A mix of mixes calls as deep as they nest. */
enum { DEEPEST = 1000 };

typedef struct mixture {
    const material *parts[2]; /* of the scene */
    float_input amount;
    unsigned depth; /* 1: of no mixes */
    unsigned lobes;
    bool is_pane; /* a part is */
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

static bool measure(mixture *m, const params *p, GError **error)
{
    m->depth = 1;
    for (int i = 0; i < 2; i++) {
        const material *part = m->parts[i];
        const mixture *inner = part->kind == &material_mix ? part->self : NULL;
        m->depth = MAX(m->depth, inner ? inner->depth + 1 : 1);
        m->lobes |= part->lobes;
        m->is_pane |= material_is_pane(part);
    }
    if (m->depth <= DEEPEST)
        return true;
    error_at(error, p->place, "expected mixes of at most %d levels, found %u", DEEPEST,
             m->depth);
    return false;
}

static void *mixture_create(const build_context *context, const params *p, GError **error)
{
    mixture *m = g_new0(mixture, 1);
    if (read_parts(m, context, p, error) && measure(m, p, error) &&
        float_input_init(&m->amount, context, p, "amount", 0.5f, error))
        return m;
    g_free(m);
    return NULL;
}

/* Uniform in [0, 1), by where the point is; at each level of mixes another number, or the
 * inner choice would follow the outer one. */
static float chance_of(vec3 p, unsigned depth)
{
    uint64_t bits[2];
    memcpy(bits, &p, sizeof bits);
    bits[1] &= 0xffffffffu; /* the unused lane */
    return (float)(hash_mix(hash_mix(bits[0], bits[1]), 0x6d68u + depth) >> 40) *
           0x1p-24f;
}

static void mixture_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                         const bsdf_options *options, bsdf *out)
{
    const mixture *m = self;
    bool second = chance_of(hit->p, m->depth) < float_input_eval(&m->amount, hit);
    const material *part = m->parts[second];
    if (part->bump)
        out->shading = bump_frame(part->bump, hit);
    part->kind->make_bsdf(part->self, hit, w, options, out);
}

static unsigned mixture_lobes(const void *self)
{
    return ((const mixture *)self)->lobes;
}

static bool mixture_is_pane(const void *self)
{
    return ((const mixture *)self)->is_pane;
}

const material_kind material_mix = {
    .name = "mix",
    .parameters = "materials amount",
    .create = mixture_create,
    .free = g_free,
    .make_bsdf = mixture_bsdf,
    .possible_lobes = mixture_lobes,
    .is_pane = mixture_is_pane,
};
