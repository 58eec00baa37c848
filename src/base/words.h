/*
 * Mistyped words: how far two are apart, so that a message can name what was meant.
 */
#pragma once

#include <stddef.h>

/** @brief Letters to insert, delete or change to make b of a (Levenshtein 1966); only the
 * first 63 letters of b count. */
size_t edit_distance(const char *a, const char *b);
