/*
 * The table of smooth curves, by RGB space: made at build time by tools/rgb_table.c, laid
 * out as Jakob & Hanika (2019) do.
 *
 *   smooth_table[space][m][z][y][x] = c0, c1, c2
 *
 * m is the largest of the three components, z its value, x and y the next two components
 * divided by z. Nodes crowd where the coefficients bend: z toward black and white, x and
 * y toward primaries and greys.
 */
#pragma once

#include "color/space.h"

enum { TABLE_Z = 48, TABLE_XY = 24 };

extern const float smooth_table[N_COLOR_SPACES][3][TABLE_Z][TABLE_XY][TABLE_XY][3];
extern const float smooth_table_z[TABLE_Z];   /**< from 0 to 1 */
extern const float smooth_table_xy[TABLE_XY]; /**< from 0 to 1 */
