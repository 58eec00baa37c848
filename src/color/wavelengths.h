/*
 * The wavelengths of a pass: eight, one in each eighth of [LAMBDA_MIN, LAMBDA_MAX], all
 * shifted by the same offset, which walks a low-discrepancy sequence from pass to pass.
 * Photons and camera paths of a pass share them. With offsets uniform in [0,1) the mean
 * over passes of (LAMBDA_MAX - LAMBDA_MIN) * spectrum_mean(f(lambda)) is the integral of
 * f over the range.
 */
#pragma once

#include "color/spectrum.h"

#include <stdint.h>

#define LAMBDA_MIN 380.0f /* nm */
#define LAMBDA_MAX 720.0f /* nm */

/** @brief The eight wavelengths, nm, ascending, and the observer's response to each. */
typedef struct wavelengths {
    spectrum lambda;
    /** Matching functions folded to the range (tails beyond it are kept in the scale) and
     *  multiplied by LAMBDA_MAX - LAMBDA_MIN: XYZ is the mean over wavelengths of xyz[i]
     * L. A surface that sends D65 with photometric integral 1 has Y = 1 on average over
     * passes. */
    spectrum xyz[3];
} wavelengths;

/** @brief Where the wavelengths of a pass lie in their strata, in [0, 1); seed shifts the
 * whole sequence. */
float wavelength_offset(uint64_t seed, uint32_t pass);
/** @brief The wavelengths of a pass. */
wavelengths wavelengths_for_pass(uint64_t seed, uint32_t pass);

/** @brief The wavelengths for an offset in [0, 1) of a stratum. */
wavelengths wavelengths_at(float offset);

enum {
    WAVELENGTH_CELLS = 1360, /**< of LAMBDA_MIN to LAMBDA_MAX: a quarter of a nm each */
    CELLS_PER_STRATUM = WAVELENGTH_CELLS / N_WAVELENGTHS,
};

/** @brief How densely wavelengths are drawn where they are not drawn evenly: constant
 * within each cell. */
typedef struct wavelength_density {
    float cumulative[WAVELENGTH_CELLS + 1]; /**< up to each cell; 0 first, 1 last */
} wavelength_density;

/** @brief A density in proportion to weights, which are positive. */
wavelength_density wavelength_density_of(const double weights[WAVELENGTH_CELLS]);

/** @brief Eight wavelengths drawn by a density, one from each eighth of it, with the
 * observer divided by the density: so means over passes of what is seen stay the same.
 * @param d NULL: evenly, as wavelengths_at */
wavelengths wavelengths_drawn(const wavelength_density *d, float offset);

/** @brief XYZ of spectral radiance L (mean over wavelengths of xyz * L). */
void spectrum_to_xyz(const wavelengths *w, spectrum radiance, float xyz[3]);
