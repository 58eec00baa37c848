/*
 * What the fuzzers share: bytes as a file, for readers that want a path.
 */
#pragma once

#include <glib.h>
#include <glib/gstdio.h>
#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/** @brief The path of a file with these bytes; the same file at every call. */
static inline const char *fuzz_file(const char *extension, const uint8_t *data,
                                    size_t size)
{
    static char *path;
    if (!path) {
        char *folder = g_dir_make_tmp("nephroid-fuzz-XXXXXX", NULL);
        g_assert_nonnull(folder);
        path = g_strdup_printf("%s/input%s", folder, extension);
        g_free(folder);
    }
    g_assert_true(g_file_set_contents_full(path, (const char *)data, (gssize)size,
                                           G_FILE_SET_CONTENTS_NONE, 0600, NULL));
    return path;
}
