/*
 * What the files about photons share.
 */
#pragma once

#include "api/objects.h"
#include "render/photons.h"

struct NephPhotons {
    render_photons *traced;
};

/** @brief The class of photon i of all; *i becomes its number within the class. @return
 * false: there are fewer */
bool photons_locate(const NephPhotons *photons, size_t *i, photon_class *c);
/** @brief Flux at the photons' wavelengths as linear sRGB. */
void photons_rgb(const NephPhotons *photons, spectrum flux, float rgb[3]);
