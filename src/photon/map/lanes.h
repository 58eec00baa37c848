/*
 * Eight floats at a time, written with the compilers' vector extensions.
 *
 * What decides whether a photon is found (distances, sides) is computed with fused() and
 * fused8(), spelled out operation by operation: left to itself a compiler may contract a
 * sum of products one way in the scalar twin and another in the vector, and the maps
 * would no longer agree to the bit.
 */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __AVX__
#include <immintrin.h>
#endif

enum { LANES = 8 }; /* size: of a vector */

typedef float floats8 __attribute__((vector_size(32)));
typedef int32_t ints8 __attribute__((vector_size(32)));
typedef float floats4 __attribute__((vector_size(16)));
typedef int32_t ints4 __attribute__((vector_size(16)));
typedef size_t sizes4 __attribute__((vector_size(32)));

static inline floats8 fill8(float x)
{
    return (floats8){x, x, x, x, x, x, x, x};
}

static inline ints8 fill8_int(int32_t x)
{
    return (ints8){x, x, x, x, x, x, x, x};
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

static inline ints8 load8_int(const void *a)
{
    ints8 v;
    memcpy(&v, a, sizeof v);
    return v;
}

/** @brief a b + c, rounded once where the processor can. */
static inline float fused(float a, float b, float c)
{
#if defined(__FMA__) || defined(__aarch64__)
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}

/** @brief fused() in each lane, to the bit. */
static inline floats8 fused8(floats8 a, floats8 b, floats8 c)
{
    floats8 r;
    for (int i = 0; i < LANES; i++)
        r[i] = fused(a[i], b[i], c[i]);
    return r;
}

static inline floats8 sqrt8(floats8 a)
{
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
}

/** @brief Lanes of a where mask is set, else of b. A mask lane is 0 or -1. */
static inline floats8 choose8(ints8 mask, floats8 a, floats8 b)
{
    return (floats8)(((ints8)a & mask) | ((ints8)b & ~mask));
}

/** @brief a where it is larger, else b. */
static inline floats8 max8(floats8 a, floats8 b)
{
#ifdef __AVX__
    return (floats8)_mm256_max_ps((__m256)a, (__m256)b);
#else
    return choose8(a > b, a, b);
#endif
}

static inline floats8 abs8(floats8 a)
{
    return (floats8)((ints8)a & fill8_int(0x7fffffff));
}

/** @brief One bit a lane of a mask, lane 0 lowest. */
static inline unsigned bits8(ints8 mask)
{
#ifdef __AVX__
    return (unsigned)_mm256_movemask_ps((__m256)mask);
#else
    unsigned bits = 0;
    for (int i = 0; i < LANES; i++)
        bits |= ((unsigned)mask[i] & 1u) << i;
    return bits;
#endif
}

/** @brief Four values in the order named by lanes. */
static inline floats4 permute4(floats4 values, ints4 lanes)
{
#ifdef __AVX__
    return (floats4)_mm_permutevar_ps((__m128)values, (__m128i)lanes);
#else
    return (floats4){values[lanes[0]], values[lanes[1]], values[lanes[2]],
                     values[lanes[3]]};
#endif
}

/** @brief Appends the lanes named by bits, lowest first: their values, and first + lane.
 *  Without branches: both arrays must have room for eight more. @return their number */
static inline size_t pack8(floats8 values, unsigned bits, size_t first, float *value,
                           size_t *index)
{
    /* The lanes of each set of four, in order; what follows them is overwritten next. */
    static const sizes4 lanes[16] = {
        {0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
        {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3}};
    size_t n = 0;
    for (int half = 0; half < LANES; half += 4) {
        unsigned four = bits >> half & 15u;
        floats4 v = {values[half], values[half + 1], values[half + 2], values[half + 3]};
        v = permute4(v, __builtin_convertvector(lanes[four], ints4));
        sizes4 i = lanes[four] + (first + (size_t)half);
        memcpy(value + n, &v, sizeof v);
        memcpy(index + n, &i, sizeof i);
        n += (size_t)__builtin_popcount(four);
    }
    return n;
}
