/*
 * Images of all directions, as lights have them: where a direction is in the image, and
 * directions drawn in proportion to what the image shows.
 *
 *   square         equal-area map (Clarberg, "Fast Equal-Area Mapping of the
 *                  (Hemi)Sphere using SIMD", 2008), as pbrt-v4 has them
 *   twice as wide  latitude-longitude map: s = φ / 2π from +x over +y, t = θ / π from +z
 *   as high        at the top, as most other programs write them
 *
 * Texels are mixed bilinearly; the density is the same all over a texel, in proportion to
 * the image's mean over the texel, so that it is positive wherever the image is.
 */
#pragma once

#include "math/distribution2.h"
#include "texture/picture.h"

/** @brief The equal-area map alone: from the unit square to unit directions and back. */
vec3 equal_area_to_sphere(vec2 st);
vec2 equal_area_to_square(vec3 d);

struct sphere_layout;

typedef struct sphere_map {
    picture *pic; /**< owned */
    const struct sphere_layout *layout;
    distribution2 drawn;
    double integral; /**< of R, G and B's mean over the sphere, sr */
} sphere_map;

/** @brief Takes a picture (picture_read_light), also on failure; NULL fails. @return false with ERROR_INPUT at
 * the place: its shape fits no layout or it is black. */
bool sphere_map_init(sphere_map *map, picture *taken, source_place place, GError **error);
void sphere_map_clear(sphere_map *map);
/** @brief "equal-area" or "latitude-longitude". */
const char *sphere_map_layout(const sphere_map *map);

/** @brief The image in unit direction d. */
void sphere_map_rgb(const sphere_map *map, vec3 d, float rgb[3]);
/** @brief A unit direction and its density. */
vec3 sphere_map_sample(const sphere_map *map, vec2 u, float *pdf_solid_angle);
float sphere_map_pdf(const sphere_map *map, vec3 d);

/** @brief Told of parts of the sphere that together are all of it. */
typedef void (*sphere_part)(void *data, vec3 d, const float rgb[3], float solid_angle);
/** @brief Goes over the image in a few thousand parts, each with its mean colour. */
void sphere_map_parts(const sphere_map *map, sphere_part tell, void *data);
