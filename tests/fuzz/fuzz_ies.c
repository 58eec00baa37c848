/* Photometric files: any text becomes a profile or an error. */
#include "fuzz_file.h"
#include "light/ies.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    ies_profile profile = {0};
    g_autofree char *text = g_strndup((const char *)data, size);
    bool read = ies_read(&profile, text, &error);
    g_assert_true(read == (error == NULL));
    if (read)
        ies_clear(&profile);
    return 0;
}
