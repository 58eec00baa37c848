/*
 * Eight floats at a time, for the loops of the denoiser.
 */
#pragma once

#include <string.h>

enum { LANES = 8 };

typedef float floats8 __attribute__((vector_size(32)));
typedef float floats4 __attribute__((vector_size(16)));
typedef int ints8 __attribute__((vector_size(32)));

static inline floats8 fill8(float x)
{
    return (floats8){x, x, x, x, x, x, x, x};
}

static inline floats8 load8(const float *a)
{
    floats8 v;
    memcpy(&v, a, sizeof v);
    return v;
}

static inline void store8(float *a, floats8 v)
{
    memcpy(a, &v, sizeof v);
}

static inline floats8 min8(floats8 a, floats8 b)
{
    ints8 less = a < b;
    return (floats8)(((ints8)a & less) | ((ints8)b & ~less));
}

static inline floats8 max8(floats8 a, floats8 b)
{
    ints8 more = a > b;
    return (floats8)(((ints8)a & more) | ((ints8)b & ~more));
}

/** @brief Each vector's sum of lanes. */
static inline floats4 sums4(floats8 a, floats8 b, floats8 c, floats8 d)
{
    floats8 ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) +
                 __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    floats8 cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14) +
                 __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    floats8 all = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13) +
                  __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
    return __builtin_shufflevector(all, all, 0, 1, 2, 3) +
           __builtin_shufflevector(all, all, 4, 5, 6, 7);
}

static inline float sum8(floats8 v)
{
    return sums4(v, v, v, v)[0];
}
