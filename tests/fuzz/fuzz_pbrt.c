/* pbrt-v4 and pbrt-v3 text: any bytes become a scene or an error that says something. */
#include "format/format.h"
#include "fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(fuzz_file(".pbrt", data, size), 1, NULL, &error);
    g_assert_true((s == NULL) == (error != NULL));
    return 0;
}
