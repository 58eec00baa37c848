/*
 * What of a scene file says what light meets, and what only from where and how it is seen.
 */
#pragma once

#include <glib.h>

/** @brief Adds a file's words to a checksum, without comments and blanks, and without
 * those directives before WorldBegin that are about camera, film and integrator. */
void pbrt_sum_world(GChecksum *sum, const char *data, size_t size);
