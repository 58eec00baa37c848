#include "math/sampler.h"

/* Past this dimension points are hashed: deep bounces gain nothing from stratification.
 */
enum { SOBOL_DIMENSIONS = 32 };

static uint32_t reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/* Laine & Karras' permutation, with the constants of Vegdahl (2021): each bit is flipped
   by a hash of the bits below it, which on reversed bits is an Owen scramble. */
static uint32_t laine_karras(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

/* The second Sobol dimension, bits reversed: its generator matrix is Pascal's triangle
   mod 2, which factors into five shift-and-xor steps over the bits. */
static uint32_t sobol_second_reversed(uint32_t index)
{
    uint32_t x = index;
    x ^= x >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    return x ^ (x & 0xaaaaaaaau) >> 1;
}

static float to_unit(uint32_t x)
{
    return (float)(x >> 8) * 0x1p-24f;
}

/* An Owen scramble of what is given with its bits reversed, as both dimensions are: the
   index itself is the first one so. */
static float scrambled(uint32_t reversed, uint32_t seed)
{
    return to_unit(reverse_bits(laine_karras(reversed, seed)));
}

float sampler_1d(sampler *s)
{
    uint64_t h = hash_mix(s->key, s->dimension++);
    if (s->dimension > SOBOL_DIMENSIONS)
        return to_unit((uint32_t)hash_mix(h, s->index));
    uint32_t shuffled = owen_scramble(s->index, (uint32_t)h);
    return scrambled(shuffled, (uint32_t)(h >> 32));
}

vec2 sampler_2d(sampler *s)
{
    uint64_t h = hash_mix(s->key, s->dimension);
    s->dimension += 2;
    if (s->dimension > SOBOL_DIMENSIONS) {
        uint64_t r = hash_mix(h, s->index);
        return (vec2){to_unit((uint32_t)r), to_unit((uint32_t)(r >> 32))};
    }
    uint32_t shuffled = owen_scramble(s->index, (uint32_t)h);
    uint32_t scramble = (uint32_t)(h >> 32);
    return (vec2){
        scrambled(shuffled, scramble),
        scrambled(sobol_second_reversed(shuffled), scramble * 0x9e3779b9u + 1u)};
}
