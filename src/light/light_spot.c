/*
 * The spot light: full intensity within the inner angle, fading to nothing at the outer
 * one by smoothstep in the cosine.
 *
 * Everything is written in y = 1 - cos θ, which keeps its digits for narrow beams:
 *
 *   I(y)/I0 = 1          y <= inner         x = (outer - y) / (outer - inner)
 *           = 3x² - 2x³  inner < y < outer
 *
 * Solid angle is 2π dy, so Φ = 2π I0 (inner + (outer - inner)/2). Emission has the
 * density I/Φ: y is uniform in the inner part, and in the outer one 2x³ - x⁴ is the
 * cumulative distribution of x, counted from the dark end.
 */
#include "light/light_kinds.h"
#include "math/frame.h"
#include "math/warp.h"

typedef struct spot_light {
    emitter intensity; /* I0, along the axis */
    vec3 p;
    frame axis;
    float inner, outer; /* 1 - cos */
    float solid_angle;  /* Φ / I0 */
} spot_light;

static float one_minus_cos(float degrees)
{
    return (float)one_minus_cos_of_angle((double)degrees / 180.0 * G_PI);
}

static void free_spot(void *self)
{
    spot_light *l = self;
    emitter_clear(&l->intensity);
    g_free(l);
}

static bool read_cone(spot_light *l, const params *p, GError **error)
{
    float angle = 30.0f, delta = 5.0f;
    if (!params_float(p, "coneangle", &angle, error) ||
        !params_float(p, "conedeltaangle", &delta, error))
        return false;
    if (!(angle > 0.0f && angle <= 180.0f) || !(delta >= 0.0f && delta <= angle)) {
        error_at(error, p->place,
                 "a spot light needs 0 < coneangle <= 180 and 0 <= conedeltaangle <= "
                 "coneangle, found %g and %g",
                 (double)angle, (double)delta);
        return false;
    }
    l->outer = one_minus_cos(angle);
    l->inner = one_minus_cos(angle - delta);
    l->solid_angle = 2.0f * PI_F * 0.5f * (l->inner + l->outer);
    return true;
}

static bool read_axis(spot_light *l, const params *p, const transform *to_world,
                      GError **error)
{
    vec3 from = {0}, to = vec3_make(0.0f, 0.0f, 1.0f);
    if (!params_point3(p, "from", &from, error) || !params_point3(p, "to", &to, error))
        return false;
    vec3 axis = normalize3(transform_vector(to_world, to - from));
    if (!(length3_2(axis) > 0.0f)) {
        error_at(error, p->place, "a spot light's \"from\" and \"to\" must differ");
        return false;
    }
    l->p = transform_point(to_world, from);
    l->axis = frame_from_normal(axis);
    return true;
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)context, (void)on;
    spot_light *l = g_new0(spot_light, 1);
    if (read_cone(l, p, error) && read_axis(l, p, to_world, error) &&
        emitter_init(&l->intensity, p, "I", NULL, error) &&
        emitter_set_total(&l->intensity, p, "power", l->solid_angle, error))
        return l;
    free_spot(l);
    return NULL;
}

static spectrum power(const void *self, const wavelengths *w)
{
    const spot_light *l = self;
    return l->solid_angle * emitter_eval(&l->intensity, w);
}

/* I / I0 in a direction: 1 - cos θ of two unit vectors is half their distance squared. */
static float falloff(const spot_light *l, vec3 direction)
{
    float y = 0.5f * length3_2(direction - l->axis.n);
    if (y <= l->inner)
        return 1.0f;
    if (y >= l->outer)
        return 0.0f;
    float x = (l->outer - y) / (l->outer - l->inner);
    return x * x * (3.0f - 2.0f * x);
}

/* Solves 2x³ - x⁴ = c in [0, 1]: Newton's steps, kept in a shrinking bracket. */
static float solve_fade(float c)
{
    double low = 0.0, high = 1.0, x = cbrt(0.5 * (double)c);
    for (int i = 0; i < 12; i++) {
        double excess = x * x * x * (2.0 - x) - (double)c;
        if (excess > 0.0)
            high = x;
        else
            low = x;
        double slope = x * x * (6.0 - 4.0 * x);
        double next = x - excess / slope;
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return (float)x;
}

static vec3 sample_cone(const spot_light *l, vec2 u)
{
    float mass = u.x * 0.5f * (l->inner + l->outer), y = mass;
    if (mass > l->inner) {
        float width = l->outer - l->inner;
        float share = clampf((mass - l->inner) / (0.5f * width), 0.0f, 1.0f);
        y = l->outer - width * solve_fade(1.0f - share);
    }
    float r = sqrtf(maxf(y * (2.0f - y), 0.0f));
    float phi = 2.0f * PI_F * u.y;
    return frame_to_world(&l->axis, vec3_make(r * cosf(phi), r * sinf(phi), 1.0f - y));
}

static light_emission leave(const spot_light *l, vec3 direction, spectrum flux)
{
    return light_leave_point(l->p, direction, falloff(l, direction) / l->solid_angle,
                             flux);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const spot_light *l = self;
    float intensity = spectrum_mean(emitter_eval(&l->intensity, w));
    return (light_bound){
        .is_local = true, .box = {l->p, l->p}, .power = 4.0f * PI_F * intensity};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive, (void)u_position;
    const spot_light *l = self;
    *out = leave(l, sample_cone(l, u_direction), power(self, w));
    return true;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n;
    const spot_light *l = self;
    *pdf_position = 1.0f;
    *pdf_direction = falloff(l, direction) / l->solid_angle;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive, (void)u;
    const spot_light *l = self;
    vec3 direction = normalize3(target - l->p);
    float share = falloff(l, direction);
    *out = leave(l, direction, share * emitter_eval(&l->intensity, w));
    return share > 0.0f && length3_2(direction) > 0.0f;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)u_primitive, (void)u;
    const spot_light *l = self;
    spectrum intensity =
        falloff(l, normalize3(ref - l->p)) * emitter_eval(&l->intensity, w);
    return light_arrive_from_point(l->p, ref, intensity, out);
}

static cone3 beam(const void *self)
{
    const spot_light *l = self;
    return (cone3){l->p, l->axis.n, 1.0f - l->outer};
}

const light_kind light_spot = {
    .name = "spot",
    .parameters = "I scale power from to coneangle conedeltaangle",
    .is_delta = true,
    .create = create,
    .free = free_spot,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = light_delta_pdf,
    .beam = beam,
};
