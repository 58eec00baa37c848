/*
 * A picture of photons over the wireframe, as the window shows them: few as arrows that
 * point to where they came from, many as points, coloured by their power.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief @param classes bit c: photons of that class are drawn
 * @return owned by the caller; NULL with an error */
NephImage *photon_picture(const NephScene *scene, const NephPhotons *photons,
                          unsigned classes, GError **error);
