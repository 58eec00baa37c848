/*
 * Meshes of bilinear patches, intersected exactly; where all are parallelograms, as most
 * lamps are, they may be met as triangles in place of that. Which side is outside is
 * decided as for triangles (shape_mesh.c): by ∂p/∂u × ∂p/∂v and the orientation, or by
 * the normals given.
 *
 *   indices of a face: p00 p10 p01 p11
 *
 * A point is drawn uniformly by area: a patch by its area, a place in (u, v) by rejection
 * against the area element, which accepts at once where the patch is a parallelogram.
 * Toward a point a single patch that is a rectangle is sampled as one (rectangle.h).
 */
#include "base/memory.h"
#include "math/distribution.h"
#include "shape/mesh_params.h"
#include "shape/patch.h"
#include "shape/rectangle.h"
#include "shape/shape_kinds.h"

#include <float.h>
#include <glib.h>
#include <string.h>

typedef struct bilinear_mesh {
    size_t n_vertices, n_patches;
    float *positions; /* 3 per vertex, world */
    float *normals;   /* 3 per vertex, world, NULL */
    vec2 *uvs;        /* per vertex, NULL */
    uint32_t *indices;
    uint32_t *halves; /* corners of two triangles per patch; NULL: not all are flat */
    bool flip;        /* without normals */
    distribution areas;
    bool is_rectangle;
    rectangle rectangle; /* if it is one */
} bilinear_mesh;

static void free_mesh(void *self)
{
    bilinear_mesh *m = self;
    big_free(m->positions);
    big_free(m->normals);
    big_free(m->uvs);
    big_free(m->indices);
    big_free(m->halves);
    distribution_clear(&m->areas);
    g_free(m);
}

static vec3 load3(const float *from, size_t i)
{
    return vec3_make(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
}

static patch patch_of(const bilinear_mesh *m, size_t primitive)
{
    const uint32_t *v = m->indices + 4 * primitive;
    dvec3 p[4];
    for (int i = 0; i < 4; i++)
        p[i] = dvec3_from_float(load3(m->positions, v[i]));
    return patch_from_corners(p[0], p[1], p[2], p[3]);
}

/* ---- Building ---- */

static bool read_mesh(bilinear_mesh *m, const params *p, GError **error)
{
    const mesh_words words = {"bilinear mesh", "patch", 4};
    size_t *n = &m->n_vertices;
    float *uvs = NULL;
    bool done =
        mesh_read_points(&words, p, n, &m->positions, error) &&
        mesh_read_numbers(&words, p, "N", PARAM_NORMAL, 3, n, &m->normals, error) &&
        mesh_read_numbers(&words, p, "uv", PARAM_POINT2, 2, n, &uvs, error) &&
        mesh_read_indices(&words, p, *n, &m->n_patches, &m->indices, error);
    m->uvs = (vec2 *)(void *)uvs;
    return done;
}

static void store3(float *to, size_t i, vec3 v)
{
    memcpy(to + 3 * i, &v, 3 * sizeof(float));
}

static bool move_to_world(bilinear_mesh *m, const shape_place *at, const params *p,
                          GError **error)
{
    for (size_t i = 0; i < m->n_vertices; i++) {
        vec3 moved = transform_point(&at->to_world, load3(m->positions, i));
        if (!finite3(moved)) {
            error_at(error, p->place, "position %zu of the mesh is not finite", i);
            return false;
        }
        store3(m->positions, i, moved);
        if (!m->normals)
            continue;
        vec3 n = normalize3(transform_normal(&at->to_world, load3(m->normals, i)));
        store3(m->normals, i, at->reverse_orientation ? -n : n);
    }
    return true;
}

static bool init_areas(bilinear_mesh *m, const params *p, GError **error)
{
    float *areas = big_alloc(m->n_patches, sizeof *areas, "patch areas", error);
    for (size_t i = 0; areas && i < m->n_patches; i++) {
        patch s = patch_of(m, i);
        areas[i] = (float)patch_area(&s);
    }
    bool done = areas && distribution_init(&m->areas, areas, m->n_patches, error);
    big_free(areas);
    if (done && !isfinite(distribution_total(&m->areas))) {
        error_at(error, p->place, "the mesh has an infinite area");
        return false;
    }
    return done;
}

/* A fourth corner that is this far off, of the largest coordinate, is so by rounding. */
#define ROUNDING (4.0 * (double)FLT_EPSILON)

static bool is_parallelogram(const bilinear_mesh *m, size_t primitive)
{
    const patch s = patch_of(m, primitive);
    bool is_flat = dvec3_length(patch_cross(&s, 0.0, 0.0)) > 0.0;
    for (int c = 0; c < 3 && is_flat; c++) {
        double b = fabs(s.p00[c]) + fabs(s.a[c]) + fabs(s.b[c]);
        is_flat = fabs(s.e[c]) <= ROUNDING * b;
    }
    return is_flat;
}

static bool init_halves(bilinear_mesh *m, GError **error)
{
    for (size_t i = 0; i < m->n_patches; i++)
        if (!is_parallelogram(m, i))
            return true;
    m->halves =
        big_alloc(6 * m->n_patches, sizeof *m->halves, "halves of patches", error);
    for (size_t i = 0; m->halves && i < m->n_patches; i++) {
        const uint32_t *v = m->indices + 4 * i;
        const uint32_t corners[6] = {v[0], v[1], v[3], v[0], v[3], v[2]};
        memcpy(m->halves + 6 * i, corners, sizeof corners);
    }
    return m->halves;
}

static void find_rectangle(bilinear_mesh *m)
{
    vec3 p[4];
    for (int i = 0; i < 4; i++)
        p[i] = load3(m->positions, m->indices[i]);
    m->is_rectangle = m->n_patches == 1 &&
                      rectangle_from_corners(p[0], p[1], p[2], p[3], &m->rectangle);
}

/* pbrt draws points by that image; here the light's own image tells. */
static bool check_emission(const params *p, GError **error)
{
    const char *name = NULL;
    return params_string(p, "emissionfilename", &name, error);
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    bilinear_mesh *m = g_new0(bilinear_mesh, 1);
    m->flip = at->reverse_orientation != transform_swaps_handedness(&at->to_world);
    if (check_emission(p, error) && read_mesh(m, p, error) &&
        move_to_world(m, at, p, error) && init_areas(m, p, error) &&
        init_halves(m, error)) {
        find_rectangle(m);
        return m;
    }
    free_mesh(m);
    return NULL;
}

/* ---- Asking ---- */

static size_t n_primitives(const void *self)
{
    return ((const bilinear_mesh *)self)->n_patches;
}

static bool halves(const void *self, mesh *out)
{
    const bilinear_mesh *m = self;
    *out = (mesh){.n_vertices = m->n_vertices,
                  .n_triangles = 2 * m->n_patches,
                  .positions = m->positions,
                  .indices = m->halves};
    return m->halves && 2 * m->n_patches < UINT32_MAX;
}

/* A patch lies in the hull of its corners; what rounding and seams add is far below. */
static box3 primitive_bounds(const void *self, uint32_t primitive)
{
    const bilinear_mesh *m = self;
    box3 box = box3_empty();
    for (int i = 0; i < 4; i++)
        box = box3_with_point(box,
                              load3(m->positions, m->indices[4 * (size_t)primitive + i]));
    vec3 margin = 1e-6f * max3(abs3(box.low), abs3(box.high));
    return (box3){box.low - margin, box.high + margin};
}

static box3 bounds(const void *self)
{
    const bilinear_mesh *m = self;
    box3 box = box3_empty();
    for (size_t i = 0; i < m->n_patches; i++)
        box = box3_union(box, primitive_bounds(self, (uint32_t)i));
    return box;
}

static bool intersect(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3])
{
    patch s = patch_of(self, primitive);
    const double range[2] = {(double)t_min, (double)r->t_max};
    double at, uv[2];
    if (!patch_intersect(&s, dvec3_from_float(r->origin), dvec3_from_float(r->direction),
                         range, &at, uv))
        return false;
    tuv[0] = (float)at;
    tuv[1] = (float)uv[0];
    tuv[2] = (float)uv[1];
    return true;
}

/* Weights of the corners. */
static void weights(double u, double v, float w[4])
{
    w[0] = (float)((1.0 - u) * (1.0 - v));
    w[1] = (float)(u * (1.0 - v));
    w[2] = (float)((1.0 - u) * v);
    w[3] = (float)(u * v);
}

/* The true normal turned to the outside; *shading is the interpolated one. */
static vec3 normal_of(const bilinear_mesh *m, const uint32_t *vertex, const patch *s,
                      const double at[2], vec3 *shading)
{
    dvec3 cross = patch_cross(s, at[0], at[1]);
    double length = dvec3_length(cross);
    vec3 n = length > 0.0 ? dvec3_to_float(cross / length) : vec3_make(0, 0, 1);
    if (!m->normals)
        return *shading = m->flip ? -n : n;
    float w[4];
    vec3 sum = {0};
    weights(at[0], at[1], w);
    for (int i = 0; i < 4; i++)
        sum += w[i] * load3(m->normals, vertex[i]);
    *shading = length3_2(sum) > 0.0f ? normalize3(sum) : n;
    return face_forward(n, *shading);
}

/* Texture coordinates, and ∂p by them, by the chain rule. */
static vec2 uv_of(const bilinear_mesh *m, const uint32_t *vertex, const patch *s,
                  const double at[2], vec3 dp[2])
{
    double u = at[0], v = at[1];
    dvec3 along_u = s->a + v * s->e, along_v = s->b + u * s->e;
    dp[0] = dvec3_to_float(along_u);
    dp[1] = dvec3_to_float(along_v);
    if (!m->uvs)
        return (vec2){(float)u, (float)v};
    double c[4][2], value[2], by_u[2], by_v[2];
    for (int i = 0; i < 4; i++) {
        c[i][0] = (double)m->uvs[vertex[i]].x;
        c[i][1] = (double)m->uvs[vertex[i]].y;
    }
    for (int k = 0; k < 2; k++) {
        by_u[k] = (1.0 - v) * (c[1][k] - c[0][k]) + v * (c[3][k] - c[2][k]);
        by_v[k] = (1.0 - u) * (c[2][k] - c[0][k]) + u * (c[3][k] - c[1][k]);
        value[k] = (1.0 - v) * ((1.0 - u) * c[0][k] + u * c[1][k]) +
                   v * ((1.0 - u) * c[2][k] + u * c[3][k]);
    }
    double determinant = by_u[0] * by_v[1] - by_v[0] * by_u[1];
    vec3 ds = dvec3_to_float((by_v[1] * along_u - by_u[1] * along_v) / determinant);
    vec3 dt = dvec3_to_float((by_u[0] * along_v - by_v[0] * along_u) / determinant);
    if (finite3(ds) && finite3(dt) && length3_2(ds) > 0.0f) {
        dp[0] = ds;
        dp[1] = dt;
    }
    return (vec2){(float)value[0], (float)value[1]};
}

/* The most that is believed of triangles (shape_mesh.c), for Embree may meet it as such.
 */
static float rounding_error(const bilinear_mesh *m, const uint32_t *vertex, vec3 p)
{
    vec3 reach = {0};
    for (int i = 0; i < 4 && m->halves; i++)
        reach = max3(reach, abs3(load3(m->positions, vertex[i]) - p));
    return 16.0f * FLT_EPSILON * max_component3(reach);
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    (void)r;
    const bilinear_mesh *m = self;
    const uint32_t *vertex = m->indices + 4 * (size_t)hit->primitive;
    patch s = patch_of(m, hit->primitive);
    const double at[2] = {(double)u, (double)v};
    hit->p = dvec3_to_float(patch_point(&s, at[0], at[1]));
    hit->n_geom = normal_of(m, vertex, &s, at, &hit->n);
    vec3 dp[2];
    hit->uv = uv_of(m, vertex, &s, at, dp);
    hit->dpdu = dp[0];
    hit->dpdv = dp[1];
    if (!(length3_2(hit->dpdu) > 0.0f))
        hit->dpdu = frame_from_normal(hit->n).s;
    hit->error = rounding_error(m, vertex, hit->p);
}

static float area(const void *self)
{
    return (float)distribution_total(&((const bilinear_mesh *)self)->areas);
}

static shape_sample sample_at(const bilinear_mesh *m, size_t i, const patch *s, vec2 u)
{
    const double at[2] = {(double)u.x, (double)u.y};
    const uint32_t *vertex = m->indices + 4 * i;
    vec3 ignored, tangents[2], p = dvec3_to_float(patch_point(s, at[0], at[1]));
    return (shape_sample){.p = p,
                          .n = normal_of(m, vertex, s, at, &ignored),
                          .uv = uv_of(m, vertex, s, at, tangents),
                          .primitive = (uint32_t)i,
                          .pdf = 1.0f / area(m),
                          .error = rounding_error(m, vertex, p)};
}

static shape_sample sample_area(const void *self, float u_primitive, vec2 u)
{
    const bilinear_mesh *m = self;
    size_t i = distribution_sample(&m->areas, &u_primitive);
    patch s = patch_of(m, i);
    double largest = patch_largest_element(&s);
    float keep = u_primitive;
    for (uint64_t attempt = 1; attempt < 64; attempt++) {
        double element = dvec3_length(patch_cross(&s, (double)u.x, (double)u.y));
        if ((double)keep * largest <= element)
            break;
        u = shape_retry(u, attempt, &keep);
    }
    return sample_at(m, i, &s, u);
}

static bool sample_toward(const void *self, vec3 ref, float u_primitive, vec2 u,
                          shape_sample *out)
{
    const bilinear_mesh *m = self;
    if (m->is_rectangle) {
        const seen_rectangle seen = rectangle_seen_from(&m->rectangle, ref);
        const patch s = patch_of(m, 0);
        *out = sample_at(m, 0, &s, rectangle_sample(&seen, u));
        out->pdf = rectangle_pdf(&m->rectangle, &seen, ref, out->p);
    } else {
        *out = sample_area(self, u_primitive, u);
        out->pdf = shape_to_solid_angle(out->pdf, ref, out->p, out->n);
    }
    return out->pdf > 0.0f;
}

static float pdf_toward(const void *self, vec3 ref, const surface_hit *hit)
{
    const bilinear_mesh *m = self;
    if (!m->is_rectangle)
        return shape_to_solid_angle(1.0f / area(self), ref, hit->p, hit->n_geom);
    const seen_rectangle seen = rectangle_seen_from(&m->rectangle, ref);
    return rectangle_pdf(&m->rectangle, &seen, ref, hit->p);
}

const shape_kind shape_bilinear = {
    .name = "bilinearmesh",
    .parameters = "P N uv indices faceIndices emissionfilename",
    .may_be_flat = true,
    .create = create,
    .free = free_mesh,
    .bounds = bounds,
    .n_primitives = n_primitives,
    .primitive_bounds = primitive_bounds,
    .intersect = intersect,
    .halves = halves,
    .fill_hit = fill_hit,
    .area = area,
    .sample_area = sample_area,
    .sample_toward = sample_toward,
    .pdf_toward = pdf_toward,
};
