/*
 * Lights in sight of a pixel, straight or by mirrors, of a film that has halves.
 *
 * Their edges are sharper than any filter keeps them with a few samples a pixel, and
 * beside them there may be nothing: they are not filtered. Nor is their mean over a pixel
 * what one wants to see at their edges, where a thousandth of a light is brighter than
 * white: with the share of the pixel that they take, image_shown_pixel draws them smooth.
 */
#pragma once

#include "render/film/film.h"

/** @brief In the film's colours. @return the share of the pixel where they are in sight
 */
float film_lights_in_sight(const film *f, size_t pixel, float rgb[3]);

/** @brief The same as channels of an image. The share is that of edges: of lights that
 * fill a pixel beside this one; those that are smaller count as all of it, for there the
 * mean is what an eye sees. */
void film_lights(const film *f, size_t pixel, float rgba[4]);
