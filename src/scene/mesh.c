/*
 * Triangle meshes, in world space.
 *
 * Which side is outside decides where a lamp shines and what is inside glass; pbrt's
 * rules are kept:
 *   without normals  cross(p1 - p0, p2 - p0), turned round if ReverseOrientation is on or
 *                    the transform mirrors, but not both
 *   with normals     the true normal is turned into the hemisphere of the interpolated
 *                    one; ReverseOrientation turns the normals given
 *
 * Hits are computed from barycentric weights in double precision. Embree itself works in
 * float on coordinates relative to the ray's origin; how far off the plane that may see a
 * ray that starts on it is bounded here per hit (field error), since the coordinates of
 * the hit alone do not tell: a large slanted triangle through the origin has hits with
 * tiny coordinates.
 *
 * Toward a point a triangle is chosen by area, then sampled uniformly by solid angle; one
 * that looks tiny or fills nearly the hemisphere by area, where the former loses digits.
 */
#include "base/memory.h"
#include "scene/mesh_triangle.h"
#include "scene/shape_kinds.h"

#include "math/distribution.h"
#include "math/frame.h"
#include "math/warp.h"

#include <glib.h>
#include <string.h>

typedef struct mesh_shape {
    mesh m;
    bool flip; /* for triangles without normals */
    distribution areas;
} mesh_shape;

void mesh_clear(mesh *m)
{
    big_free(m->positions);
    big_free(m->normals);
    big_free(m->tangents);
    big_free(m->uvs);
    big_free(m->indices);
    *m = (mesh){0};
}

/* ---- Building ---- */

static bool check_numbers(const float *numbers, size_t n, size_t width, const char *what,
                          source_place place, GError **error)
{
    for (size_t i = 0; numbers && i < n * width; i++) {
        if (!isfinite(numbers[i])) {
            error_at(error, place, "%s %zu of the mesh is not finite", what, i / width);
            return false;
        }
    }
    return true;
}

static bool check_mesh(const mesh *m, source_place place, GError **error)
{
    if (m->n_triangles == 0 || !m->positions || !m->indices) {
        error_at(error, place, "the mesh has no triangles");
        return false;
    }
    if (m->n_vertices > UINT32_MAX || m->n_triangles > UINT32_MAX - 1) {
        error_at(error, place, "the mesh has more than 2^32 vertices or triangles");
        return false;
    }
    for (size_t i = 0; i < 3 * m->n_triangles; i++) {
        if (m->indices[i] >= m->n_vertices) {
            error_at(error, place,
                     "index %u of triangle %zu is out of range: the mesh has %zu "
                     "vertices",
                     m->indices[i], i / 3, m->n_vertices);
            return false;
        }
    }
    return check_numbers(m->positions, m->n_vertices, 3, "position", place, error) &&
           check_numbers(m->normals, m->n_vertices, 3, "normal", place, error) &&
           check_numbers(m->tangents, m->n_vertices, 3, "tangent", place, error) &&
           check_numbers((const float *)m->uvs, m->n_vertices, 2, "uv", place, error);
}

static void store3(float *to, vec3 v)
{
    to[0] = v[0];
    to[1] = v[1];
    to[2] = v[2];
}

static void move_to_world(mesh *m, const shape_place *at)
{
    for (size_t i = 0; i < m->n_vertices; i++) {
        float *p = m->positions + 3 * i;
        store3(p, transform_point(&at->to_world, vec3_make(p[0], p[1], p[2])));
        if (m->normals) {
            float *n = m->normals + 3 * i;
            vec3 moved =
                normalize3(transform_normal(&at->to_world, vec3_make(n[0], n[1], n[2])));
            store3(n, at->reverse_orientation ? -moved : moved);
        }
        if (m->tangents) {
            float *t = m->tangents + 3 * i;
            store3(t, transform_vector(&at->to_world, vec3_make(t[0], t[1], t[2])));
        }
    }
}

static bool init_areas(mesh_shape *s, GError **error)
{
    float *areas = big_alloc(s->m.n_triangles, sizeof(float), "triangle areas", error);
    if (!areas)
        return false;
    for (size_t i = 0; i < s->m.n_triangles; i++) {
        triangle t;
        triangle_get(&s->m, i, &t);
        areas[i] = (float)triangle_area(&t);
    }
    bool done = distribution_init(&s->areas, areas, s->m.n_triangles, error);
    big_free(areas);
    return done;
}

static void mesh_shape_free(void *self)
{
    mesh_shape *s = self;
    mesh_clear(&s->m);
    distribution_clear(&s->areas);
    g_free(s);
}

void *mesh_shape_create(mesh *m, const shape_place *at, source_place place,
                        GError **error)
{
    mesh_shape *s = g_new0(mesh_shape, 1);
    s->m = *m;
    *m = (mesh){0};
    s->flip = at->reverse_orientation != transform_swaps_handedness(&at->to_world);
    if (check_mesh(&s->m, place, error)) {
        move_to_world(&s->m, at);
        if (check_numbers(s->m.positions, s->m.n_vertices, 3, "transformed position",
                          place, error) &&
            init_areas(s, error))
            return s;
    }
    mesh_shape_free(s);
    return NULL;
}

/* ---- From a scene file ---- */

/* The numbers of a per-vertex parameter; *out stays NULL if absent or empty. The first
 * one read tells the number of vertices. */
static bool read_numbers(const params *p, const char *name, param_type type, size_t width,
                         size_t *n, float **out, GError **error)
{
    const param *given = params_find(p, name);
    if (!given || given->n == 0)
        return true;
    if (given->type != type) {
        error_at(error, given->place, "\"%s\" of a triangle mesh has the wrong type",
                 name);
        return false;
    }
    if (given->n % width != 0 || (*n != 0 && given->n != *n * width)) {
        error_at(error, given->place,
                 "\"%s\" has %zu numbers; it needs %zu for each of %zu vertices", name,
                 given->n, width, *n ? *n : given->n / width);
        return false;
    }
    *out = big_alloc(given->n + 1, sizeof(float), "mesh vertices", error);
    if (!*out)
        return false;
    memcpy(*out, given->numbers, given->n * sizeof(float));
    *n = given->n / width;
    return true;
}

static bool read_indices(const params *p, mesh *m, GError **error)
{
    static const int one_triangle[3] = {0, 1, 2};
    const param *given = params_find(p, "indices");
    source_place place = given ? given->place : p->place;
    if (given && given->type != PARAM_INTEGER) {
        error_at(error, place, "\"indices\" of a triangle mesh must be integers");
        return false;
    }
    size_t n = given ? given->n : 3;
    if ((!given && m->n_vertices != 3) || n == 0 || n % 3 != 0) {
        error_at(error, place,
                 given ? "a triangle mesh needs three \"indices\" a triangle, found %zu"
                       : "a triangle mesh of more than one triangle needs \"indices\"",
                 n);
        return false;
    }
    m->indices = big_alloc(n, sizeof(uint32_t), "mesh indices", error);
    if (!m->indices)
        return false;
    m->n_triangles = n / 3;
    for (size_t i = 0; i < n; i++) {
        int index = given ? given->integers[i] : one_triangle[i];
        if (index < 0 || (size_t)index >= m->n_vertices) {
            error_at(error, place,
                     "index %d of triangle %zu is out of range: the mesh has %zu "
                     "vertices",
                     index, i / 3, m->n_vertices);
            return false;
        }
        m->indices[i] = (uint32_t)index;
    }
    return true;
}

static bool read_mesh(const params *p, mesh *m, GError **error)
{
    size_t *n = &m->n_vertices;
    if (!read_numbers(p, "P", PARAM_POINT3, 3, n, &m->positions, error))
        return false;
    if (!m->positions) {
        error_at(error, p->place, "a triangle mesh needs \"P\"");
        return false;
    }
    float *uvs = NULL;
    bool done = read_numbers(p, "N", PARAM_NORMAL, 3, n, &m->normals, error) &&
                read_numbers(p, "S", PARAM_VECTOR3, 3, n, &m->tangents, error) &&
                read_numbers(p, "uv", PARAM_POINT2, 2, n, &uvs, error) &&
                read_indices(p, m, error);
    m->uvs = (vec2 *)(void *)uvs;
    return done;
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    mesh m = {0};
    if (read_mesh(p, &m, error))
        return mesh_shape_create(&m, at, p->place, error);
    mesh_clear(&m);
    return NULL;
}

/* ---- Asking ---- */

static box3 bounds(const void *self)
{
    const mesh_shape *s = self;
    box3 box = box3_empty();
    for (size_t i = 0; i < s->m.n_vertices; i++) {
        const float *p = s->m.positions + 3 * i;
        box = box3_with_point(box, vec3_make(p[0], p[1], p[2]));
    }
    return box;
}

static const mesh *triangles(const void *self)
{
    return &((const mesh_shape *)self)->m;
}

static vec3 interpolate3(const float *values, const triangle *t, const double b[3])
{
    vec3 sum = {0};
    for (int i = 0; i < 3; i++) {
        const float *v = values + 3 * (size_t)t->vertex[i];
        sum += (float)b[i] * vec3_make(v[0], v[1], v[2]);
    }
    return sum;
}

static vec3 point_of(const triangle *t, const double b[3])
{
    return dvec3_to_float(b[0] * t->p[0] + b[1] * t->p[1] + b[2] * t->p[2]);
}

/* The true normal, turned to the outside; *shading is the interpolated one. Degenerate
 * triangles get any. */
static vec3 normal_of(const mesh_shape *s, const triangle *t, const double b[3],
                      vec3 *shading)
{
    double length = dvec3_length(t->cross);
    vec3 n = vec3_make(0.0f, 0.0f, 1.0f);
    if (length > 0.0)
        n = dvec3_to_float(t->cross / length);
    if (!s->m.normals)
        return *shading = s->flip ? -n : n;
    vec3 interpolated = normalize3(interpolate3(s->m.normals, t, b));
    *shading = length3_2(interpolated) > 0.0f ? interpolated : n;
    return face_forward(n, *shading);
}

static void corner_uvs(const mesh *m, const triangle *t, vec2 uv[3])
{
    static const vec2 usual[3] = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}};
    for (int i = 0; i < 3; i++)
        uv[i] = m->uvs ? m->uvs[t->vertex[i]] : usual[i];
}

static vec2 interpolate_uv(const vec2 uv[3], const double b[3])
{
    float b0 = (float)b[0], b1 = (float)b[1], b2 = (float)b[2];
    return (vec2){b0 * uv[0].x + b1 * uv[1].x + b2 * uv[2].x,
                  b0 * uv[0].y + b1 * uv[1].y + b2 * uv[2].y};
}

/* dp/du from two edges and their differences in uv; zero if uv does not tell. */
static vec3 tangent_of(const triangle *t, const vec2 uv[3])
{
    float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    float determinant = du1 * dv2 - dv1 * du2;
    vec3 along = dv2 * dvec3_to_float(t->edge[0]) - dv1 * dvec3_to_float(t->edge[1]);
    vec3 dpdu = along / determinant;
    return finite3(dpdu) ? dpdu : (vec3){0};
}

/* With v the vertices relative to p, D their largest coordinates and N = e1 x e2, the
 * plane's equation v·N / |N| is computed with an error of a few ε (|n|·D + 6 Dx Dy Dz /
 * |N|). Slivers could make it absurd: 16 ε |D| is the most that is believed. */
static float rounding_error(const triangle *t, vec3 p, vec3 n)
{
    vec3 d = {0};
    for (int i = 0; i < 3; i++)
        d = max3(d, abs3(dvec3_to_float(t->p[i]) - p));
    const float epsilon = 0x1p-23f;
    float length = sqrtf((float)dvec3_dot(t->cross, t->cross));
    float bound = 2.0f * dot3(abs3(n), d) + 6.0f * d[0] * d[1] * d[2] / length;
    return epsilon * fminf(bound, 16.0f * max_component3(d));
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    (void)r;
    const mesh_shape *s = self;
    triangle t;
    triangle_get(&s->m, hit->primitive, &t);
    const double b[3] = {1.0 - (double)u - (double)v, (double)u, (double)v};
    vec2 uv[3];
    corner_uvs(&s->m, &t, uv);
    hit->p = point_of(&t, b);
    hit->n_geom = normal_of(s, &t, b, &hit->n);
    hit->uv = interpolate_uv(uv, b);
    hit->dpdu = s->m.tangents ? interpolate3(s->m.tangents, &t, b) : tangent_of(&t, uv);
    if (!(length3_2(hit->dpdu) > 0.0f))
        hit->dpdu = frame_from_normal(hit->n).s;
    hit->error = rounding_error(&t, hit->p, hit->n_geom);
}

/* Solid angles between which Arvo's formula is used. */
static bool is_sampled_by_angle(double solid_angle)
{
    return solid_angle > 3e-4 && solid_angle < 6.0;
}

static float area(const void *self)
{
    return (float)distribution_total(&((const mesh_shape *)self)->areas);
}

static shape_sample sample_at(const mesh_shape *s, size_t primitive, const triangle *t,
                              const double b[3])
{
    vec2 uv[3];
    corner_uvs(&s->m, t, uv);
    vec3 shading, p = point_of(t, b), n = normal_of(s, t, b, &shading);
    return (shape_sample){.p = p,
                          .n = n,
                          .uv = interpolate_uv(uv, b),
                          .primitive = (uint32_t)primitive,
                          .pdf = 1.0f / area(s),
                          .error = rounding_error(t, p, n)};
}

static void weights_by_area(vec2 u, double b[3])
{
    vec2 w = warp_triangle(u);
    b[0] = 1.0 - (double)w.x - (double)w.y;
    b[1] = (double)w.x;
    b[2] = (double)w.y;
}

static shape_sample sample_area(const void *self, float u_primitive, vec2 u)
{
    const mesh_shape *s = self;
    size_t primitive = distribution_sample(&s->areas, &u_primitive);
    triangle t;
    triangle_get(&s->m, primitive, &t);
    double b[3];
    weights_by_area(u, b);
    return sample_at(s, primitive, &t, b);
}

/* Per solid angle at ref, of a point of the triangle, as sample_toward chooses it. */
static float pdf_of(const mesh_shape *s, const triangle *t, double solid_angle, vec3 ref,
                    vec3 p, vec3 n)
{
    double pdf = 1.0 / distribution_total(&s->areas);
    if (is_sampled_by_angle(solid_angle)) {
        pdf *= triangle_area(t) / solid_angle;
    } else {
        vec3 d = p - ref;
        float distance2 = length3_2(d);
        pdf *= (double)(distance2 * sqrtf(distance2) / fabsf(dot3(n, d)));
    }
    return isfinite(pdf) ? (float)pdf : 0.0f;
}

static bool sample_toward(const void *self, vec3 ref, float u_primitive, vec2 u,
                          shape_sample *out)
{
    const mesh_shape *s = self;
    size_t primitive = distribution_sample(&s->areas, &u_primitive);
    triangle t;
    triangle_get(&s->m, primitive, &t);
    double b[3], solid_angle = triangle_solid_angle(&t, ref);
    if (is_sampled_by_angle(solid_angle))
        triangle_sample_solid_angle(&t, ref, u, b);
    else
        weights_by_area(u, b);
    *out = sample_at(s, primitive, &t, b);
    out->pdf = pdf_of(s, &t, solid_angle, ref, out->p, out->n);
    return out->pdf > 0.0f;
}

static float pdf_toward(const void *self, vec3 ref, const surface_hit *hit)
{
    const mesh_shape *s = self;
    triangle t;
    triangle_get(&s->m, hit->primitive, &t);
    return pdf_of(s, &t, triangle_solid_angle(&t, ref), ref, hit->p, hit->n_geom);
}

const shape_kind mesh_kind = {
    .name = "trianglemesh",
    .create = create,
    .free = mesh_shape_free,
    .bounds = bounds,
    .triangles = triangles,
    .fill_hit = fill_hit,
    .area = area,
    .sample_area = sample_area,
    .sample_toward = sample_toward,
    .pdf_toward = pdf_toward,
};
