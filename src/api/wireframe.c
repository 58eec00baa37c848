/*
 * A scene as lines: what its photons are drawn over.
 *
 * Meshes give their edges, each once, without those between triangles of one plane (the
 * diagonals of rectangles). Shapes without triangles give lines of equal u and equal v of
 * their own area-preserving map (shape_sample_area), which is smooth: circles of latitude
 * and meridians on a sphere, circles and spokes on a disc.
 */
#include "api/objects.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { CURVED_LINES = 12, CURVED_STEPS = 24, NUMBERS = 6 };

/* Normals closer than this are one plane: 1 - cos. */
#define PLANE 1e-4f

typedef struct edge {
    uint32_t a, b; /* a < b */
    uint32_t triangle;
} edge;

typedef struct wire {
    float *segments;           /* NUMBERS each */
    size_t n, most;            /* that are there, and that there is room for */
    size_t stride, at;         /* every stride-th edge is kept */
    const transform *to_world; /* of the instance; NULL: already there */
} wire;

static void put_segment(wire *w, vec3 a, vec3 b)
{
    if (w->to_world) {
        a = transform_point(w->to_world, a);
        b = transform_point(w->to_world, b);
    }
    const float line[NUMBERS] = {a[0], a[1], a[2], b[0], b[1], b[2]};
    bool finite = true;
    for (int i = 0; i < NUMBERS; i++)
        finite &= isfinite(line[i]);
    if (finite && w->n < w->most)
        memcpy(&w->segments[NUMBERS * w->n++], line, sizeof line);
}

/* ---- Meshes ---- */

static vec3 corner(const mesh *m, uint32_t i)
{
    const float *p = m->positions + 3 * (size_t)i;
    return vec3_make(p[0], p[1], p[2]);
}

static vec3 triangle_normal(const mesh *m, uint32_t triangle)
{
    const uint32_t *i = m->indices + 3 * (size_t)triangle;
    vec3 a = corner(m, i[0]);
    return normalize3(cross3(corner(m, i[1]) - a, corner(m, i[2]) - a));
}

static int by_ends(const void *x, const void *y)
{
    const edge *e = x, *f = y;
    if (e->a != f->a)
        return e->a < f->a ? -1 : 1;
    if (e->b != f->b)
        return e->b < f->b ? -1 : 1;
    return (e->triangle > f->triangle) - (e->triangle < f->triangle);
}

/* NULL: memory is short. */
static edge *list_edges(const mesh *m)
{
    edge *edges = big_alloc(3 * m->n_triangles, sizeof *edges, "edges", NULL);
    if (!edges)
        return NULL;
    for (size_t t = 0; t < m->n_triangles; t++)
        for (size_t k = 0; k < 3; k++) {
            uint32_t a = m->indices[3 * t + k];
            uint32_t b = m->indices[3 * t + (k + 1) % 3];
            edges[3 * t + k] = (edge){MIN(a, b), MAX(a, b), (uint32_t)t};
        }
    qsort(edges, 3 * m->n_triangles, sizeof *edges, by_ends);
    return edges;
}

/* True if the first two of these edges with the same ends lie between triangles of one
   plane. */
static bool is_flat(const mesh *m, const edge *e, size_t n)
{
    if (n < 2)
        return false;
    float cosine =
        dot3(triangle_normal(m, e[0].triangle), triangle_normal(m, e[1].triangle));
    return fabsf(cosine) > 1.0f - PLANE;
}

static void put_mesh(wire *w, const mesh *m)
{
    size_t n = 3 * m->n_triangles;
    edge *all = list_edges(m);
    for (size_t i = 0, next; i < n && all; i = next) {
        for (next = i + 1; next < n && all[next].a == all[i].a && all[next].b == all[i].b;
             next++)
            ;
        if (!is_flat(m, &all[i], next - i) && w->at++ % w->stride == 0)
            put_segment(w, corner(m, all[i].a), corner(m, all[i].b));
    }
    big_free(all);
}

/* ---- Curved shapes ---- */

static vec3 at_place(const shape *s, bool along_x, float line, float step)
{
    const float edge_margin = 1e-6f;
    float a = line * (1.0f - edge_margin), b = step * (1.0f - edge_margin);
    return shape_sample_area(s, 0.5f, along_x ? (vec2){b, a} : (vec2){a, b}).p;
}

static void put_lines(wire *w, const shape *s, bool along_x)
{
    for (int i = 0; i <= CURVED_LINES; i++) {
        float line = (float)i / CURVED_LINES;
        vec3 last = at_place(s, along_x, line, 0.0f);
        for (int k = 1; k <= CURVED_STEPS; k++) {
            vec3 next = at_place(s, along_x, line, (float)k / CURVED_STEPS);
            put_segment(w, last, next);
            last = next;
        }
    }
}

static void put_shape(wire *w, const shape *s)
{
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    if (m) {
        put_mesh(w, m);
        return;
    }
    if (!s->kind->sample_area)
        return;
    put_lines(w, s, true);
    put_lines(w, s, false);
}

/* Calls put for every shape of the world, and of every instance. */
static void each_shape(const scene *s, wire *w, void (*put)(wire *w, const shape *one))
{
    for (guint k = 0; k <= s->instances->len; k++) {
        bool in_world = k == s->instances->len;
        const transform at =
            in_world ? transform_identity() : accel_instance_at(s->accel, (int)k, 0.0f);
        int object =
            in_world ? NO_INDEX : g_array_index(s->instances, instance, k).object;
        w->to_world = in_world ? NULL : &at;
        for (guint i = 0; i < s->shapes->len; i++) {
            const shape *one = s->shapes->pdata[i];
            if (one->object == object)
                put(w, one);
        }
    }
}

/* Roughly, into w->at. */
static void count_edges(wire *w, const shape *one)
{
    const mesh *m = one->kind->triangles ? one->kind->triangles(one->self) : NULL;
    w->at += m ? (3 * m->n_triangles + 1) / 2 : 2 * CURVED_LINES * CURVED_STEPS;
}

float *neph_scene_wireframe(const NephScene *s, size_t most, size_t *n)
{
    wire w = {.n = 0};
    *n = 0;
    each_shape(s->scene, &w, count_edges);
    w.stride = MAX(w.at / MAX(most, 1), 1);
    w.most = MIN(2 * w.at, most); /* where no two triangles share an edge */
    if (!memory_ask(w.most * NUMBERS * sizeof(float), "a wireframe", NULL))
        return NULL;
    w.segments = g_try_malloc_n(MAX(w.most, 1), NUMBERS * sizeof(float));
    w.at = 0;
    if (w.segments)
        each_shape(s->scene, &w, put_shape);
    *n = w.n;
    return w.segments;
}
