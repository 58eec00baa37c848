#include "color/balance.h"

#include "color/curve.h"
#include "color/observer.h"

/* XYZ to the Bradford cone responses. */
static const double cones[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                0.0367, 0.0389, -0.0685, 1.0296};

/* The chromaticity of CIE daylight. */
static void daylight_white(double kelvin, double xy[2])
{
    double t = 1e3 / kelvin;
    double x = kelvin <= 7000.0 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    xy[0] = x;
    xy[1] = (-3.0 * x + 2.870) * x - 0.275;
}

/* The chromaticity of a black body. */
static void blackbody_white(double kelvin, double xy[2])
{
    const observer *o = observer_get();
    g_autoptr(curve) glow = curve_blackbody((float)kelvin);
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < GRID_N; k++)
        for (int i = 0; i < 3; i++)
            xyz[i] += (double)(o->xyz[i][k] * curve_at(glow, (float)(GRID_FIRST + k)));
    for (int i = 0; i < 2; i++)
        xy[i] = xyz[i] / (xyz[0] + xyz[1] + xyz[2]);
}

static void respond(const double xy[2], double out[3])
{
    const double xyz[3] = {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
    for (int i = 0; i < 3; i++)
        out[i] =
            cones[3 * i] * xyz[0] + cones[3 * i + 1] * xyz[1] + cones[3 * i + 2] * xyz[2];
}

/* The inverse of the cone matrix, by cofactors. */
static void invert(double out[9])
{
    double determinant = 0.0;
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        for (int k = 0; k < 3; k++) {
            int c = (k + 1) % 3, d = (k + 2) % 3;
            out[3 * k + i] =
                cones[3 * a + c] * cones[3 * b + d] - cones[3 * a + d] * cones[3 * b + c];
        }
        determinant += cones[i] * out[3 * i];
    }
    for (int i = 0; i < 9; i++)
        out[i] /= determinant;
}

void color_balance(float kelvin, const color_space *space, double matrix[9])
{
    float chromaticities[8];
    double from[2], source[3], target[3], back[9];
    color_space_chromaticities(space, chromaticities);
    const double white[2] = {(double)chromaticities[6], (double)chromaticities[7]};
    if (kelvin < DAYLIGHT_COLDEST)
        blackbody_white((double)kelvin, from);
    else
        daylight_white((double)kelvin, from);
    respond(from, source);
    respond(white, target);
    invert(back);
    for (int i = 0; i < 9; i++) {
        matrix[i] = 0.0;
        for (int k = 0; k < 3; k++)
            matrix[i] +=
                back[i / 3 * 3 + k] * target[k] / source[k] * cones[3 * k + i % 3];
    }
}
