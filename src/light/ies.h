/*
 * IES photometric files: the luminous intensity of a real luminaire by direction, as
 * laboratories publish it.
 *
 * IESNA LM-63-1986, -1995 and -2002. Directions are asked for as type C has them: γ = 0
 * is straight down, 180 up; C = 0 and C = 90 are the horizontal axes. Angles in the file
 * are degrees, values candela once multiplied by the file's factors. Horizontal angles h
 * and vertical ones v are, by type of photometry:
 *
 *   C  v = γ, h = C: planes through the vertical axis. Rooms and streets
 *   B  planes through the axis C = 90, turned by v from straight down toward C = 0; h is
 *      the angle out of the plane h = 0, away from C = 90. Floodlights
 *   A  v = γ - 90, h = -C: as C, seen from the horizontal axis C = 0. Headlights
 */
#pragma once

#include "base/error.h"

struct ies_photometry;

typedef struct ies_profile {
    const struct ies_photometry *type;
    int n_vertical, n_horizontal;
    float *vertical, *horizontal; /**< degrees, ascending; owned */
    float *candela;               /**< [horizontal * n_vertical + vertical]; owned */
} ies_profile;

/** @brief Reads a file's text. @return false with ERROR_INPUT that names what is wrong,
 * without a place. */
bool ies_read(ies_profile *out, const char *text, GError **error);
void ies_clear(ies_profile *ies);
/** @brief Candela in a direction, linear in both angles between those of the file; 0
 *  beyond the vertical ones. @param gamma,c degrees, 0..180 and any */
float ies_candela(const ies_profile *ies, float gamma, float c);
/** @brief ∫ candela dω, of that very function. */
double ies_lumens(const ies_profile *ies);
