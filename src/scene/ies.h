/*
 * IES photometric files: the luminous intensity of a real luminaire by direction, as
 * laboratories publish it.
 *
 * IESNA LM-63-1986, -1995 and -2002, photometry of type C: γ = 0 is straight down, 180
 * up; C = 0 and C = 90 are the horizontal axes. Angles in the file are degrees, values
 * candela once multiplied by the file's factors.
 */
#pragma once

#include "base/error.h"

typedef struct ies_profile {
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
