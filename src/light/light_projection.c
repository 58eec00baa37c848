/*
 * The projection light: a picture thrown from a point along +z, pbrt-v4's slide
 * projector. "fov" spans the shorter side; the picture stands upright, y up.
 *
 * On the plane z = 1 the picture covers the area A; an element dA there has the solid
 * angle cos³θ dA, so Φ = A mean(I cos³θ). Directions are drawn in proportion to I cos³θ.
 */
#include "base/memory.h"
#include "light/light_kinds.h"
#include "math/distribution2.h"
#include "texture/picture.h"

typedef struct projection_light {
    picture *pic;
    distribution2 drawn;
    frame axes;
    vec3 p;
    float half_width, half_height; /* of the picture on the plane z = 1 */
    float scale, peak;
    curve *total; /* Φ */
} projection_light;

static void free_projection(void *self)
{
    projection_light *l = self;
    picture_unref(l->pic);
    distribution2_clear(&l->drawn);
    curve_unref(l->total);
    g_free(l);
}

static float plane_area(const projection_light *l)
{
    return 4.0f * l->half_width * l->half_height;
}

/* The direction, unit, through a place of the picture. */
static vec3 direction_of(const projection_light *l, vec2 st)
{
    return normalize3(vec3_make((2.0f * st.x - 1.0f) * l->half_width,
                                (1.0f - 2.0f * st.y) * l->half_height, 1.0f));
}

/* The place in the picture; false if the direction misses it. */
static bool place_of(const projection_light *l, vec3 d, vec2 *st)
{
    if (!(d[2] > 1e-3f))
        return false;
    st->x = 0.5f * (d[0] / (d[2] * l->half_width) + 1.0f);
    st->y = 0.5f * (1.0f - d[1] / (d[2] * l->half_height));
    return st->x >= 0.0f && st->x <= 1.0f && st->y >= 0.0f && st->y <= 1.0f;
}

/* ---- Making ---- */

static bool read_fov(projection_light *l, const params *p, GError **error)
{
    const texels *img = l->pic->levels[0];
    float fov = 90.0f, aspect = (float)img->width / (float)img->height;
    if (!params_float(p, "fov", &fov, error))
        return false;
    if (!(fov > 0.0f && fov < 180.0f)) {
        error_at(error, params_find(p, "fov")->place,
                 "parameter 'fov': expected degrees between 0 and 180, found %g",
                 (double)fov);
        return false;
    }
    float half = tanf(0.5f * fov * PI_F / 180.0f);
    l->half_width = half * maxf(1.0f, aspect);
    l->half_height = half * maxf(1.0f, 1.0f / aspect);
    return true;
}

typedef struct projected_sum {
    emission_sum emission;
    double y; /* of colours, times solid angle */
} projected_sum;

/* One texel: its weight for drawing, and its part of the sums. */
static float add_texel(projection_light *l, int x, int y, projected_sum *sum)
{
    const texels *img = l->pic->levels[0];
    vec2 st = {((float)x + 0.5f) / (float)img->width,
               ((float)y + 0.5f) / (float)img->height};
    float c = direction_of(l, st)[2], rgb[3], xyz[3];
    picture_texel_mean(l->pic, WRAP_CLAMP, x, y, rgb);
    double share =
        (double)(plane_area(l) * c * c * c) / ((double)img->width * (double)img->height);
    color_space_to_xyz(l->pic->space, rgb, xyz);
    sum->y += share * (double)xyz[1];
    float mean = (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f);
    l->peak = maxf(l->peak, mean);
    if (mean > 0.0f)
        emission_sum_add(&sum->emission, l->pic->space, rgb, share);
    return mean * c * c * c;
}

static bool sum_up(projection_light *l, projected_sum *sum, source_place place,
                   GError **error)
{
    const texels *img = l->pic->levels[0];
    size_t width = (size_t)img->width, height = (size_t)img->height;
    float *weights = big_alloc(width * height, sizeof *weights, "a light", error);
    if (!weights)
        return false;
    for (int y = 0; y < img->height; y++)
        for (int x = 0; x < img->width; x++)
            weights[(size_t)y * width + (size_t)x] = add_texel(l, x, y, sum);
    bool done = distribution2_init(&l->drawn, weights, width, height, error);
    big_free(weights);
    if (done && !(distribution2_mean(&l->drawn) > 0.0)) {
        error_at(error, place, "the light's image is black");
        return false;
    }
    return done;
}

static bool read_light(projection_light *l, const build_context *context, const params *p,
                       GError **error)
{
    projected_sum sum = {0};
    emitter white;
    l->pic = picture_read_light(context, p, "filename", error);
    if (!l->pic)
        return false;
    source_place place = params_find(p, "filename")->place;
    if (!read_fov(l, p, error) || !sum_up(l, &sum, place, error) ||
        !emitter_init(&white, p, NULL, l->pic->space, error))
        return false;
    bool done = emitter_set_total(&white, p, "power", (float)sum.y, error);
    l->scale = white.scale;
    l->total = emission_sum_curve(&sum.emission, l->scale);
    emitter_clear(&white);
    return done;
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)on;
    projection_light *l = g_new0(projection_light, 1);
    l->p = transform_point(to_world, (vec3){0});
    if (light_axes(&l->axes, to_world, p, error) && read_light(l, context, p, error))
        return l;
    free_projection(l);
    return NULL;
}

/* ---- Asking ---- */

static spectrum intensity_at(const projection_light *l, vec2 st, const wavelengths *w)
{
    float rgb[3];
    texel_mix mix = picture_bilinear(l->pic, 0, st, WRAP_CLAMP);
    picture_rgb(l->pic, &mix, rgb);
    return l->scale * rgb_eval(l->pic->space, rgb, CURVE_EMISSION, w);
}

static spectrum power(const void *self, const wavelengths *w)
{
    const projection_light *l = self;
    return curve_eval(l->total, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const projection_light *l = self;
    const float white[3] = {l->peak, l->peak, l->peak};
    float peak =
        l->scale * spectrum_mean(rgb_eval(l->pic->space, white, CURVE_EMISSION, w));
    /* between what the brightest direction and what all together get */
    float mean = spectrum_mean(power(self, w));
    return (light_bound){
        .is_local = true, .box = {l->p, l->p}, .power = sqrtf(4.0f * PI_F * peak * mean)};
}

/* Density per solid angle, of one over the picture. */
static float over_sphere(const projection_light *l, float pdf, float cosine)
{
    return pdf / (plane_area(l) * cosine * cosine * cosine);
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive, (void)u_position;
    const projection_light *l = self;
    float pdf;
    vec2 st = distribution2_sample(&l->drawn, u_direction, &pdf);
    vec3 local = direction_of(l, st);
    pdf = over_sphere(l, pdf, local[2]);
    *out = light_leave_point(l->p, frame_to_world(&l->axes, local), pdf,
                             intensity_at(l, st, w) / pdf);
    return pdf > 0.0f;
}

static spectrum intensity_toward(const projection_light *l, vec3 direction,
                                 const wavelengths *w)
{
    vec2 st;
    bool inside = place_of(l, frame_to_local(&l->axes, direction), &st);
    return inside ? intensity_at(l, st, w) : (spectrum){0};
}

static float density_toward(const projection_light *l, vec3 direction)
{
    vec3 local = frame_to_local(&l->axes, direction);
    vec2 st;
    if (!place_of(l, local, &st))
        return 0.0f;
    return over_sphere(l, distribution2_pdf(&l->drawn, st), local[2]);
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n;
    *pdf_position = 1.0f;
    *pdf_direction = density_toward(self, direction);
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive, (void)u;
    const projection_light *l = self;
    vec3 direction = normalize3(target - l->p);
    *out = light_leave_point(l->p, direction, density_toward(l, direction),
                             intensity_toward(l, direction, w));
    return out->pdf_direction > 0.0f;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)u_primitive, (void)u;
    const projection_light *l = self;
    spectrum intensity = intensity_toward(l, normalize3(ref - l->p), w);
    return light_arrive_from_point(l->p, ref, intensity, out);
}

/* Around the picture's corners. */
static cone3 beam(const void *self)
{
    const projection_light *l = self;
    const vec3 corner = direction_of(l, (vec2){0.0f, 0.0f});
    return (cone3){l->p, l->axes.n, corner[2]};
}

const light_kind light_projection = {
    .name = "projection",
    .parameters = "filename fov scale power",
    .is_delta = true,
    .create = create,
    .free = free_projection,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = light_delta_pdf,
    .beam = beam,
};
