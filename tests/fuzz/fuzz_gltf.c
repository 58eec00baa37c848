/*
 * glTF from its text (or the chunks of a .glb) to the committed scene: JSON, buffers, images,
 * meshes, the pose of skins, the scene graph. Beside the file lie a buffer and an image that it
 * may name.
 */
#include "format/format.h"
#include "fuzz_file.h"

/* A tetrahedron as in the corpus: positions, indices, then weights and joints of a skin. */
static const struct {
    float positions[12];
    uint16_t indices[12];
    float weights[16];
    uint8_t joints[16];
    float bind[16];
} body = {
    .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
    .indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3},
    .weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
    .bind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
};

/* One grey pixel, as PFM. */
static const char image_file[] = "Pf\n1 1\n-1.0\n\0\0\0?";

static void put_beside(const char *path)
{
    static bool done;
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *buffer = g_build_filename(folder, "body.bin", NULL);
    g_autofree char *picture = g_build_filename(folder, "image.png", NULL);
    if (done)
        return;
    done = g_file_set_contents(buffer, (const char *)&body, sizeof body, NULL) &&
           g_file_set_contents(picture, image_file, sizeof image_file - 1, NULL);
    g_assert_true(done);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    const char *path = fuzz_file(".gltf", data, size);
    put_beside(path);
    g_autoptr(scene) s = format_load(path, 1, NULL, &error);
    g_assert_true((s != NULL) == (error == NULL));
    return 0;
}
