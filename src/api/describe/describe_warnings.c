/*
 * What is allowed, but seldom meant: glass that encloses nothing, is turned inside out or
 * has a surface where another body has one, lights shut into bodies that let no light
 * out, environments seen from behind their portal or through fog that hides them, lights
 * that are not in the medium one sees them through, scenes of strange size.
 */
#include "api/describe/describe.h"

#include "scene/advance.h"
#include "scene/scene_media.h"
#include "shape/mesh_closed.h"

#include <math.h>

#define LARGEST_RADIUS 1e4f /* m */
#define SMALLEST_RADIUS 1e-4f

typedef struct inspection {
    const scene *scene;
    const camera *camera;
    GPtrArray *warnings; /* char* */
} inspection;

static void warn(inspection *in, const char *format, ...) G_GNUC_PRINTF(2, 3);

static void warn(inspection *in, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_ptr_array_add(in->warnings, g_strdup_vprintf(format, args));
    va_end(args);
}

static const material *material_of_shape(const scene *s, const shape *on)
{
    return on->material == NO_INDEX ? NULL : s->materials->pdata[on->material];
}

static const char *name_of(const material *m)
{
    return m->name ? m->name : m->kind->name;
}

/* ---- Glass ---- */

/* Whether the surface's own normals point into the body. */
static bool is_inside_out(const shape *on, const mesh *m, const mesh_body *body)
{
    shape_sample at = shape_sample_area(on, 0.37f, (vec2){0.3f, 0.4f});
    const uint32_t *corner = m->indices + 3 * (size_t)at.primitive;
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *v = m->positions + 3 * (size_t)corner[k];
        p[k] = vec3_make(v[0], v[1], v[2]);
    }
    float same = dot3(at.n, cross3(p[1] - p[0], p[2] - p[0]));
    return body->volume * (double)same < 0.0;
}

static void inspect_glass(inspection *in, guint i)
{
    const shape *on = in->scene->shapes->pdata[i];
    const material *m = material_of_shape(in->scene, on);
    const mesh *triangles = on->kind->triangles ? on->kind->triangles(on->self) : NULL;
    mesh_body body;
    if (!m || !triangles || !material_encloses(m) ||
        !mesh_body_of(triangles, &body, NULL))
        return;
    if (!body.closed)
        warn(in,
             "shape %u of solid glass ('%s') is open: light that enters it may never "
             "leave",
             i, name_of(m));
    else if (is_inside_out(on, triangles, &body))
        warn(in,
             "shape %u of solid glass ('%s') is inside out: its normals point inwards", i,
             name_of(m));
}

/* ---- Surfaces in one place ---- */

/* Points of all shapes of glass that are looked at, and of each. */
enum { QUERIES = 1 << 18, LEAST_QUERIES = 8, MOST_QUERIES = 256 };

/* Rays look for a surface from this far, over the width of the shape it is asked of. */
#define QUERY_DISTANCE 1e-3f

static shape_sample point_of(const shape *on, unsigned k, unsigned n)
{
    float at = (float)k + 0.5f, y = 0.7548777f * at, z = 0.5698403f * at;
    return shape_sample_area(on, at / (float)n, (vec2){y - floorf(y), z - floorf(z)});
}

/* The shape that a ray meets where it should meet shape i at a point; i if that is so.
   The ray comes aslant, so that rounding does not always decide for the same shape.
   It comes from both sides in turn. @param k number of the ray */
static int met_instead(const inspection *in, guint i, const shape_sample *at, unsigned k)
{
    const shape *on = in->scene->shapes->pdata[i];
    const frame f = frame_from_normal(k % 2 ? -at->n : at->n);
    float u = 0.4656f * (float)k, v = 0.3247f * (float)k;
    vec3 slant = f.s * (u - floorf(u) - 0.43f) + f.t * (v - floorf(v) - 0.61f);
    vec3 from = normalize3(f.n + slant);
    float distance = QUERY_DISTANCE * sqrtf(on->area);
    float rounding = maxf(8e-6f * max_component3(abs3(at->p)), at->error);
    ray r = {
        .origin = at->p + from * distance, .direction = -from, .t_max = 2.0f * distance};
    surface_hit hit;
    bool met = scene_intersect(in->scene, &r, &hit);
    return met && fabsf(hit.t - distance) < rounding ? hit.shape : (int)i;
}

/* Where glass stands right on a table, rounding tells which of the two a ray meets, and
   it passes the other. Lights and what lets nothing through may touch one another. */
static void inspect_touching(inspection *in, guint i, unsigned n_queries)
{
    const shape *on = in->scene->shapes->pdata[i];
    const material *m = material_of_shape(in->scene, on);
    if (!m || on->object != NO_INDEX || !material_encloses(m))
        return;
    for (unsigned k = 0; k < 2 * n_queries; k++) {
        shape_sample at = point_of(on, k / 2, n_queries);
        int other = met_instead(in, i, &at, k);
        if (other == (int)i)
            continue;
        warn(in,
             "shape %u of solid glass ('%s') and shape %d have surfaces in one place, "
             "where light is lost: leave a gap between them, or let them overlap",
             i, name_of(m), other);
        return;
    }
}

/* ---- Lights ---- */

static bool lets_light_through(const scene *s, const surface_hit *hit)
{
    return hit->material == NO_INDEX ||
           (scene_possible_lobes(s, hit) & LOBE_TRANSMISSION);
}

enum { N_WAYS = 26 };

/* To the sides, edges and corners of a cube. */
static vec3 way_out(int k)
{
    int cell = k < N_WAYS / 2 ? k : k + 1;
    return normalize3(vec3_make((float)(cell % 3 - 1), (float)(cell / 3 % 3 - 1),
                                (float)(cell / 9 - 1)));
}

/* The one shape around a point whose inner side is seen all around; NO_INDEX: none. */
static int shape_around(const scene *s, vec3 p)
{
    int found = NO_INDEX;
    for (int k = 0; k < N_WAYS; k++) {
        ray r = {.origin = p, .direction = way_out(k), .t_max = INFINITY};
        surface_hit hit;
        if (!scene_intersect(s, &r, &hit) || lets_light_through(s, &hit) ||
            !(dot3(hit.n_geom, r.direction) > 0.0f) ||
            (found != NO_INDEX && found != hit.shape))
            return NO_INDEX;
        found = hit.shape;
    }
    return found;
}

static bool box_holds(box3 box, vec3 p)
{
    for (int i = 0; i < 3; i++)
        if (p[i] < box.low[i] || p[i] > box.high[i])
            return false;
    return true;
}

/* A room around light and camera is as it should be. */
static void inspect_light(inspection *in, guint i)
{
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = in->scene->lights->pdata[i];
    light_bound bound = l->kind->bound(l->self, &w);
    if (!bound.is_local || !l->kind->is_delta)
        return;
    int around = shape_around(in->scene, box3_center(bound.box));
    if (around == NO_INDEX)
        return;
    const shape *on = in->scene->shapes->pdata[around];
    vec3 eye = transform_point(&in->camera->to_world, (vec3){0});
    if (!box_holds(on->kind->bounds(on->self), eye))
        warn(in, "light %u (%s) is shut into shape %d, which lets no light out", i,
             l->kind->name, around);
}

/* A portal lets light in on one side only. */
static void inspect_environment(inspection *in, guint i)
{
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = in->scene->lights->pdata[i];
    const vec3 places[] = {transform_point(&in->camera->to_world, (vec3){0}),
                           in->scene->center};
    light_sample seen;
    for (size_t k = 0; k < G_N_ELEMENTS(places); k++)
        if (l->kind->sample(l->self, &w, places[k], 0.5f, (vec2){0.5f, 0.5f}, &seen))
            return;
    warn(in,
         "light %u (%s) reaches neither the camera nor the middle of the scene: a portal "
         "lets light in on one side, which the order of its corners tells",
         i, l->kind->name);
}

static const char *medium_name(const scene *s, uint32_t number)
{
    const medium *m = scene_medium(s, number);
    return m ? m->name : "none";
}

/* A light in sight stands in the medium that the way from the camera leads to, or an
   interface is missing. */
static void inspect_light_in_medium(inspection *in, guint i)
{
    const scene *s = in->scene;
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = s->lights->pdata[i];
    ray r = {.origin = transform_point(&in->camera->to_world, (vec3){0}),
             .media.participating = in->camera->media.participating};
    light_sample seen;
    if (!scene_has_media(s) ||
        !l->kind->sample(l->self, &w, r.origin, 0.5f, (vec2){0.4f, 0.3f}, &seen) ||
        !isfinite(seen.distance))
        return;
    r.direction = seen.wi;
    r.t_max = seen.distance * (1.0f - 1e-3f);
    uint32_t behind = scene_medium_behind(s, r);
    uint32_t is = scene_light_medium(s, (int)i, seen.n, -seen.wi);
    if (behind == is || scene_occluded(s, &r))
        return;
    warn(in,
         "light %u (%s) is in medium '%s', but the way to it from the camera ends in "
         "'%s': a MediumInterface is missing on it, at the light or before the camera",
         i, l->kind->name, medium_name(s, is), medium_name(s, behind));
}

static ray ray_from_camera(const inspection *in, int k)
{
    return (ray){.origin = transform_point(&in->camera->to_world, (vec3){0}),
                 .direction = way_out(k),
                 .t_max = INFINITY,
                 .media.participating = in->camera->media.participating};
}

/* A surface that says that its near side is in another medium than the way to it. */
static bool contradicts(const surface_hit *hit, vec3 direction)
{
    return hit->boundary &&
           hit_media(hit, -direction).participating != hit->media.participating;
}

/* The first of those on a ray, as far as light goes. */
static bool find_contradiction(const scene *s, ray r, surface_hit *hit)
{
    for (int i = 0; i < MOST_CROSSINGS && scene_cross(s, &r, hit); i++) {
        if (contradicts(hit, r.direction))
            return true;
        if (!lets_light_through(s, hit))
            return false;
    }
    return false;
}

/* Which of two media fills a place must not depend on the way there, or integrators
   differ. */
static void inspect_interfaces(inspection *in)
{
    const scene *s = in->scene;
    for (int k = 0; k < N_WAYS; k++) {
        ray r = ray_from_camera(in, k);
        surface_hit hit;
        if (!find_contradiction(s, r, &hit))
            continue;
        warn(in,
             "shape %d is seen from the camera through medium '%s', but its "
             "MediumInterface has '%s' on that side: its normals, or the two media, are "
             "the wrong way round, or another surface's are",
             hit.shape, medium_name(s, hit.media.participating),
             medium_name(s, hit_media(&hit, -r.direction).participating));
        return;
    }
}

/* Less of a light is as good as none. */
#define LEAST_LEFT 0.01f

/* A medium without bounds may leave next to nothing of light from beyond all. */
static void inspect_fog(inspection *in, guint i)
{
    const scene *s = in->scene;
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = s->lights->pdata[i];
    bool comes_from_beyond = l->kind->is_environment || l->kind->is_parallel;
    if (!comes_from_beyond || !s->outer_medium)
        return;
    for (int k = 0; k < N_WAYS; k++) {
        ray r = ray_from_camera(in, k);
        if (spectrum_mean(scene_transmittance(s, &r, &w)) > LEAST_LEFT)
            return;
    }
    warn(in,
         "light %u (%s) hardly reaches the camera through medium '%s', which no surface "
         "bounds",
         i, l->kind->name, medium_name(s, s->outer_medium));
}

/* ---- All of it ---- */

GPtrArray *describe_warnings(const view *v)
{
    const scene *s = v->scene;
    inspection in = {s, &v->camera, g_ptr_array_new_with_free_func(g_free)};
    unsigned queries = QUERIES / MAX(s->shapes->len, 1);
    for (guint i = 0; i < s->shapes->len; i++) {
        inspect_glass(&in, i);
        inspect_touching(&in, i, CLAMP(queries, LEAST_QUERIES, MOST_QUERIES));
    }
    for (guint i = 0; i < s->lights->len; i++) {
        const light *l = s->lights->pdata[i];
        if (l->kind->is_environment)
            inspect_environment(&in, i);
        else
            inspect_light(&in, i);
        inspect_fog(&in, i);
        inspect_light_in_medium(&in, i);
    }
    if (scene_has_media(s))
        inspect_interfaces(&in);
    if (s->shapes->len > 0 && (s->radius > LARGEST_RADIUS || s->radius < SMALLEST_RADIUS))
        warn(&in, "the scene is %g m wide; lengths are in metres",
             2.0 * (double)s->radius);
    return in.warnings;
}
