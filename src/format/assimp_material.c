/*
 * Materials from assimp's list of keys, which are those of Wavefront's MTL with more
 * behind them.
 *
 *   metalness or roughness given     our "gltf"
 *   illum 4, 6, 7, 9, or d < 1 with
 *     an index of refraction         glass: solid on closed meshes, else a pane
 *   illum 3, 5, 8 and Kd black       a mirror of reflectance Ks
 *   Ks and Ns                        Blinn-Phong, normalised
 *   else                             diffuse
 *
 * Ke is radiance. map_Kd, map_Ke, map_d and maps of normals or heights are read; colours
 * are linear.
 */
#include "format/assimp.h"

#include "base/intern.h"
#include "format/given.h"
#include "format/height_map.h"
#include "texture/picture.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define KEY_ILLUM "$mat.illum", 0, 0
#define KEY_BUMP_STRENGTH "$tex.bumpmult", aiTextureType_HEIGHT, 0

/* ---- Keys ---- */

static bool get_number(const struct aiMaterial *m, const char *key, unsigned type,
                       unsigned index, double *out)
{
    ai_real value;
    if (aiGetMaterialFloat(m, key, type, index, &value) != aiReturn_SUCCESS ||
        !isfinite(value))
        return false;
    *out = (double)value;
    return true;
}

static int get_illum(const struct aiMaterial *m)
{
    int illum;
    return aiGetMaterialInteger(m, KEY_ILLUM, &illum) == aiReturn_SUCCESS ? illum : -1;
}

static bool get_color(const struct aiMaterial *m, const char *key, unsigned type,
                      unsigned index, double out[3])
{
    struct aiColor4D c;
    if (aiGetMaterialColor(m, key, type, index, &c) != aiReturn_SUCCESS ||
        !isfinite(c.r + c.g + c.b))
        return false;
    out[0] = (double)c.r;
    out[1] = (double)c.g;
    out[2] = (double)c.b;
    return true;
}

static bool is_black(const double c[3])
{
    return !(c[0] + c[1] + c[2] > 0.0);
}

static void clamp_albedo(double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = CLAMP(c[i], 0.0, 1.0);
}

/* ---- Textures ---- */

/* The image within the file that a name means: "*3", or the name it had. */
static const struct aiTexture *embedded_image(const assimp_reader *r, const char *name)
{
    for (unsigned i = 0; i < r->source->mNumTextures; i++) {
        const struct aiTexture *t = r->source->mTextures[i];
        bool by_number = name[0] == '*' && (unsigned)atoi(name + 1) == i;
        if (by_number || (t->mFilename.data[0] && strcmp(t->mFilename.data, name) == 0))
            return t;
    }
    return NULL;
}

/* An image within the file: known to the scene under a name of its own. */
static char *embedded_path(assimp_reader *r, const char *name)
{
    const struct aiTexture *image_is = embedded_image(r, name);
    if (!image_is)
        return NULL;
    if (image_is->mHeight != 0) {
        assimp_note(r, "an image of bare pixels within the file is left out");
        return NULL;
    }
    g_autofree char *absolute = g_canonicalize_filename(r->path, NULL);
    char *path =
        g_strdup_printf("%s.%s.%s", absolute, name[0] == '*' ? name + 1 : "image",
                        image_is->achFormatHint);
    g_autoptr(GBytes) bytes = g_bytes_new(image_is->pcData, image_is->mWidth);
    build_context_add_file(&r->scene->build, path, bytes);
    return path;
}

/* The path of a texture, with backslashes mended; NULL, noted, if there is no such file.
 */
static char *texture_path(assimp_reader *r, const struct aiMaterial *m,
                          enum aiTextureType type)
{
    struct aiString name;
    if (aiGetMaterialTexture(m, type, 0, &name, NULL, NULL, NULL, NULL, NULL, NULL) !=
            aiReturn_SUCCESS ||
        !name.data[0])
        return NULL;
    char *inside = embedded_path(r, name.data);
    if (inside || name.data[0] == '*')
        return inside;
    g_autofree char *mended = g_strdelimit(g_strdup(name.data), "\\", '/');
    char *path = g_canonicalize_filename(mended, r->directory);
    scene_sources_add(r->scene->build.sources, path);
    if (g_file_test(path, G_FILE_TEST_IS_REGULAR))
        return path;
    g_free(path);
    g_autofree char *base = g_path_get_basename(mended);
    path = g_build_filename(r->directory, base, NULL);
    if (g_file_test(path, G_FILE_TEST_IS_REGULAR))
        return path;
    assimp_note(r, "there is no image '%s': its texture is left out", mended);
    g_free(path);
    return NULL;
}

/* Images we do not decode (DDS ...) leave the plain colour. What can be read is at hand
   for the texture that reads it alike. */
static bool is_readable(assimp_reader *r, const char *path, image_encoding encoding)
{
    const image_read_options options = {.encoding = encoding};
    g_autoptr(GError) error = NULL;
    picture *pic = picture_read_file(&r->scene->build, path, &options, &error);
    if (!pic)
        assimp_note(r, "a texture is left out: %s", error->message);
    bool readable = pic != NULL;
    picture_unref(pic);
    return readable;
}

/* The texture of a type as one of the scene; its name, or NULL if there is none. */
static char *add_texture(assimp_reader *r, const struct aiMaterial *m,
                         enum aiTextureType type, bool is_spectrum, GError **error)
{
    g_autofree char *path = texture_path(r, m, type);
    if (!path)
        return NULL;
    char *name = g_strdup(path);
    GHashTable *known =
        is_spectrum ? r->scene->build.spectrum_textures : r->scene->build.float_textures;
    if (g_hash_table_contains(known, name))
        return name;
    g_autoptr(params) p = assimp_params(r);
    give_text(p, PARAM_STRING, "filename", path);
    if (!is_spectrum)
        give_text(p, PARAM_STRING, "encoding", "linear");
    if (is_readable(r, path, is_spectrum ? ENCODING_AUTO : ENCODING_LINEAR) &&
        scene_add_texture(r->scene, name, "imagemap", is_spectrum, p, error))
        return name;
    g_free(name);
    return NULL;
}

/* A colour, or the texture of a type in its place. false with an error. */
static bool give_color(assimp_reader *r, params *p, const char *name,
                       const struct aiMaterial *m, enum aiTextureType type,
                       const double color[3], GError **error)
{
    GError *inner = NULL;
    g_autofree char *texture_name = add_texture(r, m, type, true, &inner);
    if (inner) {
        g_propagate_error(error, inner);
        return false;
    }
    if (texture_name)
        give_text(p, PARAM_TEXTURE, name, texture_name);
    else
        give_triple(p, PARAM_RGB, name, color[0], color[1], color[2]);
    return true;
}

/* ---- Kinds ---- */

typedef struct look {
    double diffuse[3], specular[3], emission[3], opacity, index, exponent;
    double metalness, roughness; /* < 0: not given */
    int illum;
} look;

static look look_of(const struct aiMaterial *m)
{
    look l = {.diffuse = {0.6, 0.6, 0.6},
              .opacity = 1.0,
              .index = 1.0,
              .metalness = -1.0,
              .roughness = -1.0};
    if (!get_color(m, AI_MATKEY_BASE_COLOR, l.diffuse))
        get_color(m, AI_MATKEY_COLOR_DIFFUSE, l.diffuse);
    get_color(m, AI_MATKEY_COLOR_SPECULAR, l.specular);
    get_color(m, AI_MATKEY_COLOR_EMISSIVE, l.emission);
    get_number(m, AI_MATKEY_OPACITY, &l.opacity);
    get_number(m, AI_MATKEY_REFRACTI, &l.index);
    get_number(m, AI_MATKEY_SHININESS, &l.exponent);
    get_number(m, AI_MATKEY_METALLIC_FACTOR, &l.metalness);
    get_number(m, AI_MATKEY_ROUGHNESS_FACTOR, &l.roughness);
    l.illum = get_illum(m);
    clamp_albedo(l.diffuse);
    clamp_albedo(l.specular);
    return l;
}

static bool is_glass(const look *l)
{
    bool by_model = l->illum == 4 || l->illum == 6 || l->illum == 7 || l->illum == 9;
    return by_model || (l->opacity < 1.0 && l->index > 1.0001);
}

static bool is_mirror(const look *l)
{
    bool by_model = l->illum == 3 || l->illum == 5 || l->illum == 8;
    return by_model && is_black(l->diffuse) && !is_black(l->specular);
}

/* The normals that a map of heights means: it may be a normal map by another name. */
static void give_heights(assimp_reader *r, params *p, const struct aiMaterial *m)
{
    static const image_read_options linear = {.encoding = ENCODING_LINEAR};
    g_autofree char *path = texture_path(r, m, aiTextureType_HEIGHT);
    double strength = 1.0;
    if (!path || !is_readable(r, path, linear.encoding))
        return;
    g_autoptr(image) heights =
        build_context_read_image(&r->scene->build, path, &linear, NULL);
    get_number(m, KEY_BUMP_STRENGTH, &strength);
    if (!height_map_is_normals(heights)) {
        g_autoptr(GBytes) normals = height_map_as_normals(heights, strength);
        char *name = g_strdup_printf("%s.%g.normals.pfm", path, strength);
        g_free(path);
        path = name;
        build_context_add_file(&r->scene->build, path, normals);
        assimp_note(r, "maps of height say nothing of how high: a step from black to "
                       "white across a texel is read as a slope of 45 degrees");
    }
    give_text(p, PARAM_STRING, "normalmap", path);
}

static void give_normals(assimp_reader *r, params *p, const struct aiMaterial *m)
{
    g_autofree char *path = texture_path(r, m, aiTextureType_NORMALS);
    if (path && is_readable(r, path, ENCODING_LINEAR))
        give_text(p, PARAM_STRING, "normalmap", path);
    else
        give_heights(r, p, m);
}

/* Fills p and names the kind. */
static const char *choose_kind(assimp_reader *r, const struct aiMaterial *m, params *p,
                               bool closed, GError **error)
{
    look l = look_of(m);
    const char *kind = "diffuse";
    if (is_glass(&l)) {
        kind = closed ? "dielectric" : "thindielectric";
        give_float(p, "eta", l.index > 1.0001 ? l.index : 1.5);
    } else if (l.metalness >= 0.0 || l.roughness >= 0.0) {
        kind = "gltf";
        give_float(p, "metallic", CLAMP(l.metalness, 0.0, 1.0));
        give_float(p, "roughness", l.roughness < 0.0 ? 0.5 : MIN(l.roughness, 1.0));
        if (!give_color(r, p, "basecolor", m, aiTextureType_DIFFUSE, l.diffuse, error))
            return NULL;
    } else if (is_mirror(&l)) {
        kind = "conductor";
        give_triple(p, PARAM_RGB, "reflectance", l.specular[0], l.specular[1],
                    l.specular[2]);
    } else {
        bool shiny =
            l.illum != 0 && l.illum != 1 && !is_black(l.specular) && l.exponent >= 1.0;
        if (!give_color(r, p, "reflectance", m, aiTextureType_DIFFUSE, l.diffuse, error))
            return NULL;
        if (shiny) {
            kind = "phong";
            give_triple(p, PARAM_RGB, "specular", l.specular[0], l.specular[1],
                        l.specular[2]);
            give_float(p, "exponent", MIN(l.exponent, 1e6));
        }
    }
    give_normals(r, p, m);
    return kind;
}

static params *read_emission(assimp_reader *r, const struct aiMaterial *m, GError **error)
{
    look l = look_of(m);
    if (is_black(l.emission))
        return NULL;
    params *p = assimp_params(r);
    for (int i = 0; i < 3; i++)
        l.emission[i] = MAX(l.emission[i], 0.0);
    give_color(r, p, "L", m, aiTextureType_EMISSIVE, l.emission, error);
    return p;
}

static params *read_alpha(assimp_reader *r, const struct aiMaterial *m, GError **error)
{
    look l = look_of(m);
    g_autofree char *cut = add_texture(r, m, aiTextureType_OPACITY, false, error);
    if (is_glass(&l) || (!cut && l.opacity >= 1.0))
        return NULL;
    params *p = assimp_params(r);
    if (cut)
        give_text(p, PARAM_TEXTURE, "alpha", cut);
    else
        give_float(p, "alpha", CLAMP(l.opacity, 0.0, 1.0));
    return p;
}

/* ---- All of it ---- */

const assimp_material *assimp_material_of(assimp_reader *r, unsigned index,
                                          GError **error)
{
    if (index >= r->source->mNumMaterials) {
        error_at(error, (source_place){intern(r->path), 0, 0},
                 "a mesh has material %u of %u", index, r->source->mNumMaterials);
        return NULL;
    }
    if (!r->materials) {
        r->materials = g_new0(assimp_material, r->source->mNumMaterials);
        for (unsigned i = 0; i < r->source->mNumMaterials; i++)
            r->materials[i] =
                (assimp_material){.index = NO_INDEX, .open_index = NO_INDEX};
    }
    assimp_material *out = &r->materials[index];
    const struct aiMaterial *m = r->source->mMaterials[index];
    if (out->is_read)
        return out;
    GError *inner = NULL;
    look l = look_of(m);
    out->is_glass = is_glass(&l);
    out->area_light = read_emission(r, m, &inner);
    if (!inner)
        out->alpha = read_alpha(r, m, &inner);
    out->is_read = !inner;
    if (inner)
        g_propagate_error(error, inner);
    return out->is_read ? out : NULL;
}

int assimp_material_index(assimp_reader *r, unsigned index, bool closed, GError **error)
{
    assimp_material *of = &r->materials[index];
    int *made = closed ? &of->index : &of->open_index;
    if (*made != NO_INDEX)
        return *made;
    const struct aiMaterial *m = r->source->mMaterials[index];
    struct aiString name = {0};
    aiGetMaterialString(m, AI_MATKEY_NAME, &name);
    bool is_new = name.data[0] && scene_find_material(r->scene, name.data) == NO_INDEX;
    g_autoptr(params) p = assimp_params(r);
    const char *kind = choose_kind(r, m, p, closed, error);
    if (kind)
        *made = scene_add_material(r->scene, is_new ? name.data : NULL, kind, p, error);
    return *made;
}
