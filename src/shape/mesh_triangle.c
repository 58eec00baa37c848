#include "shape/mesh_triangle.h"

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

seen_triangle triangle_seen_from(const triangle *t, vec3 ref)
{
    seen_triangle seen;
    for (int i = 0; i < 3; i++) {
        seen.d[i] = t->p[i] - dvec3_from_float(ref);
        seen.d[i] /= dvec3_length(seen.d[i]);
    }
    const dvec3 *d = seen.d;
    double volume = fabs(dvec3_dot(d[0], dvec3_cross(d[1], d[2])));
    double sum =
        1.0 + dvec3_dot(d[0], d[1]) + dvec3_dot(d[1], d[2]) + dvec3_dot(d[2], d[0]);
    seen.solid_angle = 2.0 * atan2(volume, sum);
    return seen;
}

/* The unit direction at cosine c from axis, in the plane of axis and v. */
static dvec3 turn_toward(dvec3 axis, dvec3 v, double c)
{
    dvec3 across = v - dvec3_dot(axis, v) * axis;
    double s2 = MAX(1.0 - c * c, 0.0);
    return c * axis + sqrt(s2 / dvec3_dot(across, across)) * across;
}

static dvec3 sample_direction(const seen_triangle *seen, vec2 u)
{
    const dvec3 *d = seen->d;
    /* The angle α at corner 0, between the great circles to the others ... */
    dvec3 n1 = dvec3_cross(d[0], d[1]), n2 = dvec3_cross(d[0], d[2]);
    double scale = 1.0 / sqrt(dvec3_dot(n1, n1) * dvec3_dot(n2, n2));
    double cos_alpha = dvec3_dot(n1, n2) * scale;
    double sin_alpha = dvec3_length(dvec3_cross(n1, n2)) * scale;
    /* ... and the sub-triangle of area u.x Ω that shares it and side 0-1 ... */
    double part = (double)u.x * seen->solid_angle;
    double sin_part = sin(part), cos_part = cos(part);
    double s = sin_part * cos_alpha - cos_part * sin_alpha;
    double t = cos_part * cos_alpha + sin_part * sin_alpha;
    double a = t - cos_alpha;
    double b = s + sin_alpha * dvec3_dot(d[0], d[1]);
    double q = ((b * t - a * s) * cos_alpha - b) / ((b * s + a * t) * sin_alpha);
    dvec3 corner = turn_toward(d[0], d[2], isfinite(q) ? CLAMP(q, -1.0, 1.0) : 1.0);
    /* ... and a point between corner 1 and its far corner. */
    double z = 1.0 - (double)u.y * (1.0 - dvec3_dot(corner, d[1]));
    return turn_toward(d[1], corner, z);
}

void triangle_sample_solid_angle(const triangle *t, const seen_triangle *seen, vec3 ref,
                                 vec2 u, double b[3])
{
    dvec3 w = sample_direction(seen, u);
    dvec3 from = dvec3_from_float(ref) - t->p[0];
    dvec3 h = dvec3_cross(w, t->edge[1]), g = dvec3_cross(from, t->edge[0]);
    double scale = 1.0 / dvec3_dot(t->edge[0], h);
    double b1 = dvec3_dot(from, h) * scale, b2 = dvec3_dot(w, g) * scale;
    b[1] = isfinite(b1) ? CLAMP(b1, 0.0, 1.0) : 0.0;
    b[2] = isfinite(b2) ? CLAMP(b2, 0.0, 1.0 - b[1]) : 0.0;
    b[0] = 1.0 - b[1] - b[2];
}
