/*
 * Functions of wavelength on whole nanometres.
 */
#include "color/grid.h"

float grid_at(const float grid[GRID_N], float nm)
{
    float x = nm - (float)GRID_FIRST;
    if (!(x >= 0.0f && x <= (float)(GRID_N - 1)))
        return 0.0f;
    int i = (int)x;
    if (i > GRID_N - 2)
        i = GRID_N - 2;
    float t = x - (float)i;
    return (1.0f - t) * grid[i] + t * grid[i + 1];
}

spectrum grid_eval(const float grid[GRID_N], spectrum lambda)
{
    typedef int wavelengths __attribute__((vector_size(32)));
    spectrum x = lambda - spectrum_fill((float)GRID_FIRST), low, high;
    wavelengths cell = __builtin_convertvector(x, wavelengths);
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        low[i] = grid[cell[i]];
        high[i] = grid[cell[i] + 1];
    }
    spectrum t = x - __builtin_convertvector(cell, spectrum);
    return low + t * (high - low);
}

double grid_integrate(const float a[GRID_N], const float b[GRID_N], int first, int last)
{
    double sum = 0.0;
    for (int i = first - GRID_FIRST; i < last - GRID_FIRST; i++) {
        double a0 = (double)a[i], a1 = (double)a[i + 1];
        double b0 = (double)b[i], b1 = (double)b[i + 1];
        sum += (a0 * b0 + (a0 + a1) * (b0 + b1) + a1 * b1) / 6.0;
    }
    return sum;
}

void grid_from_table(const float *values, int n, int first, int step, float grid[GRID_N])
{
    for (int i = 0; i < GRID_N; i++) {
        float x = (float)(GRID_FIRST + i - first) / (float)step;
        int cell = x <= 0.0f ? 0 : (int)x < n - 2 ? (int)x : n - 2;
        float t = x - (float)cell;
        t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
        grid[i] = (1.0f - t) * values[cell] + t * values[cell + 1];
    }
}

void grid_scale(float grid[GRID_N], float factor)
{
    for (int i = 0; i < GRID_N; i++)
        grid[i] *= factor;
}
