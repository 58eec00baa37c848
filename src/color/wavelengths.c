/*
 * The eight wavelengths of a pass.
 *
 * The offset of a pass is van der Corput's sequence, rotated by a hash of the seed: any
 * 2^k passes from the first are exactly 8 * 2^k equidistant wavelengths. Where a scene
 * asks for more of some wavelengths, the same numbers run through the inverse of the
 * cumulative density.
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

float wavelength_offset(uint64_t seed, uint32_t pass)
{
    uint32_t shift = (uint32_t)(hash_mix(seed, 0x77617665u) >> 32);
    uint32_t bits = reverse_bits(pass) + shift;
    return (float)(bits >> 8) * 0x1p-24f;
}

wavelengths wavelengths_for_pass(uint64_t seed, uint32_t pass)
{
    return wavelengths_at(wavelength_offset(seed, pass));
}

wavelengths wavelengths_at(float offset)
{
    const observer *o = observer_get();
    const float range = LAMBDA_MAX - LAMBDA_MIN, stratum = range / N_WAVELENGTHS;
    wavelengths w;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        w.lambda[i] = LAMBDA_MIN + ((float)i + offset) * stratum;
    for (int i = 0; i < 3; i++)
        w.xyz[i] = range * grid_eval(o->folded[i], w.lambda);
    return w;
}

wavelength_density wavelength_density_of(const double weights[WAVELENGTH_CELLS])
{
    wavelength_density d;
    double total = 0.0, sum = 0.0;
    for (int i = 0; i < WAVELENGTH_CELLS; i++)
        total += weights[i];
    for (int i = 0; i < WAVELENGTH_CELLS; i++) {
        d.cumulative[i] = (float)(sum / total);
        sum += weights[i];
    }
    d.cumulative[WAVELENGTH_CELLS] = 1.0f;
    return d;
}

/* The cell that u in [0, 1) falls into. */
static int cell_at(const wavelength_density *d, float u)
{
    int low = 0, high = WAVELENGTH_CELLS;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (d->cumulative[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

wavelengths wavelengths_drawn(const wavelength_density *d, float offset)
{
    const float cell = (LAMBDA_MAX - LAMBDA_MIN) / WAVELENGTH_CELLS;
    const observer *o = observer_get();
    wavelengths w;
    spectrum part;
    if (!d)
        return wavelengths_at(offset);
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        float u = ((float)i + offset) / N_WAVELENGTHS;
        int at = cell_at(d, u);
        part[i] = d->cumulative[at + 1] - d->cumulative[at];
        float t = (u - d->cumulative[at]) / part[i];
        w.lambda[i] = LAMBDA_MIN + ((float)at + t) * cell;
    }
    for (int i = 0; i < 3; i++)
        w.xyz[i] = cell / part * grid_eval(o->folded[i], w.lambda);
    return w;
}

void spectrum_to_xyz(const wavelengths *w, spectrum radiance, float xyz[3])
{
    for (int i = 0; i < 3; i++)
        xyz[i] = spectrum_mean(w->xyz[i] * radiance);
}
