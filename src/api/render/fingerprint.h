/*
 * What tells one scene from another, in any process and on any machine: a checksum of the
 * files that it was read from, of how they were read, and of where it is seen from.
 */
#pragma once

#include "api/objects.h"

/** @brief SHA-256 in hex digits; owned by the caller. Reads the scene's files. */
char *scene_fingerprint(const NephScene *of);
/** @brief The same of what photons meet, wherever it is seen from and however large. */
char *world_fingerprint(const NephScene *of);
