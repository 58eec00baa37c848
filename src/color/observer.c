/*
 * The CIE 1931 standard observer on whole nanometres, and the folding of its tails.
 *
 * Lights carry wavelengths from LAMBDA_MIN to LAMBDA_MAX only; less than a thousandth of
 * what the eye sees lies beyond. Each matching function is scaled by so much (which
 * differs by function) that D65 keeps its white point exactly: greys stay grey.
 */
#include "color/observer.h"

#include "color/data/tables.h"
#include "color/wavelengths.h"

#include <pthread.h>

const double white_d65[2] = {0.3127, 0.3290};
const double white_d60[2] = {0.32168, 0.33767};

static observer the_observer;

/* Third-order Lagrange interpolation to 1 nm, as ASTM E2022 has it for the observer. */
static void interpolate_cubic(const float table[CIE_N], float grid[GRID_N])
{
    for (int i = 0; i < GRID_N; i++) {
        int cell = i / CIE_STEP;
        int k = cell < 1 ? 1 : cell > CIE_N - 3 ? CIE_N - 3 : cell;
        double t = (double)i / CIE_STEP - k;
        double p0 = (double)table[k - 1], p1 = (double)table[k];
        double p2 = (double)table[k + 1], p3 = (double)table[k + 2];
        double value = -t * (t - 1) * (t - 2) / 6 * p0 +
                       (t + 1) * (t - 1) * (t - 2) / 2 * p1 -
                       (t + 1) * t * (t - 2) / 2 * p2 + (t + 1) * t * (t - 1) / 6 * p3;
        grid[i] = value > 0 ? (float)value : 0.0f;
    }
}

static void daylight_from_weights(double m1, double m2, float grid[GRID_N])
{
    float basis[3][GRID_N];
    for (int k = 0; k < 3; k++)
        grid_from_table(cie_daylight[k], CIE_N, CIE_FIRST, CIE_STEP, basis[k]);
    for (int i = 0; i < GRID_N; i++)
        grid[i] = (float)((double)basis[0][i] + m1 * (double)basis[1][i] +
                          m2 * (double)basis[2][i]);
}

/* CIE 15:2004, 3.1. */
void observer_daylight(double kelvin, float grid[GRID_N])
{
    double t = 1000.0 / kelvin;
    double x = kelvin <= 7000.0 ? 0.244063 + t * (0.09911 + t * (2.9678 - t * 4.6070))
                                : 0.237040 + t * (0.24748 + t * (1.9018 - t * 2.0064));
    double y = -3.0 * x * x + 2.870 * x - 0.275;
    double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    daylight_from_weights((-1.3515 - 1.7703 * x + 5.9114 * y) / m,
                          (0.0300 - 31.4424 * x + 30.0717 * y) / m, grid);
}

/* Daylight whose chromaticity under the folded observer is exactly xy: the chromaticity
 * conditions are linear in the weights of the three components. */
static void daylight_with_white(const observer *o, const double xy[2], float grid[GRID_N])
{
    double a[2][3]; /* a[c][k]: by how much component k violates condition c */
    for (int k = 0; k < 3; k++) {
        float basis[GRID_N];
        double xyz[3], sum = 0.0;
        grid_from_table(cie_daylight[k], CIE_N, CIE_FIRST, CIE_STEP, basis);
        for (int i = 0; i < 3; i++)
            sum += xyz[i] =
                grid_integrate(o->folded[i], basis, (int)LAMBDA_MIN, (int)LAMBDA_MAX);
        for (int c = 0; c < 2; c++)
            a[c][k] = xyz[c] - xy[c] * sum;
    }
    double determinant = a[0][1] * a[1][2] - a[0][2] * a[1][1];
    daylight_from_weights((a[0][2] * a[1][0] - a[0][0] * a[1][2]) / determinant,
                          (a[0][0] * a[1][1] - a[0][1] * a[1][0]) / determinant, grid);
}

void observer_normalize(const observer *o, float grid[GRID_N])
{
    float equal[GRID_N];
    for (int i = 0; i < GRID_N; i++)
        equal[i] = 1.0f;
    double all = grid_integrate(o->xyz[1], equal, GRID_FIRST, GRID_LAST);
    double own = grid_integrate(o->xyz[1], grid, GRID_FIRST, GRID_LAST);
    grid_scale(grid, (float)(all / own));
}

static void fold(observer *o, int i, double white)
{
    const int first = (int)LAMBDA_MIN, last = (int)LAMBDA_MAX;
    for (int nm = first; nm <= last; nm++)
        o->folded[i][nm - GRID_FIRST] = o->xyz[i][nm - GRID_FIRST];
    double photometric = grid_integrate(o->xyz[1], o->d65, GRID_FIRST, GRID_LAST);
    double seen = grid_integrate(o->folded[i], o->d65, first, last);
    grid_scale(o->folded[i], (float)(white * photometric / seen));
}

static void make_observer(void)
{
    observer *o = &the_observer;
    for (int i = 0; i < 3; i++)
        interpolate_cubic(cie1931_observer[i], o->xyz[i]);
    grid_from_table(cie_d65, CIE_N, CIE_FIRST, CIE_STEP, o->d65);
    observer_normalize(o, o->d65);
    fold(o, 0, white_d65[0] / white_d65[1]);
    fold(o, 1, 1.0);
    fold(o, 2, (1.0 - white_d65[0] - white_d65[1]) / white_d65[1]);
    daylight_with_white(o, white_d60, o->d60);
    observer_normalize(o, o->d60);
}

const observer *observer_get(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_observer);
    return &the_observer;
}
