/* What the importer's child tells: any bytes become a model or an error. */
#include "base/memory.h"
#include "format/model/model.h"
#include "fuzz_file.h"

#include <string.h>

/* A copy that ends where it ends, at an address that is one of eight. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GError) error = NULL;
    model m;
    void *copy = g_aligned_alloc(MAX(size, 1), 1, 8);
    if (size > 0)
        memcpy(copy, data, size);
    bool read = model_read(copy, size, &m, &error);
    g_assert_true(read == (error == NULL));
    model_clear(&m);
    g_aligned_free(copy);
    return 0;
}
