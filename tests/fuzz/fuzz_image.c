/* Images of every format, told apart by their bytes: any bytes become one or an error. */
#include "fuzz_file.h"
#include "image/image.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(GBytes) bytes = g_bytes_new(data, size);
    g_autoptr(image) img = image_read_bytes("input", bytes, NULL, &error);
    g_assert_true((img == NULL) == (error != NULL));
    return 0;
}
