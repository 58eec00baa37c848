#include "scene/mesh_triangle.h"

#include <glib.h>
#include <string.h>

static dvec3 corner_of(const mesh *m, uint32_t vertex)
{
    vec3 p; /* the padding after the last position is what is read beyond it */
    memcpy(&p, m->positions + 3 * (size_t)vertex, sizeof p);
    p[3] = 0.0f;
    return dvec3_from_float(p);
}

void triangle_get(const mesh *m, size_t primitive, triangle *t)
{
    for (size_t i = 0; i < 3; i++) {
        t->vertex[i] = m->indices[3 * primitive + i];
        t->p[i] = corner_of(m, t->vertex[i]);
    }
    t->edge[0] = t->p[1] - t->p[0];
    t->edge[1] = t->p[2] - t->p[0];
    t->cross = dvec3_cross(t->edge[0], t->edge[1]);
}

double triangle_area(const triangle *t)
{
    return 0.5 * dvec3_length(t->cross);
}

/* Unit directions from ref to the corners. */
static void directions(const triangle *t, vec3 ref, dvec3 d[3])
{
    for (int i = 0; i < 3; i++) {
        d[i] = t->p[i] - dvec3_from_float(ref);
        d[i] /= dvec3_length(d[i]);
    }
}

double triangle_solid_angle(const triangle *t, vec3 ref)
{
    dvec3 d[3];
    directions(t, ref, d);
    double volume = fabs(dvec3_dot(d[0], dvec3_cross(d[1], d[2])));
    double sum =
        1.0 + dvec3_dot(d[0], d[1]) + dvec3_dot(d[1], d[2]) + dvec3_dot(d[2], d[0]);
    return 2.0 * atan2(volume, sum);
}

/* The unit direction at cosine c from axis, in the plane of axis and v. */
static dvec3 turn_toward(dvec3 axis, dvec3 v, double c)
{
    dvec3 across = v - dvec3_dot(axis, v) * axis;
    double s = sqrt(MAX(1.0 - c * c, 0.0));
    return c * axis + s / dvec3_length(across) * across;
}

/* The angle at corner d[0] between the great circles to d[1] and d[2]. */
static double corner_angle(const dvec3 d[3])
{
    dvec3 n1 = dvec3_cross(d[0], d[1]), n2 = dvec3_cross(d[0], d[2]);
    return atan2(dvec3_length(dvec3_cross(n1, n2)), dvec3_dot(n1, n2));
}

static dvec3 sample_direction(const dvec3 d[3], double solid_angle, vec2 u)
{
    /* The sub-triangle of area u.x Ω that shares corner 0 and side 0-1 ... */
    double alpha = corner_angle(d), part = (double)u.x * solid_angle;
    double s = sin(part - alpha), t = cos(part - alpha);
    double a = t - cos(alpha);
    double b = s + sin(alpha) * dvec3_dot(d[0], d[1]);
    double q = ((b * t - a * s) * cos(alpha) - b) / ((b * s + a * t) * sin(alpha));
    dvec3 corner = turn_toward(d[0], d[2], isfinite(q) ? CLAMP(q, -1.0, 1.0) : 1.0);
    /* ... and a point between corner 1 and its far corner. */
    double z = 1.0 - (double)u.y * (1.0 - dvec3_dot(corner, d[1]));
    return turn_toward(d[1], corner, z);
}

void triangle_sample_solid_angle(const triangle *t, vec3 ref, vec2 u, double b[3])
{
    dvec3 d[3];
    directions(t, ref, d);
    dvec3 w = sample_direction(d, triangle_solid_angle(t, ref), u);
    dvec3 from = dvec3_from_float(ref) - t->p[0];
    dvec3 h = dvec3_cross(w, t->edge[1]), g = dvec3_cross(from, t->edge[0]);
    double scale = 1.0 / dvec3_dot(t->edge[0], h);
    double b1 = dvec3_dot(from, h) * scale, b2 = dvec3_dot(w, g) * scale;
    b[1] = isfinite(b1) ? CLAMP(b1, 0.0, 1.0) : 0.0;
    b[2] = isfinite(b2) ? CLAMP(b2, 0.0, 1.0 - b[1]) : 0.0;
    b[0] = 1.0 - b[1] - b[2];
}
