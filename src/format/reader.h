/*
 * What a file format must do; a line of format.def each.
 */
#pragma once

#include "scene/builder.h"

typedef struct format_reader {
    const char *name;              /**< as messages call it */
    const char *const *extensions; /**< lower case, with the dot, NULL-terminated */
    /** By its first bytes, whatever its name; NULL: by the name alone. */
    bool (*recognises)(const char *bytes, size_t size);
    /** Builds the scene from the file; does not commit. false with an error. */
    bool (*read)(scene_builder *to, const char *path, GError **error);
} format_reader;

#define FORMAT(name) extern const format_reader name##_reader;
#include "format/format.def"
#undef FORMAT
