/*
 * The diffuse area light: a shape that sends the same radiance L to all directions of its
 * front (where n_geom points), or of both sides, Φ = π A L per side. L may be a spectrum
 * texture (ours): it is looked up where light leaves, places are drawn by area alone.
 */
#include "light/light_kinds.h"
#include "math/frame.h"
#include "math/warp.h"
#include "texture/picture.h"
#include "texture/texture.h"

typedef struct area_light {
    emitter radiance;
    const shape *on; /* borrowed */
    bool two_sided;
    spectrum_input colors; /* textured: times radiance.scale, in place of its spectrum */
    picture *pic;          /* the same as pbrt has it: over the whole of u and v */
} area_light;

enum { N_MEAN = 1024 };

static void free_area(void *self)
{
    area_light *l = self;
    emitter_clear(&l->radiance);
    spectrum_input_clear(&l->colors);
    picture_unref(l->pic);
    g_free(l);
}

static bool is_textured(const area_light *l)
{
    return l->colors.texture || l->pic;
}

static spectrum pictured(const area_light *l, const surface_hit *hit,
                         const wavelengths *w)
{
    float rgb[3];
    vec2 st = {hit->uv.x, 1.0f - hit->uv.y};
    texel_mix mix = picture_bilinear(l->pic, 0, st, WRAP_CLAMP);
    picture_rgb(l->pic, &mix, rgb);
    return l->radiance.scale * rgb_eval(l->pic->space, rgb, CURVE_EMISSION, w);
}

static spectrum shines(const area_light *l, const surface_hit *hit, const wavelengths *w)
{
    if (l->pic)
        return pictured(l, hit, w);
    if (!l->colors.texture)
        return emitter_eval(&l->radiance, w);
    return l->radiance.scale * spectrum_input_eval(&l->colors, hit, w);
}

/* L at a place drawn on the shape, less what a cut-out takes of it; alpha 0 everywhere
 * makes a light that is not seen but shines (pbrt-v4). */
static spectrum shines_from(const area_light *l, const shape_sample *at,
                            const wavelengths *w)
{
    if (!is_textured(l) && !l->on->has_alpha)
        return emitter_eval(&l->radiance, w);
    const surface_hit hit = {.p = at->p,
                             .n = at->n,
                             .n_geom = at->n,
                             .uv = at->uv,
                             .primitive = at->primitive,
                             .mesh = at->mesh,
                             .corners = at->corners};
    return shines(l, &hit, w) * (l->on->is_invisible ? 1.0f : shape_opacity(l->on, &hit));
}

/* Mean over the surface: by points spread evenly (Roberts' sequence) if it
 * is textured. */
static spectrum mean_radiance(const area_light *l, const wavelengths *w)
{
    spectrum sum = {0};
    if (!is_textured(l))
        return emitter_eval(&l->radiance, w);
    for (int i = 0; i < N_MEAN; i++) {
        float x = ((float)i + 0.5f) / N_MEAN, y = 0.7548777f * (float)i,
              z = 0.5698403f * (float)i;
        shape_sample at =
            shape_sample_area(l->on, x, (vec2){y - floorf(y), z - floorf(z)});
        sum += shines_from(l, &at, w);
    }
    return sum / N_MEAN;
}

/* Φ / L */
static float exitance(const area_light *l)
{
    return (l->two_sided ? 2.0f : 1.0f) * PI_F * l->on->area;
}

/* What is textured is given the power that its mean over the surface asks for. */
static bool set_textured_power(area_light *l, const params *p, GError **error)
{
    enum { N = 16 };
    float y = 0.0f;
    if (!params_has(p, "power"))
        return true;
    for (int i = 0; i < N; i++) {
        const wavelengths w = wavelengths_at(((float)i + 0.5f) / N);
        float xyz[3];
        spectrum_to_xyz(&w, mean_radiance(l, &w), xyz);
        y += xyz[1] / N;
    }
    if (y > 0.0f)
        return emitter_set_total(&l->radiance, p, "power", exitance(l) * y, error);
    error_at(error, params_find(p, "power")->place,
             "the light's picture is black where the shape is: no scale gives it power");
    return false;
}

static bool read_picture(area_light *l, const build_context *context, const params *p,
                         GError **error)
{
    if (params_has(p, "L")) {
        error_at(error, params_find(p, "L")->place,
                 "an area light has either 'L' or 'filename'");
        return false;
    }
    l->pic = picture_read_light(context, p, "filename", error);
    return l->pic && emitter_init(&l->radiance, p, NULL, l->pic->space, error);
}

/* The emitter is white where it is textured, for its scale. */
static bool read_radiance(area_light *l, const build_context *context, const params *p,
                          GError **error)
{
    const param *q = params_find(p, "L");
    bool textured = q && q->type == PARAM_TEXTURE;
    if (params_has(p, "filename"))
        return read_picture(l, context, p, error) && set_textured_power(l, p, error);
    if (textured)
        return spectrum_input_init(&l->colors, context, p, "L", CURVE_EMISSION, NULL,
                                   error) &&
               emitter_init(&l->radiance, p, NULL, NULL, error) &&
               set_textured_power(l, p, error);
    return emitter_init(&l->radiance, p, "L", NULL, error) &&
           emitter_set_total(&l->radiance, p, "power", exitance(l), error);
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)to_world;
    area_light *l = g_new0(area_light, 1);
    l->on = on;
    if (!(on->area > 0.0f))
        error_at(error, on->place, "a shape that shines must have an area");
    else if (params_bool(p, "twosided", &l->two_sided, error) &&
             read_radiance(l, context, p, error))
        return l;
    free_area(l);
    return NULL;
}

static spectrum power(const void *self, const wavelengths *w)
{
    const area_light *l = self;
    return exitance(l) * mean_radiance(l, w);
}

/* cosθ / π over the sides that shine; 0 behind a one-sided light. */
static float direction_pdf(const area_light *l, float cosine)
{
    if (l->two_sided)
        return 0.5f * INV_PI_F * fabsf(cosine);
    return INV_PI_F * maxf(0.0f, cosine);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const area_light *l = self;
    float intensity = spectrum_mean(mean_radiance(l, w)) * l->on->area;
    return (light_bound){.is_local = true,
                         .box = l->on->kind->bounds(l->on->self),
                         .power = 4.0f * PI_F * intensity};
}

static void leave(const area_light *l, const shape_sample *at, vec3 direction,
                  light_emission *out)
{
    out->ray = (ray){.origin = offset_point(at->p, at->n, 0.0f, at->error, direction),
                     .direction = direction,
                     .t_max = INFINITY};
    out->n = at->n;
    out->primitive = at->primitive;
    out->pdf_position = at->pdf;
    out->pdf_direction = direction_pdf(l, dot3(at->n, direction));
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    const area_light *l = self;
    shape_sample at = shape_sample_area(l->on, u_primitive, u_position);
    bool back = l->two_sided && u_direction.x >= 0.5f;
    if (l->two_sided)
        u_direction.x = 2.0f * u_direction.x - (back ? 1.0f : 0.0f);
    vec3 local = warp_cosine_hemisphere(u_direction);
    frame f = frame_from_normal(back ? -at.n : at.n);
    leave(l, &at, frame_to_world(&f, local), out);
    out->flux = exitance(l) * shines_from(l, &at, w);
    return out->pdf_direction > 0.0f;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p;
    const area_light *l = self;
    *pdf_position = 1.0f / l->on->area;
    *pdf_direction = direction_pdf(l, dot3(n, direction));
}

/* From where a ray will start: off the surface by what may be much of a far target. */
static vec3 start_toward(const shape_sample *at, vec3 target)
{
    return offset_point(at->p, at->n, 0.0f, at->error, target - at->p);
}

static bool leave_toward(const area_light *l, const wavelengths *w,
                         const shape_sample *at, vec3 target, light_emission *out)
{
    vec3 direction = normalize3(target - start_toward(at, target));
    leave(l, at, direction, out);
    out->flux = shines_from(l, at, w) * (fabsf(dot3(at->n, direction)) * l->on->area);
    return out->pdf_direction > 0.0f;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    const area_light *l = self;
    shape_sample at = shape_sample_area(l->on, u_primitive, u);
    return leave_toward(l, w, &at, target, out);
}

static bool emit_aimed(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                       vec3 center, const light_aim *aim, light_emission *out)
{
    const area_light *l = self;
    shape_sample at = shape_sample_area(l->on, u_primitive, u);
    vec3 target = aim->target(aim->data, start_toward(&at, center));
    return leave_toward(l, w, &at, target, out);
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    const area_light *l = self;
    shape_sample at;
    if (!shape_sample_toward(l->on, ref, u_primitive, u, &at))
        return false;
    vec3 to = at.p - ref;
    float distance = length3(to);
    if (!(distance > 0.0f) || !(l->two_sided || dot3(at.n, to) < 0.0f))
        return false;
    *out = (light_sample){.wi = to / distance,
                          .distance = distance,
                          .radiance = shines_from(l, &at, w),
                          .pdf = at.pdf,
                          .n = at.n};
    return true;
}

static float pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit)
{
    (void)wi;
    const area_light *l = self;
    return shape_pdf_toward(l->on, ref, hit);
}

static spectrum radiance(const void *self, const surface_hit *hit, vec3 wo,
                         const wavelengths *w)
{
    const area_light *l = self;
    if (l->two_sided || dot3(hit->n_geom, wo) > 0.0f)
        return shines(l, hit, w);
    return spectrum_fill(0.0f);
}

const light_kind light_area = {
    .name = "diffuse",
    .parameters = "L filename scale power twosided",
    .create = create,
    .free = free_area,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .emit_aimed = emit_aimed,
    .sample = sample,
    .pdf = pdf,
    .radiance = radiance,
};
