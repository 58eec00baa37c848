/*
 * Values as bytes, one behind the other in the machine's order, and back: for files and
 * messages that the same program reads, whose bytes are checked elsewhere. What is read
 * is bounded by what is there.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <string.h>

/** @brief Appends n elements of so many bytes. */
static inline void bytes_put(GByteArray *to, const void *data, size_t n, size_t size)
{
    g_byte_array_append(to, data, (guint)(n * size));
}

/** @brief Where the reading stands. */
typedef struct bytes_reader {
    const guint8 *at, *end;
    bool failed; /**< there were fewer; all that was read since then is zero */
} bytes_reader;

/** @brief Reads n elements of so many bytes. */
static inline void bytes_get(bytes_reader *from, void *data, size_t n, size_t size)
{
    size_t left = (size_t)(from->end - from->at);
    if (from->failed || (n > 0 && size > left / n)) {
        from->failed = true;
        memset(data, 0, n * size);
        return;
    }
    memcpy(data, from->at, n * size);
    from->at += n * size;
}

static inline void bytes_put_bool(GByteArray *to, bool value)
{
    const guint8 byte = value ? 1 : 0;
    bytes_put(to, &byte, 1, 1);
}

static inline bool bytes_get_bool(bytes_reader *from)
{
    guint8 byte = 0;
    bytes_get(from, &byte, 1, 1);
    return byte != 0;
}

/** @brief Reads a count of elements of so many bytes that follow; 0 if they do not. */
static inline size_t bytes_get_count(bytes_reader *from, size_t size)
{
    guint64 n = 0;
    bytes_get(from, &n, 1, sizeof n);
    if (n > (size_t)(from->end - from->at) / size) {
        from->failed = true;
        return 0;
    }
    return (size_t)n;
}

/** @brief Appends a count. */
static inline void bytes_put_count(GByteArray *to, size_t n)
{
    const guint64 count = n;
    bytes_put(to, &count, 1, sizeof count);
}
