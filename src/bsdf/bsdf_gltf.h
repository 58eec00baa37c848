/*
 * The numbers of glTF's surface at a point.
 */
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"

/** @brief What a surface scatters by; the four parts are mixed already by metalness and
 * transmission. */
typedef struct gltf_surface {
    spectrum f0;      /**< of the facets at normal incidence, 0..1 */
    spectrum diffuse; /**< of the matt base, 0..1 */
    spectrum through; /**< what a thin pane lets through, 0..1 */
    spectrum leaf;    /**< what the base scatters to the other side, 0..1 */
    float f90;        /**< of the facets at grazing angles, 0..1 */
    float plain_f0,
        plain_f90;      /**< of what is not metal: what is kept from base and pane */
    float coat;         /**< 0..1 */
    ggx roughness;      /**< alpha_x along the grooves' normal */
    ggx coat_roughness; /**< round: alpha_x = alpha_y */
    bool is_followed;   /**< facets and coat are GLOSSY however rough they are */
    float turn;         /**< from the frame's s to the axis of alpha_x, rad */
} gltf_surface;

/** @brief Reflection, and transmission without refraction, alike on both sides. */
void bsdf_make_gltf(bsdf *b, const gltf_surface *surface);
