/*
 * Spectra as eight wavelengths, one per wavelength of the pass: reflectance products,
 * metals and lights are then right, not RGB guesses.
 */
#pragma once

#include <math.h>
#include <stdbool.h>

enum { N_WAVELENGTHS = 8 };

/** @brief A quantity at the eight wavelengths of the pass. 32 bytes, 32-aligned. */
typedef float spectrum __attribute__((vector_size(32)));

static inline spectrum spectrum_fill(float x)
{
    return (spectrum){x, x, x, x, x, x, x, x};
}

static inline float spectrum_sum(spectrum s)
{
    return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

static inline float spectrum_mean(spectrum s)
{
    return spectrum_sum(s) * (1.0f / N_WAVELENGTHS);
}

static inline float spectrum_max(spectrum s)
{
    float m = s[0];
    for (int i = 1; i < N_WAVELENGTHS; i++)
        m = s[i] > m ? s[i] : m;
    return m;
}

static inline bool spectrum_is_black(spectrum s)
{
    return !(spectrum_max(s) > 0.0f);
}

static inline bool spectrum_is_finite(spectrum s)
{
    return isfinite(spectrum_sum(s * 0.0f));
}

static inline spectrum spectrum_clamp(spectrum s, float low, float high)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        s[i] = s[i] < low ? low : s[i] > high ? high : s[i];
    return s;
}

static inline spectrum spectrum_sqrt(spectrum s)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        s[i] = sqrtf(s[i]);
    return s;
}

static inline spectrum spectrum_exp(spectrum s)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        s[i] = expf(s[i]);
    return s;
}

/** @brief Only the given wavelength of s, the others zero. */
static inline spectrum spectrum_wavelength(spectrum s, int wavelength)
{
    spectrum out = {0};
    out[wavelength] = s[wavelength];
    return out;
}
