/*
 * Curves with a width: hair, grass, wires. Parameters are pbrt's; a curve becomes cubic
 * Bézier segments, each in 2^splitdepth spans for the acceleration structure, which do
 * not show.
 *
 * Unlike pbrt's "cylinder", which is a flat ribbon with the normals of a tube, this one
 * is a tube, so that glass fibres and the light behind wires come out right; its v goes
 * around. "flat" curves turn to every ray, so a place seen from two sides is not the same
 * place: light tracing and camera rays differ by about a width there
 * (surface_hit.camera_facing). As in pbrt, rays that leave a flat curve start two widths
 * above it, and no curve can be a light.
 *
 * Places for aimed photons are drawn on the tube, of flat curves too: uniform along and
 * around, exact where the curve is straight.
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "math/distribution.h"
#include "shape/curve_segment.h"
#include "shape/instance.h"
#include "shape/shape_kinds.h"
#include "shape/shape_quadric.h"

#include <glib.h>
#include <string.h>

enum { MOST_SPLITS = 8, AREA_CELLS = 32 /* a segment */, MEAN_STEPS = 16 };

/* Of a segment, to look for pieces near a place. */
enum { MOST_HALVINGS = 20 };

typedef struct curve_shape {
    quadric q; /* object space, orientation, area */
    curve_type type;
    int split;
    size_t n_segments;
    curve_segment *segments;
    distribution areas; /* over AREA_CELLS of each segment */
} curve_shape;

static void free_curve(void *self)
{
    curve_shape *c = self;
    big_free(c->segments);
    distribution_clear(&c->areas);
    g_free(c);
}

/* ---- Parameters ---- */

/* What a curve is read from. */
typedef struct curve_input {
    int type, basis, degree;
    float width[2];
    const param *points, *normals;
    size_t n_segments;
} curve_input;

enum { BASIS_BEZIER, BASIS_BSPLINE };

static bool fail(const params *p, const char *name, GError **error, const char *text)
{
    source_place place = params_has(p, name) ? params_find(p, name)->place : p->place;
    error_at(error, place, "\"%s\" of a curve %s", name, text);
    return false;
}

static bool read_widths(const params *p, curve_input *in, GError **error)
{
    float width = 1.0f;
    if (!params_float(p, "width", &width, error))
        return false;
    in->width[0] = in->width[1] = width;
    if (!params_float(p, "width0", &in->width[0], error) ||
        !params_float(p, "width1", &in->width[1], error))
        return false;
    if (in->width[0] >= 0.0f && in->width[1] >= 0.0f &&
        in->width[0] + in->width[1] > 0.0f)
        return true;
    return fail(p, params_has(p, "width") ? "width" : "width0", error,
                "must be positive; only one end may have width 0");
}

static bool read_points(const params *p, curve_input *in, GError **error)
{
    in->points = params_find(p, "P");
    size_t n = in->points ? in->points->n / 3 : 0, degree = (size_t)in->degree;
    if (!in->points || in->points->type != PARAM_POINT3)
        return fail(p, "P", error, "must be points, and must be there");
    if (n <= degree || (in->basis == BASIS_BEZIER && (n - 1) % degree != 0))
        return fail(p, "P", error,
                    in->basis == BASIS_BEZIER
                        ? "needs degree + 1 points, and degree more for each further "
                          "Bézier segment"
                        : "needs at least degree + 1 points");
    in->n_segments = in->basis == BASIS_BEZIER ? (n - 1) / degree : n - degree;
    return true;
}

static bool read_normals(const params *p, curve_input *in, GError **error)
{
    in->normals = params_find(p, "N");
    if (in->type != CURVE_RIBBON) {
        if (in->normals)
            log_at(p->log, LOG_NOTE, in->normals->place,
                   "\"N\" is for curves of type \"ribbon\" only");
        in->normals = NULL;
        return true;
    }
    if (!in->normals || in->normals->type != PARAM_NORMAL ||
        in->normals->n != 3 * (in->n_segments + 1))
        return fail(p, "N", error,
                    "must be there for type \"ribbon\": one normal more than segments");
    return true;
}

static bool read_input(const params *p, curve_input *in, int *split, GError **error)
{
    static const char *const types[] = {"flat", "cylinder", "ribbon", NULL};
    static const char *const bases[] = {"bezier", "bspline", NULL};
    in->degree = 3;
    if (!params_choice(p, "type", types, &in->type, error) ||
        !params_choice(p, "basis", bases, &in->basis, error) ||
        !params_integer(p, "degree", &in->degree, error) ||
        !params_integer(p, "splitdepth", split, error))
        return false;
    if (in->degree != 2 && in->degree != 3)
        return fail(p, "degree", error, "must be 2 or 3");
    *split = CLAMP(*split, 0, MOST_SPLITS); /* more do not show either */
    return read_widths(p, in, error) && read_points(p, in, error) &&
           read_normals(p, in, error);
}

/* ---- To Bézier ---- */

static dvec3 load(const param *from, size_t i)
{
    const float *v = from->numbers + 3 * i;
    return dvec3_from_float(vec3_make(v[0], v[1], v[2]));
}

static void elevate(const dvec3 q[3], dvec3 p[4])
{
    p[0] = q[0];
    p[1] = (q[0] + 2.0 * q[1]) / 3.0;
    p[2] = (2.0 * q[1] + q[2]) / 3.0;
    p[3] = q[2];
}

static void control_points(const curve_input *in, size_t segment, dvec3 p[4])
{
    size_t first = in->basis == BASIS_BEZIER ? segment * (size_t)in->degree : segment;
    dvec3 q[4] = {{0}};
    for (size_t i = 0; i <= (size_t)in->degree; i++)
        q[i] = load(in->points, first + i);
    if (in->basis == BASIS_BEZIER && in->degree == 3) {
        memcpy(p, q, sizeof q);
    } else if (in->basis == BASIS_BEZIER) {
        elevate(q, p);
    } else if (in->degree == 2) {
        const dvec3 bezier[3] = {0.5 * (q[0] + q[1]), q[1], 0.5 * (q[1] + q[2])};
        elevate(bezier, p);
    } else {
        p[0] = (q[0] + 4.0 * q[1] + q[2]) / 6.0;
        p[1] = (2.0 * q[1] + q[2]) / 3.0;
        p[2] = (q[1] + 2.0 * q[2]) / 3.0;
        p[3] = (q[1] + 4.0 * q[2] + q[3]) / 6.0;
    }
}

static dvec3 unit(dvec3 v)
{
    double length = dvec3_length(v);
    return length > 0.0 ? v / length : v;
}

static bool make_segments(curve_shape *c, const curve_input *in, GError **error)
{
    size_t n = c->n_segments = in->n_segments;
    c->segments = big_alloc(n, sizeof *c->segments, "curve segments", error);
    for (size_t i = 0; c->segments && i < n; i++) {
        curve_segment *s = &c->segments[i];
        control_points(in, i, s->p);
        for (size_t k = 0; k < 2; k++) {
            double at = (double)(i + k) / (double)n;
            s->width[k] = (1.0 - at) * (double)in->width[0] + at * (double)in->width[1];
            if (in->normals)
                s->n[k] = unit(load(in->normals, i + k));
        }
    }
    return c->segments != NULL;
}

/* ---- Places by area ---- */

/* Uniform along by area, around by angle (on a ribbon: across). */
static quadric_point map_curve(const void *self, vec2 u)
{
    const curve_shape *c = self;
    size_t cell = distribution_sample(&c->areas, &u.x);
    const curve_segment *s = &c->segments[cell / AREA_CELLS];
    double along = ((double)(cell % AREA_CELLS) + (double)u.x) / AREA_CELLS;
    curve_point at = segment_at(s, along);
    vec3 tangent = normalize3(dvec3_to_float(at.d1));
    frame f = frame_from_normal(tangent);
    float angle = 2.0f * PI_F * u.y;
    dvec3 n = dvec3_from_float(f.s * cosf(angle) + f.t * sinf(angle)), off = at.r * n;
    if (c->type == CURVE_RIBBON) {
        dvec3 across = segment_across(s, along);
        off = (2.0 * (double)u.y - 1.0) * across;
        n = unit(dvec3_cross(at.d1, across));
    }
    quadric_point out = {.uv = {(float)along, u.y}};
    for (int i = 0; i < 3; i++) {
        out.p[i] = at.c[i] + off[i];
        out.n[i] = n[i];
    }
    return out;
}

static bool init_area(curve_shape *c, const params *p, GError **error)
{
    size_t n = c->n_segments * AREA_CELLS;
    double total = 0.0;
    float *areas = big_alloc(n, sizeof *areas, "curve areas", error);
    for (size_t i = 0; areas && i < n && still_wanted_at(i, NULL); i++) {
        double u = ((double)(i % AREA_CELLS) + 0.5) / AREA_CELLS;
        curve_point at = segment_at(&c->segments[i / AREA_CELLS], u);
        double around = c->type == CURVE_RIBBON ? 2.0 : 2.0 * G_PI;
        double slant = dvec3_length((dvec3){dvec3_length(at.d1), at.dr, 0.0, 0.0});
        areas[i] = (float)(around * at.r * slant / AREA_CELLS);
        total += (double)areas[i];
    }
    bool done = areas && distribution_init(&c->areas, areas, n, error);
    big_free(areas);
    return done && quadric_set_area(&c->q, map_curve, total, p, error);
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    if (at->area_light) {
        error_at(error, at->area_light->place, "a curve can not be a light, in pbrt too");
        return NULL;
    }
    curve_input in = {0};
    curve_shape *c = g_new0(curve_shape, 1);
    c->split = 3;
    quadric_place(&c->q, at);
    c->q.mean_steps = MEAN_STEPS; /* there may be a million curves */
    bool done = read_input(p, &in, &c->split, error);
    c->type = (curve_type)in.type;
    if (done && make_segments(c, &in, error) && init_area(c, p, error))
        return c;
    free_curve(c);
    return NULL;
}

/* ---- Asking ---- */

static size_t n_primitives(const void *self)
{
    const curve_shape *c = self;
    return c->n_segments << c->split;
}

static curve_span span_of(const curve_shape *c, uint32_t primitive)
{
    uint32_t part = primitive & ((1u << c->split) - 1u);
    double step = ldexp(1.0, -c->split);
    return (curve_span){&c->segments[primitive >> c->split], part * step,
                        (part + 1) * step};
}

static box3 primitive_bounds(const void *self, uint32_t primitive)
{
    const curve_shape *c = self;
    curve_span span = span_of(c, primitive);
    dvec3 p[4];
    span_control(&span, p);
    double r = 0.5001 * fmax(span.segment->width[0], span.segment->width[1]);
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(fmin(p[0][k], p[1][k]), fmin(p[2][k], p[3][k])) - r;
        high[k] = fmax(fmax(p[0][k], p[1][k]), fmax(p[2][k], p[3][k])) + r;
    }
    return quadric_bounds(&c->q, low, high);
}

static box3 bounds(const void *self)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < n_primitives(self); i++)
        box = box3_union(box, primitive_bounds(self, (uint32_t)i));
    return box;
}

static bool intersect(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3])
{
    const curve_shape *c = self;
    curve_span span = span_of(c, primitive);
    quadric_ray object = quadric_to_object(&c->q, r);
    const double range[2] = {(double)t_min, (double)r->t_max};
    double at, along, across;
    if (!curve_intersect(&span, c->type, object.o, object.d, range, &at, &along, &across))
        return false;
    tuv[0] = (float)at;
    tuv[1] = (float)along;
    tuv[2] = (float)across;
    return true;
}

/* A hit in object space: place, normal before orientation, ∂p/∂u, ∂p/∂v, v. */
typedef struct curve_hit {
    dvec3 p, n, along, across;
    float v;
} curve_hit;

/* Turned to the ray as far as the curve lets it. */
static curve_hit flat_hit(const curve_point *at, dvec3 p, dvec3 d, float v)
{
    dvec3 tangent = unit(at->d1);
    dvec3 n = unit(dvec3_dot(d, tangent) * tangent - d);
    return (curve_hit){p, n, at->d1, 2.0 * at->r * dvec3_cross(tangent, n), v};
}

/* On the circle at u; where the radius changes the normal leans over. */
static curve_hit tube_hit(const curve_segment *s, const curve_point *at, dvec3 p)
{
    dvec3 tangent = unit(at->d1), off = p - at->c;
    dvec3 out = unit(off - dvec3_dot(off, tangent) * tangent);
    double speed = dvec3_length(at->d1);
    double stretch = speed - at->r * dvec3_dot(out, at->d2) / speed;
    dvec3 n = unit(out - at->dr / stretch * tangent);
    vec3 chord = dvec3_to_float(unit(s->p[3] - s->p[0]));
    frame f = frame_from_tangent(dvec3_to_float(tangent), frame_from_normal(chord).s);
    vec3 turned = dvec3_to_float(out);
    float angle = atan2f(dot3(turned, f.t), dot3(turned, f.s)) / (2.0f * PI_F);
    return (curve_hit){at->c + at->r * out, n, at->d1 - dvec3_dot(n, at->d1) * n,
                       2.0 * G_PI * at->r * dvec3_cross(tangent, out),
                       angle < 0.0f ? angle + 1.0f : angle};
}

static curve_hit ribbon_hit(const curve_segment *s, const curve_point *at, double u,
                            float v)
{
    const double h = 1e-6;
    double side = 2.0 * (double)v - 1.0;
    dvec3 b = segment_across(s, u);
    dvec3 turn = (segment_across(s, u + h) - segment_across(s, u - h)) / (2.0 * h);
    dvec3 along = at->d1 + side * turn;
    return (curve_hit){at->c + side * b, unit(dvec3_cross(along, b)), along, 2.0 * b, v};
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    const curve_shape *c = self;
    const curve_segment *s = span_of(c, hit->primitive).segment;
    quadric_ray object = quadric_to_object(&c->q, r);
    dvec3 d = object.d;
    dvec3 p = object.o + (double)hit->t * d;
    curve_point at = segment_at(s, (double)u);
    curve_hit h = c->type == CURVE_FLAT     ? flat_hit(&at, p, d, v)
                  : c->type == CURVE_RIBBON ? ribbon_hit(s, &at, (double)u, v)
                                            : tube_hit(s, &at, p);
    quadric_point point = {.uv = {u, h.v}};
    double dpdu[3], dpdv[3];
    for (int i = 0; i < 3; i++) {
        point.p[i] = h.p[i];
        point.n[i] = h.n[i];
        dpdu[i] = h.along[i];
        dpdv[i] = h.across[i];
    }
    quadric_fill_hit(&c->q, &point, dpdu, dpdv, hit);
    hit->camera_facing = c->type == CURVE_FLAT;
    if (hit->camera_facing)
        hit->error = (float)(4.0 * at.r / dvec3_length(d)) * length3(r->direction);
}

/* ---- The axis ---- */

static vec3 axis_at(const void *self, const surface_hit *hit)
{
    const curve_shape *c = self;
    curve_point at = segment_at(span_of(c, hit->primitive).segment, (double)hit->uv.x);
    return transform_point(&c->q.to_world, dvec3_to_float(at.c));
}

/* Which pieces are wanted, and of what size. */
typedef struct piece_search {
    const curve_shape *c;
    vec3 p;
    float radius;
    double to_world; /* a length over that in object space */
    shape_piece piece;
    void *data;
} piece_search;

/* No point of a span is further from its middle than the longest side of its control
   polygon, times one and a half. */
static double reach_of(const curve_span *span)
{
    dvec3 p[4];
    double longest = 0.0;
    span_control(span, p);
    for (int i = 0; i < 3; i++)
        longest = fmax(longest, dvec3_length(p[i + 1] - p[i]));
    return 1.5 * longest;
}

static void search_pieces(const piece_search *s, curve_span span, int depth)
{
    const double fine = 0.2;
    curve_point at = segment_at(span.segment, 0.5 * (span.low + span.high));
    vec3 middle = transform_point(&s->c->q.to_world, dvec3_to_float(at.c));
    double reach = reach_of(&span) * s->to_world;
    if ((double)length3(middle - s->p) > (double)s->radius + reach)
        return;
    if (reach > fine * (double)s->radius && depth > 0) {
        double half = 0.5 * (span.low + span.high);
        search_pieces(s, (curve_span){span.segment, span.low, half}, depth - 1);
        search_pieces(s, (curve_span){span.segment, half, span.high}, depth - 1);
        return;
    }
    double length = dvec3_length(at.d1) * (span.high - span.low);
    s->piece(middle, (float)(2.0 * at.r * length * s->to_world * s->to_world), s->data);
}

static void pieces_near(const void *self, vec3 p, float radius, shape_piece piece,
                        void *data)
{
    const curve_shape *c = self;
    const piece_search s = {
        .c = c,
        .p = p,
        .radius = radius,
        .to_world = sqrt(instance_mean_area_factor(&c->q.to_world)),
        .piece = piece,
        .data = data,
    };
    for (size_t i = 0; i < c->n_segments; i++)
        search_pieces(&s, (curve_span){&c->segments[i], 0.0, 1.0}, MOST_HALVINGS);
}

const shape_kind shape_curve = {
    .name = "curve",
    .parameters = "P type basis degree width width0 width1 N splitdepth",
    .create = create,
    .free = free_curve,
    .bounds = bounds,
    .n_primitives = n_primitives,
    .primitive_bounds = primitive_bounds,
    .intersect = intersect,
    .fill_hit = fill_hit,
    .area = quadric_area,
    .sample_area = quadric_sample_area,
    .axis_at = axis_at,
    .pieces_near = pieces_near,
};
