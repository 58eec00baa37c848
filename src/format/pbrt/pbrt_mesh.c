/*
 * Meshes whose arrays do not fit together. pbrt tells of them and goes on: normals,
 * tangents and texture coordinates that are not one a vertex are left out, corners that
 * make no face too, and a mesh that names vertices it does not have is not seen.
 */
#include "format/pbrt/pbrt_parser.h"

#include <string.h>

/* Corners of a face; 0: the kind is no mesh of arrays. */
static size_t corners_of(const char *kind)
{
    if (strcmp(kind, "trianglemesh") == 0 || strcmp(kind, "loopsubdiv") == 0)
        return 3;
    return strcmp(kind, "bilinearmesh") == 0 ? 4 : 0;
}

/* Leaves out what is not one a vertex. pbrt-v3 takes more texture coordinates. */
static void fit_numbers(pbrt_parser *parser, params *p, const char *name, size_t width,
                        size_t n_vertices)
{
    param *q = params_look_up(p, name);
    if (!q || q->n == width * n_vertices)
        return;
    if (parser->is_v3 && width == 2 && q->n > 2 * n_vertices) {
        q->n = 2 * n_vertices;
        return;
    }
    pbrt_warning(parser, q->place, "'%s' of %zu vertices are left out: the mesh has %zu",
                 name, q->n / width, n_vertices);
    params_remove(p, name);
}

static void fit_corners(pbrt_parser *parser, params *p, param *q, size_t corners)
{
    size_t over = q->n % corners;
    if (over > 0 && over < q->n)
        pbrt_warning(parser, q->place, "the last %zu of %zu indices make no face", over,
                     q->n);
    if (over < q->n)
        q->n -= over;
    const param *faces = params_look_up(p, "faceIndices");
    if (!faces || faces->n == q->n / corners)
        return;
    pbrt_warning(parser, faces->place,
                 "'faceIndices' of %zu faces are left out: the mesh has %zu", faces->n,
                 q->n / corners);
    params_remove(p, "faceIndices");
}

/* The first index that no vertex has; -1 is no index. */
static bool has_all(const param *indices, size_t n_vertices, int *missing)
{
    for (size_t i = 0; i < indices->n; i++)
        if (indices->integers[i] < 0 || (size_t)indices->integers[i] >= n_vertices) {
            *missing = indices->integers[i];
            return false;
        }
    return true;
}

static bool leave_out(pbrt_parser *parser, source_place at, const char *why)
{
    pbrt_warning(parser, at, "a mesh %s is not seen", why);
    return false;
}

bool pbrt_fit_mesh(pbrt_parser *parser, const directive_arguments *a)
{
    size_t corners = corners_of(a->kind);
    const param *points = params_look_up(a->p, "P");
    param *indices = params_look_up(a->p, "indices");
    if (corners == 0 || (points && points->type != PARAM_POINT3) ||
        (indices && indices->type != PARAM_INTEGER))
        return true;
    if (!points)
        return leave_out(parser, a->at, "without 'P'");
    size_t n_vertices = points->n / 3;
    bool is_face = n_vertices == corners && !parser->is_v3;
    if (!indices && !is_face)
        return leave_out(parser, a->at, "without 'indices'");
    fit_numbers(parser, a->p, "uv", 2, n_vertices);
    fit_numbers(parser, a->p, "N", 3, n_vertices);
    fit_numbers(parser, a->p, "S", 3, n_vertices);
    if (!indices)
        return true;
    fit_corners(parser, a->p, indices, corners);
    int missing;
    if (has_all(indices, n_vertices, &missing))
        return true;
    g_autofree char *why =
        g_strdup_printf("that names vertex %d of %zu", missing, n_vertices);
    return leave_out(parser, indices->place, why);
}
