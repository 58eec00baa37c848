#include "bench_mesh.h"

#include "base/memory.h"
#include "base/output.h"
#include "format/ply/ply_write.h"
#include "math/vec.h"

#include <stdio.h>
#include <stdlib.h>

static void give_up(const GError *error)
{
    fprintf(stderr, "bench: %s\n", error->message);
    exit(3);
}

void bench_landscape(float x, float y, float p[3])
{
    p[0] = x;
    p[1] = 0.02f * sinf(40.0f * x) * cosf(31.0f * y);
    p[2] = y;
}

void bench_cave(float x, float y, float p[3])
{
    float around = 2.0f * PI_F * x, down = 0.05f + 0.95f * PI_F * y;
    float r = 1.0f + 0.03f * sinf(40.0f * around) * cosf(31.0f * down);
    p[0] = r * sinf(down) * cosf(around);
    p[1] = r * sinf(down) * sinf(around);
    p[2] = r * cosf(down);
}

mesh bench_mesh_make(size_t triangles, bench_surface surface)
{
    GError *error = NULL;
    uint32_t n = (uint32_t)sqrt(0.5 * (double)triangles), row = n + 1;
    mesh m = {.n_vertices = (size_t)row * row, .n_triangles = 2 * (size_t)n * n};
    m.positions = big_alloc(3 * m.n_vertices + 1, sizeof(float), "mesh", &error);
    m.indices = m.positions
                    ? big_alloc(3 * m.n_triangles, sizeof(uint32_t), "mesh", &error)
                    : NULL;
    if (!m.indices)
        give_up(error);
    for (size_t i = 0; i < m.n_vertices; i++)
        surface((float)(i % row) / (float)n, (float)(i / row) / (float)n,
                &m.positions[3 * i]);
    uint32_t *to = m.indices;
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * row + i;
            const uint32_t quad[6] = {a, a + row, a + 1, a + 1, a + row, a + row + 1};
            for (int k = 0; k < 6; k++)
                *to++ = quad[k];
        }
    return m;
}

void bench_mesh_write(const mesh *m, const char *path)
{
    GError *error = NULL;
    output *out = output_open(path, &error);
    if (out)
        ply_write(out, m);
    if (!out || !output_commit(out, &error))
        give_up(error);
}
