/*
 * Where the nodes of a glTF file stand: each has a matrix of its own, relative to its
 * parent's. Joints may be flattened, which hides what hangs on them, so that matrices are
 * kept apart from transforms, which have inverses.
 */
#include "format/gltf/gltf_animation.h"

#include <math.h>
#include <string.h>

typedef double matrix[4][4];

/* What is flattened along an axis, as planes often are, keeps this share of its
 * thickness, so that it can be seen. */
#define FLAT 1e-6

static void multiply(const matrix a, const matrix b, matrix out)
{
    matrix product;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            product[i][j] = 0.0;
            for (int k = 0; k < 4; k++)
                product[i][j] += a[i][k] * b[k][j];
        }
    memcpy(out, product, sizeof product);
}

/* Move times turn times scale. */
static void compose(const double t[3], const double q[4], const double s[3], matrix out)
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double k = length > 0.0 ? 1.0 / length : 0.0;
    double x = k * q[0], y = k * q[1], z = k * q[2], w = length > 0.0 ? k * q[3] : 1.0;
    const double turn[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
        {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
        {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)},
    };
    double most = fmax(fabs(s[0]), fmax(fabs(s[1]), fabs(s[2])));
    memset(out, 0, sizeof(matrix));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out[i][j] = turn[i][j] * (fabs(s[j]) > 0.0 ? s[j] : FLAT * most);
        out[i][3] = t[i];
    }
    out[3][3] = 1.0;
}

bool gltf_transform(const double t[3], const double q[4], const double s[3],
                    transform *out)
{
    matrix m;
    compose(t, q, s, m);
    return transform_from_matrix((const double(*)[4])m, out);
}

/* Columns come first in the file. */
static void own_matrix(const gltf *g, const json_value *node, matrix out)
{
    double columns[16], t[3] = {0}, s[3] = {1.0, 1.0, 1.0}, q[4] = {0, 0, 0, 1.0};
    const gltf_moved *moved = g->moved ? &g->moved[node->index] : NULL;
    if (json_numbers(node, "matrix", columns, 16)) {
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                out[i][j] = columns[4 * j + i];
        return;
    }
    json_numbers(node, "translation", t, 3);
    json_numbers(node, "rotation", q, 4);
    json_numbers(node, "scale", s, 3);
    if (moved && moved->has_translation)
        memcpy(t, moved->translation, sizeof t);
    if (moved && moved->has_rotation)
        memcpy(q, moved->rotation, sizeof q);
    if (moved && moved->has_scale)
        memcpy(s, moved->scale, sizeof s);
    compose(t, q, s, out);
}

bool gltf_node_transform(const gltf *g, const json_value *node, transform *out)
{
    matrix m;
    own_matrix(g, node, m);
    return transform_from_matrix((const double(*)[4])m, out);
}

void gltf_find_parents(gltf *g)
{
    json_value nodes = json_member(&g->root, "nodes");
    guint n = g->n_nodes = json_length(&nodes);
    g->parents = g_new(int, n + 1);
    for (guint i = 0; i < n; i++)
        g->parents[i] = NO_INDEX;
    for (guint i = 0; i < n && !gltf_failed(g); i++) {
        json_value node = json_element(&nodes, i);
        json_value children = json_member(&node, "children");
        guint n_children = json_length(&children);
        for (guint k = 0; k < n_children; k++) {
            gint64 index = json_whole_at(&children, k, (gint64)n - 1);
            if (index >= 0)
                g->parents[index] = (int)i;
        }
    }
}

bool gltf_node_matrix(gltf *g, guint index, double out[4][4])
{
    json_value nodes = json_member(&g->root, "nodes");
    json_value node = json_element(&nodes, index);
    if (gltf_failed(g))
        return false;
    own_matrix(g, &node, out);
    int at = g->parents[index];
    for (unsigned depth = 0; at != NO_INDEX && !gltf_failed(g); depth++) {
        matrix above;
        if (depth > GLTF_DEEPEST) {
            json_fail(&node, "expected nodes in a tree of at most %d levels",
                      GLTF_DEEPEST);
            return false;
        }
        json_value parent = json_element(&nodes, (guint)at);
        own_matrix(g, &parent, above);
        multiply((const double(*)[4])above, (const double(*)[4])out, out);
        at = g->parents[at];
    }
    return !gltf_failed(g);
}
