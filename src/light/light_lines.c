#include "light/light_lines.h"

/* Times the mean of a spectrum: what exceeds it is a line. Colours are below it, be they
   as pure as a colour space has them. */
#define SMOOTH 8.0

/* The light's power at the middle of every cell. @return the mean */
static double measure(const light *l, double power[WAVELENGTH_CELLS])
{
    double sum = 0.0;
    for (int k = 0; k < CELLS_PER_STRATUM; k++) {
        const wavelengths w = wavelengths_at(((float)k + 0.5f) / CELLS_PER_STRATUM);
        spectrum here = l->kind->power(l->self, &w);
        for (int i = 0; i < N_WAVELENGTHS; i++) {
            power[i * CELLS_PER_STRATUM + k] = (double)here[i];
            sum += (double)here[i];
        }
    }
    return sum / WAVELENGTH_CELLS;
}

static void add_lines(const double power[WAVELENGTH_CELLS], double mean,
                      light_lines *lines)
{
    bool any = false;
    for (int i = 0; i < WAVELENGTH_CELLS; i++) {
        double excess = fmax(power[i] / mean - SMOOTH, 0.0);
        lines->excess[i] += excess;
        any |= excess > 0.0;
    }
    lines->n += any;
}

/* The eighth part of all cells, one in each stratum, that tells most of the light. */
static int brightest_offset(const double power[WAVELENGTH_CELLS], double *mean)
{
    int best = CELLS_PER_STRATUM / 2;
    *mean = 0.0;
    for (int n = 0; n < CELLS_PER_STRATUM; n++) {
        int k = (CELLS_PER_STRATUM / 2 + n) % CELLS_PER_STRATUM;
        double sum = 0.0;
        for (int i = 0; i < N_WAVELENGTHS; i++)
            sum += power[i * CELLS_PER_STRATUM + k];
        if (sum / N_WAVELENGTHS > *mean) {
            *mean = sum / N_WAVELENGTHS;
            best = k;
        }
    }
    return best;
}

/* A bound is in proportion to the spectrum. */
static light_bound measure_bound(const light *l, const double power[WAVELENGTH_CELLS],
                                 double mean)
{
    double there;
    int k = brightest_offset(power, &there);
    const wavelengths w = wavelengths_at(((float)k + 0.5f) / CELLS_PER_STRATUM);
    light_bound bound = l->kind->bound(l->self, &w);
    float scale = there > 0.0 ? (float)(mean / there) : 0.0f;
    bound.power *= scale;
    bound.irradiance *= scale;
    return bound;
}

light_strength light_measure(const light *l, light_lines *lines)
{
    double power[WAVELENGTH_CELLS], mean = measure(l, power);
    if (lines && mean > 0.0 && isfinite(mean))
        add_lines(power, mean, lines);
    return (light_strength){.power = (float)mean, .bound = measure_bound(l, power, mean)};
}

/* Half of all wavelengths, at most, go to lines: a light without any is still seen well.
 */
wavelength_density *light_lines_density(const light_lines *lines)
{
    double weights[WAVELENGTH_CELLS];
    if (lines->n == 0)
        return NULL;
    for (int i = 0; i < WAVELENGTH_CELLS; i++)
        weights[i] = 1.0 + lines->excess[i] / lines->n;
    wavelength_density d = wavelength_density_of(weights);
    return g_memdup2(&d, sizeof d);
}
