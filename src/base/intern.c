#include "base/intern.h"

#include <glib.h>

/* g_intern_string does the same, but leaves a table behind whenever it grows. */
const char *intern(const char *text)
{
    static GMutex lock;
    static GStringChunk *kept;
    if (!text)
        return NULL;
    g_mutex_lock(&lock);
    if (!kept)
        kept = g_string_chunk_new(4096);
    const char *copy = g_string_chunk_insert_const(kept, text);
    g_mutex_unlock(&lock);
    return copy;
}
