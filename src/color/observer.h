/*
 * The CIE 1931 standard observer and the illuminants that define the colour spaces.
 */
#pragma once

#include "color/grid.h"

/** @brief What the eye makes of a wavelength; made once, immutable. */
typedef struct observer {
    /** x-bar, y-bar, z-bar over 360..830 nm. */
    float xyz[3][GRID_N];
    /** The same on 380..720 nm, zero beyond, each scaled so that the integral over the
     *  range of D65 of photometric integral 1 is D65's white point with Y = 1. */
    float folded[3][GRID_N];
    /** D65, with the photometric integral of equal energy, as pbrt normalises it. */
    float d65[GRID_N];
    /** Daylight with exactly the chromaticity of ACES' white, normalised likewise. */
    float d60[GRID_N];
} observer;

/** @brief The observer. Thread-safe. */
const observer *observer_get(void);

/** @brief xy of the white points that RGB spaces define. */
extern const double white_d65[2], white_d60[2];

/** @brief CIE daylight of a correlated colour temperature of 4000..25000 K. */
void observer_daylight(double kelvin, float grid[GRID_N]);

/** @brief Scales an illuminant to the photometric integral of equal energy. */
void observer_normalize(const observer *o, float grid[GRID_N]);
