/*
 * Some floats at a time, written with the compilers' vector extensions: eight, or sixteen
 * where the processor has AVX-512. What is computed in a lane does not depend on how many
 * there are, but the order in which lanes are summed does.
 *
 * What decides whether a point is found (distances, sides) is computed with fused() and
 * fused_lanes(), spelled out operation by operation: left to itself a compiler may
 * contract a sum of products one way in the scalar twin and another in the vector, and
 * the maps would no longer agree to the bit.
 */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __AVX__
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define HAS_WIDE_LANES 1
#else
#define HAS_WIDE_LANES 0
#endif
enum { LANES = 8 << HAS_WIDE_LANES }; /* size: of a vector */

typedef float lane_floats __attribute__((vector_size(4 * LANES)));
typedef int32_t lane_ints __attribute__((vector_size(4 * LANES)));

/** Where memory is aligned for one number. */
typedef float lane_floats_stored
    __attribute__((vector_size(4 * LANES), aligned(4), may_alias));

typedef float floats8 __attribute__((vector_size(32)));
typedef int32_t ints8 __attribute__((vector_size(32)));
typedef float floats4 __attribute__((vector_size(16)));
typedef int32_t ints4 __attribute__((vector_size(16)));

/** @brief a b + c, rounded once where the processor can. */
static inline float fused(float a, float b, float c)
{
#if defined(__FMA__) || defined(__aarch64__)
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}

/* ---- Eight ---- */

/** @brief fused() in each lane, to the bit. */
static inline floats8 fused8(floats8 a, floats8 b, floats8 c)
{
    floats8 r;
    for (int i = 0; i < 8; i++)
        r[i] = fused(a[i], b[i], c[i]);
    return r;
}

/** @brief a where it is larger, else b. */
static inline floats8 max8(floats8 a, floats8 b)
{
#ifdef __AVX__
    return (floats8)_mm256_max_ps((__m256)a, (__m256)b);
#else
    ints8 larger = a > b;
    return (floats8)(((ints8)a & larger) | ((ints8)b & ~larger));
#endif
}

/** @brief a where it is smaller, else b. */
static inline floats8 min8(floats8 a, floats8 b)
{
#ifdef __AVX__
    return (floats8)_mm256_min_ps((__m256)a, (__m256)b);
#else
    ints8 smaller = a < b;
    return (floats8)(((ints8)a & smaller) | ((ints8)b & ~smaller));
#endif
}

/** @brief One bit a lane of a mask, lane 0 lowest. A mask lane is 0 or -1. */
static inline unsigned bits8(ints8 mask)
{
#ifdef __AVX__
    return (unsigned)_mm256_movemask_ps((__m256)mask);
#else
    unsigned bits = 0;
    for (int i = 0; i < 8; i++)
        bits |= ((unsigned)mask[i] & 1u) << i;
    return bits;
#endif
}

/* ---- As many as there are lanes ---- */

static inline lane_floats fill_lanes(float x)
{
    return (lane_floats){0} + x;
}

static inline lane_floats load_lanes(const float *a)
{
    return *(const lane_floats_stored *)a;
}

static inline lane_ints load_lane_ints(const void *a)
{
    lane_ints v;
    memcpy(&v, a, sizeof v);
    return v;
}

static inline void store_lanes(float *a, lane_floats v)
{
    *(lane_floats_stored *)a = v; /* a memcpy into an array is checked by a call */
}

/** @brief fused() in each lane, to the bit. */
static inline lane_floats fused_lanes(lane_floats a, lane_floats b, lane_floats c)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#else
    return fused8(a, b, c);
#endif
}

static inline lane_floats sqrt_lanes(lane_floats a)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_sqrt_ps((__m512)a);
#else
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
#endif
}

/** @brief a where it is larger, else b. */
static inline lane_floats max_lanes(lane_floats a, lane_floats b)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_max_ps((__m512)a, (__m512)b);
#else
    return max8(a, b);
#endif
}

/** @brief a where it is smaller, else b. */
static inline lane_floats min_lanes(lane_floats a, lane_floats b)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_min_ps((__m512)a, (__m512)b);
#else
    return min8(a, b);
#endif
}

/** @brief a where the mask is -1, b where it is 0. */
static inline lane_floats choose_lanes(lane_ints mask, lane_floats a, lane_floats b)
{
    return (lane_floats)(((lane_ints)a & mask) | ((lane_ints)b & ~mask));
}

static inline lane_floats abs_lanes(lane_floats a)
{
    return (lane_floats)((lane_ints)a & 0x7fffffff);
}

/** @brief One bit a lane where a < b, lane 0 lowest. */
static inline unsigned bits_below(lane_floats a, lane_floats b)
{
#if HAS_WIDE_LANES
    return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
#else
    return bits8(a < b);
#endif
}

/** @brief The least of the lanes named by bits, one of them at least. */
static inline float least_lane(lane_floats values, unsigned bits)
{
#if HAS_WIDE_LANES
    return _mm512_mask_reduce_min_ps((__mmask16)bits, (__m512)values);
#else
    float least = INFINITY;
    for (int lane = 0; lane < LANES; lane++)
        least = (bits >> lane & 1u) && values[lane] < least ? values[lane] : least;
    return least;
#endif
}

/** @brief Sums of each half's lanes, lane by lane. */
static inline floats8 fold_lanes(lane_floats v)
{
#if HAS_WIDE_LANES
    return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
           __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    return v;
#endif
}

/** @brief Each vector's sum of lanes. */
static inline floats4 sums_of_lanes(const lane_floats v[4])
{
    floats8 a = fold_lanes(v[0]), b = fold_lanes(v[1]);
    floats8 c = fold_lanes(v[2]), d = fold_lanes(v[3]);
    floats8 ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) +
                 __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    floats8 cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14) +
                 __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    floats8 all = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13) +
                  __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
    return __builtin_shufflevector(all, all, 0, 1, 2, 3) +
           __builtin_shufflevector(all, all, 4, 5, 6, 7);
}

static inline float sum_of_lanes(lane_floats v)
{
    return sums_of_lanes((const lane_floats[4]){v, v, v, v})[0];
}

/** @brief Bits of the first n lanes. */
static inline unsigned bits_first(size_t n)
{
    return n < LANES ? (1u << n) - 1u : (1u << LANES) - 1u;
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
 *  Without branches: both arrays must have room for LANES more. @return their number */
static inline size_t pack_lanes(lane_floats values, unsigned bits, uint32_t first,
                                float *value, uint32_t *index)
{
#if HAS_WIDE_LANES
    const __m512i lanes =
        _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    __m512i numbers = _mm512_add_epi32(_mm512_set1_epi32((int32_t)first), lanes);
    _mm512_storeu_ps(value, _mm512_maskz_compress_ps((__mmask16)bits, (__m512)values));
    _mm512_storeu_si512(index, _mm512_maskz_compress_epi32((__mmask16)bits, numbers));
    return (size_t)__builtin_popcount(bits);
#else
    /* The lanes of each set of four, in order; what follows them is overwritten next. */
    static const ints4 lanes[16] = {
        {0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
        {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3}};
    size_t n = 0;
    for (int half = 0; half < LANES; half += 4) {
        unsigned four = bits >> half & 15u;
        floats4 v = {values[half], values[half + 1], values[half + 2], values[half + 3]};
        v = permute4(v, lanes[four]);
        ints4 i = lanes[four] + (int32_t)(first + (uint32_t)half);
        memcpy(value + n, &v, sizeof v);
        memcpy(index + n, &i, sizeof i);
        n += (size_t)__builtin_popcount(four);
    }
    return n;
#endif
}

/** @brief Appends first + lane for the lanes named by bits, lowest first: room for LANES
 * more is needed. @return their number */
static inline size_t pack_numbers(unsigned bits, uint32_t first, uint32_t *number)
{
#if HAS_WIDE_LANES
    const __m512i lanes =
        _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    __m512i numbers = _mm512_add_epi32(_mm512_set1_epi32((int32_t)first), lanes);
    _mm512_storeu_si512(number, _mm512_maskz_compress_epi32((__mmask16)bits, numbers));
    return (size_t)__builtin_popcount(bits);
#else
    size_t n = 0;
    for (unsigned left = bits; left; left &= left - 1u)
        number[n++] = first + (uint32_t)__builtin_ctz(left);
    return n;
#endif
}

#if HAS_WIDE_LANES
/** Gathers take places as signed: they are counted from the middle. */
#define GATHER_MIDDLE (1u << 31)

static inline __m512i gather_places(const uint32_t *index)
{
    return _mm512_xor_epi32(_mm512_loadu_si512(index),
                            _mm512_set1_epi32((int32_t)GATHER_MIDDLE));
}
#endif

/** @brief Words from the places that index names. */
static inline lane_ints gather_lanes(const uint32_t *words, const uint32_t *index)
{
#if HAS_WIDE_LANES
    return (lane_ints)_mm512_i32gather_epi32(gather_places(index), words + GATHER_MIDDLE,
                                             4);
#else
    lane_ints v;
    for (int lane = 0; lane < LANES; lane++)
        v[lane] = (int32_t)words[index[lane]];
    return v;
#endif
}

/** @brief Floats from the places that index names. */
static inline lane_floats gather_float_lanes(const float *values, const uint32_t *index)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_i32gather_ps(gather_places(index), values + GATHER_MIDDLE,
                                            4);
#else
    lane_floats v;
    for (int lane = 0; lane < LANES; lane++)
        v[lane] = values[index[lane]];
    return v;
#endif
}

/** @brief Of sixteen values those that number names. */
static inline lane_floats pick_lanes(const float values[16], lane_ints number)
{
#if HAS_WIDE_LANES
    return (lane_floats)_mm512_permutexvar_ps((__m512i)number, _mm512_loadu_ps(values));
#else
    lane_floats v;
    for (int lane = 0; lane < LANES; lane++)
        v[lane] = values[number[lane]];
    return v;
#endif
}

/** @brief pack_lanes of values that have an index each. The arrays may be those that the
 * values and indices come from, or begin further ahead. */
static inline size_t pack_lane_pairs(lane_floats values, const uint32_t *from,
                                     unsigned bits, float *value, uint32_t *index)
{
#if HAS_WIDE_LANES
    __m512i numbers = _mm512_loadu_si512(from);
    _mm512_storeu_ps(value, _mm512_maskz_compress_ps((__mmask16)bits, (__m512)values));
    _mm512_storeu_si512(index, _mm512_maskz_compress_epi32((__mmask16)bits, numbers));
    return (size_t)__builtin_popcount(bits);
#else
    size_t n = 0;
    for (unsigned left = bits; left; left &= left - 1u) {
        int lane = __builtin_ctz(left);
        value[n] = values[lane];
        index[n++] = from[lane];
    }
    return n;
#endif
}
