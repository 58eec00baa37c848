/*
 * What a file format must do; one row each in format.c's table.
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

extern const format_reader pbrt_reader;
extern const format_reader gltf_reader;
extern const format_reader ply_reader;
extern const format_reader model_reader;
