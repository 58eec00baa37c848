/*
 * Height maps of formats that do not say how high: as normal maps.
 */
#pragma once

#include "image/image.h"

/** @brief True if an image looks like a normal map, which files call a height map all too
 * often: blue, with red and green about a half. */
bool height_map_is_normals(const image *img);

/**
 * @brief A normal map from the grey of an image, as a PFM file.
 * @param strength slope of a step from black to white across one texel
 * @return NULL if there is no memory for it
 */
GBytes *height_map_as_normals(const image *img, double strength);
