/*
 * RGB triples to spectra at a pass' wavelengths, as curve_rgb means them but without
 * making a curve: for texels, which are met by the million.
 */
#include "color/curve.h"
#include "color/space.h"

spectrum rgb_eval(const color_space *space, const float rgb[3], curve_role role,
                  const wavelengths *w)
{
    /* An albedo fills the unit cube; other quantities are halved into its middle. */
    float top = rgb[0] > rgb[1] ? rgb[0] : rgb[1], unit[3], coefficients[3];
    top = rgb[2] > top ? rgb[2] : top;
    float scale = role == CURVE_ALBEDO ? 1.0f : 2.0f * top;
    if (!(top > 0.0f))
        return (spectrum){0};
    for (int i = 0; i < 3; i++) {
        float share = rgb[i] / scale;
        unit[i] = share > 1.0f ? 1.0f : share > 0.0f ? share : 0.0f;
    }
    smooth_from_rgb(space, unit, coefficients);
    spectrum s = smooth_eval(coefficients, w) * scale;
    return role == CURVE_EMISSION ? s * grid_eval(space->illuminant, w->lambda) : s;
}
