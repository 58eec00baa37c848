#include "scene/mesh_triangle.h"

#include <glib.h>

static double dot_double(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross_double(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalize_double(double v[3])
{
    double length = sqrt(dot_double(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

void triangle_get(const mesh *m, size_t primitive, triangle *t)
{
    double edge[2][3];
    for (int i = 0; i < 3; i++) {
        t->vertex[i] = m->indices[3 * primitive + (size_t)i];
        for (int k = 0; k < 3; k++)
            t->p[i][k] = (double)m->positions[3 * (size_t)t->vertex[i] + (size_t)k];
    }
    for (int k = 0; k < 3; k++) {
        edge[0][k] = t->p[1][k] - t->p[0][k];
        edge[1][k] = t->p[2][k] - t->p[0][k];
    }
    cross_double(edge[0], edge[1], t->cross);
}

double triangle_area(const triangle *t)
{
    return 0.5 * sqrt(dot_double(t->cross, t->cross));
}

/* Unit directions from ref to the corners. */
static void directions(const triangle *t, vec3 ref, double d[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            d[i][k] = t->p[i][k] - (double)ref[k];
        normalize_double(d[i]);
    }
}

double triangle_solid_angle(const triangle *t, vec3 ref)
{
    double d[3][3], normal[3];
    directions(t, ref, d);
    cross_double(d[1], d[2], normal);
    double volume = fabs(dot_double(d[0], normal));
    double sum =
        1.0 + dot_double(d[0], d[1]) + dot_double(d[1], d[2]) + dot_double(d[2], d[0]);
    return 2.0 * atan2(volume, sum);
}

/* The unit direction at cosine c from axis, in the plane of axis and v. */
static void turn_toward(const double axis[3], const double v[3], double c, double out[3])
{
    double along = dot_double(axis, v), across[3];
    for (int i = 0; i < 3; i++)
        across[i] = v[i] - along * axis[i];
    normalize_double(across);
    double s = sqrt(fmax(0.0, 1.0 - c * c));
    for (int i = 0; i < 3; i++)
        out[i] = c * axis[i] + s * across[i];
}

/* The angle at corner d[0] between the great circles to d[1] and d[2]. */
static double corner_angle(const double d[3][3])
{
    double n1[3], n2[3], n3[3];
    cross_double(d[0], d[1], n1);
    cross_double(d[0], d[2], n2);
    cross_double(n1, n2, n3);
    return atan2(sqrt(dot_double(n3, n3)), dot_double(n1, n2));
}

static void sample_direction(const double d[3][3], double solid_angle, vec2 u,
                             double w[3])
{
    /* The sub-triangle of area u.x Ω that shares corner 0 and side 0-1 ... */
    double alpha = corner_angle(d), part = (double)u.x * solid_angle;
    double s = sin(part - alpha), t = cos(part - alpha);
    double a = t - cos(alpha);
    double b = s + sin(alpha) * dot_double(d[0], d[1]);
    double q = ((b * t - a * s) * cos(alpha) - b) / ((b * s + a * t) * sin(alpha));
    double corner[3];
    turn_toward(d[0], d[2], isfinite(q) ? CLAMP(q, -1.0, 1.0) : 1.0, corner);
    /* ... and a point between corner 1 and its far corner. */
    double z = 1.0 - (double)u.y * (1.0 - dot_double(corner, d[1]));
    turn_toward(d[1], corner, z, w);
}

void triangle_sample_solid_angle(const triangle *t, vec3 ref, vec2 u, double b[3])
{
    double d[3][3], w[3], edge1[3], edge2[3], from[3], h[3], g[3];
    directions(t, ref, d);
    sample_direction((const double(*)[3])d, triangle_solid_angle(t, ref), u, w);
    for (int k = 0; k < 3; k++) {
        edge1[k] = t->p[1][k] - t->p[0][k];
        edge2[k] = t->p[2][k] - t->p[0][k];
        from[k] = (double)ref[k] - t->p[0][k];
    }
    cross_double(w, edge2, h);
    cross_double(from, edge1, g);
    double scale = 1.0 / dot_double(edge1, h);
    double b1 = dot_double(from, h) * scale, b2 = dot_double(w, g) * scale;
    b[1] = isfinite(b1) ? CLAMP(b1, 0.0, 1.0) : 0.0;
    b[2] = isfinite(b2) ? CLAMP(b2, 0.0, 1.0 - b[1]) : 0.0;
    b[0] = 1.0 - b[1] - b[2];
}
