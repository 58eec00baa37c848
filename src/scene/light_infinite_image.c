/*
 * The environment in a picture. Directions are drawn in proportion to it, for light
 * sampling and for photons alike; photons start on a disk that covers the scene, so
 * Φ = π R² ∫ L dω.
 */
#include "scene/light_kinds.h"
#include "scene/scene.h"
#include "scene/sphere_map.h"

typedef struct image_sky {
    sphere_map map;
    frame axes; /* of the picture, in the world; may be left-handed */
    float scale;
    curve *total;     /* ∫ L dω over the sphere */
    float irradiance; /* the largest on a plane, as a share of the total */
    light_disk disk;
} image_sky;

static void free_sky(void *self)
{
    image_sky *l = self;
    sphere_map_clear(&l->map);
    curve_unref(l->total);
    g_free(l);
}

/* ---- Making ---- */

/* What is summed over the picture. */
typedef struct sky_sum {
    const image_sky *light;
    emission_sum emission;
    double illuminance;     /* on a plane that looks up, of luminance */
    double on_planes[3][2]; /* on planes that look along the axes, of R, G and B's mean */
} sky_sum;

static void add_part(void *data, vec3 d, const float rgb[3], float solid_angle)
{
    sky_sum *sum = data;
    const color_space *space = sum->light->map.pic.space;
    float xyz[3], mean = (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f);
    emission_sum_add(&sum->emission, space, rgb, (double)solid_angle);
    color_space_to_xyz(space, rgb, xyz);
    sum->illuminance += (double)(xyz[1] * maxf(d[2], 0.0f) * solid_angle);
    for (int i = 0; i < 3; i++)
        sum->on_planes[i][d[i] > 0.0f] += (double)(fabsf(d[i]) * mean * solid_angle);
}

/* pbrt-v4: the picture is scaled so that a plane that looks to +z has the illuminance. */
static bool read_scale(image_sky *l, const sky_sum *sum, const params *p, GError **error)
{
    emitter white;
    if (!emitter_init(&white, p, NULL, l->map.pic.space, error))
        return false;
    bool done = sum->illuminance > 0.0 || !params_has(p, "illuminance");
    if (done)
        done =
            emitter_set_total(&white, p, "illuminance", (float)sum->illuminance, error);
    else
        error_at(error, params_find(p, "illuminance")->place,
                 "the picture's upper half is black: no scale gives it an illuminance");
    l->scale = white.scale;
    emitter_clear(&white);
    return done;
}

static bool sum_up(image_sky *l, const params *p, GError **error)
{
    sky_sum sum = {.light = l};
    sphere_map_parts(&l->map, add_part, &sum);
    if (!read_scale(l, &sum, p, error))
        return false;
    l->total = emission_sum_curve(&sum.emission, l->scale);
    for (int i = 0; i < 6; i++)
        l->irradiance =
            maxf(l->irradiance, (float)(sum.on_planes[i / 2][i % 2] / l->map.integral));
    return true;
}

static bool read_picture(image_sky *l, const struct scene *s, const params *p,
                         GError **error)
{
    picture pic;
    if (params_has(p, "L")) {
        error_at(error, params_find(p, "L")->place,
                 "an infinite light has either 'L' or 'filename'");
        return false;
    }
    if (!picture_read(&pic, s, p, "filename", NULL, error))
        return false;
    source_place place = params_find(p, "filename")->place;
    if (!sphere_map_init(&l->map, &pic, place, error))
        return false;
    if (s)
        log_message(&s->log, LOG_NOTE, "%s:%d: the sky's picture is read as %s map",
                    place.file, place.line, sphere_map_layout(&l->map));
    return true;
}

static bool has_filename(const params *p)
{
    return params_has(p, "filename");
}

static void *create(const struct scene *s, const params *p, const transform *to_world,
                    const shape *on, GError **error)
{
    (void)on;
    image_sky *l = g_new0(image_sky, 1);
    if (light_axes(&l->axes, to_world, p, error) && read_picture(l, s, p, error) &&
        sum_up(l, p, error))
        return l;
    free_sky(l);
    return NULL;
}

static void prepare(void *self, vec3 center, float radius)
{
    ((image_sky *)self)->disk = (light_disk){center, radius};
}

/* ---- Asking ---- */

static spectrum power(const void *self, const wavelengths *w)
{
    const image_sky *l = self;
    return light_disk_area(&l->disk) * curve_eval(l->total, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const image_sky *l = self;
    return (light_bound){.irradiance =
                             l->irradiance * spectrum_mean(curve_eval(l->total, w))};
}

/* Radiance from local direction d. */
static spectrum radiance_from(const image_sky *l, vec3 d, const wavelengths *w)
{
    float rgb[3];
    sphere_map_rgb(&l->map, d, rgb);
    return l->scale * rgb_eval(l->map.pic.space, rgb, CURVE_EMISSION, w);
}

/* A direction in the world from where light comes; *radiance from there. */
static vec3 draw(const image_sky *l, const wavelengths *w, vec2 u, spectrum *radiance,
                 float *pdf)
{
    vec3 local = sphere_map_sample(&l->map, u, pdf);
    *radiance = radiance_from(l, local, w);
    return frame_to_world(&l->axes, local);
}

static light_emission leave(const image_sky *l, vec3 origin, vec3 direction,
                            float pdf_direction, spectrum flux)
{
    return (light_emission){
        .ray = {.origin = origin, .direction = direction, .t_max = INFINITY},
        .n = direction,
        .flux = flux,
        .pdf_position = 1.0f / light_disk_area(&l->disk),
        .pdf_direction = pdf_direction};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive;
    const image_sky *l = self;
    spectrum radiance;
    float pdf;
    vec3 direction = -draw(l, w, u_direction, &radiance, &pdf);
    *out = leave(l, light_disk_start(&l->disk, direction, u_position), direction, pdf,
                 radiance * (light_disk_area(&l->disk) / pdf));
    return pdf > 0.0f;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n;
    const image_sky *l = self;
    *pdf_position = 1.0f / light_disk_area(&l->disk);
    *pdf_direction = sphere_map_pdf(&l->map, frame_to_local(&l->axes, -direction));
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive;
    const image_sky *l = self;
    spectrum radiance;
    float pdf;
    vec3 direction = -draw(l, w, u, &radiance, &pdf);
    *out = leave(l, light_disk_before(&l->disk, direction, target), direction, pdf,
                 radiance / pdf);
    return pdf > 0.0f;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)ref, (void)u_primitive;
    const image_sky *l = self;
    *out = (light_sample){.distance = INFINITY};
    out->wi = draw(l, w, u, &out->radiance, &out->pdf);
    out->n = -out->wi;
    return out->pdf > 0.0f;
}

static float pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit)
{
    (void)ref, (void)hit;
    const image_sky *l = self;
    return sphere_map_pdf(&l->map, frame_to_local(&l->axes, wi));
}

static spectrum environment(const void *self, vec3 d, const wavelengths *w)
{
    const image_sky *l = self;
    return radiance_from(l, frame_to_local(&l->axes, d), w);
}

const light_kind image_sky_kind = {
    .name = "infinite",
    .parameters = "L filename scale illuminance",
    .is_meant = has_filename,
    .is_environment = true,
    .is_parallel = true,
    .create = create,
    .free = free_sky,
    .prepare = prepare,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = pdf,
    .environment = environment,
};
