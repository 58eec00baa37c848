#include "photon/flat_curve.h"

/* Sums pieces of a curve around a place. */
typedef struct piece_sum {
    vec3 p;
    float r2;
    const kernel *kappa;
    double area;
} piece_sum;

static void add_piece(vec3 middle, float area, void *data)
{
    piece_sum *sum = data;
    float distance2 = length3_2(middle - sum->p);
    if (distance2 < sum->r2)
        sum->area += (double)area * (double)kernel_eval(sum->kappa, distance2, sum->r2);
}

float flat_curve_area(const flat_curve *flat, vec3 p, float radius, const kernel *kappa)
{
    piece_sum sum = {p, radius * radius, kappa, 0.0};
    scene_pieces_near(flat->scene, flat->hit, p, radius, add_piece, &sum);
    return (float)sum.area;
}
