/*
 * A whole input file as bytes: mapped, or inflated if it is gzip'ed (by content, whatever
 * its name).
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

/** @brief An open file. Its bytes end with the close. */
typedef struct input {
    const char *data; /**< size bytes, not terminated */
    size_t size;
    GMappedFile *map;
    char *inflated; /**< NULL if it was not compressed */
} input;

/** @brief false with an error that names neither file nor place: the caller knows where
 * the name came from. */
bool input_open(input *in, const char *path, GError **error);
void input_close(input *in);
