/* pbrt-v4 and pbrt-v3 text: any bytes build a scene or end in an error. */
#include "format/format.h"
#include "fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    bool read = format_read(b, fuzz_file(".pbrt", data, size), &error);
    g_assert_true(read == (error == NULL));
    return 0;
}
