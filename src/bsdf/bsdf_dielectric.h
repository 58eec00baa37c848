/*
 * What the smooth and the rough dielectric share.
 */
#pragma once

#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"

typedef struct dielectric {
    spectrum eta;  /**< index below over that above the surface */
    spectrum tint; /**< times the light that passes, 0..1 */
    ggx roughness;
    bool disperses;
    bool lossless; /**< no Fresnel reflection, only total */
} dielectric;

_Static_assert(sizeof(dielectric) <= BSDF_DATA_SIZE, "a dielectric must fit");

extern const bsdf_ops dielectric_smooth_ops, dielectric_rough_ops;

/** @brief Index of the far side over that on wo's side. */
spectrum dielectric_eta(const bsdf *b, vec3 wo);

/** @brief The wavelength that decides: the one kept, else a random one where they differ;
 * *u stays uniform. */
int dielectric_pick_wavelength(const bsdf *b, float *u);

/**
 * @brief f of refraction by rough facets, flux being kept: radiance is smaller by eta².
 * Walter 2007, eq. 17 and 21.
 *  @param wo,wi directions above and below, away from the boundary
 *  @param eta far side over wo's
 *  @param passes share of light that the facet lets through
 *  @param pdf pdf_solid_angle of wi if a facet seen from wo is picked and refracts
 */
float dielectric_refraction(ggx g, vec3 wo, vec3 wi, float eta, float *passes,
                            float *pdf);
