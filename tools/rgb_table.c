/*
 * Makes the table of smooth curves (src/color/table.h) at build time:
 *
 *   rgb_table OUTPUT.S
 *
 * The output is assembler, because compilers take many seconds over a million numbers in
 * C and assemblers do not. A column of the table (one hue and saturation, all values of
 * the largest component) is solved from its middle outwards, each node starting from the
 * one before.
 */
#include "color/fit.h"
#include "color/table.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static float nodes_z[TABLE_Z], nodes_xy[TABLE_XY];
static float table[N_COLOR_SPACES][3][TABLE_Z][TABLE_XY][TABLE_XY][3];

static double smoothstep(double x)
{
    return x * x * (3.0 - 2.0 * x);
}

static void make_nodes(void)
{
    for (int i = 0; i < TABLE_Z; i++)
        nodes_z[i] = (float)smoothstep(smoothstep((double)i / (TABLE_Z - 1)));
    for (int i = 0; i < TABLE_XY; i++)
        nodes_xy[i] = (float)smoothstep((double)i / (TABLE_XY - 1));
}

/* One node; c holds its neighbour's coefficients and takes its own. */
static void solve_node(int space, const int node[4], double c[3])
{
    int m = node[0], z = node[1], y = node[2], x = node[3];
    double value = (double)nodes_z[z], rgb[3];
    rgb[m] = value;
    rgb[(m + 1) % 3] = value * (double)nodes_xy[x];
    rgb[(m + 2) % 3] = value * (double)nodes_xy[y];
    if (x == TABLE_XY - 1 && y == TABLE_XY - 1) {
        c[0] = c[1] = 0.0;
        c[2] = smooth_inverse(value);
    } else {
        smooth_fit(color_space_at(space), rgb, SMOOTH_TABLE_STIFFNESS, c);
    }
    for (int k = 0; k < 3; k++)
        table[space][m][z][y][x][k] = (float)c[k];
}

/* Black and white themselves need infinite coefficients; their neighbours' serve, since
 * the first step of z is 6e-6. */
static void copy_ends(int space, const int node[4])
{
    int m = node[0], y = node[2], x = node[3];
    const size_t size = sizeof table[space][m][0][y][x];
    memcpy(table[space][m][0][y][x], table[space][m][1][y][x], size);
    memcpy(table[space][m][TABLE_Z - 1][y][x], table[space][m][TABLE_Z - 2][y][x], size);
}

static void solve_column(int space, int m, int y, int x)
{
    const int middle = TABLE_Z / 2;
    double c[3] = {0}, start[3];
    int node[4] = {m, middle, y, x};
    solve_node(space, node, c);
    memcpy(start, c, sizeof c);
    for (node[1] = middle + 1; node[1] < TABLE_Z - 1; node[1]++)
        solve_node(space, node, c);
    memcpy(c, start, sizeof c);
    for (node[1] = middle - 1; node[1] > 0; node[1]--)
        solve_node(space, node, c);
    copy_ends(space, node);
}

static void write_floats(FILE *file, const char *name, const float *values, size_t n)
{
    fprintf(file, ".globl %s\n.hidden %s\n.balign 64\n%s:\n", name, name, name);
    for (size_t i = 0; i < n; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        fprintf(file, "%s0x%x%s", i % 8 ? "," : ".long ", bits,
                i % 8 == 7 || i + 1 == n ? "\n" : "");
    }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: rgb_table OUTPUT.S\n");
        return EXIT_FAILURE;
    }
    make_nodes();
    for (int space = 0; space < N_COLOR_SPACES; space++)
        for (int m = 0; m < 3; m++)
            for (int y = 0; y < TABLE_XY; y++)
                for (int x = 0; x < TABLE_XY; x++)
                    solve_column(space, m, y, x);
    fprintf(file, ".section .rodata\n");
    write_floats(file, "smooth_table_z", nodes_z, TABLE_Z);
    write_floats(file, "smooth_table_xy", nodes_xy, TABLE_XY);
    write_floats(file, "smooth_table", &table[0][0][0][0][0][0],
                 sizeof table / sizeof(float));
    fprintf(file, ".section .note.GNU-stack,\"\",%%progbits\n");
    return fclose(file) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
