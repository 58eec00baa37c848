/*
 * One cubic Bézier segment of a curve with a width, and where rays meet it, in double
 * precision. Three kinds of surface are spanned by it:
 *
 *   flat      no surface of its own: a ribbon that turns to face every ray
 *   cylinder  a tube: circles of radius w/2 around the curve, across it; open at the ends
 *   ribbon    the strip  c(u) + s b(u), |s| <= 1,  b = w/2 of n × c', n turning evenly
 *             from one given normal to the next
 *
 * A span is cut into pieces so short that they are nearly straight; the chord of each
 * gives a first guess, and Newton's method goes from there to the surface itself
 * (compare Reshetov & Luebke, "Phantom Ray-Hair Intersector", 2018).
 */
#pragma once

#include "shape/patch.h"

typedef enum curve_type { CURVE_FLAT, CURVE_CYLINDER, CURVE_RIBBON } curve_type;

typedef struct curve_segment {
    dvec3 p[4];      /**< control points */
    double width[2]; /**< at its ends */
    dvec3 n[2];      /**< of a ribbon, at its ends; unit */
} curve_segment;

/** @brief A part of a segment, u in low..high. */
typedef struct curve_span {
    const curve_segment *segment;
    double low, high;
} curve_span;

/** @brief The curve at u: place, first and second derivative, half the width and its
 * derivative. */
typedef struct curve_point {
    dvec3 c, d1, d2;
    double r, dr;
} curve_point;

curve_point segment_at(const curve_segment *s, double u);
/** @brief Half a ribbon's width, across it. */
dvec3 segment_across(const curve_segment *s, double u);
/** @brief The control points of a part of the segment. */
void span_control(const curve_span *span, dvec3 p[4]);

/** @brief The nearest t in range (of o + t d, d need not be unit) where a ray meets the
 * surface; *u along the curve, *v across: 0..1, 0 for a tube. */
bool curve_intersect(const curve_span *span, curve_type type, dvec3 o, dvec3 d,
                     const double range[2], double *t, double *u, double *v);
