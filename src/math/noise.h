/*
 * Perlin's noise (Perlin, "Improving Noise", 2002) with pbrt-v4's choice of gradients,
 * and sums of it at ever smaller scales.
 */
#pragma once

#include "math/vec.h"

/** @brief A smooth random function of space in about -1..1, zero at whole points. */
float noise3(vec3 p);
/** @brief Fractional Brownian motion: octaves of noise, each 1.99 times as fine and omega
 * times as strong as the one before. */
float noise_fbm(vec3 p, float omega, int octaves);
/** @brief The same of |noise|, which has creases. */
float noise_turbulence(vec3 p, float omega, int octaves);
