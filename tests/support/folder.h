/*
 * What is in a folder of a test's own.
 */
#pragma once

#include <glib.h>

static inline unsigned n_files_in(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    unsigned n = 0;
    while (g_dir_read_name(dir))
        n++;
    return n;
}
