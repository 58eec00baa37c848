/*
 * How strong a light is over all wavelengths, and where its spectrum has lines.
 *
 * Eight wavelengths tell enough of daylight or a filament. A laser, sodium or mercury
 * shines at a few nanometres only, which most passes would miss: to the few that do not,
 * the light would be dozens of times too bright. So lights are measured at every quarter
 * of a nanometre, and where one sends much more than on average, more wavelengths are
 * drawn.
 */
#pragma once

#include "light/light.h"

/** @brief What the lines of all lights add up to. */
typedef struct light_lines {
    double excess[WAVELENGTH_CELLS]; /**< over a smooth spectrum, of lights of mean 1 */
    int n;                           /**< lights that have lines */
} light_lines;

/** @brief A light's strength, as means over wavelengths. */
typedef struct light_strength {
    float power; /**< W per nm */
    light_bound bound;
} light_strength;

/** @brief Measures a light that has been told the scene. @param lines the light's are
 * added; NULL: nobody asks */
light_strength light_measure(const light *l, light_lines *lines);

/** @brief How densely wavelengths are to be drawn. @return NULL: evenly, no light has
 * lines; freed by g_free */
wavelength_density *light_lines_density(const light_lines *lines);
