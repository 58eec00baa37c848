/*
 * Curves from formulas: Planck's law and the refractive index of glasses.
 */
#include "color/curve_make.h"

#include <math.h>

/* Wien's displacement law and Planck's second constant (CODATA 2018), m K. */
#define WIEN_B 2.897771955e-3
#define PLANCK_C2 1.438776877e-2

/* Spectral radiance relative to that at the peak. */
static double planck(double nm, const void *data)
{
    double kelvin = *(const double *)data;
    double at_peak = PLANCK_C2 / WIEN_B, here = PLANCK_C2 / (nm * 1e-9 * kelvin);
    double ratio = WIEN_B / (nm * 1e-9 * kelvin);
    double power = pow(ratio, 5.0);
    return power * expm1(at_peak) / expm1(here);
}

curve *curve_blackbody(float kelvin)
{
    double temperature = (double)kelvin;
    if (!(kelvin > 0.0f) || !isfinite(kelvin))
        return NULL;
    return curve_from_function(planck, &temperature);
}

typedef struct sellmeier_terms {
    const double *b, *c;
    int n;
} sellmeier_terms;

static double sellmeier(double nm, const void *data)
{
    const sellmeier_terms *terms = data;
    double square = nm * nm * 1e-6, n2 = 1.0;
    for (int i = 0; i < terms->n; i++)
        n2 += terms->b[i] * square / (square - terms->c[i]);
    return sqrt(n2);
}

curve *curve_sellmeier_terms(const double *b, const double *c, int n_terms)
{
    const sellmeier_terms terms = {b, c, n_terms};
    return curve_from_function(sellmeier, &terms);
}
