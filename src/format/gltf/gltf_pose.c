/*
 * The pose of a mesh: what its node's weights make of its morph targets, then what the
 * node's skin makes of that.
 *
 *   vertex = base + sum of weight[k] * target[k]
 *   world  = sum of weight[j] * (world matrix of joint j * its inverse bind matrix) *
 * vertex
 *
 * A skin says where vertices are in the world, so that the node's own transform does not
 * count. Normals go by the matrix of cofactors of the mean matrix. Weights are scaled to
 * a sum of one, which rounded ones miss; vertices without any hang on the first joint.
 *
 * Khronos, "glTF 2.0 Specification", 3.7.2.2 and 3.7.3, 2021.
 */
#include "format/gltf/gltf_pose.h"

#include "base/memory.h"
#include "format/gltf/gltf_animation.h"

#include <math.h>
#include <string.h>

/* ---- Reading ---- */

static void read_weights(gltf *g, const json_value *node, const json_value *of,
                         gltf_pose *pose)
{
    const gltf_moved *moved = g->moved ? &g->moved[node->index] : NULL;
    if (moved && moved->weights) {
        pose->n_weights = moved->n_weights;
        pose->weights = g_memdup2(moved->weights, moved->n_weights * sizeof(double));
        return;
    }
    json_value own = json_member(node, "weights"), shared = json_member(of, "weights");
    const json_value *list = json_exists(&own) ? &own : &shared;
    pose->n_weights = json_length(list);
    pose->weights = g_new0(double, pose->n_weights + 1);
    for (guint i = 0; i < pose->n_weights && !gltf_failed(g); i++)
        pose->weights[i] = json_real_at(list, i);
}

/* Sixteen numbers a joint, columns first. NULL: there are none, or with an error. */
static float *read_binds(gltf *g, const json_value *skin, guint n_joints)
{
    size_t count = 0;
    gint64 index = json_whole(skin, "inverseBindMatrices", GLTF_MOST);
    float *binds = index < 0 ? NULL : gltf_read_floats(g, index, 16, 0, &count);
    if (!binds || count >= n_joints)
        return binds;
    json_fail(skin, "expected %u inverse bind matrices, found %zu", n_joints, count);
    big_free(binds);
    return NULL;
}

/* A joint's world matrix times its inverse bind matrix. */
static void make_joint(const double world[4][4], const float *columns, gltf_joint *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            double sum = columns ? 0.0 : world[i][j];
            for (int k = 0; k < 4 && columns; k++)
                sum += world[i][k] * (double)columns[4 * j + k];
            out->m[i][j] = sum;
        }
}

static void read_skin(gltf *g, const json_value *skin, gltf_pose *pose)
{
    json_value joints = json_member(skin, "joints");
    pose->n_joints = json_length(&joints);
    if (pose->n_joints == 0)
        json_fail(skin, "expected at least one joint, found none");
    if (gltf_failed(g))
        return;
    float *binds = read_binds(g, skin, pose->n_joints);
    pose->joints = g_new0(gltf_joint, pose->n_joints);
    for (guint i = 0; i < pose->n_joints && !gltf_failed(g); i++) {
        double world[4][4];
        gint64 node = json_whole_at(&joints, i, (gint64)g->n_nodes - 1);
        if (node >= 0 && gltf_node_matrix(g, (guint)node, world))
            make_joint((const double(*)[4])world, binds ? binds + 16 * i : NULL,
                       &pose->joints[i]);
    }
    big_free(binds);
}

bool gltf_pose_is_own(const gltf *g, const json_value *node)
{
    if (g->moved && g->moved[node->index].weights)
        return true;
    json_value weights = json_member(node, "weights"), skin = json_member(node, "skin");
    return json_exists(&weights) || json_exists(&skin);
}

bool gltf_pose_read(gltf *g, const json_value *node, const json_value *of,
                    gltf_pose *pose)
{
    json_value array;
    gint64 index;
    json_value skin = gltf_refer(g, node, "skin", "skins", &array, &index);
    *pose = (gltf_pose){.is_own = gltf_pose_is_own(g, node)};
    if (!gltf_failed(g))
        read_weights(g, node, of, pose);
    if (!gltf_failed(g) && json_exists(&skin))
        read_skin(g, &skin, pose);
    return !gltf_failed(g);
}

void gltf_pose_clear(gltf_pose *pose)
{
    g_free(pose->weights);
    g_free(pose->joints);
    *pose = (gltf_pose){0};
}

/* ---- Morph targets ---- */

/* Numbers of vertices that targets may change: how many of each the mesh keeps. */
typedef struct morphed {
    const char *name;
    float *values;
    unsigned width;
    float second_sign; /* of the second number: v goes up here */
} morphed;

static void add_target(gltf *g, const json_value *target, const morphed *to,
                       size_t n_vertices, double weight)
{
    size_t count;
    gint64 index = to->values ? json_whole(target, to->name, GLTF_MOST) : -1;
    unsigned width = index < 0 ? 0 : gltf_components(g, index);
    if (index < 0 || gltf_failed(g))
        return;
    if (width > to->width)
        json_fail(target, "expected a %s of %u components, found %u", to->name, to->width,
                  width);
    float *change = gltf_read_floats(g, index, width, 0, &count);
    if (change && count != n_vertices)
        json_fail(target, "expected a %s of %zu elements, found %zu", to->name,
                  n_vertices, count);
    for (size_t i = 0; change && !gltf_failed(g) && i < n_vertices; i++)
        for (unsigned c = 0; c < width; c++)
            to->values[i * to->width + c] +=
                (float)weight * (c == 1 ? to->second_sign : 1.0f) * change[i * width + c];
    big_free(change);
}

static void morph(gltf *g, const json_value *primitive, const gltf_pose *pose, mesh *m)
{
    json_value targets = json_member(primitive, "targets");
    guint n = json_length(&targets);
    const morphed all[] = {{"POSITION", m->positions, 3, 1.0f},
                           {"NORMAL", m->normals, 3, 1.0f},
                           {"TANGENT", m->tangents, 3, 1.0f},
                           {"TEXCOORD_0", (float *)m->uvs, 2, -1.0f},
                           {"TEXCOORD_1", (float *)m->uvs2, 2, -1.0f},
                           {"COLOR_0", m->colors, 4, 1.0f}};
    if (pose->n_weights > 0 && n > 0 && n != pose->n_weights)
        json_fail(&targets, "expected as many targets as weights (%u), found %u",
                  pose->n_weights, n);
    for (guint i = 0; i < MIN(n, pose->n_weights) && !gltf_failed(g); i++) {
        json_value target = json_element(&targets, i);
        for (size_t k = 0; k < G_N_ELEMENTS(all) && fabs(pose->weights[i]) > 0.0; k++)
            add_target(g, &target, &all[k], m->n_vertices, pose->weights[i]);
    }
    for (size_t i = 0; n > 0 && m->colors && i < 4 * m->n_vertices; i++)
        m->colors[i] = clampf(m->colors[i], 0.0f, 1.0f);
}

/* ---- Skins ---- */

/* Four joints and weights a vertex. */
typedef struct influence {
    float *joints, *weights;
} influence;

static bool read_influence(gltf *g, const json_value *attributes, guint set,
                           size_t n_vertices, influence *out)
{
    g_autofree char *joints_name = g_strdup_printf("JOINTS_%u", set);
    g_autofree char *weights_name = g_strdup_printf("WEIGHTS_%u", set);
    gint64 joints = json_whole(attributes, joints_name, GLTF_MOST);
    gint64 weights = json_whole(attributes, weights_name, GLTF_MOST);
    size_t n_joints = 0, n_weights = 0;
    *out = (influence){0};
    if (joints < 0 || weights < 0)
        return false;
    out->joints = gltf_read_floats(g, joints, 4, 0, &n_joints);
    if (out->joints)
        out->weights = gltf_read_floats(g, weights, 4, 0, &n_weights);
    if (out->weights && (n_joints != n_vertices || n_weights != n_vertices))
        json_fail(attributes, "expected a %s and a %s of %zu elements, found %zu and %zu",
                  joints_name, weights_name, n_vertices, n_joints, n_weights);
    return true;
}

static void influence_clear(influence *of)
{
    big_free(of->joints);
    big_free(of->weights);
}

static void add_joint(const gltf_joint *joint, double weight, gltf_joint *sum)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            sum->m[i][j] += weight * joint->m[i][j];
}

/* Adds what one set says of vertex i; false if there is no such joint. */
static bool add_influence(const gltf_pose *pose, const influence *of, size_t i,
                          gltf_joint *sum, double *total)
{
    for (size_t c = 4 * i; c < 4 * i + 4; c++) {
        double weight = (double)of->weights[c];
        if (!(weight > 0.0))
            continue;
        if (!(of->joints[c] >= 0.0f && of->joints[c] < (float)pose->n_joints))
            return false;
        add_joint(&pose->joints[(guint)of->joints[c]], weight, sum);
        *total += weight;
    }
    return true;
}

/* v becomes m v, of length one. */
static void turn(const double m[3][3], float *v)
{
    double in[3] = {(double)v[0], (double)v[1], (double)v[2]}, out[3], length2 = 0.0;
    for (int i = 0; i < 3; i++) {
        out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
        length2 += out[i] * out[i];
    }
    for (int i = 0; i < 3 && length2 > 0.0; i++)
        v[i] = (float)(out[i] / sqrt(length2));
}

/* The inverse transpose but for its scale; outside stays outside. */
static void cofactors(const gltf_joint *of, double out[3][3])
{
    double determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            out[i][j] = of->m[a][c] * of->m[b][d] - of->m[a][d] * of->m[b][c];
        }
    for (int j = 0; j < 3; j++)
        determinant += of->m[0][j] * out[0][j];
    for (int i = 0; i < 9 && determinant < 0.0; i++)
        out[i / 3][i % 3] = -out[i / 3][i % 3];
}

static void move_vertex(const gltf_joint *by, mesh *m, size_t i)
{
    double normals[3][3], plain[3][3];
    float *p = m->positions + 3 * i;
    double in[3] = {(double)p[0], (double)p[1], (double)p[2]};
    for (int k = 0; k < 3; k++) {
        p[k] = (float)(by->m[k][0] * in[0] + by->m[k][1] * in[1] + by->m[k][2] * in[2] +
                       by->m[k][3]);
        memcpy(plain[k], by->m[k], sizeof plain[k]);
    }
    if (m->tangents)
        turn((const double(*)[3])plain, m->tangents + 3 * i);
    if (!m->normals)
        return;
    cofactors(by, normals);
    turn((const double(*)[3])normals, m->normals + 3 * i);
}

/* The mean matrix of all sets at vertex i; false with an error noted. */
static bool mean_joint(const json_value *attributes, const gltf_pose *pose,
                       const GArray *sets, size_t i, gltf_joint *out)
{
    gltf_joint sum = {0};
    double total = 0.0;
    for (guint k = 0; k < sets->len; k++) {
        if (add_influence(pose, &g_array_index(sets, influence, k), i, &sum, &total))
            continue;
        json_fail(attributes, "vertex %zu hangs on a joint that its skin has not", i);
        return false;
    }
    *out = pose->joints[0];
    if (total > 0.0) {
        *out = (gltf_joint){0};
        add_joint(&sum, 1.0 / total, out);
    }
    return true;
}

static void skin(const json_value *attributes, const gltf_pose *pose, const GArray *sets,
                 mesh *m)
{
    gltf_joint by;
    for (size_t i = 0; i < m->n_vertices; i++) {
        if (!mean_joint(attributes, pose, sets, i, &by))
            return;
        move_vertex(&by, m, i);
    }
}

bool gltf_pose_apply(gltf *g, const json_value *primitive, const gltf_pose *pose, mesh *m)
{
    json_value attributes = json_member(primitive, "attributes");
    influence one;
    morph(g, primitive, pose, m);
    if (gltf_failed(g) || !pose->joints)
        return false;
    g_autoptr(GArray) sets = g_array_new(FALSE, FALSE, sizeof one);
    g_array_set_clear_func(sets, (GDestroyNotify)influence_clear);
    while (!gltf_failed(g) &&
           read_influence(g, &attributes, sets->len, m->n_vertices, &one))
        g_array_append_val(sets, one);
    if (gltf_failed(g) || sets->len == 0)
        return false;
    skin(&attributes, pose, sets, m);
    return true;
}
