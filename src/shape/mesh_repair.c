#include "shape/mesh_repair.h"

static bool is_finite(const float *numbers, size_t width)
{
    float sum = 0.0f;
    for (size_t i = 0; i < width; i++)
        sum += 0.0f * numbers[i]; /* NaN of what is not finite */
    return isfinite(sum);
}

static void drop(float *numbers, size_t n, size_t width, const char *what,
                 source_place place, const log_sink *log)
{
    size_t n_bad = 0;
    for (size_t i = 0; numbers && i < n; i++) {
        if (is_finite(numbers + i * width, width))
            continue;
        n_bad++;
        for (size_t k = 0; k < width; k++)
            numbers[i * width + k] = 0.0f;
    }
    if (n_bad)
        log_at(log, LOG_NOTE, place,
               "%zu of %zu %s of the mesh are no numbers and left out", n_bad, n, what);
}

void mesh_drop_bad(mesh *m, source_place place, const log_sink *log)
{
    drop(m->normals, m->n_vertices, 3, "normals", place, log);
    drop(m->tangents, m->n_vertices, 3, "tangents", place, log);
    drop((float *)(void *)m->uvs, m->n_vertices, 2, "texture coordinates", place, log);
    drop((float *)(void *)m->uvs2, m->n_vertices, 2, "second texture coordinates", place,
         log);
}
