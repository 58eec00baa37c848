#include "shape/mesh_params.h"

#include "base/memory.h"

#include <string.h>

bool mesh_read_numbers(const mesh_words *words, const params *p, const char *name,
                       param_type type, size_t width, size_t *n, float **out,
                       GError **error)
{
    const param *given = params_find(p, name);
    if (!given || given->n == 0)
        return true;
    if (given->type != type) {
        error_at(error, given->place, "\"%s\" of a %s has the wrong type", name,
                 words->shape);
        return false;
    }
    if (given->n % width != 0 || (*n != 0 && given->n != *n * width)) {
        error_at(error, given->place,
                 "\"%s\" has %zu numbers; it needs %zu for each of %zu vertices", name,
                 given->n, width, *n ? *n : given->n / width);
        return false;
    }
    *out = big_alloc(given->n + 1, sizeof(float), "mesh vertices", error);
    if (!*out)
        return false;
    memcpy(*out, given->numbers, given->n * sizeof(float));
    *n = given->n / width;
    return true;
}

bool mesh_read_points(const mesh_words *words, const params *p, size_t *n, float **out,
                      GError **error)
{
    if (!mesh_read_numbers(words, p, "P", PARAM_POINT3, 3, n, out, error))
        return false;
    if (!*out)
        error_at(error, p->place, "a %s needs \"P\"", words->shape);
    return *out != NULL;
}

static bool check_face_indices(const mesh_words *words, const params *p, size_t n_faces,
                               GError **error)
{
    const param *given = params_find(p, "faceIndices");
    if (!given || (given->type == PARAM_INTEGER && given->n == n_faces))
        return true;
    error_at(error, given->place, "\"faceIndices\" needs one integer for each of %zu %ss",
             n_faces, words->face);
    return false;
}

/* How many indices there are, or 0 with an error. */
static size_t count_indices(const mesh_words *words, const params *p, const param *given,
                            size_t n_vertices, GError **error)
{
    source_place place = given ? given->place : p->place;
    size_t n = given ? given->n : words->corners;
    if (given && given->type != PARAM_INTEGER) {
        error_at(error, place, "\"indices\" of a %s must be integers", words->shape);
        return 0;
    }
    if (!given && n_vertices != words->corners) {
        error_at(error, place, "a %s of more than one %s needs \"indices\"", words->shape,
                 words->face);
        return 0;
    }
    if (n == 0 || n % words->corners != 0) {
        error_at(error, place, "a %s needs %s \"indices\" a %s, found %zu", words->shape,
                 words->corners == 3 ? "three" : "four", words->face, n);
        return 0;
    }
    return n;
}

bool mesh_read_indices(const mesh_words *words, const params *p, size_t n_vertices,
                       size_t *n_faces, uint32_t **out, GError **error)
{
    const param *given = params_find(p, "indices");
    size_t n = count_indices(words, p, given, n_vertices, error);
    if (n == 0 || !check_face_indices(words, p, n / words->corners, error))
        return false;
    *out = big_alloc(n, sizeof(uint32_t), "mesh indices", error);
    if (!*out)
        return false;
    *n_faces = n / words->corners;
    for (size_t i = 0; i < n; i++) {
        int index = given ? given->integers[i] : (int)i;
        if (index < 0 || (size_t)index >= n_vertices) {
            error_at(error, given->place,
                     "index %d of %s %zu is out of range: the mesh has %zu vertices",
                     index, words->face, i / words->corners, n_vertices);
            return false;
        }
        (*out)[i] = (uint32_t)index;
    }
    return true;
}
