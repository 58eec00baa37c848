#include "shape/shape_quadric.h"

#include <glib.h>

/* Of the mean of the area factor: steps at first, how often they are doubled at most. */
enum { LEAST_STEPS = 4, ROMBERG_ROWS = 8 };
enum { MEAN_STEPS = LEAST_STEPS << (ROMBERG_ROWS - 1) };

static double dot_double(const double *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static double determinant(const quadric *q)
{
    const double(*m)[4] = q->to_world.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Mᵀ M is a multiple of the identity. */
static bool is_similarity(const double m[4][4])
{
    double gram[3][3], trace = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            gram[i][j] = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
        trace += gram[i][i];
    }
    for (int i = 0; i < 9; i++) {
        double expected = i % 4 == 0 ? trace / 3.0 : 0.0;
        if (fabs(gram[i / 3][i % 3] - expected) > 1e-6 * trace)
            return false;
    }
    return true;
}

static double area_factor(const quadric *q, const double n[3])
{
    double moved[3];
    for (int i = 0; i < 3; i++) {
        moved[i] = 0.0;
        for (int k = 0; k < 3; k++)
            moved[i] += q->to_world.inverse[k][i] * n[k];
    }
    return fabs(determinant(q)) * sqrt(dot_double(moved, moved, 3));
}

void quadric_place(quadric *q, const shape_place *at)
{
    *q = (quadric){.to_world = at->to_world,
                   .flip = at->reverse_orientation !=
                           transform_swaps_handedness(&at->to_world),
                   .is_similar = is_similarity(at->to_world.m),
                   .phi_max = 2.0 * G_PI,
                   .mean_steps = MEAN_STEPS};
    for (int column = 0; column < 4; column++)
        for (int i = 0; i < 3; i++)
            q->to_object[column][i] = at->to_world.inverse[i][column];
}

bool quadric_init(quadric *q, const params *p, const shape_place *at, GError **error)
{
    float phi_max = 360.0f;
    if (!params_float(p, "phimax", &phi_max, error))
        return false;
    if (!(phi_max > 0.0f && phi_max <= 360.0f)) {
        error_at(error, params_find(p, "phimax")->place,
                 "phimax must be above 0 and at most 360 degrees, found %g",
                 (double)phi_max);
        return false;
    }
    quadric_place(q, at);
    q->phi_max = (double)phi_max / 180.0 * G_PI;
    return true;
}

/* The mean of the area factor over the surface by the midpoint rule, n steps each way. */
static double midpoint_mean(const quadric *q, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) {
            vec2 u = {((float)i + 0.5f) / (float)n, ((float)k + 0.5f) / (float)n};
            sum += area_factor(q, q->map(q, u).n);
        }
    }
    return sum / ((double)n * n);
}

/* The mean of the area factor over the surface, by Romberg's extrapolation: the rule's
   error is a series in the square of the step. */
static double mean_factor(const quadric *q)
{
    const double settled = 1e-6;
    double row[ROMBERG_ROWS] = {0};
    for (int k = 0; k < ROMBERG_ROWS && LEAST_STEPS << k <= q->mean_steps; k++) {
        double above = k > 0 ? row[k - 1] : 0.0, power = 1.0;
        double better = midpoint_mean(q, LEAST_STEPS << k);
        for (int j = 0; j < k; j++) {
            double before = row[j];
            row[j] = better;
            power *= 4.0;
            better += (better - before) / (power - 1.0);
        }
        row[k] = better;
        if (k > 1 && fabs(better - above) <= settled * better)
            return better;
    }
    return row[0];
}

bool quadric_set_area(quadric *q, quadric_map map, double object_area, const params *p,
                      GError **error)
{
    q->map = map;
    if (q->is_similar) {
        q->factor = area_factor(q, (const double[3]){0.0, 0.0, 1.0});
        q->area = (float)(object_area * q->factor);
    } else {
        double norm2 = 0.0; /* of M⁻¹ (Frobenius): no factor is above |det M| times it */
        for (int i = 0; i < 3; i++)
            norm2 += dot_double(q->to_world.inverse[i], q->to_world.inverse[i], 3);
        q->factor = fabs(determinant(q)) * sqrt(norm2);
        q->area = (float)(object_area * mean_factor(q));
    }
    if (q->area > 0.0f && isfinite(q->area))
        return true;
    error_at(error, p->place, "the shape has no area (or an infinite one)");
    return false;
}

static vec3 point_to_world(const quadric *q, const double p[3])
{
    vec3 out = {0};
    for (int i = 0; i < 3; i++)
        out[i] = (float)(dot_double(q->to_world.m[i], p, 3) + q->to_world.m[i][3]);
    return out;
}

static vec3 normal_to_world(const quadric *q, const double n[3])
{
    double out[3];
    for (int i = 0; i < 3; i++) {
        out[i] = q->to_world.inverse[0][i] * n[0] + q->to_world.inverse[1][i] * n[1] +
                 q->to_world.inverse[2][i] * n[2];
    }
    double scale = (q->flip ? -1.0 : 1.0) / sqrt(dot_double(out, out, 3));
    return vec3_make((float)(out[0] * scale), (float)(out[1] * scale),
                     (float)(out[2] * scale));
}

static vec3 vector_to_world(const quadric *q, const double v[3])
{
    vec3 out = {0};
    for (int i = 0; i < 3; i++)
        out[i] = (float)dot_double(q->to_world.m[i], v, 3);
    return out;
}

void quadric_fill_hit(const quadric *q, const quadric_point *at, const double dpdu[3],
                      const double dpdv[3], surface_hit *hit)
{
    hit->p = point_to_world(q, at->p);
    hit->n = hit->n_geom = normal_to_world(q, at->n);
    hit->dpdu = vector_to_world(q, dpdu);
    hit->dpdv = vector_to_world(q, dpdv);
    hit->uv = at->uv;
    hit->error = 0.0f;
}

double quadric_phi(const double p[3])
{
    double phi = atan2(p[1], p[0]);
    return phi < 0.0 ? phi + 2.0 * G_PI : phi;
}

box3 quadric_bounds(const quadric *q, const double low[3], const double high[3])
{
    box3 box = box3_empty();
    for (unsigned corner = 0; corner < 8; corner++) {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = (corner >> i) & 1 ? high[i] : low[i];
        box = box3_with_point(box, point_to_world(q, p));
    }
    for (int i = 0; i < 3; i++) {
        box.low[i] = nextafterf(box.low[i], -INFINITY);
        box.high[i] = nextafterf(box.high[i], INFINITY);
    }
    return box;
}

float quadric_area(const void *self)
{
    const quadric *q = self;
    return q->area;
}

shape_sample quadric_sample_area(const void *self, float u_primitive, vec2 u)
{
    const quadric *q = self;
    quadric_point at = q->map(q, u);
    if (!q->is_similar) {
        float keep = u_primitive;
        for (uint64_t i = 1; i < 64; i++) {
            if ((double)keep * q->factor < area_factor(q, at.n))
                break;
            at = q->map(q, shape_retry(u, i, &keep));
        }
    }
    return (shape_sample){.p = point_to_world(q, at.p),
                          .n = normal_to_world(q, at.n),
                          .uv = at.uv,
                          .pdf = 1.0f / q->area};
}
