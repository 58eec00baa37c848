#include "math/noise.h"

/* Perlin's permutation of 0..255. */
static const unsigned char permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225,
    140, 36,  103, 30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148,
    247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203, 117, 35,  11,  32,
    57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175,
    74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,
    65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169,
    200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,
    52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212,
    207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104,
    218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241,
    81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157,
    184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

static unsigned permuted(unsigned i)
{
    return permutation[i & 255u];
}

/* The gradient at a whole point times the way from it. */
static float gradient(const unsigned cell[3], int dx, int dy, int dz, vec3 way)
{
    unsigned h =
        permuted(permuted(permuted(cell[0] + (unsigned)dx) + cell[1] + (unsigned)dy) +
                 cell[2] + (unsigned)dz) &
        15u;
    float x = way[0] - (float)dx, y = way[1] - (float)dy, z = way[2] - (float)dz;
    float u = h < 8 || h == 12 || h == 13 ? x : y;
    float v = h < 4 || h == 12 || h == 13 ? y : z;
    return (h & 1u ? -u : u) + (h & 2u ? -v : v);
}

static float fade(float t)
{
    return t * t * t * (t * (6.0f * t - 15.0f) + 10.0f);
}

float noise3(vec3 p)
{
    unsigned cell[3];
    vec3 way = {0};
    for (int i = 0; i < 3; i++) {
        /* beyond 2^24 floats are whole, and the noise is zero */
        float x = isfinite(p[i]) ? clampf(p[i], -0x1p24f, 0x1p24f) : 0.0f;
        float whole = floorf(x);
        cell[i] = (unsigned)((int)whole & 255);
        way[i] = x - whole;
    }
    float s = fade(way[0]), t = fade(way[1]), edges[4];
    for (int i = 0; i < 4; i++) {
        int y = i & 1, z = i >> 1;
        edges[i] = lerpf(gradient(cell, 0, y, z, way), gradient(cell, 1, y, z, way), s);
    }
    return lerpf(lerpf(edges[0], edges[1], t), lerpf(edges[2], edges[3], t),
                 fade(way[2]));
}

float noise_fbm(vec3 p, float omega, int octaves)
{
    float sum = 0.0f, weight = 1.0f, scale = 1.0f;
    for (int i = 0; i < octaves; i++) {
        sum += weight * noise3(scale * p);
        scale *= 1.99f;
        weight *= omega;
    }
    return sum;
}

/* pbrt-v4 adds the mean of one octave more, 0.2. */
float noise_turbulence(vec3 p, float omega, int octaves)
{
    float sum = 0.0f, weight = 1.0f, scale = 1.0f;
    for (int i = 0; i < octaves; i++) {
        sum += weight * fabsf(noise3(scale * p));
        scale *= 1.99f;
        weight *= omega;
    }
    return sum + 0.2f * weight;
}
