/*
 * Materials of models are those of Wavefront's MTL, with more behind them.
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
#include "format/model/model_scene.h"

#include "base/intern.h"
#include "format/given.h"
#include "format/gltf/height_map.h"
#include "texture/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_black(const double c[3])
{
    return !(c[0] + c[1] + c[2] > 0.0);
}

/* ---- Textures ---- */

/* The image within the file that a name means: "*3", or the name it had; NULL: none. */
static const model_image *embedded_image(const model_builder *b, const char *name)
{
    const GArray *images = b->source->images;
    guint64 number = G_MAXUINT64;
    if (name[0] == '*')
        number = g_ascii_strtoull(name + 1, NULL, 10);
    for (guint i = 0; i < images->len; i++) {
        const model_image *image_is = &g_array_index(images, model_image, i);
        if (number == i || (*image_is->name && strcmp(image_is->name, name) == 0))
            return image_is;
    }
    return NULL;
}

/* An image within the file: known to the scene under a name of its own. */
static char *embedded_path(model_builder *b, const char *name)
{
    const model_image *image_is = embedded_image(b, name);
    if (!image_is)
        return NULL;
    if (image_is->size == 0) {
        model_tell(b, "an image of bare pixels within the file is left out");
        return NULL;
    }
    g_autofree char *absolute = g_canonicalize_filename(b->path, NULL);
    g_autofree char *extension = g_strcanon(g_strdup(image_is->extension),
                                            G_CSET_A_2_Z G_CSET_a_2_z G_CSET_DIGITS, '_');
    guint number = (guint)(image_is - &g_array_index(b->source->images, model_image, 0));
    char *path = g_strdup_printf("%s.%u.%s", absolute, number, extension);
    g_autoptr(GBytes) bytes = g_bytes_new(image_is->bytes, image_is->size);
    build_context_add_file(&b->builder->build, path, bytes);
    return path;
}

/* The path of a texture, with backslashes mended; NULL, noted, if there is no such file.
 */
static char *texture_path(model_builder *b, const model_material *m, stream_map map)
{
    const char *name = m->maps[map];
    if (!*name)
        return NULL;
    char *inside = embedded_path(b, name);
    if (inside || name[0] == '*')
        return inside;
    g_autofree char *mended = g_strdelimit(g_strdup(name), "\\", '/');
    char *path = g_canonicalize_filename(mended, b->directory);
    scene_sources_add(b->builder->build.sources, path);
    if (g_file_test(path, G_FILE_TEST_IS_REGULAR))
        return path;
    g_free(path);
    g_autofree char *base = g_path_get_basename(mended);
    path = g_build_filename(b->directory, base, NULL);
    if (g_file_test(path, G_FILE_TEST_IS_REGULAR))
        return path;
    model_tell(b, "there is no image '%s': its texture is left out", mended);
    g_free(path);
    return NULL;
}

/* Images we do not decode (DDS ...) leave the plain colour. What can be read is at hand
   for the texture that reads it alike. */
static bool is_readable(model_builder *b, const char *path, image_encoding encoding)
{
    const image_read_options options = {.encoding = encoding};
    g_autoptr(GError) error = NULL;
    picture *pic = picture_read_file(&b->builder->build, path, &options, &error);
    if (!pic)
        model_tell(b, "a texture is left out: %s", error->message);
    bool readable = pic != NULL;
    picture_unref(pic);
    return readable;
}

/* The texture of a map as one of the scene; its name, or NULL if there is none. */
static char *add_texture(model_builder *b, const model_material *m, stream_map map,
                         bool is_spectrum, GError **error)
{
    g_autofree char *path = texture_path(b, m, map);
    if (!path)
        return NULL;
    char *name = g_strdup(path);
    GHashTable *known = is_spectrum ? b->builder->build.spectrum_textures
                                    : b->builder->build.float_textures;
    if (g_hash_table_contains(known, name))
        return name;
    g_autoptr(params) p = model_params(b);
    give_text(p, PARAM_STRING, "filename", path);
    if (!is_spectrum)
        give_text(p, PARAM_STRING, "encoding", "linear");
    if (is_readable(b, path, is_spectrum ? ENCODING_AUTO : ENCODING_LINEAR) &&
        builder_add_texture(b->builder, name, "imagemap", is_spectrum, p, error))
        return name;
    g_free(name);
    return NULL;
}

/* A colour, or the texture of a map in its place. false with an error. */
static bool give_color(model_builder *b, params *p, const char *name,
                       const model_material *m, stream_map map, const double color[3],
                       GError **error)
{
    GError *inner = NULL;
    g_autofree char *texture_name = add_texture(b, m, map, true, &inner);
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

static look look_of(const model_material *m)
{
    const stream_material *n = m->numbers;
    look l = {.opacity = (double)n->opacity,
              .index = (double)n->index,
              .exponent = (double)n->exponent,
              .metalness = (double)n->metalness,
              .roughness = (double)n->roughness,
              .illum = n->illum};
    for (int i = 0; i < 3; i++) {
        l.diffuse[i] = CLAMP((double)n->diffuse[i], 0.0, 1.0);
        l.specular[i] = CLAMP((double)n->specular[i], 0.0, 1.0);
        l.emission[i] = (double)n->emission[i];
    }
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
static void give_heights(model_builder *b, params *p, const model_material *m)
{
    static const image_read_options linear = {.encoding = ENCODING_LINEAR};
    g_autofree char *path = texture_path(b, m, STREAM_MAP_HEIGHTS);
    double strength = (double)m->numbers->bump_strength;
    if (!path || !is_readable(b, path, linear.encoding))
        return;
    g_autoptr(image) heights =
        build_context_read_image(&b->builder->build, path, &linear, NULL);
    if (!height_map_is_normals(heights)) {
        g_autoptr(GBytes) normals = height_map_as_normals(heights, strength);
        if (!normals) {
            model_tell(b, "there is no memory for a map of heights, which is left out");
            return;
        }
        char *name = g_strdup_printf("%s.%g.normals.pfm", path, strength);
        g_free(path);
        path = name;
        build_context_add_file(&b->builder->build, path, normals);
        model_tell(b, "maps of height say nothing of how high: a step from black to "
                      "white across a texel is read as a slope of 45 degrees");
    }
    give_text(p, PARAM_STRING, "normalmap", path);
}

static void give_normals(model_builder *b, params *p, const model_material *m)
{
    g_autofree char *path = texture_path(b, m, STREAM_MAP_NORMALS);
    if (path && is_readable(b, path, ENCODING_LINEAR))
        give_text(p, PARAM_STRING, "normalmap", path);
    else
        give_heights(b, p, m);
}

/* Fills p and names the kind. */
static const char *choose_kind(model_builder *b, const model_material *m, params *p,
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
        if (!give_color(b, p, "basecolor", m, STREAM_MAP_COLOR, l.diffuse, error))
            return NULL;
    } else if (is_mirror(&l)) {
        kind = "conductor";
        give_triple(p, PARAM_RGB, "reflectance", l.specular[0], l.specular[1],
                    l.specular[2]);
    } else {
        bool shiny =
            l.illum != 0 && l.illum != 1 && !is_black(l.specular) && l.exponent >= 1.0;
        if (!give_color(b, p, "reflectance", m, STREAM_MAP_COLOR, l.diffuse, error))
            return NULL;
        if (shiny) {
            kind = "phong";
            give_triple(p, PARAM_RGB, "specular", l.specular[0], l.specular[1],
                        l.specular[2]);
            give_float(p, "exponent", MIN(l.exponent, 1e6));
        }
    }
    give_normals(b, p, m);
    return kind;
}

static params *read_emission(model_builder *b, const model_material *m, GError **error)
{
    look l = look_of(m);
    if (is_black(l.emission))
        return NULL;
    params *p = model_params(b);
    for (int i = 0; i < 3; i++)
        l.emission[i] = MAX(l.emission[i], 0.0);
    give_color(b, p, "L", m, STREAM_MAP_EMISSION, l.emission, error);
    return p;
}

static params *read_alpha(model_builder *b, const model_material *m, GError **error)
{
    look l = look_of(m);
    g_autofree char *cut = add_texture(b, m, STREAM_MAP_OPACITY, false, error);
    if (is_glass(&l) || (!cut && l.opacity >= 1.0))
        return NULL;
    params *p = model_params(b);
    if (cut)
        give_text(p, PARAM_TEXTURE, "alpha", cut);
    else
        give_float(p, "alpha", CLAMP(l.opacity, 0.0, 1.0));
    return p;
}

/* ---- All of it ---- */

const model_look *model_look_of(model_builder *b, unsigned index, GError **error)
{
    const GArray *materials = b->source->materials;
    if (!b->looks) {
        b->looks = g_new0(model_look, materials->len);
        for (guint i = 0; i < materials->len; i++)
            b->looks[i] = (model_look){.index = NO_INDEX, .open_index = NO_INDEX};
    }
    model_look *out = &b->looks[index];
    const model_material *m = &g_array_index(materials, model_material, index);
    if (out->is_read)
        return out;
    GError *inner = NULL;
    look l = look_of(m);
    out->is_glass = is_glass(&l);
    out->area_light = read_emission(b, m, &inner);
    if (!inner)
        out->alpha = read_alpha(b, m, &inner);
    out->is_read = !inner;
    if (inner)
        g_propagate_error(error, inner);
    return out->is_read ? out : NULL;
}

int model_material_index(model_builder *b, unsigned index, bool closed, GError **error)
{
    model_look *of = &b->looks[index];
    int *made = closed ? &of->index : &of->open_index;
    if (*made != NO_INDEX)
        return *made;
    const model_material *m = &g_array_index(b->source->materials, model_material, index);
    g_autofree char *name = g_utf8_make_valid(m->name, -1);
    bool is_new = *name && builder_find_material(b->builder, name) == NO_INDEX;
    g_autoptr(params) p = model_params(b);
    const char *kind = choose_kind(b, m, p, closed, error);
    if (kind)
        *made = builder_add_material(b->builder, is_new ? name : NULL, kind, p, error);
    return *made;
}
