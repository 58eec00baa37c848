/*
 * What reading and writing of settings needs of their table beside what settings.h tells.
 */
#pragma once

#include "settings/settings.h"

enum { MOST_PASSES = 1000000000 };

/** @brief The name that a mistyped one was probably meant to be, or NULL. */
const char *settings_nearest_name(const char *name);
