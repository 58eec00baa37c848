/*
 * Any scene as pbrt-v4 text, with its meshes as PLY and its images beside it.
 */
#pragma once

#include "format/format.h"

/**
 * @brief Reads a scene of any format and writes it to `out` (.pbrt); meshes and images go
 * into a folder beside it, named like it with "-files" in place of the extension.
 * @param options may be NULL
 * @return false with ERROR_INPUT (the scene, or where to write), or ERROR_FAILED
 */
bool format_convert(const char *in, const char *out, const load_options *options,
                    GError **error);
