/*
 * Participating media that were measured.
 */
#pragma once

#include <stddef.h>

/** @brief Coefficients for red, green and blue of sRGB, mm⁻¹. */
typedef struct medium_preset {
    const char *name;
    float scattering[3]; /**< reduced: for g = 0 */
    float absorption[3];
} medium_preset;

/** @brief Number i; NULL behind the last. */
const medium_preset *medium_preset_at(size_t i);
/** @brief By name, as pbrt spells it; NULL if there is none. */
const medium_preset *medium_preset_find(const char *name);
