/*
 * Meshes as binary PLY.
 */
#include "format/ply/ply_write.h"

#include <string.h>

/* What is written of a vertex, as ply.c reads it. */
typedef struct column {
    const float *from;
    size_t width;
    const char *names[4];
} column;

enum { N_COLUMNS = 6 };

static void list_columns(const mesh *m, column columns[N_COLUMNS])
{
    const column all[N_COLUMNS] = {
        {m->positions, 3, {"x", "y", "z"}},
        {m->normals, 3, {"nx", "ny", "nz"}},
        {(const float *)m->uvs, 2, {"u", "v"}},
        {(const float *)m->uvs2, 2, {"u2", "v2"}},
        {m->tangents, 3, {"tx", "ty", "tz"}},
        {m->colors, 4, {"color_r", "color_g", "color_b", "color_a"}},
    };
    memcpy(columns, all, sizeof all);
}

static void write_header(FILE *to, const mesh *m, const column columns[N_COLUMNS])
{
    fprintf(to, "ply\nformat binary_%s_endian 1.0\nelement vertex %zu\n",
            G_BYTE_ORDER == G_LITTLE_ENDIAN ? "little" : "big", m->n_vertices);
    for (int c = 0; c < N_COLUMNS; c++)
        for (size_t k = 0; columns[c].from && k < columns[c].width; k++)
            fprintf(to, "property float %s\n", columns[c].names[k]);
    fprintf(to, "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
            m->n_triangles);
}

void ply_write(output *out, const mesh *m)
{
    FILE *to = output_stream(out);
    column columns[N_COLUMNS];
    list_columns(m, columns);
    write_header(to, m, columns);
    for (size_t i = 0; i < m->n_vertices; i++)
        for (int c = 0; c < N_COLUMNS; c++)
            if (columns[c].from)
                fwrite(columns[c].from + i * columns[c].width, sizeof(float),
                       columns[c].width, to);
    for (size_t i = 0; i < m->n_triangles; i++) {
        fputc(3, to);
        fwrite(m->indices + 3 * i, sizeof(uint32_t), 3, to);
    }
}
