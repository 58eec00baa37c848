/*
 * Gauss-Newton with Marquardt's damping for the three coefficients of the smooth curve
 *
 *   R(t) = 1/2 + p / (2 sqrt(1 + p²)),   p = c0 t² + c1 t + c2,   t in [-1, 1].
 *
 * W. Jakob, J. Hanika, "A Low-Dimensional Function Space for Efficient Spectral
 * Upsampling", 2019. The errors are RGB under the space's illuminant, integrated as the
 * renderer integrates; they are linear in R, so the derivatives come with the values.
 */
#include "color/fit.h"

#include <math.h>
#include <string.h>

enum { MAX_STEPS = 200 };
#define MAX_COEFFICIENT 1e4 /* beyond, curves are steps that eight wavelengths miss */

/* The state at one set of coefficients: J^T J, J^T r, and the sum of squared errors. */
typedef struct normal_equations {
    double a[3][3], b[3];
    double error2, largest;
} normal_equations;

static normal_equations evaluate(const color_space *space, const double rgb[3],
                                 const double c[3])
{
    double value[3] = {0}, slope[3][3] = {{0}};
    for (int i = 0; i < FIT_N; i++) {
        double t = 2.0 * i / (FIT_N - 1) - 1.0;
        double p = (c[0] * t + c[1]) * t + c[2];
        double s = 1.0 / sqrt(1.0 + p * p);
        double r = 0.5 + 0.5 * p * s, d = 0.5 * s * s * s;
        for (int k = 0; k < 3; k++) {
            double w = space->fit[k][i];
            value[k] += w * r;
            slope[k][0] += w * d * t * t;
            slope[k][1] += w * d * t;
            slope[k][2] += w * d;
        }
    }
    normal_equations n = {0};
    for (int k = 0; k < 3; k++) {
        double miss = rgb[k] - value[k];
        n.error2 += miss * miss;
        n.largest = fmax(n.largest, fabs(miss));
        for (int i = 0; i < 3; i++) {
            n.b[i] += slope[k][i] * miss;
            for (int j = 0; j < 3; j++)
                n.a[i][j] += slope[k][i] * slope[k][j];
        }
    }
    return n;
}

/* Solves (A + damping diag(A)) x = b by Cramer's rule. */
static bool damped_step(const normal_equations *n, double damping, double x[3])
{
    double m[3][3];
    memcpy(m, n->a, sizeof m);
    for (int i = 0; i < 3; i++)
        m[i][i] *= 1.0 + damping;
    double minor[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
            minor[i][j] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
        }
    double determinant =
        m[0][0] * minor[0][0] + m[0][1] * minor[0][1] + m[0][2] * minor[0][2];
    for (int j = 0; j < 3; j++)
        x[j] = (n->b[0] * minor[0][j] + n->b[1] * minor[1][j] + n->b[2] * minor[2][j]) /
               determinant;
    return isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
}

double smooth_fit(const color_space *space, const double rgb[3], double c[3])
{
    double goal = 1e-7 * fmax(1e-3, fmax(rgb[0], fmax(rgb[1], rgb[2])));
    double damping = 1e-3;
    normal_equations now = evaluate(space, rgb, c);
    for (int step = 0; step < MAX_STEPS && now.largest > goal && damping < 1e12; step++) {
        double delta[3], trial[3];
        if (!damped_step(&now, damping, delta)) {
            damping *= 10.0;
            continue;
        }
        for (int i = 0; i < 3; i++)
            trial[i] = fmin(fmax(c[i] + delta[i], -MAX_COEFFICIENT), MAX_COEFFICIENT);
        normal_equations then = evaluate(space, rgb, trial);
        if (then.error2 < now.error2) {
            now = then;
            memcpy(c, trial, sizeof trial);
            damping *= 0.1;
        } else {
            damping *= 4.0;
        }
    }
    return now.largest;
}

double smooth_inverse(double x)
{
    return (x - 0.5) / sqrt(fmax(x * (1.0 - x), 1e-15));
}

bool smooth_is_grey(const float rgb[3])
{
    float low = fminf(rgb[0], fminf(rgb[1], rgb[2]));
    float high = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    return high - low <= 1e-6f * high;
}

void smooth_solve(const color_space *space, const float rgb[3], float coefficients[3])
{
    double target[3], c[3] = {0};
    for (int i = 0; i < 3; i++)
        target[i] = rgb[i] > 0.0f ? fmin((double)rgb[i], 1.0) : 0.0;
    c[2] = smooth_inverse((target[0] + target[1] + target[2]) / 3.0);
    if (!smooth_is_grey(rgb))
        smooth_fit(space, target, c);
    for (int i = 0; i < 3; i++)
        coefficients[i] = (float)c[i];
}
