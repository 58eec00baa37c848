/*
 * White balance: what is white under daylight of some colour temperature becomes the
 * white of a colour space.
 */
#pragma once

#include "color/space.h"

/** Temperatures, K, that daylight is defined for, and of the coldest white: below
 * daylight it is that of a black body, as pbrt-v4 has it. */
#define DAYLIGHT_COLDEST 4000.0f
#define DAYLIGHT_HOTTEST 25000.0f
#define WHITE_COLDEST 1000.0f

/** @brief The matrix, row by row, that takes XYZ seen in CIE daylight of kelvin to XYZ
 * seen in the space's white (CIE 15; von Kries in the Bradford cone space: Lam 1985). */
void color_balance(float kelvin, const color_space *space, double matrix[9]);
