#include "scene/microfacet.h"

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
