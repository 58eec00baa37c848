/*
 * Learning where to emit: rounds of trial photons, before the first pass, teach the guide
 * which starts lead to caustics that the camera sees.
 */
#pragma once

#include "photon/guide.h"
#include "transport/transport.h"

/** @brief Makes plan->guide for the caustic photons, where the settings ask for it. false
 * when cancelled or out of memory. Deterministic: it depends on scene and settings only.
 */
bool aim_caustics(transport_plan *plan, const cancel_flag *cancel, GError **error);
