/*
 * Triangle meshes, in world space.
 *
 * Which side is outside decides where a light shines and what is inside glass; pbrt's
 * rules are kept:
 *   without normals  cross(p1 - p0, p2 - p0), turned round if ReverseOrientation is on or
 *                    the transform mirrors, but not both
 *   with normals     the true normal is turned into the hemisphere of the interpolated
 *                    one; ReverseOrientation turns the normals given
 *
 * True normals are computed once per triangle, in double precision, and kept: 16 bytes a
 * triangle for two roots and divisions less at every hit. A hit's point is the mean of
 * the corners by barycentric weights. Embree itself works in float on coordinates
 * relative to the ray's origin; how far off the plane that may see a ray that starts on
 * it is bounded here per hit (field error), since the coordinates of the hit alone do not
 * tell: a large slanted triangle through the origin has hits with tiny coordinates.
 *
 * Toward a point a triangle is chosen by area, then sampled uniformly by solid angle; one
 * that looks tiny or fills nearly the hemisphere by area, where the former loses digits.
 * Two triangles that are a rectangle are sampled as one (rectangle.h).
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "shape/mesh_params.h"
#include "shape/mesh_triangle.h"
#include "shape/rectangle.h"
#include "shape/shape_kinds.h"

#include "math/distribution.h"
#include "math/frame.h"
#include "math/warp.h"

#include <glib.h>
#include <string.h>

typedef struct mesh_shape {
    mesh m;
    bool flip; /* for triangles without normals */
    distribution areas;
    box3 box;
    vec3 *planes; /* per triangle: unit normal as the corners turn, and in the unused lane
                     1 / |e1 x e2|, which tells slivers */
    bool is_rectangle;
    mesh_rectangle rectangle; /* if it is one */
} mesh_shape;

/* ---- Building ---- */

static bool check_numbers(const float *numbers, size_t n, size_t width, const char *what,
                          source_place place, GError **error)
{
    for (size_t i = 0; numbers && i < n * width && still_wanted_at(i, NULL); i++) {
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
    for (size_t i = 0; i < 3 * m->n_triangles && still_wanted_at(i, NULL); i++) {
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
           check_numbers((const float *)m->uvs, m->n_vertices, 2, "uv", place, error) &&
           check_numbers((const float *)m->uvs2, m->n_vertices, 2, "second uv", place,
                         error) &&
           check_numbers(m->colors, m->n_vertices, 4, "colour", place, error);
}

static void store3(float *to, vec3 v)
{
    to[0] = v[0];
    to[1] = v[1];
    to[2] = v[2];
}

static void move_to_world(mesh *m, const shape_place *at)
{
    for (size_t i = 0; i < m->n_vertices && still_wanted_at(i, NULL); i++) {
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

/* Degenerate triangles get any normal. */
static vec3 plane_of(const triangle *t)
{
    double length = dvec3_length(t->cross);
    vec3 n = vec3_make(0.0f, 0.0f, 1.0f);
    if (length > 0.0)
        n = dvec3_to_float(t->cross / length);
    n[3] = (float)(1.0 / length);
    return n;
}

static bool init_triangles(mesh_shape *s, GError **error)
{
    size_t n = s->m.n_triangles;
    float *areas = big_alloc(n, sizeof *areas, "triangle areas", error);
    if (!areas)
        return false;
    s->planes = big_alloc(n, sizeof *s->planes, "triangle normals", error);
    for (size_t i = 0; s->planes && i < n && still_wanted_at(i, NULL); i++) {
        triangle t;
        triangle_get(&s->m, i, &t);
        areas[i] = (float)triangle_area(&t);
        s->planes[i] = plane_of(&t);
    }
    bool done = s->planes && distribution_init(&s->areas, areas, n, error);
    s->is_rectangle = mesh_rectangle_find(&s->m, &s->rectangle);
    big_free(areas);
    return done;
}

static box3 box_around(const mesh *m)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < m->n_vertices; i++) {
        const float *p = m->positions + 3 * i;
        box = box3_with_point(box, vec3_make(p[0], p[1], p[2]));
    }
    return box;
}

static void mesh_shape_free(void *self)
{
    mesh_shape *s = self;
    mesh_clear(&s->m);
    distribution_clear(&s->areas);
    big_free(s->planes);
    g_free(s);
}

void *mesh_shape_create(mesh *m, const shape_place *at, source_place place,
                        GError **error)
{
    mesh_shape *s = g_new0(mesh_shape, 1);
    s->m = *m;
    *m = (mesh){0};
    s->flip = at->reverse_orientation != transform_swaps_handedness(&at->to_world);
    if (check_mesh(&s->m, place, error) && still_wanted(error)) {
        move_to_world(&s->m, at);
        if (check_numbers(s->m.positions, s->m.n_vertices, 3, "transformed position",
                          place, error) &&
            init_triangles(s, error)) {
            s->box = box_around(&s->m);
            return s;
        }
    }
    mesh_shape_free(s);
    return NULL;
}

/* ---- From a scene file ---- */

static bool read_mesh(const params *p, mesh *m, GError **error)
{
    const mesh_words words = {"triangle mesh", "triangle", 3};
    size_t *n = &m->n_vertices;
    float *uvs = NULL;
    bool done =
        mesh_read_points(&words, p, n, &m->positions, error) &&
        mesh_read_numbers(&words, p, "N", PARAM_NORMAL, 3, n, &m->normals, error) &&
        mesh_read_numbers(&words, p, "S", PARAM_VECTOR3, 3, n, &m->tangents, error) &&
        mesh_read_numbers(&words, p, "uv", PARAM_POINT2, 2, n, &uvs, error) &&
        mesh_read_indices(&words, p, *n, &m->n_triangles, &m->indices, error);
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
    return ((const mesh_shape *)self)->box;
}

static const mesh *triangles(const void *self)
{
    return &((const mesh_shape *)self)->m;
}

/* What a point on a triangle is computed from. */
typedef struct corners {
    const uint32_t *vertex;
    vec3 p[3];
} corners;

/* One load; the lane that belongs to the next position, or to the padding after the last,
 * is masked: setting it alone would send the vector through memory. */
static vec3 corner_at(const mesh *m, uint32_t vertex)
{
    vec3 p;
    memcpy(&p, m->positions + 3 * (size_t)vertex, sizeof p);
    return (vec3)((vec3_bits)p & (vec3_bits){-1, -1, -1, 0});
}

static corners corners_of(const mesh *m, size_t primitive)
{
    const uint32_t *v = m->indices + 3 * primitive;
    return (corners){
        .vertex = v,
        .p = {corner_at(m, v[0]), corner_at(m, v[1]), corner_at(m, v[2])},
    };
}

static vec3 interpolate3(const float *values, const corners *c, const float b[3])
{
    vec3 sum = {0};
    for (int i = 0; i < 3; i++) {
        const float *v = values + 3 * (size_t)c->vertex[i];
        sum += b[i] * vec3_make(v[0], v[1], v[2]);
    }
    return sum;
}

static vec3 point_of(const corners *c, const float b[3])
{
    return b[0] * c->p[0] + b[1] * c->p[1] + b[2] * c->p[2];
}

/* The true normal, turned to the outside; *shading is the interpolated one. */
static vec3 normal_of(const mesh_shape *s, const corners *c, vec3 plane, const float b[3],
                      vec3 *shading)
{
    vec3 n = vec3_make(plane[0], plane[1], plane[2]);
    if (!s->m.normals)
        return *shading = s->flip ? -n : n;
    vec3 interpolated = normalize3(interpolate3(s->m.normals, c, b));
    *shading = length3_2(interpolated) > 0.0f ? interpolated : n;
    return face_forward(n, *shading);
}

static void corner_uvs(const mesh *m, const corners *c, vec2 uv[3])
{
    static const vec2 usual[3] = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}};
    for (int i = 0; i < 3; i++)
        uv[i] = m->uvs ? m->uvs[c->vertex[i]] : usual[i];
}

static vec2 interpolate_uv(const vec2 uv[3], const float b[3])
{
    return (vec2){b[0] * uv[0].x + b[1] * uv[1].x + b[2] * uv[2].x,
                  b[0] * uv[0].y + b[1] * uv[1].y + b[2] * uv[2].y};
}

/* dp/du and dp/dv from two edges and their differences in uv; zero if uv does not tell.
 */
static vec3 tangents_of(const corners *c, const vec2 uv[3], vec3 *dpdv)
{
    float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    float determinant = du1 * dv2 - dv1 * du2;
    vec3 e1 = c->p[1] - c->p[0], e2 = c->p[2] - c->p[0];
    vec3 dpdu = (dv2 * e1 - dv1 * e2) / determinant;
    *dpdv = (du1 * e2 - du2 * e1) / determinant;
    if (finite3(dpdu) && finite3(*dpdv))
        return dpdu;
    *dpdv = (vec3){0};
    return (vec3){0};
}

static void fill_uv(const mesh_shape *s, const corners *c, const float b[3],
                    surface_hit *hit)
{
    vec2 uv[3];
    corner_uvs(&s->m, c, uv);
    hit->uv = interpolate_uv(uv, b);
    hit->dpdu = tangents_of(c, uv, &hit->dpdv);
}

/* With v the vertices relative to p, D their largest coordinates and N = e1 x e2, the
 * plane's equation v·N / |N| is computed with an error of a few ε (|n|·D + 6 Dx Dy Dz /
 * |N|). Slivers could make it absurd: 16 ε |D| is the most that is believed. */
static float rounding_error(const corners *c, vec3 p, vec3 plane)
{
    vec3 d = {0};
    for (int i = 0; i < 3; i++)
        d = max3(d, abs3(c->p[i] - p));
    const float epsilon = 0x1p-23f;
    float bound = 2.0f * dot3(abs3(plane), d) + 6.0f * d[0] * d[1] * d[2] * plane[3];
    return epsilon * minf(bound, 16.0f * max_component3(d));
}

/* What fill_uv gives for the usual uvs. */
static void fill_usual_uv(const corners *c, const float b[3], surface_hit *hit)
{
    vec3 e1 = c->p[1] - c->p[0], e2 = c->p[2] - c->p[0];
    hit->uv = (vec2){b[1] + b[2], b[2]};
    hit->dpdu = e1;
    hit->dpdv = e2 - e1;
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    (void)r;
    const mesh_shape *s = self;
    const corners c = corners_of(&s->m, hit->primitive);
    const vec3 plane = s->planes[hit->primitive];
    const float b[3] = {1.0f - u - v, u, v};
    hit->p = point_of(&c, b);
    hit->n_geom = normal_of(s, &c, plane, b, &hit->n);
    if (s->m.uvs)
        fill_uv(s, &c, b, hit);
    else
        fill_usual_uv(&c, b, hit);
    if (s->m.tangents)
        hit->dpdu = interpolate3(s->m.tangents, &c, b);
    if (!(length3_2(hit->dpdu) > 0.0f))
        hit->dpdu = frame_from_normal(hit->n).s;
    hit->error = rounding_error(&c, hit->p, plane);
    hit->mesh = &s->m;
    hit->corners = (vec2){u, v};
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

static shape_sample sample_at(const mesh_shape *s, size_t primitive,
                              const double weights[3])
{
    const float b[3] = {(float)weights[0], (float)weights[1], (float)weights[2]};
    const corners c = corners_of(&s->m, primitive);
    const vec3 plane = s->planes[primitive];
    vec2 uv[3];
    corner_uvs(&s->m, &c, uv);
    vec3 shading, p = point_of(&c, b), n = normal_of(s, &c, plane, b, &shading);
    return (shape_sample){.p = p,
                          .n = n,
                          .uv = interpolate_uv(uv, b),
                          .primitive = (uint32_t)primitive,
                          .mesh = &s->m,
                          .corners = {b[1], b[2]},
                          .pdf = 1.0f / area(s),
                          .error = rounding_error(&c, p, plane)};
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
    double b[3];
    weights_by_area(u, b);
    return sample_at(s, primitive, b);
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

static bool sample_rectangle(const mesh_shape *s, vec3 ref, vec2 u, shape_sample *out)
{
    const rectangle *whole = &s->rectangle.whole;
    const seen_rectangle seen = rectangle_seen_from(whole, ref);
    double b[3];
    int primitive = mesh_rectangle_weights(&s->rectangle, rectangle_sample(&seen, u), b);
    *out = sample_at(s, (size_t)primitive, b);
    out->pdf = rectangle_pdf(whole, &seen, ref, out->p);
    return out->pdf > 0.0f;
}

static bool sample_toward(const void *self, vec3 ref, float u_primitive, vec2 u,
                          shape_sample *out)
{
    const mesh_shape *s = self;
    if (s->is_rectangle)
        return sample_rectangle(s, ref, u, out);
    size_t primitive = distribution_sample(&s->areas, &u_primitive);
    triangle t;
    triangle_get(&s->m, primitive, &t);
    const seen_triangle seen = triangle_seen_from(&t, ref);
    double b[3];
    if (is_sampled_by_angle(seen.solid_angle))
        triangle_sample_solid_angle(&t, &seen, ref, u, b);
    else
        weights_by_area(u, b);
    *out = sample_at(s, primitive, b);
    out->pdf = pdf_of(s, &t, seen.solid_angle, ref, out->p, out->n);
    return out->pdf > 0.0f;
}

static float pdf_toward(const void *self, vec3 ref, const surface_hit *hit)
{
    const mesh_shape *s = self;
    if (s->is_rectangle) {
        const seen_rectangle seen = rectangle_seen_from(&s->rectangle.whole, ref);
        return rectangle_pdf(&s->rectangle.whole, &seen, ref, hit->p);
    }
    triangle t;
    triangle_get(&s->m, hit->primitive, &t);
    return pdf_of(s, &t, triangle_seen_from(&t, ref).solid_angle, ref, hit->p,
                  hit->n_geom);
}

const shape_kind shape_mesh = {
    .name = "trianglemesh",
    .parameters = "P N S uv indices faceIndices",
    .may_be_flat = true,
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
