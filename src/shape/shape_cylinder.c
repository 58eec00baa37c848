/*
 * The cylinder around the z axis, open at both ends, cut by an angle. Its normal points
 * away from the axis before orientation.
 */
#include "shape/shape_kinds.h"
#include "shape/shape_quadric.h"

#include <glib.h>

typedef struct cylinder {
    quadric q;
    double radius, z_min, z_max;
} cylinder;

/* @param turn the angle of (x, y) over phi_max */
static quadric_point at_angle(const cylinder *c, double x, double y, double z,
                              double turn)
{
    quadric_point at = {.p = {x, y, z}, .n = {x / c->radius, y / c->radius, 0.0}};
    at.uv = (vec2){(float)turn, (float)((z - c->z_min) / (c->z_max - c->z_min))};
    return at;
}

static quadric_point map_cylinder(const void *self, vec2 u)
{
    const cylinder *c = self;
    double phi = (double)u.y * c->q.phi_max;
    return at_angle(c, c->radius * cos(phi), c->radius * sin(phi),
                    c->z_min + (double)u.x * (c->z_max - c->z_min), (double)u.y);
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    quadric q;
    float radius = 1.0f, z[2] = {-1.0f, 1.0f};
    if (!quadric_init(&q, p, at, error) || !params_float(p, "radius", &radius, error) ||
        !params_float(p, "zmin", &z[0], error) || !params_float(p, "zmax", &z[1], error))
        return NULL;
    if (!(radius > 0.0f)) {
        error_at(error, params_find(p, "radius")->place,
                 "the cylinder's radius must be positive, found %g", (double)radius);
        return NULL;
    }
    cylinder *c = g_new(cylinder, 1);
    *c =
        (cylinder){q, (double)radius, (double)minf(z[0], z[1]), (double)maxf(z[0], z[1])};
    double area = q.phi_max * c->radius * (c->z_max - c->z_min);
    if (quadric_set_area(&c->q, map_cylinder, area, p, error))
        return c;
    g_free(c);
    return NULL;
}

static box3 bounds(const void *self)
{
    const cylinder *c = self;
    return quadric_bounds(&c->q, (const double[3]){-c->radius, -c->radius, c->z_min},
                          (const double[3]){c->radius, c->radius, c->z_max});
}

static bool intersect(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3])
{
    (void)primitive;
    const cylinder *c = self;
    quadric_ray object = quadric_to_object(&c->q, r);
    double roots[2];
    if (!quadric_roots(&object, 2, c->radius, roots))
        return false;
    for (int i = 0; i < 2; i++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = object.o[k] + roots[i] * object.d[k];
        if (roots[i] > (double)t_min && roots[i] < (double)r->t_max && p[2] >= c->z_min &&
            p[2] <= c->z_max && quadric_in_turn(&c->q, p)) {
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
    const cylinder *c = self;
    quadric_ray object = quadric_to_object(&c->q, r);
    double p[3];
    for (int k = 0; k < 3; k++)
        p[k] = object.o[k] + (double)hit->t * object.d[k];
    double onto = c->radius / sqrt(p[0] * p[0] + p[1] * p[1]);
    quadric_point at =
        at_angle(c, p[0] * onto, p[1] * onto, p[2], quadric_phi(p) / c->q.phi_max);
    double dpdu[3] = {-c->q.phi_max * at.p[1], c->q.phi_max * at.p[0], 0.0};
    const double dpdv[3] = {0.0, 0.0, c->z_max - c->z_min};
    quadric_fill_hit(&c->q, &at, dpdu, dpdv, hit);
}

const shape_kind shape_cylinder = {
    .name = "cylinder",
    .parameters = "radius zmin zmax phimax",
    .create = create,
    .free = g_free,
    .bounds = bounds,
    .intersect = intersect,
    .fill_hit = fill_hit,
    .area = quadric_area,
    .sample_area = quadric_sample_area,
};
