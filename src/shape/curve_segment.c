#include "shape/curve_segment.h"

#include <glib.h>

enum { MOST_PIECES = 32, NEWTON_STEPS = 12 };

/* Pieces stray from their chord by no more than this share of the radius. */
#define STRAY 0.1

/* Newton's method has arrived when u moves by less. */
#define ARRIVED 1e-11

/* Spans overlap by this much, so that no ray slips between them. */
#define SEAM 1e-9

/* ---- The curve ---- */

curve_point segment_at(const curve_segment *s, double u)
{
    double v = 1.0 - u;
    const dvec3 *p = s->p;
    return (curve_point){
        .c = v * v * v * p[0] + 3.0 * u * v * v * p[1] + 3.0 * u * u * v * p[2] +
             u * u * u * p[3],
        .d1 = 3.0 * (v * v * (p[1] - p[0]) + 2.0 * u * v * (p[2] - p[1]) +
                     u * u * (p[3] - p[2])),
        .d2 = 6.0 * (v * (p[2] - 2.0 * p[1] + p[0]) + u * (p[3] - 2.0 * p[2] + p[1])),
        .r = 0.5 * (v * s->width[0] + u * s->width[1]),
        .dr = 0.5 * (s->width[1] - s->width[0]),
    };
}

static dvec3 normal_at(const curve_segment *s, double u)
{
    double cosine = CLAMP(dvec3_dot(s->n[0], s->n[1]), -1.0, 1.0), angle = acos(cosine);
    if (!(sin(angle) > 1e-6))
        return s->n[0];
    return (sin((1.0 - u) * angle) * s->n[0] + sin(u * angle) * s->n[1]) / sin(angle);
}

dvec3 segment_across(const curve_segment *s, double u)
{
    curve_point at = segment_at(s, u);
    dvec3 across = dvec3_cross(normal_at(s, u), at.d1);
    double length = dvec3_length(across);
    return length > 0.0 ? at.r / length * across : across;
}

/* A value of the blossom: the polar form of the cubic. */
static dvec3 blossom(const dvec3 p[4], const double u[3])
{
    dvec3 q[4] = {p[0], p[1], p[2], p[3]};
    for (int level = 0; level < 3; level++) {
        for (int i = 0; i < 3 - level; i++)
            q[i] = (1.0 - u[level]) * q[i] + u[level] * q[i + 1];
    }
    return q[0];
}

void span_control(const curve_span *span, dvec3 p[4])
{
    double a = span->low, b = span->high;
    const double arguments[4][3] = {{a, a, a}, {a, a, b}, {a, b, b}, {b, b, b}};
    for (int i = 0; i < 4; i++)
        p[i] = blossom(span->segment->p, arguments[i]);
}

/* ---- Pieces ---- */

/* What a search works with. */
typedef struct search {
    const curve_segment *segment;
    double low, high; /* of the span, with its seams */
    double stray;     /* how far pieces stray from their chords at most */
    dvec3 o, d;
    double range[2];
    double t, u, v; /* of the nearest hit */
    bool found;
} search;

/* A chord is off by at most 1/8 of the second derivative, which is at most six times the
   second difference of control points. */
static int n_pieces(const curve_span *span, double least_radius, double *stray)
{
    dvec3 p[4];
    span_control(span, p);
    double bend = fmax(dvec3_length(p[0] - 2.0 * p[1] + p[2]),
                       dvec3_length(p[1] - 2.0 * p[2] + p[3]));
    double wanted = sqrt(0.75 * bend / (STRAY * least_radius));
    int n = wanted < MOST_PIECES ? 1 + (int)wanted : MOST_PIECES;
    *stray = 0.75 * bend / (n * n);
    return n;
}

static void take(search *s, double t, double u, double v)
{
    if (!(t > s->range[0] && t < s->range[1]) || !(u >= s->low && u <= s->high) ||
        (s->found && t >= s->t))
        return;
    s->found = true;
    s->t = t;
    s->u = CLAMP(u, 0.0, 1.0);
    s->v = v;
}

/* ---- Flat: the nearest approach of line and curve, seen along the ray ---- */

static dvec3 across_ray(const search *s, dvec3 v)
{
    return v - dvec3_dot(v, s->d) / dvec3_dot(s->d, s->d) * s->d;
}

static void search_flat(search *s, double u)
{
    double step = 1.0;
    for (int i = 0; i < NEWTON_STEPS && fabs(step) > ARRIVED; i++) {
        curve_point at = segment_at(s->segment, u);
        dvec3 off = across_ray(s, at.c - s->o), along = across_ray(s, at.d1);
        double slope = dvec3_dot(along, along) + dvec3_dot(off, across_ray(s, at.d2));
        step = dvec3_dot(off, along) / slope;
        if (!isfinite(step))
            return;
        u = CLAMP(u - step, s->low - 0.5, s->high + 0.5);
    }
    curve_point at = segment_at(s->segment, u);
    dvec3 off = across_ray(s, at.c - s->o);
    double distance = dvec3_length(off);
    if (!(fabs(step) <= 1e-6) || !(distance <= at.r))
        return;
    double side = dvec3_dot(dvec3_cross(s->d, at.d1), off) < 0.0 ? 0.5 : -0.5;
    take(s, dvec3_dot(at.c - s->o, s->d) / dvec3_dot(s->d, s->d), u,
         0.5 + side * (at.r > 0.0 ? distance / at.r : 0.0));
}

/* Where the ray passes closest to the chord, unless that is too far off. */
static void flat_piece(search *s, double low, double high)
{
    curve_point a = segment_at(s->segment, low), b = segment_at(s->segment, high);
    dvec3 from = across_ray(s, a.c - s->o), chord = across_ray(s, b.c - s->o) - from;
    double x = -dvec3_dot(from, chord) / dvec3_dot(chord, chord);
    x = isfinite(x) ? CLAMP(x, 0.0, 1.0) : 0.5;
    if (dvec3_length(from + x * chord) <= fmax(a.r, b.r) + s->stray)
        search_flat(s, low + (high - low) * x);
}

/* ---- Tube: x - c(u) stands across the curve and has length r(u) ---- */

static void search_tube(search *s, double t, double u)
{
    double step = 1.0, miss = 1.0;
    for (int i = 0; i < NEWTON_STEPS && (fabs(step) > ARRIVED || miss > 1e-10); i++) {
        curve_point at = segment_at(s->segment, u);
        dvec3 off = s->o + t * s->d - at.c;
        double f = dvec3_dot(off, at.d1), g = dvec3_dot(off, off) - at.r * at.r;
        double f_t = dvec3_dot(s->d, at.d1);
        double f_u = dvec3_dot(off, at.d2) - dvec3_dot(at.d1, at.d1);
        double g_t = 2.0 * dvec3_dot(off, s->d);
        double g_u = -2.0 * f - 2.0 * at.r * at.dr;
        double determinant = f_t * g_u - f_u * g_t;
        step = (f_t * g - g_t * f) / determinant;
        double move = (f * g_u - g * f_u) / determinant;
        miss = fabs(g) / (at.r * at.r);
        if (!isfinite(step) || !isfinite(move))
            return;
        u = CLAMP(u - step, s->low - 0.5, s->high + 0.5);
        t -= move;
    }
    if (fabs(step) <= 1e-6 && miss <= 1e-6)
        take(s, t, u, 0.0);
}

/* The ray between the planes at both ends of the chord, as far as it is within the
   cylinder around it. */
static void tube_piece(search *s, double low, double high)
{
    curve_point a = segment_at(s->segment, low), b = segment_at(s->segment, high);
    dvec3 chord = b.c - a.c, from = s->o - a.c;
    double length2 = dvec3_dot(chord, chord),
           radius = (1.0 + 2.0 * STRAY) * fmax(a.r, b.r);
    double from_along = dvec3_dot(from, chord) / length2;
    double d_along = dvec3_dot(s->d, chord) / length2;
    dvec3 from_off = from - from_along * chord, d_off = s->d - d_along * chord;
    double t[2] = {-HUGE_VAL, HUGE_VAL};
    double a2 = dvec3_dot(d_off, d_off), half = -dvec3_dot(from_off, d_off);
    double root = half * half - a2 * (dvec3_dot(from_off, from_off) - radius * radius);
    if (!(root >= 0.0) || !(length2 > 0.0))
        return;
    if (a2 > 0.0) {
        t[0] = (half - sqrt(root)) / a2;
        t[1] = (half + sqrt(root)) / a2;
    }
    /* A bent tube reaches beyond the planes by its radius times the bend. */
    const double beyond = 0.5;
    double in = (-beyond - from_along) / d_along,
           out = (1.0 + beyond - from_along) / d_along;
    if (isfinite(in) && isfinite(out)) {
        t[0] = fmax(t[0], fmin(in, out));
        t[1] = fmin(t[1], fmax(in, out));
    }
    for (int i = 0; i < 2 && t[0] <= t[1]; i++) {
        double x = CLAMP(from_along + t[i] * d_along, 0.0, 1.0);
        search_tube(s, t[i], low + (high - low) * x);
    }
}

/* ---- Ribbon: c(u) + s b(u) lies on the ray ---- */

static void search_ribbon(search *s, double u, double side)
{
    const double h = 1e-6;
    dvec3 e1 = across_ray(s, fabs(s->d[0]) < 0.6 * dvec3_length(s->d)
                                 ? (dvec3){1.0, 0.0, 0.0, 0.0}
                                 : (dvec3){0.0, 1.0, 0.0, 0.0});
    dvec3 e2 = dvec3_cross(s->d, e1), off = {0};
    double step = 1.0;
    for (int i = 0; i < NEWTON_STEPS && fabs(step) > ARRIVED; i++) {
        curve_point at = segment_at(s->segment, u);
        dvec3 b = segment_across(s->segment, u);
        dvec3 turn =
            (segment_across(s->segment, u + h) - segment_across(s->segment, u - h)) /
            (2.0 * h);
        dvec3 along = at.d1 + side * turn;
        off = at.c + side * b - s->o;
        double f = dvec3_dot(off, e1), g = dvec3_dot(off, e2);
        double f_u = dvec3_dot(along, e1), g_u = dvec3_dot(along, e2);
        double f_s = dvec3_dot(b, e1), g_s = dvec3_dot(b, e2);
        double determinant = f_u * g_s - f_s * g_u;
        step = (f * g_s - g * f_s) / determinant;
        double move = (f_u * g - g_u * f) / determinant;
        if (!isfinite(step) || !isfinite(move))
            return;
        u = CLAMP(u - step, s->low - 0.5, s->high + 0.5);
        side -= move;
    }
    if (fabs(step) <= 1e-6 && fabs(side) <= 1.0)
        take(s, dvec3_dot(off, s->d) / dvec3_dot(s->d, s->d), u, 0.5 * (side + 1.0));
}

static void ribbon_piece(search *s, double low, double high)
{
    const double reach = 1.2, beyond = 0.1 * (high - low);
    const double ends[2] = {low - beyond, high + beyond};
    dvec3 corner[4];
    for (int i = 0; i < 4; i++) {
        dvec3 b = segment_across(s->segment, ends[i & 1]);
        corner[i] = segment_at(s->segment, ends[i & 1]).c + (i < 2 ? -reach : reach) * b;
    }
    patch guess = patch_from_corners(corner[0], corner[1], corner[2], corner[3]);
    const double anywhere[2] = {-HUGE_VAL, HUGE_VAL};
    double t, uv[2];
    if (patch_intersect(&guess, s->o, s->d, anywhere, &t, uv))
        search_ribbon(s, ends[0] + uv[0] * (ends[1] - ends[0]),
                      reach * (2.0 * uv[1] - 1.0));
}

/* ---- All of them ---- */

bool curve_intersect(const curve_span *span, curve_type type, dvec3 o, dvec3 d,
                     const double range[2], double *t, double *u, double *v)
{
    static void (*const pieces[])(search *, double, double) = {
        [CURVE_FLAT] = flat_piece,
        [CURVE_CYLINDER] = tube_piece,
        [CURVE_RIBBON] = ribbon_piece,
    };
    search s = {.segment = span->segment,
                .low = span->low - SEAM,
                .high = span->high + SEAM,
                .o = o,
                .d = d,
                .range = {range[0], range[1]}};
    double widest = fmax(span->segment->width[0], span->segment->width[1]);
    int n = n_pieces(
        span,
        0.5 * fmax(fmin(span->segment->width[0], span->segment->width[1]), 0.1 * widest),
        &s.stray);
    double step = (span->high - span->low) / n;
    for (int i = 0; i < n; i++)
        pieces[type](&s, span->low + i * step, span->low + (i + 1) * step);
    *t = s.t;
    *u = s.u;
    *v = s.v;
    return s.found;
}
