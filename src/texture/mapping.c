#include "texture/mapping.h"

#include <glib.h>
#include <string.h>

typedef struct mapping_kind {
    const char *name;
    bool (*read)(mapping2 *m, const params *p, GError **error);
    texture_point2 (*eval)(const mapping2 *m, const surface_hit *hit);
} mapping_kind;

static bool read_uv(mapping2 *m, const params *p, GError **error)
{
    return params_float(p, "uscale", &m->scale.x, error) &&
           params_float(p, "vscale", &m->scale.y, error) &&
           params_float(p, "udelta", &m->delta.x, error) &&
           params_float(p, "vdelta", &m->delta.y, error);
}

static float share_of(float width, vec3 derivative)
{
    float length = length3(derivative);
    return width > 0.0f && length > 0.0f ? width / length : 0.0f;
}

static texture_point2 eval_uv(const mapping2 *m, const surface_hit *hit)
{
    return (texture_point2){
        .st = {m->scale.x * hit->uv.x + m->delta.x, m->scale.y * hit->uv.y + m->delta.y},
        .ds = fabsf(m->scale.x) * share_of(hit->footprint, hit->dpdu),
        .dt = fabsf(m->scale.y) * share_of(hit->footprint, hit->dpdv)};
}

static bool read_nothing(mapping2 *m, const params *p, GError **error)
{
    (void)m, (void)p, (void)error;
    return true;
}

/* The footprint in texture space: the mean over axes, for transforms that stretch. */
static float width_in_texture(const mapping2 *m, const surface_hit *hit)
{
    if (!(hit->footprint > 0.0f))
        return 0.0f;
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        vec3 axis = {0};
        axis[i] = 1.0f;
        sum += length3(transform_vector(&m->to_texture, axis));
    }
    return hit->footprint * sum / 3.0f;
}

static float around(vec3 p)
{
    float phi = atan2f(p[1], p[0]);
    return phi < 0.0f ? phi + 2.0f * PI_F : phi;
}

static texture_point2 eval_spherical(const mapping2 *m, const surface_hit *hit)
{
    vec3 p = transform_point(&m->to_texture, hit->p);
    float distance = maxf(length3(p), 1e-30f), width = width_in_texture(m, hit);
    float across = maxf(sqrtf(p[0] * p[0] + p[1] * p[1]), 1e-30f);
    return (texture_point2){.st = {acosf(clampf(p[2] / distance, -1.0f, 1.0f)) * INV_PI_F,
                                   around(p) * 0.5f * INV_PI_F},
                            .ds = minf(1.0f, width * INV_PI_F / distance),
                            .dt = minf(1.0f, width * 0.5f * INV_PI_F / across)};
}

static texture_point2 eval_cylindrical(const mapping2 *m, const surface_hit *hit)
{
    vec3 p = transform_point(&m->to_texture, hit->p);
    float width = width_in_texture(m, hit);
    float across = maxf(sqrtf(p[0] * p[0] + p[1] * p[1]), 1e-30f);
    return (texture_point2){.st = {(PI_F + atan2f(p[1], p[0])) * 0.5f * INV_PI_F, p[2]},
                            .ds = minf(1.0f, width * 0.5f * INV_PI_F / across),
                            .dt = width};
}

static bool read_vector(const params *p, const char *name, vec3 *out, GError **error)
{
    if (!params_point3(p, name, out, error))
        return false;
    if (length3_2(*out) > 0.0f)
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a vector that is not zero", name);
    return false;
}

static bool read_planar(mapping2 *m, const params *p, GError **error)
{
    m->v1 = vec3_make(1.0f, 0.0f, 0.0f);
    m->v2 = vec3_make(0.0f, 1.0f, 0.0f);
    return read_vector(p, "v1", &m->v1, error) && read_vector(p, "v2", &m->v2, error) &&
           params_float(p, "udelta", &m->delta.x, error) &&
           params_float(p, "vdelta", &m->delta.y, error);
}

static texture_point2 eval_planar(const mapping2 *m, const surface_hit *hit)
{
    vec3 p = transform_point(&m->to_texture, hit->p);
    float width = width_in_texture(m, hit);
    return (texture_point2){
        .st = {m->delta.x + dot3(p, m->v1), m->delta.y + dot3(p, m->v2)},
        .ds = width * length3(m->v1),
        .dt = width * length3(m->v2)};
}

static const mapping_kind kinds[] = {
    {"uv", read_uv, eval_uv},
    {"spherical", read_nothing, eval_spherical},
    {"cylindrical", read_nothing, eval_cylindrical},
    {"planar", read_planar, eval_planar},
};

const char *const *mapping2_names(void)
{
    static const char *const names[] = {"uv", "spherical", "cylindrical", "planar", NULL};
    return names;
}

bool mapping2_init(mapping2 *m, const params *p, GError **error)
{
    int chosen = 0;
    *m = (mapping2){.scale = {1.0f, 1.0f}};
    if (!params_choice(p, "mapping", mapping2_names(), &chosen, error))
        return false;
    m->kind = &kinds[chosen];
    m->to_texture = transform_inverse(&p->to_world);
    return m->kind->read(m, p, error);
}

texture_point2 mapping2_eval(const mapping2 *m, const surface_hit *hit)
{
    return m->kind->eval(m, hit);
}
