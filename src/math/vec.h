/*
 * Vectors of three floats in one SIMD register: `a + t * b` reads as in the paper.
 * The fourth lane is unused and kept at zero by the functions here.
 */
#pragma once

#include <math.h>
#include <stdbool.h>

/** @brief A point, vector or normal: x, y, z and an unused lane. 16 bytes, 16-aligned. */
typedef float vec3 __attribute__((vector_size(16)));

/** @brief The bits of a vec3, or the outcome of a comparison: each lane 0 or -1. */
typedef int vec3_bits __attribute__((vector_size(16)));

/** @brief Two plain floats: a random pair, a texture coordinate, a raster position. */
typedef struct vec2 {
    float x, y;
} vec2;

#define PI_F 3.14159265358979323846f
#define INV_PI_F 0.31830988618379067154f

/*
 * In place of fminf and fmaxf, which gcc calls from libm as their rules for NaN ask: a
 * call into SSE code from AVX code costs up to 0.3 µs on some processors, these cost one
 * instruction. If one of the two is NaN the result is b.
 */
static inline float minf(float a, float b)
{
    return a < b ? a : b;
}

static inline float maxf(float a, float b)
{
    return a > b ? a : b;
}

static inline vec3 vec3_make(float x, float y, float z)
{
    return (vec3){x, y, z, 0.0f};
}

static inline float dot3(vec3 a, vec3 b)
{
    vec3 p = a * b;
    return p[0] + p[1] + p[2];
}

static inline vec3 cross3(vec3 a, vec3 b)
{
    return vec3_make(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]);
}

static inline float length3_2(vec3 a)
{
    return dot3(a, a);
}

static inline float length3(vec3 a)
{
    return sqrtf(dot3(a, a));
}

/** @brief a turned, if need be, into the hemisphere around b. */
static inline vec3 face_forward(vec3 a, vec3 b)
{
    return dot3(a, b) < 0.0f ? -a : a;
}

static inline float max_component3(vec3 a)
{
    return maxf(a[0], maxf(a[1], a[2]));
}

static inline vec3 abs3(vec3 a)
{
    return (vec3)((vec3_bits)a & 0x7fffffff);
}

/** @brief a where the mask is set, else b. */
static inline vec3 choose3(vec3_bits mask, vec3 a, vec3 b)
{
    return (vec3)(((vec3_bits)a & mask) | ((vec3_bits)b & ~mask));
}

static inline vec3 min3(vec3 a, vec3 b)
{
    return choose3(a < b, a, b);
}

static inline vec3 max3(vec3 a, vec3 b)
{
    return choose3(a > b, a, b);
}

static inline bool finite3(vec3 a)
{
    vec3 zero = a * 0.0f;
    return isfinite(zero[0] + zero[1] + zero[2]);
}

/** @brief False if a squared length has lost digits, or all of them, to the range of
 * floats: the areas of what is a nanometre or a million kilometres wide. */
static inline bool is_safe_square(float length2)
{
    return length2 > 1e-30f && length2 < 1e30f;
}

/** @brief The power of two that brings a vector to a length near 1, changing no digit; 1
 * of zero and of what is not finite. */
static inline float scale_to_unit(vec3 a)
{
    float largest = max_component3(abs3(a));
    if (!(largest > 0.0f && largest < INFINITY))
        return 1.0f;
    int exponent = -ilogbf(largest);
    return ldexpf(1.0f, exponent > 120 ? 120 : exponent);
}

/** @brief a / |a|; the zero vector stays zero. */
static inline vec3 normalize3(vec3 a)
{
    float length2 = length3_2(a);
    if (__builtin_expect(!is_safe_square(length2), 0)) {
        a *= scale_to_unit(a);
        length2 = length3_2(a);
    }
    return length2 > 0.0f ? a / sqrtf(length2) : a;
}

/** @brief |a| of what may be an area: its square may be no float's. */
static inline float length3_of_area(vec3 a)
{
    float scale = is_safe_square(length3_2(a)) ? 1.0f : scale_to_unit(a);
    return length3(a * scale) / scale;
}

static inline float clampf(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static inline float square(float x)
{
    return x * x;
}

static inline float lerpf(float a, float b, float t)
{
    return a + t * (b - a);
}
