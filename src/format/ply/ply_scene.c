/*
 * A PLY file as a scene of its own: one diffuse mesh.
 */
#include "base/intern.h"
#include "format/defaults.h"
#include "format/given.h"
#include "format/ply/ply.h"
#include "format/reader.h"

#include <string.h>

static bool read_ply_scene(scene_builder *to, const char *path, GError **error)
{
    mesh m = {0};
    source_place place = {intern(path), 0, 0};
    g_autoptr(params) p = params_new(place, "/", color_space_srgb());
    shape_place at = {.to_world = transform_identity()};
    give_triple(p, PARAM_RGB, "reflectance", 0.6, 0.6, 0.6);
    at.material = builder_add_material(to, NULL, "diffuse", p, error);
    return at.material != NO_INDEX && ply_read(path, &m, error) &&
           builder_add_mesh(to, &m, &at, place, error) &&
           scene_complete(to, path, vec3_make(0.0f, 1.0f, 0.0f), true, error);
}

static bool is_ply(const char *bytes, size_t size)
{
    return size > 4 && memcmp(bytes, "ply", 3) == 0 &&
           (bytes[3] == '\n' || bytes[3] == '\r');
}

static const char *const extensions[] = {".ply", ".ply.gz", NULL};

const format_reader ply_reader = {.name = "PLY",
                                  .extensions = extensions,
                                  .recognises = is_ply,
                                  .read = read_ply_scene};
