/*
 * The disk at height h above the xy plane, with an optional hole and cut by an angle. Its
 * normal is +z in object space before orientation.
 */
#include "shape/shape_kinds.h"
#include "shape/shape_quadric.h"

#include "math/warp.h"

#include <glib.h>

typedef struct disk {
    quadric q;
    double height, radius, inner;
} disk;

static quadric_point at_xy(const disk *d, double x, double y)
{
    quadric_point at = {.p = {x, y, d->height}, .n = {0.0, 0.0, 1.0}};
    double r = sqrt(x * x + y * y);
    at.uv = (vec2){(float)(quadric_phi(at.p) / d->q.phi_max),
                   (float)((d->radius - r) / (d->radius - d->inner))};
    return at;
}

static quadric_point map_disk(const void *self, vec2 u)
{
    const disk *d = self;
    bool is_whole = !(d->inner > 0.0) && d->q.phi_max >= 2.0 * G_PI * (1.0 - 1e-9);
    if (is_whole) {
        vec2 unit = warp_disk(u);
        return at_xy(d, d->radius * (double)unit.x, d->radius * (double)unit.y);
    }
    double inner2 = d->inner * d->inner, outer2 = d->radius * d->radius;
    double r = sqrt(inner2 + (double)u.x * (outer2 - inner2));
    double phi = (double)u.y * d->q.phi_max;
    return at_xy(d, r * cos(phi), r * sin(phi));
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    quadric q;
    float height = 0.0f, radius = 1.0f, inner = 0.0f;
    if (!quadric_init(&q, p, at, error) || !params_float(p, "height", &height, error) ||
        !params_float(p, "radius", &radius, error) ||
        !params_float(p, "innerradius", &inner, error))
        return NULL;
    if (!(radius > 0.0f) || !(inner >= 0.0f && inner < radius)) {
        error_at(error, p->place,
                 "the disk needs 0 <= innerradius < radius, found radius %g and "
                 "innerradius %g",
                 (double)radius, (double)inner);
        return NULL;
    }
    disk *d = g_new(disk, 1);
    *d = (disk){q, (double)height, (double)radius, (double)inner};
    double area = 0.5 * q.phi_max * (d->radius - d->inner) * (d->radius + d->inner);
    if (quadric_set_area(&d->q, map_disk, area, p, error))
        return d;
    g_free(d);
    return NULL;
}

static box3 bounds(const void *self)
{
    const disk *d = self;
    return quadric_bounds(&d->q, (const double[3]){-d->radius, -d->radius, d->height},
                          (const double[3]){d->radius, d->radius, d->height});
}

static bool intersect(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3])
{
    (void)primitive;
    const disk *d = self;
    quadric_ray object = quadric_to_object(&d->q, r);
    double where = (d->height - object.o[2]) / object.d[2];
    if (!(where > (double)t_min && where < (double)r->t_max))
        return false;
    double p[3] = {object.o[0] + where * object.d[0], object.o[1] + where * object.d[1]};
    double distance2 = p[0] * p[0] + p[1] * p[1];
    if (distance2 > d->radius * d->radius || distance2 < d->inner * d->inner ||
        !quadric_in_turn(&d->q, p))
        return false;
    tuv[0] = (float)where;
    tuv[1] = tuv[2] = 0.0f;
    return true;
}

static void fill_hit(const void *self, const ray *r, float u, float v, surface_hit *hit)
{
    (void)u, (void)v;
    const disk *d = self;
    quadric_ray object = quadric_to_object(&d->q, r);
    double t = (double)hit->t;
    quadric_point at =
        at_xy(d, object.o[0] + t * object.d[0], object.o[1] + t * object.d[1]);
    double dpdu[3] = {-d->q.phi_max * at.p[1], d->q.phi_max * at.p[0], 0.0};
    double rho = sqrt(at.p[0] * at.p[0] + at.p[1] * at.p[1]),
           slope = rho > 0.0 ? (d->inner - d->radius) / rho : 0.0;
    const double dpdv[3] = {slope * at.p[0], slope * at.p[1], 0.0};
    quadric_fill_hit(&d->q, &at, dpdu, dpdv, hit);
}

const shape_kind shape_disk = {
    .name = "disk",
    .parameters = "height radius innerradius phimax",
    .create = create,
    .free = g_free,
    .bounds = bounds,
    .intersect = intersect,
    .fill_hit = fill_hit,
    .area = quadric_area,
    .sample_area = quadric_sample_area,
};
