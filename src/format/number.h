/*
 * Numbers in text: decimal, independent of the locale, correctly rounded, and quick,
 * since a mesh written as text is millions of them.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/** @brief Reads all n bytes of text as one decimal number.
 *  @return false if they are not one, or it does not fit (never infinity or nan) */
bool number_float(const char *text, size_t n, float *out);
bool number_double(const char *text, size_t n, double *out);
/** @brief The same for a whole number without '.' or exponent. */
bool number_int(const char *text, size_t n, int *out);
