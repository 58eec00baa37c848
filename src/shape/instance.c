#include "shape/instance.h"

/* The share of its coordinates that rounding may move a point by; as in offset_point. */
#define ROUNDING 4e-6f

ray instance_ray(const transform *to_world, const ray *r)
{
    transform to_object = transform_inverse(to_world);
    ray out = *r;
    out.origin = transform_point(&to_object, r->origin);
    out.direction = transform_vector(&to_object, r->direction);
    return out;
}

float instance_largest_scale(const transform *t)
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            sum += t->m[i][k] * t->m[i][k];
    }
    return (float)sqrt(sum);
}

void instance_place_hit(const transform *to_world, surface_hit *hit)
{
    float coordinates = max_component3(abs3(hit->p));
    hit->error =
        maxf(hit->error, ROUNDING * coordinates) * instance_largest_scale(to_world);
    hit->p = transform_point(to_world, hit->p);
    hit->n_geom = normalize3(transform_normal(to_world, hit->n_geom));
    hit->n = face_forward(normalize3(transform_normal(to_world, hit->n)), hit->n_geom);
    hit->dpdu = transform_vector(to_world, hit->dpdu);
    hit->dpdv = transform_vector(to_world, hit->dpdv);
}

void instance_move_hit(const transform *by, surface_hit *hit)
{
    hit->p = transform_point(by, hit->p);
    hit->n_geom = normalize3(transform_normal(by, hit->n_geom));
    hit->n = face_forward(normalize3(transform_normal(by, hit->n)), hit->n_geom);
    hit->dpdu = transform_vector(by, hit->dpdu);
    hit->dpdv = transform_vector(by, hit->dpdv);
}

static double determinant(const transform *to_world)
{
    const double(*m)[4] = to_world->m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

double instance_area_factor(const transform *to_world, vec3 n)
{
    transform to_object = transform_inverse(to_world);
    return fabs(determinant(to_world)) / (double)length3(transform_normal(&to_object, n));
}

double instance_mean_area_factor(const transform *to_world)
{
    double side = cbrt(fabs(determinant(to_world)));
    return side * side;
}
