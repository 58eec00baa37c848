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

enum { MAX_STEPS = 100 };
#define SETTLED 1e-6 /* relative gain of a step that is not worth another */

typedef double lanes __attribute__((vector_size(32)));

/* The state at one set of coefficients: the normal equations, and what is minimised. */
typedef struct normal_equations {
    double a[3][3], b[3];
    double objective, largest;
} normal_equations;

static double sum_lanes(lanes v)
{
    return (v[0] + v[1]) + (v[2] + v[3]);
}

/* RGB of the curve, and its derivatives by the coefficients. */
static void integrate(const color_space *space, const double c[3], double value[3],
                      double slope[3][3])
{
    lanes v[3] = {{0}}, s[3][3] = {{{0}}};
    for (int i = 0; i < FIT_PADDED; i += 4) {
        lanes t = {i, i + 1, i + 2, i + 3};
        t = t * (2.0 / (FIT_N - 1)) - 1.0;
        lanes p = (c[0] * t + c[1]) * t + c[2], root = 1.0 + p * p;
        for (int k = 0; k < 4; k++)
            root[k] = sqrt(root[k]);
        lanes r = 0.5 + 0.5 * p / root, d = 0.5 / (root * root * root);
        for (int k = 0; k < 3; k++) {
            lanes w;
            memcpy(&w, &space->fit[k][i], sizeof w);
            v[k] += w * r;
            s[k][2] += w *= d;
            s[k][1] += w *= t;
            s[k][0] += w *= t;
        }
    }
    for (int k = 0; k < 3; k++) {
        value[k] = sum_lanes(v[k]);
        for (int j = 0; j < 3; j++)
            slope[k][j] = sum_lanes(s[k][j]);
    }
}

static normal_equations evaluate(const color_space *space, const double rgb[3],
                                 const double c[3], double stiffness)
{
    normal_equations n = {0};
    double value[3], slope[3][3];
    integrate(space, c, value, slope);
    for (int k = 0; k < 3; k++) {
        double miss = rgb[k] - value[k];
        n.objective += miss * miss;
        n.largest = fmax(n.largest, fabs(miss));
        for (int i = 0; i < 3; i++) {
            n.b[i] += slope[k][i] * miss;
            for (int j = 0; j < 3; j++)
                n.a[i][j] += slope[k][i] * slope[k][j];
        }
    }
    for (int i = 0; i < 2; i++) {
        n.objective += stiffness * c[i] * c[i];
        n.b[i] -= stiffness * c[i];
        n.a[i][i] += stiffness;
    }
    return n;
}

/* Solves (A + damping diag(A)) x = b by Cramer's rule. */
static bool damped_step(const normal_equations *n, double damping, double x[3])
{
    double m[3][3], minor[3][3];
    memcpy(m, n->a, sizeof m);
    for (int i = 0; i < 3; i++)
        m[i][i] *= 1.0 + damping;
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

double smooth_fit(const color_space *space, const double rgb[3], double stiffness,
                  double c[3])
{
    const double brightness = fmax(1e-6, fmax(rgb[0], fmax(rgb[1], rgb[2])));
    const double weight = stiffness * brightness * brightness;
    double damping = 1e-3;
    normal_equations now = evaluate(space, rgb, c, weight);
    for (int step = 0; step < MAX_STEPS && damping < 1e9; step++) {
        double trial[3];
        bool finite = damped_step(&now, damping, trial);
        for (int i = 0; i < 3; i++)
            trial[i] += c[i];
        normal_equations then = evaluate(space, rgb, trial, weight);
        if (!finite || !(then.objective < now.objective)) {
            damping = fmax(damping, 1e-6) * 8.0;
            continue;
        }
        bool settled = then.largest < 1e-8 * brightness ||
                       then.objective > (1.0 - SETTLED) * now.objective;
        now = then;
        memcpy(c, trial, sizeof trial);
        damping *= 0.05;
        if (settled)
            break;
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
        smooth_fit(space, target, SMOOTH_STIFFNESS, c);
    for (int i = 0; i < 3; i++)
        coefficients[i] = (float)c[i];
}
