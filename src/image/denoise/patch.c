#include "image/denoise/patch.h"

/* Numbers of a row that patches of a block reach over, in whole vectors. */
enum { ACROSS = (BLOCK + 2 * PATCH + LANES - 1) / LANES };

/* Squared differences, summed over columns of patches. */
static void sum_columns(const patch_source *s, size_t at, ptrdiff_t offset,
                        float *columns)
{
    for (int i = 0; i < ACROSS; i++) {
        floats8 sum = {0};
        for (int c = 0; c < s->n_channels; c++) {
            const float *p = s->value[c] + at + LANES * i;
            for (int v = -PATCH; v <= PATCH; v++) {
                const float *row = p + v * (ptrdiff_t)s->g->stride;
                floats8 difference = load8(row) - load8(row + offset);
                sum += difference * difference;
            }
        }
        store8(columns + LANES * i, sum);
    }
}

void patch_distances(const patch_source *s, int x, int y, int dx, int dy, float *d)
{
    float columns[ACROSS * LANES];
    ptrdiff_t offset = dy * (ptrdiff_t)s->g->stride + dx;
    sum_columns(s, plane_at(s->g, x - PATCH, y), offset, columns);
    const float *noise = s->noise + plane_at(s->g, x, y);
    for (int i = 0; i < BLOCK; i += LANES) {
        floats8 sum = {0};
        for (int u = 0; u <= 2 * PATCH; u++)
            sum += load8(columns + i + u);
        floats8 here = load8(noise + i), there = load8(noise + i + offset);
        floats8 beyond = max8(sum - (here + min8(here, there)), fill8(0.0f));
        store8(d + i, beyond / (here + there + s->least));
    }
}
