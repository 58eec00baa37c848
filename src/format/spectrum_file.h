/*
 * Spectra in files: lines of wavelength (nm) and value, '#' comments; pbrt calls them
 * .spd.
 */
#pragma once

#include "base/error.h"

/** @brief The numbers of a file, wavelength and value in turn: a GArray of float, owned
 * by the caller. NULL with ERROR_INPUT at the place in the file, or, if it cannot be
 * opened, at `place`. */
GArray *spectrum_file_read(const char *path, source_place place, GError **error);
