/*
 * What runs when nothing is chosen: path tracing for the light that paths find, and
 * photons for the light that only photons find (caustics, seen directly or through
 * glass).
 *
 * Light that goes light → specular or glossy → diffuse surface is found by photons and by
 * paths from the eye; at whatever diffuse surface the camera path stands, and however it
 * got there, each takes the share that it finds better (photon/trace/caustic_mis.h).
 * Every other path is traced from the camera; brightly lit places are looked at as lights
 * are (path_spots.c). Trials tell how many photons a pass is worth, and how often it is
 * worth to look (plan/caustics.h, plan/path_trial.h); where that is never, this is
 * `path`.
 */
#pragma once

#include "transport/transport.h"
