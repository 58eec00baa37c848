/*
 * The eight wavelengths of a pass.
 *
 * The offset of a pass is van der Corput's sequence, rotated by a hash of the seed: any
 * 2^k passes from the first are exactly 8 * 2^k equidistant wavelengths.
 */
#include "color/wavelengths.h"

#include "color/observer.h"
#include "math/sampler.h"

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

wavelengths wavelengths_for_pass(uint64_t seed, uint32_t pass)
{
    uint32_t shift = (uint32_t)(hash_mix(seed, 0x77617665u) >> 32);
    uint32_t bits = reverse_bits(pass) + shift;
    return wavelengths_at((float)(bits >> 8) * 0x1p-24f);
}

wavelengths wavelengths_at(float offset)
{
    const observer *o = observer_get();
    const float range = LAMBDA_MAX - LAMBDA_MIN, stratum = range / N_LANES;
    wavelengths w;
    for (int i = 0; i < N_LANES; i++)
        w.lambda[i] = LAMBDA_MIN + ((float)i + offset) * stratum;
    for (int i = 0; i < 3; i++)
        w.xyz[i] = range * grid_eval(o->folded[i], w.lambda);
    return w;
}

void spectrum_to_xyz(const wavelengths *w, spectrum radiance, float xyz[3])
{
    for (int i = 0; i < 3; i++)
        xyz[i] = spectrum_mean(w->xyz[i] * radiance);
}
