/*
 * What runs when nothing is chosen: path tracing for the light that paths find, and
 * photons for the light that only photons find (caustics, seen directly or through
 * glass).
 *
 * The partition is by path. Light that goes lamp → specular or glossy → diffuse surface
 * comes from the caustic map, at whatever diffuse surface the camera path stands and
 * however it got there; every other path is traced from the camera. Without a surface
 * that casts caustics there is no map, and this is `path`.
 */
#pragma once

#include "transport/transport.h"

extern const transport_kind transport_auto;
