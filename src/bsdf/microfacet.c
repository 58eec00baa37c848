#include "bsdf/microfacet.h"

#include "math/sampler.h"

#include <string.h>

vec3 ggx_sample_visible(ggx g, vec3 wo, vec2 u)
{
    /* Stretched, the surface is a hemisphere; its mirror directions fill a spherical cap.
     * Dupuy & Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023. */
    vec3 w = normalize3(vec3_make(g.alpha_x * wo[0], g.alpha_y * wo[1], wo[2]));
    float z = (1.0f - u.y) * (1.0f + w[2]) - w[2];
    float r = sqrtf(maxf(0.0f, 1.0f - z * z));
    float phi = 2.0f * PI_F * u.x;
    vec3 h = vec3_make(r * cosf(phi), r * sinf(phi), z) + w;
    return normalize3(vec3_make(g.alpha_x * h[0], g.alpha_y * h[1], maxf(h[2], 1e-9f)));
}

void ggx_few_points(vec3 wo, vec2 u[GGX_FEW])
{
    uint64_t words[2];
    memcpy(words, &wo, sizeof words);
    uint64_t h = hash_mix(words[0], words[1] & 0xffffffffu); /* the fourth is not wo's */
    float x = (float)(h >> 40) * 0x1p-24f, y = (float)(h & 0xffffff) * 0x1p-24f;
    for (int k = 0; k < GGX_FEW; k++) {
        float a = x + (float)k / GGX_FEW, b = y + (float)(5 * k % GGX_FEW) / GGX_FEW;
        u[k] = (vec2){a - floorf(a), b - floorf(b)};
    }
}
