/*
 * Smooth curves of texels, by look-up, and the sigmoid at eight wavelengths.
 */
#include "color/fit.h"
#include "color/table.h"
#include "math/vec.h"

#include <string.h>

/* A place between two neighbouring nodes. */
typedef struct table_place {
    int cell;
    float t;
} table_place;

static table_place find(const float *nodes, int n, float x)
{
    int below = 0;
    for (int i = 1; i < n - 1; i++)
        below += nodes[i] <= x;
    return (table_place){below, (x - nodes[below]) / (nodes[below + 1] - nodes[below])};
}

void smooth_from_rgb(const color_space *space, const float rgb[3], float coefficients[3])
{
    float c[3];
    for (int i = 0; i < 3; i++)
        c[i] = rgb[i] > 0.0f ? minf(rgb[i], 1.0f) : 0.0f;
    if (smooth_is_grey(c)) {
        smooth_solve(space, c, coefficients);
        return;
    }
    int m = c[0] >= c[1] ? (c[0] >= c[2] ? 0 : 2) : (c[1] >= c[2] ? 1 : 2);
    table_place z = find(smooth_table_z, TABLE_Z, c[m]);
    table_place x = find(smooth_table_xy, TABLE_XY, c[(m + 1) % 3] / c[m]);
    table_place y = find(smooth_table_xy, TABLE_XY, c[(m + 2) % 3] / c[m]);
    memset(coefficients, 0, 3 * sizeof *coefficients);
    for (int corner = 0; corner < 8; corner++) {
        int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        float weight =
            (i ? x.t : 1.0f - x.t) * (j ? y.t : 1.0f - y.t) * (k ? z.t : 1.0f - z.t);
        const float *node =
            smooth_table[space->index][m][z.cell + k][y.cell + j][x.cell + i];
        for (int n = 0; n < 3; n++)
            coefficients[n] += weight * node[n];
    }
}

spectrum smooth_eval(const float coefficients[3], const wavelengths *w)
{
    spectrum t = (w->lambda - SMOOTH_CENTER) * (1.0f / SMOOTH_HALF);
    spectrum p = (coefficients[0] * t + coefficients[1]) * t + coefficients[2];
    return 0.5f + 0.5f * p / spectrum_sqrt(1.0f + p * p);
}
