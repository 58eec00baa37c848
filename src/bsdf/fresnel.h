/*
 * Smooth boundaries: where light goes and how much of it. Unpolarised light throughout.
 * Born & Wolf, "Principles of Optics", §1.5 and §14.2.
 */
#pragma once

#include "color/spectrum.h"
#include "math/vec.h"

/** @brief Reflectance of a boundary between dielectrics.
 *  @param cos_o cosine to the normal on the side where light is, >= 0
 *  @param eta refractive index of the far side over that of this side
 *  @return 1 under total internal reflection */
static inline float fresnel_dielectric(float cos_o, float eta)
{
    float cos_o2 = cos_o * cos_o;
    float cos_t2 = 1.0f - (1.0f - cos_o2) / (eta * eta);
    if (!(cos_t2 > 0.0f))
        return 1.0f;
    float cos_t = sqrtf(cos_t2);
    float parallel = (eta * cos_o - cos_t) / (eta * cos_o + cos_t);
    float perpendicular = (cos_o - eta * cos_t) / (cos_o + eta * cos_t);
    return minf(1.0f, 0.5f * (parallel * parallel + perpendicular * perpendicular));
}

/** @brief The same at eight wavelengths. */
spectrum fresnel_dielectric_wavelengths(float cos_o, spectrum eta);

/** @brief Reflectance of a metal with complex index eta + i k. */
spectrum fresnel_conductor(float cos_o, spectrum eta, spectrum k);

/** @brief Mirror of w about m (both away from the surface). */
static inline vec3 reflect3(vec3 w, vec3 m)
{
    return m * (2.0f * dot3(w, m)) - w;
}

/** @brief Snell's law: w and unit m on one side, eta = far over near.
 *  @return false under total internal reflection */
bool refract3(vec3 w, vec3 m, float eta, vec3 *t);
