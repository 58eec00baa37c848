#include "math/sampler.h"

#include <string.h>

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

/* Where what a stream draws in these dimensions was computed ahead, if it draws them as
   was foreseen. NULL: it was not. */
static const float *known(const sampler *s, uint32_t dimension)
{
    return s->ahead && s->dimension == dimension
               ? &s->ahead->number[dimension][s->index - s->ahead->first]
               : NULL;
}

/* The first dimensions that sampler_light, sampler_2d and sampler_scatter draw behind one
   another. */
enum { AHEAD_LIGHT = 0, AHEAD_2D = 4, AHEAD_SCATTER = 6 };

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
    const float *ahead = known(s, AHEAD_2D);
    if (ahead) {
        s->dimension += 2;
        return (vec2){ahead[0], ahead[AHEAD_STREAMS]};
    }
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

/* ---- Four numbers side by side, the same to the bit ---- */

typedef uint8_t bytes16 __attribute__((vector_size(16)));
typedef uint32_t words4 __attribute__((vector_size(16)));
typedef int32_t ints4 __attribute__((vector_size(16)));
typedef float floats4 __attribute__((vector_size(16)));

static words4 reverse_bits4(words4 x)
{
    x = (words4)__builtin_shufflevector((bytes16)x, (bytes16)x, 3, 2, 1, 0, 7, 6, 5, 4,
                                        11, 10, 9, 8, 15, 14, 13, 12);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

static words4 laine_karras4(words4 x, words4 seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static words4 sobol_second_reversed4(words4 x)
{
    x ^= x >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    return x ^ (x & 0xaaaaaaaau) >> 1;
}

/* Each lane by the hash of its dimension; `second` masks the one that is the second of a
   pair and shares its hash with the first. */
static floats4 four_numbers(uint32_t index, const uint64_t hash[4], words4 second)
{
    words4 seed = {(uint32_t)hash[0], (uint32_t)hash[1], (uint32_t)hash[2],
                   (uint32_t)hash[3]};
    words4 scramble = {(uint32_t)(hash[0] >> 32), (uint32_t)(hash[1] >> 32),
                       (uint32_t)(hash[2] >> 32), (uint32_t)(hash[3] >> 32)};
    words4 scramble_second = scramble * 0x9e3779b9u + 1u;
    words4 reversed = (words4){0} + reverse_bits(index);
    words4 shuffled = reverse_bits4(laine_karras4(reversed, seed));
    words4 points = (sobol_second_reversed4(shuffled) & second) | (shuffled & ~second);
    scramble = (scramble_second & second) | (scramble & ~second);
    words4 bits = reverse_bits4(laine_karras4(points, scramble));
    return __builtin_convertvector((ints4)(bits >> 8), floats4) * 0x1p-24f;
}

scatter_numbers sampler_scatter(sampler *s)
{
    uint32_t d = s->dimension;
    const float *u = known(s, AHEAD_SCATTER);
    if (u) {
        enum { NEXT = AHEAD_STREAMS };
        s->dimension += 4;
        return (scatter_numbers){u[0], {u[NEXT], u[2 * NEXT]}, u[3 * NEXT]};
    }
    if (d + 4 > SOBOL_DIMENSIONS) {
        float lobe = sampler_1d(s);
        vec2 direction = sampler_2d(s);
        return (scatter_numbers){lobe, direction, sampler_1d(s)};
    }
    s->dimension += 4;
    uint64_t pair = hash_mix(s->key, d + 1);
    const uint64_t hash[4] = {hash_mix(s->key, d), pair, pair, hash_mix(s->key, d + 3)};
    floats4 four = four_numbers(s->index, hash, (words4){0, 0, ~0u, 0});
    return (scatter_numbers){four[0], {four[1], four[2]}, four[3]};
}

light_numbers sampler_light(sampler *s)
{
    uint32_t d = s->dimension;
    const float *u = known(s, AHEAD_LIGHT);
    if (u) {
        enum { NEXT = AHEAD_STREAMS };
        s->dimension += 4;
        return (light_numbers){u[0], u[NEXT], {u[2 * NEXT], u[3 * NEXT]}};
    }
    if (d + 4 > SOBOL_DIMENSIONS) {
        float light = sampler_1d(s), primitive = sampler_1d(s);
        return (light_numbers){light, primitive, sampler_2d(s)};
    }
    s->dimension += 4;
    uint64_t pair = hash_mix(s->key, d + 2);
    const uint64_t hash[4] = {hash_mix(s->key, d), hash_mix(s->key, d + 1), pair, pair};
    floats4 four = four_numbers(s->index, hash, (words4){0, 0, 0, ~0u});
    return (light_numbers){four[0], four[1], {four[2], four[3]}};
}

/* ---- Streams side by side, the same to the bit ---- */

typedef uint32_t words16 __attribute__((vector_size(4 * AHEAD_STREAMS)));
typedef int32_t ints16 __attribute__((vector_size(4 * AHEAD_STREAMS)));
typedef float floats16 __attribute__((vector_size(4 * AHEAD_STREAMS)));

static inline words16 reverse_bits16(words16 x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

static inline words16 laine_karras16(words16 x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static inline words16 sobol_second_reversed16(words16 x)
{
    x ^= x >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    return x ^ (x & 0xaaaaaaaau) >> 1;
}

static inline void scrambled16(words16 reversed, uint32_t seed, float to[AHEAD_STREAMS])
{
    words16 bits = reverse_bits16(laine_karras16(reversed, seed));
    floats16 u = __builtin_convertvector((ints16)(bits >> 8), floats16) * 0x1p-24f;
    memcpy(to, &u, sizeof u);
}

void sampler_look_ahead(const sampler *s, sampler_ahead *out)
{
    static const bool is_pair[AHEAD_DIMENSIONS] = {[2] = true, [4] = true, [7] = true};
    words16 index = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const words16 reversed = reverse_bits16(index + s->index);
    out->key = s->key;
    out->first = s->index;
    for (uint32_t d = 0; d < AHEAD_DIMENSIONS; d++) {
        uint64_t h = hash_mix(s->key, d);
        uint32_t scramble = (uint32_t)(h >> 32);
        words16 shuffled = reverse_bits16(laine_karras16(reversed, (uint32_t)h));
        scrambled16(shuffled, scramble, out->number[d]);
        if (is_pair[d])
            scrambled16(sobol_second_reversed16(shuffled), scramble * 0x9e3779b9u + 1u,
                        out->number[++d]);
    }
}
