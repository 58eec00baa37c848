/*
 * From sums on the film to means: of surfaces; and of colours: white balance, then the
 * film's colour space.
 */
#include "render/film/film.h"

#include <math.h>

double film_surface_weight(const film *f, const film_sum *sum)
{
    bool enough = sum->surface_weight > (double)f->least * sum->weight;
    double weight = enough ? sum->surface_weight : sum->weight;
    return fabs(weight) > 0.0 ? weight : 1.0;
}

void film_to_rgb(const film *f, const double sum[3], double weight, float out[3])
{
    float xyz[3];
    out[0] = out[1] = out[2] = 0.0f;
    bool is_black = sum[0] == 0.0 && sum[1] == 0.0 && sum[2] == 0.0;
    if (is_black || !(fabs(weight) > 0.0)) /* as most layers are in most pixels */
        return;
    for (int i = 0; i < 3; i++) {
        const double *m = f->balance + 3 * i;
        double balanced = m[0] * sum[0] + m[1] * sum[1] + m[2] * sum[2];
        xyz[i] = (float)((f->balanced ? balanced : sum[i]) / weight);
    }
    color_space_from_xyz(f->space, xyz, out);
}
