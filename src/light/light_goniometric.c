/*
 * The goniometric light: a point whose intensity depends on the direction, from a picture
 * of all directions or from an IES profile.
 *
 * pbrt-v4 turns the picture so that its +z is the light's +y, and its +y the light's +z.
 * An IES profile hangs in it likewise: γ = 0, down, is the light's -y, C = 0 its +x and
 * C = 90 its +z. Its candela become watts per steradian by 683 lm/W and the spectrum's
 * own efficacy: ∫ ȳ I dλ is candela / 683. The table is resampled to half degrees and
 * scaled so that its integral, the lumens, stays exactly.
 */
#include "base/input.h"
#include "light/ies.h"
#include "light/light_kinds.h"
#include "params/build_context.h"
#include "texture/sphere_map.h"

#include <string.h>

/* lm/W at 555 nm, which defines the candela. */
#define LUMENS_PER_WATT 683.0

enum { IES_WIDTH = 720, IES_HEIGHT = 360 };

typedef struct goniometric_light {
    emitter intensity;
    sphere_map map;
    frame axes; /* of the map, in the world */
    vec3 p;
    float peak; /* of the map */
} goniometric_light;

static void free_goniometric(void *self)
{
    goniometric_light *l = self;
    emitter_clear(&l->intensity);
    sphere_map_clear(&l->map);
    g_free(l);
}

/* ---- Making ---- */

static image *resampled(const ies_profile *ies, GError **error)
{
    static const char *const channel[] = {"Y"};
    image *img = image_new(IES_WIDTH, IES_HEIGHT, 1, channel, error);
    for (int i = 0; img && i < IES_WIDTH * IES_HEIGHT; i++) {
        float c = 360.0f * ((float)(i % IES_WIDTH) + 0.5f) / IES_WIDTH;
        float up = 180.0f * ((float)(i / IES_WIDTH) + 0.5f) / IES_HEIGHT;
        img->pixels[i] = ies_candela(ies, 180.0f - up, c);
    }
    return img;
}

static bool take_profile(goniometric_light *l, const ies_profile *ies, source_place place,
                         GError **error)
{
    image *img = resampled(ies, error);
    if (!img)
        return false;
    if (!sphere_map_init(&l->map, picture_from_grey(img, error), place, error))
        return false;
    l->intensity.scale *= (float)(ies_lumens(ies) / (l->map.integral * LUMENS_PER_WATT));
    return true;
}

static bool read_profile(goniometric_light *l, const char *path, source_place place,
                         GError **error)
{
    GError *inner = NULL;
    ies_profile ies = {0};
    input in;
    bool done = input_read(&in, path, &inner);
    if (done && !(done = ies_read(&ies, in.data, &inner)))
        g_prefix_error(&inner, "%s: ", path);
    input_close(&in);
    if (done)
        done = take_profile(l, &ies, place, error);
    else
        error_move_at(error, place, inner);
    ies_clear(&ies);
    return done;
}

/* The same to all sides, as pbrt-v4 has it without a picture. */
static bool even_map(goniometric_light *l, source_place place, GError **error)
{
    static const char *const channel[] = {"Y"};
    image *img = image_new(1, 1, 1, channel, error);
    if (!img)
        return false;
    img->pixels[0] = 1.0f;
    return sphere_map_init(&l->map, picture_from_grey(img, error), place, error);
}

static bool read_map(goniometric_light *l, const build_context *context, const params *p,
                     GError **error)
{
    g_autofree char *path = NULL;
    if (!params_path(p, "filename", &path, error))
        return false;
    if (!path)
        return even_map(l, p->place, error);
    source_place place = params_find(p, "filename")->place;
    g_autofree char *lower = g_ascii_strdown(path, -1);
    if (g_str_has_suffix(lower, ".ies")) {
        if (context)
            scene_sources_add(context->sources, path);
        return read_profile(l, path, place, error);
    }
    return sphere_map_init(&l->map, picture_read_light(context, p, "filename", error),
                           place, error);
}

static float value_in(const goniometric_light *l, vec3 local)
{
    float rgb[3];
    sphere_map_rgb(&l->map, local, rgb);
    return (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f);
}

static void find_peak(void *data, vec3 d, const float rgb[3], float solid_angle)
{
    (void)d, (void)solid_angle;
    goniometric_light *l = data;
    l->peak = maxf(l->peak, (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f));
}

/* "power" is what the light's Y comes to in all directions together. */
static bool read_light(goniometric_light *l, const build_context *context,
                       const params *p, GError **error)
{
    if (!emitter_init(&l->intensity, p, "I", NULL, error))
        return false;
    float before = l->intensity.scale;
    if (!read_map(l, context, p, error))
        return false;
    if (params_has(p, "power"))
        l->intensity.scale = before;
    sphere_map_parts(&l->map, find_peak, l);
    return emitter_set_total(&l->intensity, p, "power", (float)l->map.integral, error);
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)on;
    goniometric_light *l = g_new0(goniometric_light, 1);
    frame axes;
    if (light_axes(&axes, to_world, p, error) && read_light(l, context, p, error)) {
        l->axes = (frame){axes.s, axes.n, axes.t};
        l->p = transform_point(to_world, (vec3){0});
        return l;
    }
    free_goniometric(l);
    return NULL;
}

/* ---- Asking ---- */

static spectrum power(const void *self, const wavelengths *w)
{
    const goniometric_light *l = self;
    return (float)l->map.integral * emitter_eval(&l->intensity, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const goniometric_light *l = self;
    float peak = l->peak * spectrum_mean(emitter_eval(&l->intensity, w));
    /* between what the brightest direction and what all together get */
    float mean = spectrum_mean(power(self, w));
    return (light_bound){
        .is_local = true, .box = {l->p, l->p}, .power = sqrtf(4.0f * PI_F * peak * mean)};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive, (void)u_position;
    const goniometric_light *l = self;
    float pdf;
    vec3 local = sphere_map_sample(&l->map, u_direction, &pdf);
    *out = light_leave_point(l->p, frame_to_world(&l->axes, local), pdf,
                             emitter_eval(&l->intensity, w) * (value_in(l, local) / pdf));
    return pdf > 0.0f;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n;
    const goniometric_light *l = self;
    *pdf_position = 1.0f;
    *pdf_direction = sphere_map_pdf(&l->map, frame_to_local(&l->axes, direction));
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive, (void)u;
    const goniometric_light *l = self;
    vec3 direction = normalize3(target - l->p);
    vec3 local = frame_to_local(&l->axes, direction);
    float value = value_in(l, local);
    *out = light_leave_point(l->p, direction, sphere_map_pdf(&l->map, local),
                             value * emitter_eval(&l->intensity, w));
    return value > 0.0f && length3_2(direction) > 0.0f;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)u_primitive, (void)u;
    const goniometric_light *l = self;
    vec3 local = frame_to_local(&l->axes, normalize3(ref - l->p));
    spectrum intensity = value_in(l, local) * emitter_eval(&l->intensity, w);
    return light_arrive_from_point(l->p, ref, intensity, out);
}

const light_kind light_goniometric = {
    .name = "goniometric",
    .parameters = "I scale power filename",
    .is_delta = true,
    .create = create,
    .free = free_goniometric,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = light_delta_pdf,
};
