/*
 * Materials are assimp's list of keys, which are those of Wavefront's MTL with more
 * behind them.
 */
#include "format/model/child/tell.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define KEY_ILLUM "$mat.illum", 0, 0
#define KEY_BUMP_STRENGTH "$tex.bumpmult", aiTextureType_HEIGHT, 0

static void get_number(const struct aiMaterial *m, const char *key, unsigned type,
                       unsigned index, float *to)
{
    ai_real value;
    if (aiGetMaterialFloat(m, key, type, index, &value) == aiReturn_SUCCESS &&
        isfinite((float)value))
        *to = (float)value;
}

static bool get_color(const struct aiMaterial *m, const char *key, unsigned type,
                      unsigned index, float to[3])
{
    struct aiColor4D c;
    if (aiGetMaterialColor(m, key, type, index, &c) != aiReturn_SUCCESS ||
        !isfinite(c.r + c.g + c.b))
        return false;
    to[0] = c.r;
    to[1] = c.g;
    to[2] = c.b;
    return true;
}

static stream_material numbers_of(const struct aiMaterial *m)
{
    stream_material s = {.diffuse = {0.6f, 0.6f, 0.6f},
                         .opacity = 1.0f,
                         .index = 1.0f,
                         .metalness = -1.0f,
                         .roughness = -1.0f,
                         .bump_strength = 1.0f,
                         .illum = -1};
    int illum;
    if (!get_color(m, AI_MATKEY_BASE_COLOR, s.diffuse))
        get_color(m, AI_MATKEY_COLOR_DIFFUSE, s.diffuse);
    get_color(m, AI_MATKEY_COLOR_SPECULAR, s.specular);
    get_color(m, AI_MATKEY_COLOR_EMISSIVE, s.emission);
    get_number(m, AI_MATKEY_OPACITY, &s.opacity);
    get_number(m, AI_MATKEY_REFRACTI, &s.index);
    get_number(m, AI_MATKEY_SHININESS, &s.exponent);
    get_number(m, AI_MATKEY_METALLIC_FACTOR, &s.metalness);
    get_number(m, AI_MATKEY_ROUGHNESS_FACTOR, &s.roughness);
    get_number(m, KEY_BUMP_STRENGTH, &s.bump_strength);
    if (aiGetMaterialInteger(m, KEY_ILLUM, &illum) == aiReturn_SUCCESS)
        s.illum = illum;
    return s;
}

/* The name first, then those of the maps. */
static void tell_material(out *o, const struct aiMaterial *m)
{
    static const enum aiTextureType types[N_STREAM_MAPS] = {
        [STREAM_MAP_COLOR] = aiTextureType_DIFFUSE,
        [STREAM_MAP_EMISSION] = aiTextureType_EMISSIVE,
        [STREAM_MAP_OPACITY] = aiTextureType_OPACITY,
        [STREAM_MAP_NORMALS] = aiTextureType_NORMALS,
        [STREAM_MAP_HEIGHTS] = aiTextureType_HEIGHT};
    struct aiString names[1 + N_STREAM_MAPS] = {0};
    const stream_material numbers = numbers_of(m);
    size_t size = sizeof numbers;
    if (aiGetMaterialString(m, AI_MATKEY_NAME, &names[0]) != aiReturn_SUCCESS)
        names[0].data[0] = '\0';
    for (int i = 0; i < N_STREAM_MAPS; i++)
        if (aiGetMaterialTexture(m, types[i], 0, &names[1 + i], NULL, NULL, NULL, NULL,
                                 NULL, NULL) != aiReturn_SUCCESS)
            names[1 + i].data[0] = '\0';
    for (int i = 0; i < 1 + N_STREAM_MAPS; i++)
        size += strlen(names[i].data) + 1;
    out_begin(o, STREAM_MATERIAL, size);
    out_bytes(o, &numbers, sizeof numbers);
    for (int i = 0; i < 1 + N_STREAM_MAPS; i++)
        out_bytes(o, names[i].data, strlen(names[i].data) + 1);
    out_end(o);
}

/* One of bare pixels has a height, else its width is a number of bytes. */
static void tell_image(out *o, const struct aiTexture *t)
{
    const stream_image image = {.n_bytes = t->mHeight == 0 ? t->mWidth : 0};
    size_t n_name = strlen(t->mFilename.data) + 1, n_hint = strlen(t->achFormatHint) + 1;
    out_begin(o, STREAM_IMAGE, sizeof image + n_name + n_hint + image.n_bytes);
    out_bytes(o, &image, sizeof image);
    out_bytes(o, t->mFilename.data, n_name);
    out_bytes(o, t->achFormatHint, n_hint);
    out_bytes(o, t->pcData, image.n_bytes);
    out_end(o);
}

void tell_materials(out *o, const struct aiScene *scene)
{
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        tell_image(o, scene->mTextures[i]);
    for (unsigned i = 0; i < scene->mNumMaterials; i++)
        tell_material(o, scene->mMaterials[i]);
}
