/*
 * The middle of some numbers.
 */
#pragma once

#include <stddef.h>

/** @brief The value that stands at n / 2 once n >= 1 of them are in order: the middle
 * one, or of two the larger. Sorts them; none is NaN. */
float median(float *values, size_t n);
