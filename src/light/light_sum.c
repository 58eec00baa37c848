/*
 * Sums of many emitters of RGB colours, as one spectrum: smooth spectra of colours are
 * not linear in them, so the sum is taken wavelength by wavelength.
 */
#include "light/light_kinds.h"

static float wavelength_of(int i)
{
    return LAMBDA_MIN + (LAMBDA_MAX - LAMBDA_MIN) * (float)i / (EMISSION_SUM_N - 1);
}

void emission_sum_add(emission_sum *sum, const color_space *space, const float rgb[3],
                      double weight)
{
    for (int i = 0; i < EMISSION_SUM_N; i += N_WAVELENGTHS) {
        wavelengths w;
        for (int k = 0; k < N_WAVELENGTHS; k++)
            w.lambda[k] = wavelength_of(i + k);
        spectrum value = rgb_eval(space, rgb, CURVE_EMISSION, &w);
        for (int k = 0; k < N_WAVELENGTHS; k++)
            sum->values[i + k] += weight * (double)value[k];
    }
}

curve *emission_sum_curve(const emission_sum *sum, float scale)
{
    float nm[EMISSION_SUM_N], values[EMISSION_SUM_N];
    for (int i = 0; i < EMISSION_SUM_N; i++) {
        nm[i] = wavelength_of(i);
        values[i] = scale * (float)sum->values[i];
    }
    return curve_tabulated(nm, values, EMISSION_SUM_N, NULL);
}
