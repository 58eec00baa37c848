/*
 * The point light: the same intensity to all sides, Φ = 4π I.
 */
#include "light/light_kinds.h"
#include "math/warp.h"

typedef struct point_light {
    emitter intensity;
    vec3 p;
} point_light;

static const float all_around = 4.0f * PI_F;

static void free_point(void *self)
{
    point_light *l = self;
    emitter_clear(&l->intensity);
    g_free(l);
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)context, (void)on;
    point_light *l = g_new0(point_light, 1);
    vec3 from = {0};
    if (params_point3(p, "from", &from, error) &&
        emitter_init(&l->intensity, p, "I", NULL, error) &&
        emitter_set_total(&l->intensity, p, "power", all_around, error)) {
        l->p = transform_point(to_world, from);
        return l;
    }
    free_point(l);
    return NULL;
}

static spectrum power(const void *self, const wavelengths *w)
{
    const point_light *l = self;
    return all_around * emitter_eval(&l->intensity, w);
}

static light_emission leave(const point_light *l, vec3 direction, spectrum flux)
{
    return light_leave_point(l->p, direction, 1.0f / all_around, flux);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const point_light *l = self;
    return (light_bound){
        .is_local = true, .box = {l->p, l->p}, .power = spectrum_mean(power(self, w))};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive, (void)u_position;
    *out = leave(self, warp_sphere(u_direction), power(self, w));
    return true;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)self, (void)p, (void)n, (void)direction;
    *pdf_position = 1.0f;
    *pdf_direction = 1.0f / all_around;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive, (void)u;
    const point_light *l = self;
    vec3 direction = normalize3(target - l->p);
    *out = leave(l, direction, emitter_eval(&l->intensity, w));
    return length3_2(direction) > 0.0f;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)u_primitive, (void)u;
    const point_light *l = self;
    spectrum intensity = emitter_eval(&l->intensity, w);
    return light_arrive_from_point(l->p, ref, intensity, out);
}

const light_kind light_point = {
    .name = "point",
    .parameters = "I scale power from",
    .is_delta = true,
    .create = create,
    .free = free_point,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = light_delta_pdf,
};
