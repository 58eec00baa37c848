#include "math/warp.h"

/* Sine and cosine of a quarter turn's half, |x| <= pi/4, to an ulp or two: Taylor's
   series, without the reduction of the angle that libm must do. */
static float small_sine(float x)
{
    float x2 = x * x;
    float p = -1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)));
    return x + x * x2 * p;
}

static float small_cosine(float x)
{
    float x2 = x * x;
    float p =
        1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320 - x2 * (1.0f / 3628800)));
    return 1.0f + x2 * (-0.5f + x2 * p);
}

vec2 warp_disk(vec2 u)
{
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
    /* Multiplied by one and zero, not branched on: a branch would be guessed wrong every
       other time. */
    float wide = fabsf(x) > fabsf(y) ? 1.0f : 0.0f, tall = 1.0f - wide;
    float r = wide * x + tall * y, other = wide * y + tall * x;
    if (!(fabsf(r) > 0.0f))
        return (vec2){0.0f, 0.0f};
    float angle = 0.25f * PI_F * (other / r); /* from the axis that r is along */
    float along = r * small_cosine(angle), across = r * small_sine(angle);
    return (vec2){wide * along + tall * across, wide * across + tall * along};
}

vec3 warp_cosine_hemisphere(vec2 u)
{
    vec2 d = warp_disk(u);
    return vec3_make(d.x, d.y, sqrtf(maxf(0.0f, 1.0f - d.x * d.x - d.y * d.y)));
}

vec3 warp_sphere(vec2 u)
{
    float z = 1.0f - 2.0f * u.x;
    float r = 2.0f * sqrtf(maxf(0.0f, u.x * (1.0f - u.x)));
    float phi = 2.0f * PI_F * u.y;
    return vec3_make(r * cosf(phi), r * sinf(phi), z);
}

vec3 warp_cone(vec2 u, float one_minus_cos)
{
    float below_one = u.x * one_minus_cos;
    float r = sqrtf(maxf(0.0f, below_one * (2.0f - below_one)));
    float phi = 2.0f * PI_F * u.y;
    return vec3_make(r * cosf(phi), r * sinf(phi), 1.0f - below_one);
}

float warp_cone_pdf(float one_minus_cos)
{
    return 1.0f / (2.0f * PI_F * one_minus_cos);
}

vec2 warp_triangle(vec2 u)
{
    /* Heitz, "A Low-Distortion Map Between Triangle and Square", 2019. */
    if (u.y > u.x) {
        float x = 0.5f * u.x;
        return (vec2){x, u.y - x};
    }
    float y = 0.5f * u.y;
    return (vec2){u.x - y, y};
}
