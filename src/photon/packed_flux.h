/*
 * Flux in 24 bytes: floats without their last byte. They are rounded up or down by
 * chance, so that each is right on average: a wavelength of one photon is off by at most
 * one part in 32768, the sum of n photons by some 1e-5/√n, hardly more than it is by
 * adding floats. That is what a map keeps, in which a photon is one of many; whoever asks
 * for photons themselves is given those that were traced.
 */
#pragma once

#include "color/spectrum.h"

#include <stdint.h>
#include <string.h>

#ifdef __AVX2__
#include <immintrin.h>
#endif

typedef struct packed_flux {
    uint8_t bytes[3 * N_WAVELENGTHS]; /**< of each float the lowest first */
} packed_flux;

typedef uint64_t flux_pairs __attribute__((vector_size(4 * N_WAVELENGTHS)));
typedef uint32_t flux_bits __attribute__((vector_size(4 * N_WAVELENGTHS)));

/** @param chance random bits, eight for each wavelength */
static inline void flux_pack(spectrum flux, uint64_t chance, packed_flux *packed)
{
    const uint32_t first = (uint32_t)chance, last = (uint32_t)(chance >> 32);
    flux_bits up = {first, first, first, first, last, last, last, last};
    up >>= (flux_bits){0, 8, 16, 24, 0, 8, 16, 24};
    flux_bits bits = ((flux_bits)flux + (up & 0xff)) >> 8;
    for (int i = 0; i < N_WAVELENGTHS; i += 2) {
        uint64_t pair = bits[i] | (uint64_t)bits[i + 1] << 24;
        memcpy(packed->bytes + 3 * i, &pair, 6);
    }
}

/** @brief The scalar twin of flux_unpack. */
static inline spectrum flux_unpack_scalar(const packed_flux *packed)
{
    spectrum flux;
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        const uint8_t *b = packed->bytes + 3 * i;
        uint32_t bits = (uint32_t)b[0] << 8 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 24;
        float value;
        memcpy(&value, &bits, sizeof value);
        flux[i] = value;
    }
    return flux;
}

/** @brief Eight bytes behind may be read, too. */
static inline spectrum flux_unpack(const packed_flux *packed)
{
#if defined(__AVX512VBMI__) && defined(__AVX512VL__)
    const __m256i bytes =
        _mm256_setr_epi8(0, 0, 1, 2, 0, 3, 4, 5, 0, 6, 7, 8, 0, 9, 10, 11, 0, 12, 13, 14,
                         0, 15, 16, 17, 0, 18, 19, 20, 0, 21, 22, 23);
    __m256i all = _mm256_loadu_si256((const __m256i *)packed->bytes);
    return (spectrum)_mm256_maskz_permutexvar_epi8(0xeeeeeeeeu, bytes, all);
#elif defined(__AVX2__)
    const __m256i bytes =
        _mm256_setr_epi8(-1, 0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11, -1, 0, 1,
                         2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11);
    __m128i low = _mm_loadu_si128((const __m128i *)packed->bytes);
    __m128i high = _mm_loadu_si128((const __m128i *)(packed->bytes + 12));
    return (spectrum)_mm256_shuffle_epi8(_mm256_set_m128i(high, low), bytes);
#else
    flux_pairs pairs;
    for (int i = 0; i < N_WAVELENGTHS / 2; i++) {
        uint64_t pair;
        memcpy(&pair, packed->bytes + 6 * i, sizeof pair);
        pairs[i] = pair;
    }
    const uint64_t first = 0xffffff00u, second = first << 32;
    return (spectrum)((pairs << 8 & first) | (pairs << 16 & second));
#endif
}
