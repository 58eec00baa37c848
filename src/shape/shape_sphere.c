/*
 * The sphere, whole or cut by two planes and an angle.
 *
 * Toward a point outside, a whole sphere is sampled uniformly in the cone it fills:
 *
 *         _..-¯¯ n\ α
 *   ref <─────────(─ c )      sin θmax = R/d, cos α = sin²θ / sin θmax +
 *         ¯¯--..__/                    cos θ √(1 − sin²θ / sin²θmax)
 *
 * with 1 − cos kept instead of cos, so that small and far spheres keep their digits.
 */
#include "math/warp.h"
#include "shape/shape_kinds.h"
#include "shape/shape_quadric.h"

#include <glib.h>

typedef struct sphere {
    quadric q;
    double radius, z_min, z_max;
    double theta_min, theta_max; /* at z_min and z_max: theta_min > theta_max */
    bool is_whole;
    double center[3], world_radius; /* used if is_whole and similar */
} sphere;

/* @param turn the angle around the axis, over phi_max */
static quadric_point at_angles(const sphere *s, const double p[3], double turn)
{
    quadric_point at;
    for (int i = 0; i < 3; i++) {
        at.p[i] = p[i];
        at.n[i] = p[i] / s->radius;
    }
    double theta = acos(CLAMP(at.n[2], -1.0, 1.0));
    at.uv = (vec2){(float)turn,
                   (float)((theta - s->theta_min) / (s->theta_max - s->theta_min))};
    return at;
}

static quadric_point map_sphere(const void *self, vec2 u)
{
    const sphere *s = self;
    double z = s->z_min + (double)u.x * (s->z_max - s->z_min);
    double r = sqrt(fmax(0.0, (s->radius - z) * (s->radius + z)));
    double phi = (double)u.y * s->q.phi_max;
    return at_angles(s, (const double[3]){r * cos(phi), r * sin(phi), z}, (double)u.y);
}

static bool read_extent(sphere *s, const params *p, GError **error)
{
    float radius = 1.0f;
    if (!params_float(p, "radius", &radius, error))
        return false;
    if (!(radius > 0.0f)) {
        error_at(error, params_find(p, "radius")->place,
                 "the sphere's radius must be positive, found %g", (double)radius);
        return false;
    }
    float z[2] = {-radius, radius};
    if (!params_float(p, "zmin", &z[0], error) || !params_float(p, "zmax", &z[1], error))
        return false;
    s->radius = (double)radius;
    s->z_min = (double)clampf(minf(z[0], z[1]), -radius, radius);
    s->z_max = (double)clampf(maxf(z[0], z[1]), -radius, radius);
    s->theta_min = acos(s->z_min / s->radius);
    s->theta_max = acos(s->z_max / s->radius);
    return true;
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    sphere s = {0};
    if (!quadric_init(&s.q, p, at, error) || !read_extent(&s, p, error))
        return NULL;
    s.is_whole = s.z_min <= -s.radius && s.z_max >= s.radius &&
                 s.q.phi_max >= 2.0 * G_PI * (1.0 - 1e-9);
    sphere *self = g_new(sphere, 1);
    *self = s;
    double area = s.q.phi_max * s.radius * (s.z_max - s.z_min);
    if (!quadric_set_area(&self->q, map_sphere, area, p, error)) {
        g_free(self);
        return NULL;
    }
    for (int i = 0; i < 3; i++)
        self->center[i] = self->q.to_world.m[i][3];
    self->world_radius = self->radius * sqrt(self->q.factor);
    return self;
}

static box3 bounds(const void *self)
{
    const sphere *s = self;
    return quadric_bounds(&s->q, (const double[3]){-s->radius, -s->radius, s->z_min},
                          (const double[3]){s->radius, s->radius, s->z_max});
}

static bool is_on_part(const sphere *s, const quadric_ray *r, double t)
{
    if (s->is_whole)
        return true;
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = r->o[i] + t * r->d[i];
    return p[2] >= s->z_min && p[2] <= s->z_max && quadric_in_turn(&s->q, p);
}

static bool intersect(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3])
{
    (void)primitive;
    const sphere *s = self;
    quadric_ray object = quadric_to_object(&s->q, r);
    double roots[2];
    if (!quadric_roots(&object, 3, s->radius, roots))
        return false;
    for (int i = 0; i < 2; i++) {
        if (roots[i] > (double)t_min && roots[i] < (double)r->t_max &&
            is_on_part(s, &object, roots[i])) {
            tuv[0] = (float)roots[i];
            tuv[1] = tuv[2] = 0.0f;
            return true;
        }
    }
    return false;
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    (void)u, (void)v;
    const sphere *s = self;
    quadric_ray object = quadric_to_object(&s->q, r);
    double p[3], length2 = 0.0;
    for (int i = 0; i < 3; i++) {
        p[i] = object.o[i] + (double)hit->t * object.d[i];
        length2 += p[i] * p[i];
    }
    double onto = s->radius / sqrt(length2);
    for (int i = 0; i < 3; i++)
        p[i] *= onto;
    quadric_point at = at_angles(s, p, quadric_phi(p) / s->q.phi_max);
    double dpdu[3] = {-s->q.phi_max * p[1], s->q.phi_max * p[0], 0.0};
    double rho = hypot(p[0], p[1]), along = s->theta_max - s->theta_min;
    double slope = rho > 0.0 ? along * p[2] / rho : 0.0;
    const double dpdv[3] = {slope * p[0], slope * p[1], -along * rho};
    quadric_fill_hit(&s->q, &at, dpdu, dpdv, hit);
}

/* The cone in which ref sees the sphere; false if ref is inside or too near to tell, or
 * the sphere is no sphere in the world. */
static bool visible_cone(const sphere *s, vec3 ref, double axis[3], double *sin2_max)
{
    if (!s->is_whole || !s->q.is_similar)
        return false;
    double distance2 = 0.0;
    for (int i = 0; i < 3; i++) {
        axis[i] = s->center[i] - (double)ref[i];
        distance2 += axis[i] * axis[i];
    }
    *sin2_max = s->world_radius * s->world_radius / distance2;
    for (int i = 0; i < 3; i++)
        axis[i] /= sqrt(distance2);
    return *sin2_max < 1.0 - 1e-5;
}

static bool sample_toward(const void *self, vec3 ref, float u_primitive, vec2 u,
                          shape_sample *out)
{
    const sphere *s = self;
    double axis[3], sin2_max;
    if (!visible_cone(s, ref, axis, &sin2_max)) {
        *out = quadric_sample_area(self, u_primitive, u);
        vec3 d = out->p - ref;
        float distance2 = length3_2(d);
        out->pdf *= distance2 * sqrtf(distance2) / fabsf(dot3(out->n, d));
        return isfinite(out->pdf) && out->pdf > 0.0f;
    }
    double x = (double)u.x * one_minus_cos_of_sine2(sin2_max), sin2 = x * (2.0 - x);
    double cos_alpha =
        sin2 / sqrt(sin2_max) + (1.0 - x) * sqrt(MAX(1.0 - sin2 / sin2_max, 0.0));
    float sin_alpha = (float)sqrt(MAX(1.0 - cos_alpha * cos_alpha, 0.0));
    float phi = 2.0f * PI_F * u.y;
    frame f =
        frame_from_normal(vec3_make((float)axis[0], (float)axis[1], (float)axis[2]));
    vec3 n = f.s * (sin_alpha * cosf(phi)) + f.t * (sin_alpha * sinf(phi)) -
             f.n * (float)cos_alpha;
    *out = (shape_sample){
        .n = s->q.flip ? -n : n,
        .pdf = (float)(1.0 / (2.0 * G_PI * one_minus_cos_of_sine2(sin2_max)))};
    for (int i = 0; i < 3; i++)
        out->p[i] = (float)(s->center[i] + s->world_radius * (double)n[i]);
    return isfinite(out->pdf);
}

static float pdf_toward(const void *self, vec3 ref, const surface_hit *hit)
{
    const sphere *s = self;
    double axis[3], sin2_max;
    if (visible_cone(s, ref, axis, &sin2_max))
        return (float)(1.0 / (2.0 * G_PI * one_minus_cos_of_sine2(sin2_max)));
    vec3 d = hit->p - ref;
    float distance2 = length3_2(d);
    float pdf = distance2 * sqrtf(distance2) / (fabsf(dot3(hit->n_geom, d)) * s->q.area);
    return isfinite(pdf) ? pdf : 0.0f;
}

const shape_kind shape_sphere = {
    .name = "sphere",
    .parameters = "radius zmin zmax phimax",
    .create = create,
    .free = g_free,
    .bounds = bounds,
    .intersect = intersect,
    .fill_hit = fill_hit,
    .area = quadric_area,
    .sample_area = quadric_sample_area,
    .sample_toward = sample_toward,
    .pdf_toward = pdf_toward,
};
