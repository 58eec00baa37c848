#include "base/intern.h"

#include <glib.h>
#include <pthread.h>

/* g_intern_string does the same, but leaves a table behind whenever it grows. */
const char *intern(const char *text)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static GStringChunk *kept;
    if (!text)
        return NULL;
    pthread_mutex_lock(&lock);
    if (!kept)
        kept = g_string_chunk_new(4096);
    const char *copy = g_string_chunk_insert_const(kept, text);
    pthread_mutex_unlock(&lock);
    return copy;
}
