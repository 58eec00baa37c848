/*
 * Random streams keyed by (seed, pass, who, dimension): the same key gives the same
 * number on any thread, machine and number of processors.
 *
 * The first dimensions of a stream are Owen-scrambled Sobol points, drawn in pairs: the
 * stream's index runs over samples of a pixel or photons of a pass, so those fill the
 * unit square evenly. Later dimensions, where stratification no longer pays, are hashed.
 *
 *   key ── hash(seed, pass, stream): one scramble per pixel or per photon class
 *   index ── sample or photon number: the point of the Sobol sequence
 *   dimension ── grows with every draw; each pair is shuffled and scrambled on its own
 *
 * Burley, "Practical Hash-based Owen Scrambling", JCGT 2020.
 */
#pragma once

#include "math/vec.h"

#include <stdint.h>

/** @brief One stream. Plain value: copy it to branch, the copies then draw the same
 * numbers unless sampler_split gives one a new key. */
typedef struct sampler {
    uint64_t key;
    uint32_t index;
    uint32_t dimension;
    const struct sampler_ahead *ahead; /**< borrowed; NULL: nothing is known ahead */
} sampler;

/** @brief A well-mixed 64-bit hash of two words (used to build keys). */
static inline uint64_t hash_mix(uint64_t a, uint64_t b)
{
    uint64_t x = a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2));
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/** @brief The stream of point `index` in the set named by key. */
static inline sampler sampler_make(uint64_t key, uint64_t index)
{
    return (sampler){.key = hash_mix(key, index >> 32), .index = (uint32_t)index};
}

/** @brief A stream of its own, independent of s; draws nothing from s. Branch number i.
 */
static inline sampler sampler_split(const sampler *s, uint32_t branch)
{
    uint64_t key = hash_mix(s->key, ((uint64_t)branch << 32) | (s->dimension + 1u));
    return (sampler){.key = hash_mix(key, 0x5bd1e995u), .index = s->index};
}

/** @brief Uniform in [0, 1). */
float sampler_1d(sampler *s);

/** @brief Uniform in [0, 1)², the two coordinates stratified together. */
vec2 sampler_2d(sampler *s);

/** @brief The numbers of a scattering. */
typedef struct scatter_numbers {
    float lobe;
    vec2 direction;
    float roulette;
} scatter_numbers;

/** @brief What sampler_1d, sampler_2d and sampler_1d give in turn, computed side by side:
 * at less than half the price. */
scatter_numbers sampler_scatter(sampler *s);

/** @brief The numbers that choose a light and a point on it. */
typedef struct light_numbers {
    float light, primitive;
    vec2 place;
} light_numbers;

/** @brief What sampler_1d, sampler_1d and sampler_2d give in turn, as above. */
light_numbers sampler_light(sampler *s);

/** @brief The first numbers of neighbouring streams, computed side by side: what
 * sampler_light, sampler_2d and sampler_scatter give in turn. */
enum { AHEAD_STREAMS = 16, AHEAD_DIMENSIONS = 10 };
typedef struct sampler_ahead {
    _Alignas(64) float number[AHEAD_DIMENSIONS][AHEAD_STREAMS];
    uint64_t key;
    uint32_t first; /**< index of the first stream */
} sampler_ahead;

/** @brief Computes those of s and of the streams behind it. */
void sampler_look_ahead(const sampler *s, sampler_ahead *out);

/** @brief Lets a stream use them, if it is one of those and has drawn nothing yet. */
static inline void sampler_use_ahead(sampler *s, const sampler_ahead *ahead)
{
    if (s->key == ahead->key && s->index - ahead->first < AHEAD_STREAMS)
        s->ahead = ahead;
}
