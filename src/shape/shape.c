/*
 * The table of shapes, and what all shapes share: a sample by area is turned into a
 * sample by solid angle, dω = cosθ dA / d², for the kinds that know nothing better.
 */
#include "shape/shape.h"

#include "math/sampler.h"
#include "params/kinds.h"
#include "shape/shape_kinds.h"

#include <string.h>

static const shape_kind *const kinds[] = {
#define SHAPE(kind, file) &shape_##kind,
#include "shape/shape.def"
#undef SHAPE
};

const char *shape_kind_name(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i]->name : NULL;
}

const char *shape_kind_parameters(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i]->parameters : NULL;
}

static bool hides_nothing(const float_input *alpha)
{
    return alpha && !alpha->texture && !(alpha->constant > 0.0f);
}

static shape *shape_wrap(const shape_kind *kind, void *self, const shape_place *at,
                         source_place place)
{
    shape *s = g_new0(shape, 1);
    *s =
        (shape){.kind = kind,
                .self = self,
                .material = hides_nothing(at->alpha) ? NO_INDEX : at->material,
                .light = NO_INDEX,
                .camera_hidden = at->camera_hidden,
                .is_invisible = hides_nothing(at->alpha),
                .has_alpha = at->alpha && (at->alpha->texture || at->alpha->constant < 1),
                .alpha = at->alpha ? *at->alpha : (float_input){.constant = 1.0f},
                .object = NO_INDEX,
                .area = kind->area(self),
                .place = place};
    return s;
}

bool shape_may_be_flat(const char *name)
{
    int i = kind_find(shape_kind_name, "a shape", name, (source_place){0}, NULL);
    return i >= 0 && kinds[i]->may_be_flat;
}

shape *shape_new(const char *name, const params *p, const shape_place *at, GError **error)
{
    int i = kind_find(shape_kind_name, "a shape", name, p->place, error);
    if (i < 0)
        return NULL;
    const shape_kind *kind = kinds[i];
    void *self = kind->create(p, at, error);
    if (kind->becomes)
        kind = kind->becomes;
    if (!self)
        return NULL;
    g_autofree char *what = g_strdup_printf("shape \"%s\"", name);
    if (!params_all_used(p, what, error)) {
        kind->free(self);
        return NULL;
    }
    return shape_wrap(kind, self, at, p->place);
}

shape *shape_new_mesh(mesh *m, const shape_place *at, source_place place, GError **error)
{
    void *self = mesh_shape_create(m, at, place, error);
    return self ? shape_wrap(&shape_mesh, self, at, place) : NULL;
}

void shape_free(shape *s)
{
    if (!s)
        return;
    s->kind->free(s->self);
    g_free(s);
}

vec2 shape_retry(vec2 u, uint64_t attempt, float *third)
{
    uint32_t bits[2];
    memcpy(bits, &u, sizeof bits);
    uint64_t h = hash_mix(((uint64_t)bits[0] << 32) | bits[1], attempt);
    *third = (float)(hash_mix(h, 1) >> 40) * 0x1p-24f;
    return (vec2){(float)(h >> 40) * 0x1p-24f, (float)((h >> 8) & 0xffffff) * 0x1p-24f};
}

shape_sample shape_sample_area(const shape *s, float u_primitive, vec2 u)
{
    return s->kind->sample_area(s->self, u_primitive, u);
}

float shape_to_solid_angle(float pdf_area, vec3 ref, vec3 p, vec3 n)
{
    vec3 d = p - ref;
    float distance2 = length3_2(d);
    float cosine = fabsf(dot3(n, d)) / sqrtf(distance2);
    float pdf = pdf_area * distance2 / cosine;
    return isfinite(pdf) ? pdf : 0.0f;
}

bool shape_sample_toward(const shape *s, vec3 ref, float u_primitive, vec2 u,
                         shape_sample *out)
{
    if (s->kind->sample_toward)
        return s->kind->sample_toward(s->self, ref, u_primitive, u, out);
    *out = shape_sample_area(s, u_primitive, u);
    out->pdf = shape_to_solid_angle(out->pdf, ref, out->p, out->n);
    return out->pdf > 0.0f;
}

float shape_pdf_toward(const shape *s, vec3 ref, const surface_hit *hit)
{
    if (s->kind->pdf_toward)
        return s->kind->pdf_toward(s->self, ref, hit);
    return shape_to_solid_angle(1.0f / s->area, ref, hit->p, hit->n_geom);
}
