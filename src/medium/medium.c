/*
 * Beer-Lambert's law.
 */
#include "medium/medium.h"

#include <math.h>

static spectrum coefficient(const medium *m, const curve *c, const wavelengths *w)
{
    return c ? curve_eval(c, w) * m->scale : (spectrum){0};
}

spectrum medium_scattering(const medium *m, const wavelengths *w)
{
    return coefficient(m, m->scattering, w);
}

spectrum medium_extinction(const medium *m, const wavelengths *w)
{
    return coefficient(m, m->absorption, w) + coefficient(m, m->scattering, w);
}

spectrum medium_transmittance(const medium *m, float t, const wavelengths *w)
{
    spectrum out = spectrum_fill(1.0f);
    if (!m)
        return out;
    if (m->absorption || m->scattering)
        out = transmittance_after(medium_extinction(m, w), t);
    if (m->color) {
        spectrum color = curve_eval(m->color, w);
        for (int i = 0; i < N_WAVELENGTHS; i++)
            out[i] *= powf(color[i], t / m->distance);
    }
    return out;
}
