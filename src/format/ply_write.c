/*
 * Meshes as binary PLY.
 */
#include "format/ply_write.h"

#include "base/output.h"

static void write_header(FILE *to, const mesh *m)
{
    fprintf(to,
            "ply\nformat binary_%s_endian 1.0\nelement vertex %zu\nproperty float x\n"
            "property float y\nproperty float z\n",
            G_BYTE_ORDER == G_LITTLE_ENDIAN ? "little" : "big", m->n_vertices);
    if (m->normals)
        fputs("property float nx\nproperty float ny\nproperty float nz\n", to);
    if (m->uvs)
        fputs("property float u\nproperty float v\n", to);
    fprintf(to, "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
            m->n_triangles);
}

bool ply_write(const char *path, const mesh *m, GError **error)
{
    g_autoptr(output) out = output_open(path, error);
    if (!out)
        return false;
    FILE *to = output_stream(out);
    write_header(to, m);
    for (size_t i = 0; i < m->n_vertices; i++) {
        fwrite(m->positions + 3 * i, sizeof(float), 3, to);
        if (m->normals)
            fwrite(m->normals + 3 * i, sizeof(float), 3, to);
        if (m->uvs)
            fwrite(&m->uvs[i], sizeof(float), 2, to);
    }
    for (size_t i = 0; i < m->n_triangles; i++) {
        fputc(3, to);
        fwrite(m->indices + 3 * i, sizeof(uint32_t), 3, to);
    }
    return output_commit(g_steal_pointer(&out), error);
}
