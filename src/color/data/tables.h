/*
 * Measured and standardised figures, apart from the code that reads them. Each table's
 * file names its source.
 */
#pragma once

enum {
    CIE_FIRST = 360,      /**< nm, first entry of the observer and the illuminants */
    CIE_STEP = 5,         /**< nm */
    CIE_N = 95,           /**< to 830 nm */
    CIE_LAMP_FIRST = 380, /**< nm, first entry of the fluorescent lamps */
    CIE_LAMP_N = 81,      /**< to 780 nm */
    CORNELL_FIRST = 400,  /**< nm, first entry of the Cornell box' paints */
    CORNELL_STEP = 4,     /**< nm */
    CORNELL_N = 76,       /**< to 700 nm */
};

extern const float cie1931_observer[3][CIE_N];
extern const float cie_d65[CIE_N];
extern const float cie_daylight[3][CIE_N];          /**< S0, S1, S2 */
extern const float cie_fluorescent[12][CIE_LAMP_N]; /**< F1..F12 */
extern const float cornell_paints[3][CORNELL_N];    /**< white, red, green */

/** @brief Complex refractive index eta + i k of a metal at a wavelength. */
typedef struct metal_point {
    float nm, eta, k;
} metal_point;

/** @brief A metal, points ascending from 360 nm or below to 830 nm or above. */
typedef struct metal_table {
    const char *name; /**< chemical symbol; NULL ends the list */
    const metal_point *points;
    int n;
} metal_table;

extern const metal_table measured_metals[];

enum { GLASS_TERMS = 4 };

/** @brief Sellmeier's formula: n² = 1 + sum b λ² / (λ² - c), λ in µm, c in µm². */
typedef struct glass_formula {
    const char *name; /**< NULL ends the list */
    double b[GLASS_TERMS], c[GLASS_TERMS];
} glass_formula;

extern const glass_formula measured_glasses[];

/** @brief n² = a + b / (λ² - c) + d λ² + e λ⁴, λ in µm; clear over the visible. */
typedef struct oxide_formula {
    const char *name; /**< NULL ends the list */
    double a, b, c, d, e;
} oxide_formula;

extern const oxide_formula measured_oxides[];
