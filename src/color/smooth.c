/*
 * Smooth curves of texels and the sigmoid at eight wavelengths.
 */
#include "color/fit.h"

void smooth_from_rgb(const color_space *space, const float rgb[3], float coefficients[3])
{
    smooth_solve(space, rgb, coefficients);
}

spectrum smooth_eval(const float coefficients[3], const wavelengths *w)
{
    spectrum t = (w->lambda - SMOOTH_CENTER) * (1.0f / SMOOTH_HALF);
    spectrum p = (coefficients[0] * t + coefficients[1]) * t + coefficients[2];
    return 0.5f + 0.5f * p / spectrum_sqrt(1.0f + p * p);
}
