/*
 * The environment in a picture. Directions are drawn in proportion to it, for light
 * sampling and for photons alike; photons start on a disk that covers the scene, so
 * Φ = π R² ∫ L dω.
 *
 * With a portal, a rectangle in the world, the environment is only seen through it, from
 * the side that n = (p3 - p0) x (p1 - p0) points away from, as in pbrt-v4. Points are
 * then lit from places uniform on the portal, and photons pass it: Φ = A ∫ L cosθ dω.
 */
#include "color/observer.h"
#include "light/light_kinds.h"
#include "params/build_context.h"
#include "texture/sphere_map.h"

#include <string.h>

/* Without one, area is 0. */
typedef struct environment_portal {
    vec3 corner, u, v, n; /* p0, p1 - p0, p3 - p0 */
    float area;
} environment_portal;

typedef struct image_environment {
    sphere_map map;
    frame axes; /* of the picture, in the world; may be left-handed */
    float scale;
    curve *total;     /* ∫ L dω over the sphere */
    curve *passing;   /* Φ through the portal; NULL without one */
    float irradiance; /* the largest on a plane, as a share of the total */
    light_disk disk;
    environment_portal portal;
} image_environment;

static void free_environment(void *self)
{
    image_environment *l = self;
    sphere_map_clear(&l->map);
    curve_unref(l->total);
    curve_unref(l->passing);
    g_free(l);
}

/* ---- The portal ---- */

static bool read_portal(environment_portal *portal, const params *p, GError **error)
{
    const param *q = params_find(p, "portal");
    if (!q)
        return true;
    vec3 c[4] = {{0}};
    if (q->type == PARAM_POINT3 && q->n == 12)
        for (int i = 0; i < 4; i++)
            c[i] = vec3_make(q->numbers[3 * i], q->numbers[3 * i + 1],
                             q->numbers[3 * i + 2]);
    portal->corner = c[0];
    portal->u = c[1] - c[0];
    portal->v = c[3] - c[0];
    vec3 n = cross3(portal->v, portal->u);
    portal->area = length3_of_area(n);
    portal->n = normalize3(n);
    float size = length3(portal->u) * length3(portal->v);
    bool is_rectangle = finite3(n) && portal->area > 0.999f * size && size > 0.0f &&
                        length3_2(c[2] - c[1] - portal->v) < 1e-6f * size;
    if (!is_rectangle)
        error_at(error, q->place,
                 "parameter 'portal': expected four corners of a rectangle in turn");
    return is_rectangle;
}

/* Whether the ray from p along d goes out through it; *distance to there. */
static bool through(const environment_portal *portal, vec3 p, vec3 d, float *distance)
{
    float cosine = dot3(d, portal->n);
    if (!(cosine > 0.0f))
        return false;
    *distance = dot3(portal->corner - p, portal->n) / cosine;
    vec3 at = p + *distance * d - portal->corner;
    float u = dot3(at, portal->u) / length3_2(portal->u);
    float v = dot3(at, portal->v) / length3_2(portal->v);
    return *distance > 0.0f && u >= 0.0f && u <= 1.0f && v >= 0.0f && v <= 1.0f;
}

static vec3 portal_point(const environment_portal *portal, vec2 u)
{
    return portal->corner + u.x * portal->u + u.y * portal->v;
}

/* ---- Making ---- */

/* What is summed over the picture. */
typedef struct environment_sum {
    const image_environment *light;
    emission_sum emission;
    double illuminance;     /* on a plane that looks up, of luminance */
    double on_planes[3][2]; /* on planes that look along the axes, of R, G and B's mean */
    emission_sum passing;   /* ∫ L cosθ dω of the portal */
} environment_sum;

static void add_part(void *data, vec3 d, const float rgb[3], float solid_angle)
{
    environment_sum *sum = data;
    const color_space *space = sum->light->map.pic->space;
    float xyz[3], mean = (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f);
    emission_sum_add(&sum->emission, space, rgb, (double)solid_angle);
    float cosine = dot3(frame_to_world(&sum->light->axes, d), sum->light->portal.n);
    if (cosine > 0.0f)
        emission_sum_add(&sum->passing, space, rgb, (double)(cosine * solid_angle));
    color_space_to_xyz(space, rgb, xyz);
    sum->illuminance += (double)(xyz[1] * maxf(d[2], 0.0f) * solid_angle);
    for (int i = 0; i < 3; i++)
        sum->on_planes[i][d[i] > 0.0f] += (double)(fabsf(d[i]) * mean * solid_angle);
}

/* pbrt-v4: the picture is scaled so that a plane that looks to +z has the illuminance. */
static bool read_scale(image_environment *l, const environment_sum *sum, const params *p,
                       GError **error)
{
    emitter white;
    if (!emitter_init(&white, p, NULL, l->map.pic->space, error))
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

static bool sum_up(image_environment *l, const params *p, GError **error)
{
    environment_sum sum = {.light = l};
    sphere_map_parts(&l->map, add_part, &sum);
    if (!read_scale(l, &sum, p, error))
        return false;
    l->total = emission_sum_curve(&sum.emission, l->scale);
    if (l->portal.area > 0.0f)
        l->passing = emission_sum_curve(&sum.passing, l->scale * l->portal.area);
    for (int i = 0; i < 6; i++)
        l->irradiance =
            maxf(l->irradiance, (float)(sum.on_planes[i / 2][i % 2] / l->map.integral));
    return true;
}

/* L as a colour: pbrt-v4, too, has pictures alone behind portals. */
static bool read_color(const params *p, const color_space **space, float rgb[3],
                       GError **error)
{
    const param *q = params_find(p, "L");
    g_autoptr(curve) c = NULL;
    if (!q) {
        error_at(error, p->place,
                 "a portal needs 'filename' or 'L' of what shines behind it, found none");
        return false;
    }
    if (!params_curve(p, "L", CURVE_EMISSION, &c, error))
        return false;
    *space = p->space;
    if (q->type == PARAM_RGB) {
        memcpy(rgb, q->numbers, 3 * sizeof *rgb);
        return true;
    }
    const observer *eye = observer_get();
    float xyz[3] = {0}, all = 0.0f;
    for (int k = 0; k < GRID_N; k++) {
        for (int i = 0; i < 3; i++)
            xyz[i] += curve_at(c, (float)(GRID_FIRST + k)) * eye->xyz[i][k];
        all += eye->xyz[1][k];
    }
    for (int i = 0; i < 3; i++)
        xyz[i] /= all;
    color_space_from_xyz(*space, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = maxf(rgb[i], 0.0f);
    return true;
}

static bool read_constant(image_environment *l, const params *p, GError **error)
{
    enum { SIDE = 64 }; /* what is summed over its texels is exact enough */
    const color_space *space;
    float rgb[3];
    picture *pic = read_color(p, &space, rgb, error)
                       ? picture_of_color(SIDE, space, rgb, error)
                       : NULL;
    return pic && sphere_map_init(&l->map, pic, p->place, error);
}

static bool read_picture(image_environment *l, const build_context *context,
                         const params *p, GError **error)
{
    if (!params_has(p, "filename"))
        return read_constant(l, p, error);
    if (params_has(p, "L")) {
        error_at(error, params_find(p, "L")->place,
                 "an infinite light has either 'L' or 'filename'");
        return false;
    }
    picture *pic = picture_read_light(context, p, "filename", error);
    if (!pic)
        return false;
    source_place place = params_find(p, "filename")->place;
    if (!sphere_map_init(&l->map, pic, place, error))
        return false;
    if (context && place.line > 0) /* a reader that made it knows */
        log_message(&context->log, LOG_NOTE,
                    "%s:%d: the environment's picture is read as %s map", place.file,
                    place.line, sphere_map_layout(&l->map));
    return true;
}

static bool has_picture(const params *p)
{
    return params_has(p, "filename") || params_has(p, "portal");
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)on;
    image_environment *l = g_new0(image_environment, 1);
    if (light_axes(&l->axes, to_world, p, error) && read_portal(&l->portal, p, error) &&
        read_picture(l, context, p, error) && sum_up(l, p, error))
        return l;
    free_environment(l);
    return NULL;
}

static void prepare(void *self, vec3 center, float radius)
{
    ((image_environment *)self)->disk = (light_disk){center, radius};
}

/* ---- Asking ---- */

static spectrum power(const void *self, const wavelengths *w)
{
    const image_environment *l = self;
    return l->passing ? curve_eval(l->passing, w)
                      : light_disk_area(&l->disk) * curve_eval(l->total, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const image_environment *l = self;
    return (light_bound){.irradiance =
                             l->irradiance * spectrum_mean(curve_eval(l->total, w))};
}

/* Radiance from local direction d. */
static spectrum radiance_from(const image_environment *l, vec3 d, const wavelengths *w)
{
    float rgb[3];
    sphere_map_rgb(&l->map, d, rgb);
    return l->scale * rgb_eval(l->map.pic->space, rgb, CURVE_EMISSION, w);
}

/* A direction in the world from where light comes; *radiance from there. */
static vec3 draw(const image_environment *l, const wavelengths *w, vec2 u,
                 spectrum *radiance, float *pdf)
{
    vec3 local = sphere_map_sample(&l->map, u, pdf);
    *radiance = radiance_from(l, local, w);
    return frame_to_world(&l->axes, local);
}

/* Density of starting places across a direction. */
static float position_pdf(const image_environment *l, vec3 direction)
{
    return l->passing ? 1.0f / (l->portal.area * fabsf(dot3(direction, l->portal.n)))
                      : 1.0f / light_disk_area(&l->disk);
}

static light_emission leave(const image_environment *l, vec3 origin, vec3 direction,
                            float pdf_direction, spectrum flux)
{
    return (light_emission){
        .ray = {.origin = origin, .direction = direction, .t_max = INFINITY},
        .n = direction,
        .flux = flux,
        .pdf_position = position_pdf(l, direction),
        .pdf_direction = pdf_direction};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive;
    const image_environment *l = self;
    spectrum radiance;
    float pdf;
    vec3 direction = -draw(l, w, u_direction, &radiance, &pdf);
    if (l->passing && !(dot3(direction, l->portal.n) < 0.0f))
        return false;
    vec3 start = l->passing ? light_disk_before(&l->disk, direction,
                                                portal_point(&l->portal, u_position))
                            : light_disk_start(&l->disk, direction, u_position);
    *out = leave(l, start, direction, pdf, radiance / (position_pdf(l, direction) * pdf));
    return pdf > 0.0f;
}

/* A photon's line passes the portal from outside. */
static bool admits(const void *self, const ray *r, float *begins)
{
    const image_environment *l = self;
    float behind = 4.0f * l->disk.radius, distance;
    *begins = -INFINITY;
    if (!l->passing)
        return true;
    if (!through(&l->portal, r->origin + behind * r->direction, -r->direction, &distance))
        return false;
    *begins = behind - distance;
    return true;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)n;
    const image_environment *l = self;
    float distance;
    *pdf_position = position_pdf(l, direction);
    *pdf_direction = sphere_map_pdf(&l->map, frame_to_local(&l->axes, -direction));
    vec3 far = p + 4.0f * l->disk.radius * direction;
    if (l->passing && !through(&l->portal, far, -direction, &distance))
        *pdf_position = *pdf_direction = 0.0f;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive;
    const image_environment *l = self;
    spectrum radiance;
    float pdf;
    vec3 direction = -draw(l, w, u, &radiance, &pdf);
    *out = leave(l, light_disk_before(&l->disk, direction, target), direction, pdf,
                 radiance / pdf);
    return pdf > 0.0f;
}

/* Density at ref of a direction that leaves through the portal at a distance. */
static float portal_pdf(const environment_portal *portal, vec3 wi, float distance)
{
    return square(distance) / (portal->area * dot3(wi, portal->n));
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)u_primitive;
    const image_environment *l = self;
    *out = (light_sample){.distance = INFINITY};
    if (l->passing) {
        vec3 to = portal_point(&l->portal, u) - ref;
        out->wi = normalize3(to);
        if (!(dot3(out->wi, l->portal.n) > 0.0f))
            return false;
        out->pdf = portal_pdf(&l->portal, out->wi, length3(to));
        out->radiance = radiance_from(l, frame_to_local(&l->axes, out->wi), w);
    } else {
        out->wi = draw(l, w, u, &out->radiance, &out->pdf);
    }
    out->n = -out->wi;
    return out->pdf > 0.0f;
}

static float pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit)
{
    (void)hit;
    const image_environment *l = self;
    float distance;
    if (!l->passing)
        return sphere_map_pdf(&l->map, frame_to_local(&l->axes, wi));
    return through(&l->portal, ref, wi, &distance) ? portal_pdf(&l->portal, wi, distance)
                                                   : 0.0f;
}

static spectrum environment(const void *self, vec3 p, vec3 d, const wavelengths *w)
{
    const image_environment *l = self;
    float distance;
    if (l->passing && !through(&l->portal, p, d, &distance))
        return spectrum_fill(0.0f);
    return radiance_from(l, frame_to_local(&l->axes, d), w);
}

const light_kind light_image_environment = {
    .name = "infinite",
    .parameters = "L filename scale illuminance portal",
    .is_meant = has_picture,
    .is_environment = true,
    .is_parallel = true,
    .create = create,
    .free = free_environment,
    .prepare = prepare,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = pdf,
    .environment = environment,
    .admits = admits,
};
