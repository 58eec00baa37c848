/*
 * A whole input file as bytes. Every reader opens its files here: only regular files are
 * read, so that nothing waits for a pipe or reads a device without end, and what is read
 * stays as it is whatever becomes of the file.
 *
 * Errors name the path, but neither the file nor the place that named it: the caller
 * knows.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

/** @brief The bytes of a file, until the close. */
typedef struct input {
    char *data; /**< size bytes and a zero */
    size_t size;
} input;

/** @brief A file as it is. */
bool input_read(input *in, const char *path, GError **error);
/** @brief A file, inflated if it is gzip'ed (by content, whatever its name); the zero
 * behind is there only if it was not. */
bool input_open(input *in, const char *path, GError **error);
void input_close(input *in);

/** @brief A file opened for reading and its size; -1 with an error. Closed by the caller,
 * and by exec. */
int input_descriptor(const char *path, size_t *size, GError **error);
/** @brief The first bytes, at most size. @return how many; 0 if there is no such file */
size_t input_peek(const char *path, char *to, size_t size);
/** @brief A file as it is, with a zero behind it; NULL with an error. */
GBytes *input_bytes(const char *path, GError **error);
