/*
 * Meshes where glTF's nodes put them. One that is shown once is put into the world as it
 * is. One that several nodes show, or that EXT_mesh_gpu_instancing repeats, becomes an
 * object with an instance for each place; what shines of it is copied, since each copy is
 * a light of its own, and so is what a node poses in a way of its own.
 */
#include "format/gltf/gltf_pose.h"

#include "base/intern.h"
#include "base/memory.h"

/* ---- Before anything is read ---- */

static void count_node(gltf *g, const json_value *node, bool *shown)
{
    json_value array, extensions;
    gint64 index;
    json_value of = gltf_refer(g, node, "mesh", "meshes", &array, &index);
    json_value copies = gltf_extension(node, "EXT_mesh_gpu_instancing", &extensions);
    if (!json_exists(&of))
        return;
    if (gltf_pose_is_own(g, node))
        return;
    g->meshes[index].repeats |= shown[index] || json_exists(&copies);
    shown[index] = true;
}

static void note_colors(gltf *g, const json_value *of)
{
    json_value primitives = json_member(of, "primitives");
    guint n = json_length(&primitives);
    for (guint i = 0; i < n; i++) {
        json_value primitive = json_element(&primitives, i);
        json_value attributes = json_member(&primitive, "attributes");
        json_value colors = json_member(&attributes, "COLOR_0");
        gint64 number = json_whole(&primitive, "material", GLTF_MOST);
        guint at = number < 0 ? g->n_materials : (guint)number;
        if (json_exists(&colors) && at <= g->n_materials)
            g->materials[at].colored = true;
    }
}

void gltf_survey(gltf *g)
{
    json_value nodes = json_member(&g->root, "nodes");
    json_value meshes = json_member(&g->root, "meshes");
    guint n = json_length(&nodes);
    g_autofree bool *shown = g_new0(bool, g->n_meshes + 1);
    for (guint i = 0; i < n && !gltf_failed(g); i++) {
        json_value node = json_element(&nodes, i);
        count_node(g, &node, shown);
    }
    for (guint i = 0; i < g->n_meshes && !gltf_failed(g); i++) {
        json_value of = json_element(&meshes, i);
        note_colors(g, &of);
        g->meshes[i].object = NO_INDEX;
    }
}

/* ---- Places ---- */

/* Makes the object at the first call, if there is anything to put into one. */
static void make_object(gltf *g, const json_value *of, const gltf_pose *pose,
                        gltf_mesh_info *info)
{
    const transform identity = transform_identity();
    const source_place place = {intern(g->path), 0, 0};
    GError *error = NULL;
    if (info->is_made)
        return;
    info->is_made = true;
    int object = builder_object_begin(g->builder, NULL, place, &error);
    if (object == NO_INDEX) {
        gltf_take_error(g, of, error);
        return;
    }
    if (gltf_add_primitives(g, of, pose, GLTF_DARK, &identity) > 0)
        info->object = object;
    builder_object_end(g->builder);
}

/* What nodes show, and how. */
typedef struct shown_mesh {
    json_value of;
    gltf_mesh_info *info;
    gltf_pose pose;
} shown_mesh;

static void place_mesh(gltf *g, const shown_mesh *shown, const transform *to_world)
{
    const json_value *of = &shown->of;
    const gltf_pose *pose = &shown->pose;
    gltf_mesh_info *info = shown->info;
    const source_place place = {intern(g->path), 0, 0};
    const motion still = motion_still(to_world);
    GError *error = NULL;
    if (!info->repeats || pose->is_own) {
        gltf_add_primitives(g, of, pose, GLTF_ALL, to_world);
        return;
    }
    make_object(g, of, pose, info);
    if (!gltf_failed(g))
        gltf_add_primitives(g, of, pose, GLTF_SHINING, to_world);
    if (!gltf_failed(g) && info->object != NO_INDEX &&
        !builder_add_instance(g->builder, info->object, &still, place, &error))
        gltf_take_error(g, of, error);
}

/* ---- EXT_mesh_gpu_instancing ---- */

/* One attribute of the copies; false with an error. *values is NULL if there is none. */
static bool read_attribute(gltf *g, const json_value *attributes, const char *name,
                           unsigned n_components, size_t *count, float **values)
{
    gint64 index = json_whole(attributes, name, GLTF_MOST);
    size_t n;
    if (index < 0)
        return !gltf_failed(g);
    *values = gltf_read_floats(g, index, n_components, 0, &n);
    if (*values && *count > 0 && n != *count)
        json_fail(attributes, "expected %zu elements, as the others have, found %zu",
                  *count, n);
    *count = n;
    return !gltf_failed(g);
}

/* A count of many may stand in a file of few bytes. */
static bool expect_copies(gltf *g, const shown_mesh *shown, size_t n)
{
    const source_place whole = {NULL, 0, 0};
    GError *error = NULL;
    if (builder_expect_instances(g->builder, n, whole, &error))
        return true;
    gltf_take_error(g, &shown->of, error);
    return false;
}

static void place_copies(gltf *g, const shown_mesh *shown, const json_value *attributes,
                         const transform *to_world)
{
    float *t = NULL, *q = NULL, *s = NULL;
    size_t n = 0;
    bool done = read_attribute(g, attributes, "TRANSLATION", 3, &n, &t) &&
                read_attribute(g, attributes, "ROTATION", 4, &n, &q) &&
                read_attribute(g, attributes, "SCALE", 3, &n, &s);
    done = done && expect_copies(g, shown, n);
    for (size_t i = 0; i < n && done && !gltf_failed(g); i++) {
        double move[3] = {0}, turn[4] = {0, 0, 0, 1.0}, scale[3] = {1.0, 1.0, 1.0};
        transform own;
        for (size_t c = 0; c < 3; c++) {
            move[c] = t ? (double)t[3 * i + c] : move[c];
            scale[c] = s ? (double)s[3 * i + c] : scale[c];
        }
        for (size_t c = 0; c < 4 && q; c++)
            turn[c] = (double)q[4 * i + c];
        if (!gltf_transform(move, turn, scale, &own))
            continue;
        own = transform_multiply(to_world, &own);
        place_mesh(g, shown, &own);
    }
    big_free(t);
    big_free(q);
    big_free(s);
}

void gltf_add_mesh(gltf *g, const json_value *node, const transform *to_world)
{
    json_value array, extensions;
    gint64 index;
    shown_mesh shown = {.of = gltf_refer(g, node, "mesh", "meshes", &array, &index)};
    if (!json_exists(&shown.of))
        return;
    json_value copies = gltf_extension(node, "EXT_mesh_gpu_instancing", &extensions);
    json_value attributes = json_member(&copies, "attributes");
    shown.info = &g->meshes[index];
    bool done = gltf_pose_read(g, node, &shown.of, &shown.pose);
    if (json_exists(&copies) && shown.pose.joints)
        gltf_note(g, LOG_WARNING,
                  "a mesh with a skin is shown once: copies are left out");
    if (done && json_exists(&copies) && !shown.pose.joints)
        place_copies(g, &shown, &attributes, to_world);
    else if (done)
        place_mesh(g, &shown, to_world);
    gltf_pose_clear(&shown.pose);
}
