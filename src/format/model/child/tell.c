/*
 * Meshes once each, then the places where nodes put them, lights and cameras: each with
 * the product of its node's transforms.
 */
#include "format/model/child/tell.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(struct aiVector3D) == 3 * sizeof(float),
               "positions go as they are");

static bool all_finite(const float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

/* ---- Meshes ---- */

static uint64_t count_triangles(const struct aiMesh *m)
{
    uint64_t n = 0;
    for (unsigned i = 0; i < m->mNumFaces; i++)
        n += m->mFaces[i].mNumIndices == 3;
    return n;
}

static void tell_mesh(out *o, const struct aiMesh *m)
{
    if (!all_finite((const float *)m->mVertices, 3 * (size_t)m->mNumVertices))
        out_fail(o, STREAM_DAMAGED, "a position of a mesh is not finite");
    const struct aiVector3D *uvs = m->mTextureCoords[0];
    const stream_mesh mesh = {.n_vertices = m->mNumVertices,
                              .n_triangles = count_triangles(m),
                              .material = m->mMaterialIndex,
                              .has = (m->mNormals ? STREAM_HAS_NORMALS : 0) |
                                     (uvs ? STREAM_HAS_UVS : 0)};
    uint64_t per_vertex = 3 + (m->mNormals ? 3 : 0) + (uvs ? 2 : 0);
    out_begin(o, STREAM_MESH,
              sizeof mesh + 4 * (mesh.n_vertices * per_vertex + mesh.n_triangles * 3));
    out_bytes(o, &mesh, sizeof mesh);
    out_bytes(o, m->mVertices, m->mNumVertices * sizeof *m->mVertices);
    if (m->mNormals)
        out_bytes(o, m->mNormals, m->mNumVertices * sizeof *m->mNormals);
    for (unsigned i = 0; uvs && i < m->mNumVertices; i++)
        out_bytes(o, &uvs[i], 2 * sizeof(float));
    for (unsigned i = 0; i < m->mNumFaces; i++)
        if (m->mFaces[i].mNumIndices == 3)
            out_bytes(o, m->mFaces[i].mIndices, 3 * sizeof(uint32_t));
    out_end(o);
}

/* ---- Nodes ---- */

typedef struct place {
    const struct aiNode *node;
    double to_world[16];
} place;

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static void multiply(const double a[16], const struct aiMatrix4x4 *by, double to[16])
{
    const ai_real *b = &by->a1;
    for (int i = 0; i < 16; i++) {
        to[i] = 0.0;
        for (int k = 0; k < 4; k++)
            to[i] += a[i / 4 * 4 + k] * (double)b[4 * k + i % 4];
    }
}

/* Calls visit for the nodes until it says true; false if there is no more memory. Nodes
 * may be nested deeper than calls can be. */
static bool each_node(const struct aiScene *scene,
                      bool (*visit)(const place *at, void *data), void *data)
{
    size_t n = 1, room = 64;
    place *open = malloc(room * sizeof *open);
    if (!open)
        return false;
    multiply(identity, &scene->mRootNode->mTransformation, open[0].to_world);
    open[0].node = scene->mRootNode;
    while (n > 0) {
        const place at = open[--n];
        size_t n_children = at.node->mNumChildren;
        if (visit(&at, data))
            break;
        if (n + n_children > room) {
            room = 2 * (n + n_children);
            place *grown = realloc(open, room * sizeof *open);
            if (!grown) {
                free(open);
                return false;
            }
            open = grown;
        }
        for (size_t i = n_children; i-- > 0; n++) {
            open[n].node = at.node->mChildren[i];
            multiply(at.to_world, &open[n].node->mTransformation, open[n].to_world);
        }
    }
    free(open);
    return true;
}

static bool is_place(const double to_world[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(to_world[i]))
            return false;
    return true;
}

typedef struct mesh_teller {
    out *out;
    const struct aiScene *scene;
    bool lines, nowhere;
} mesh_teller;

static bool tell_instances(const place *at, void *data)
{
    mesh_teller *t = data;
    for (unsigned i = 0; i < at->node->mNumMeshes; i++) {
        stream_instance instance = {.mesh = at->node->mMeshes[i]};
        memcpy(instance.to_world, at->to_world, sizeof instance.to_world);
        if (!(t->scene->mMeshes[instance.mesh]->mPrimitiveTypes &
              aiPrimitiveType_TRIANGLE))
            t->lines = true;
        else if (!is_place(at->to_world))
            t->nowhere = true;
        else
            out_struct(t->out, STREAM_INSTANCE, &instance, sizeof instance);
    }
    return false;
}

/* ---- Lights and cameras: they have the place of the node of their name ---- */

typedef struct name_finder {
    const char *name;
    double *to_world;
} name_finder;

static bool find_name(const place *at, void *data)
{
    const name_finder *f = data;
    bool found = strcmp(at->node->mName.data, f->name) == 0;
    if (found)
        memcpy(f->to_world, at->to_world, sizeof at->to_world);
    return found;
}

static bool find_place(const struct aiScene *scene, const char *name, double to_world[16])
{
    name_finder f = {name, to_world};
    memcpy(to_world, identity, sizeof identity);
    return each_node(scene, find_name, &f) && is_place(to_world);
}

static bool kind_of_light(const struct aiLight *l, uint32_t *kind)
{
    switch (l->mType) {
    case aiLightSource_POINT:
        *kind = STREAM_POINT;
        return true;
    case aiLightSource_SPOT:
        *kind = STREAM_SPOT;
        return true;
    case aiLightSource_DIRECTIONAL:
        *kind = STREAM_DISTANT;
        return true;
    default:
        return false;
    }
}

static void tell_light(out *o, const struct aiScene *scene, const struct aiLight *l)
{
    stream_light s = {
        .position = {l->mPosition.x, l->mPosition.y, l->mPosition.z},
        .direction = {l->mDirection.x, l->mDirection.y, l->mDirection.z},
        .color = {l->mColorDiffuse.r, l->mColorDiffuse.g, l->mColorDiffuse.b},
        .inner_angle = l->mAngleInnerCone,
        .outer_angle = l->mAngleOuterCone};
    if (s.color[0] + s.color[1] + s.color[2] <= 0.0f)
        return; /* dark ones are no loss */
    if (!kind_of_light(l, &s.kind))
        out_note(o, STREAM_WARNING,
                 "a light that is neither point, spot nor directional is left out");
    else if (!find_place(scene, l->mName.data, s.to_world) ||
             !all_finite(s.position, 3) || !all_finite(s.direction, 3) ||
             !all_finite(s.color, 3) || !isfinite(s.inner_angle + s.outer_angle))
        out_note(o, STREAM_WARNING, "a light that is nowhere is left out");
    else
        out_struct(o, STREAM_LIGHT, &s, sizeof s);
}

static void tell_camera(out *o, const struct aiScene *scene, const struct aiCamera *c)
{
    stream_camera s = {.position = {c->mPosition.x, c->mPosition.y, c->mPosition.z},
                       .look_at = {c->mLookAt.x, c->mLookAt.y, c->mLookAt.z},
                       .up = {c->mUp.x, c->mUp.y, c->mUp.z},
                       .aspect = c->mAspect,
                       .fov = c->mHorizontalFOV};
    if (find_place(scene, c->mName.data, s.to_world) && all_finite(s.position, 3) &&
        all_finite(s.look_at, 3) && all_finite(s.up, 3) && isfinite(s.aspect + s.fov))
        out_struct(o, STREAM_CAMERA, &s, sizeof s);
    else
        out_note(o, STREAM_WARNING, "a camera that looks nowhere is left out");
}

/* ---- All of it ---- */

static void tell_left_out(out *o, const struct aiScene *scene)
{
    bool bones = false;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        bones |= scene->mMeshes[i]->mNumBones > 0;
    if (bones || scene->mNumAnimations > 0)
        out_note(o, STREAM_WARNING,
                 "animations and bones are left out: it stands as it was modelled");
}

void tell_scene(out *o, const struct aiScene *scene)
{
    mesh_teller t = {.out = o, .scene = scene};
    tell_left_out(o, scene);
    tell_materials(o, scene);
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        tell_mesh(o, scene->mMeshes[i]);
    if (!each_node(scene, tell_instances, &t))
        out_fail(o, STREAM_NO_MEMORY, "");
    if (t.lines)
        out_note(o, STREAM_WARNING, "points and lines are left out");
    if (t.nowhere)
        out_note(o, STREAM_WARNING, "a node that is nowhere is left out");
    for (unsigned i = 0; i < scene->mNumLights; i++)
        tell_light(o, scene, scene->mLights[i]);
    if (scene->mNumCameras > 0)
        tell_camera(o, scene, scene->mCameras[0]);
}
