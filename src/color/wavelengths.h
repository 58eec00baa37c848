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
     *  multiplied by LAMBDA_MAX - LAMBDA_MIN, so that XYZ = mean over lanes of xyz[i] *
     * L. A surface that sends D65 with photometric integral 1 has Y = 1 on average over
     * passes. */
    spectrum xyz[3];
} wavelengths;

/** @brief The wavelengths of a pass; seed shifts the whole sequence. */
wavelengths wavelengths_for_pass(uint64_t seed, uint32_t pass);

/** @brief The wavelengths for an offset in [0, 1) of a stratum. */
wavelengths wavelengths_at(float offset);

/** @brief XYZ of spectral radiance L (mean over lanes of xyz * L). */
void spectrum_to_xyz(const wavelengths *w, spectrum radiance, float xyz[3]);
