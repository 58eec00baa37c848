/*
 * Settings that send fewer photons a pass than were asked for: where time or memory is
 * short.
 */
#pragma once

#include "settings/settings.h"

enum { PHOTON_SHARE_LEAST = 1000 /**< of a pass; who asks for fewer has these */ };

/** @brief A share of so many, but no fewer than the least. */
int64_t photon_share_of(int64_t n, double share);
/** @brief The settings send a share of the photons that they ask for; 1 and more: all. */
void photon_share_take(settings *how, double share);
