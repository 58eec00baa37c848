/* PLY, text and binary: any bytes become a mesh or an error. */
#include "format/ply/ply.h"
#include "fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    mesh m = {0};
    bool read = ply_read(fuzz_file(".ply", data, size), &m, &error);
    g_assert_true(read == (error == NULL));
    mesh_clear(&m);
    return 0;
}
