/*
 * Every format that the importer reads: what assimp's exporters write of a small scene
 * comes back as the triangles that it had. (What they read in common, they may have wrong
 * in common; the numbers of the triangles are ours.)
 */
#include "scene_text.h"

#include <assimp/cexport.h>
#include <assimp/scene.h>
#include <math.h>

/* A tetrahedron with corners that tell the axes apart. */
static struct aiVector3D corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}};
static unsigned faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/* Its area, by hand: three right triangles, and sqrt(84) for the slanted one. */
#define AREA (0.5 * (2.0 + 4.0 + 8.0 + 9.165151389911680))

static bool export_as(const char *id, const char *path)
{
    struct aiFace list[4];
    unsigned mesh_index = 0;
    for (int i = 0; i < 4; i++)
        list[i] = (struct aiFace){3, faces[i]};
    struct aiMesh body = {.mPrimitiveTypes = aiPrimitiveType_TRIANGLE,
                          .mNumVertices = 4,
                          .mNumFaces = 4,
                          .mVertices = corners,
                          .mFaces = list};
    struct aiMesh *meshes[] = {&body};
    struct aiMaterial plain = {0};
    struct aiMaterial *materials[] = {&plain};
    const struct aiMatrix4x4 identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    struct aiNode child = {
        .mNumMeshes = 1, .mMeshes = &mesh_index, .mTransformation = identity};
    struct aiNode *children[] = {&child};
    struct aiNode root = {
        .mNumChildren = 1, .mChildren = children, .mTransformation = identity};
    child.mParent = &root;
    const struct aiScene all = {.mRootNode = &root,
                                .mNumMeshes = 1,
                                .mMeshes = meshes,
                                .mNumMaterials = 1,
                                .mMaterials = materials};
    return aiExportScene(&all, id, path, 0) == aiReturn_SUCCESS;
}

static double area_of(const scene *s)
{
    double sum = 0.0;
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *on = s->shapes->pdata[i];
        sum += (double)on->kind->area(on->self);
    }
    return sum;
}

/* The file, the second of the folder's, is the tetrahedron. */
static void check_file(scene_folder *f, const char *how)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f->files->pdata[1], 1, NULL, &error);
    g_assert_no_error(error);
    g_test_message("%s: %g, to %g %g %g", how, area_of(s), (double)s->bounds.high[0],
                   (double)s->bounds.high[1], (double)s->bounds.high[2]);
    const float size[3] = {1.0f, 2.0f, 4.0f};
    for (int i = 0; i < 3; i++) {
        g_assert_cmpfloat(fabsf(s->bounds.low[i]), <, 1e-5f);
        g_assert_cmpfloat(fabsf(s->bounds.high[i] - size[i]), <, 1e-5f);
    }
    g_assert_cmpfloat(fabs(area_of(s) - AREA), <, 1e-4);
    folder_remove(f);
}

static void check(const char *id, const char *extension)
{
    scene_folder f = folder_new("");
    g_autofree char *name = g_strconcat("a", extension, NULL);
    char *path = g_build_filename(f.path, name, NULL);
    g_ptr_array_add(f.files, path);
    g_assert_true(export_as(id, path));
    check_file(&f, id);
}

static void test_obj(void)
{
    check("objnomtl", ".obj");
}

static void test_stl(void)
{
    check("stl", ".stl");
    check("stlb", ".stl");
}

static void test_3mf(void)
{
    check("3mf", ".3mf");
}

static void test_collada(void)
{
    check("collada", ".dae");
}

/* ---- FBX, whose exporter writes binary files that no importer reads ---- */

static void put_u32(GByteArray *out, size_t value)
{
    const guint32 is = GUINT32_TO_LE((guint32)value);
    g_byte_array_append(out, (const guint8 *)&is, sizeof is);
}

/* A property: its letter, and bytes of which there may be a count before. */
static void put_value(GByteArray *out, char letter, const void *bytes, guint size)
{
    g_byte_array_append(out, (const guint8 *)&letter, 1);
    if (letter == 'S')
        put_u32(out, size);
    if (letter == 'd' || letter == 'i') {
        put_u32(out, size / (letter == 'd' ? 8 : 4));
        put_u32(out, 0); /* not compressed */
        put_u32(out, size);
    }
    g_byte_array_append(out, bytes, size);
}

/* Opens a node; its end is not known yet. */
static guint open_node(GByteArray *out, const char *name, guint n_values,
                       const GByteArray *values)
{
    guint start = out->len;
    const guint8 length = (guint8)strlen(name);
    put_u32(out, 0);
    put_u32(out, n_values);
    put_u32(out, values ? values->len : 0);
    g_byte_array_append(out, &length, 1);
    g_byte_array_append(out, (const guint8 *)name, length);
    if (values)
        g_byte_array_append(out, values->data, values->len);
    return start;
}

/* Nodes that have others end with an empty one. */
static void close_node(GByteArray *out, guint start, bool has_children)
{
    static const guint8 empty[13] = {0};
    if (has_children)
        g_byte_array_append(out, empty, sizeof empty);
    const guint32 end = GUINT32_TO_LE(out->len);
    memcpy(out->data + start, &end, sizeof end);
}

static void put_array(GByteArray *out, const char *name, char letter, const void *bytes,
                      guint size)
{
    g_autoptr(GByteArray) value = g_byte_array_new();
    put_value(value, letter, bytes, size);
    close_node(out, open_node(out, name, 1, value), false);
}

static guint open_object(GByteArray *out, const char *name, gint64 id)
{
    static const char of_kind[] = "a\0\1Mesh";
    g_autoptr(GByteArray) values = g_byte_array_new();
    put_value(values, 'L', &id, 8);
    put_value(values, 'S', of_kind, sizeof of_kind - 1);
    put_value(values, 'S', "Mesh", 4);
    return open_node(out, name, 3, values);
}

static void put_connection(GByteArray *out, gint64 from, gint64 to)
{
    g_autoptr(GByteArray) values = g_byte_array_new();
    put_value(values, 'S', "OO", 2);
    put_value(values, 'L', &from, 8);
    put_value(values, 'L', &to, 8);
    close_node(out, open_node(out, "C", 3, values), false);
}

static void put_objects(GByteArray *out)
{
    double positions[12];
    gint32 indices[12];
    for (int i = 0; i < 4; i++) {
        positions[3 * i] = (double)corners[i].x;
        positions[3 * i + 1] = (double)corners[i].y;
        positions[3 * i + 2] = (double)corners[i].z;
        for (int k = 0; k < 3; k++)
            indices[3 * i + k] = k < 2 ? (gint32)faces[i][k] : ~(gint32)faces[i][k];
    }
    guint objects = open_node(out, "Objects", 0, NULL);
    guint geometry = open_object(out, "Geometry", 1);
    put_array(out, "Vertices", 'd', positions, sizeof positions);
    put_array(out, "PolygonVertexIndex", 'i', indices, sizeof indices);
    close_node(out, geometry, true);
    guint model = open_object(out, "Model", 2);
    put_array(out, "Version", 'I', &(gint32){232}, 4);
    close_node(out, model, true);
    close_node(out, objects, true);
}

static void test_binary_fbx(void)
{
    g_autoptr(GByteArray) out = g_byte_array_new();
    static const char magic[] = "Kaydara FBX Binary  \0\x1a";
    g_byte_array_append(out, (const guint8 *)magic, sizeof magic);
    put_u32(out, 7400);
    guint head = open_node(out, "FBXHeaderExtension", 0, NULL);
    put_array(out, "FBXVersion", 'I', &(gint32){7400}, 4);
    close_node(out, head, true);
    put_objects(out);
    guint connections = open_node(out, "Connections", 0, NULL);
    put_connection(out, 2, 0);
    put_connection(out, 1, 2);
    close_node(out, connections, true);
    g_byte_array_append(out, (const guint8[13]){0}, 13);
    scene_folder f = folder_new("");
    folder_write(&f, "a.FBX", (const char *)out->data, out->len);
    check_file(&f, "by hand");
}

static void test_fbx(void)
{
    check("fbxa", ".fbx");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/model-formats/obj", test_obj);
    g_test_add_func("/model-formats/stl", test_stl);
    g_test_add_func("/model-formats/3mf", test_3mf);
    g_test_add_func("/model-formats/collada", test_collada);
    g_test_add_func("/model-formats/fbx", test_fbx);
    g_test_add_func("/model-formats/binary-fbx", test_binary_fbx);
    return g_test_run();
}
