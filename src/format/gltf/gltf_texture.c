/*
 * glTF texture references as textures of the scene. Each use makes a texture of its own,
 * named after its image and what is taken of it, unless the same is there already.
 */
#include "format/gltf/gltf.h"

#include "base/intern.h"
#include "format/given.h"
#include "format/pbrt/pbrt_text.h"

#include <string.h>

enum { NEAREST = 9728, CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648, REPEAT = 10497 };

/* The image of a texture: WebP and Basis have a plain one beside them, or are refused. */
static json_value image_of(gltf *g, const json_value *tex, json_value *array,
                           gint64 *index)
{
    json_value img = gltf_refer(g, tex, "source", "images", array, index);
    if (!json_exists(&img))
        json_fail(tex, "expected a \"source\" (PNG or JPEG), found none");
    return img;
}

/* Embedded images get a path that no file has: the glTF file's with their number. */
static const char *embedded_path(gltf *g, GBytes *bytes, gint64 index)
{
    gsize size;
    const uint8_t *data = g_bytes_get_data(bytes, &size);
    bool is_png = size > 4 && memcmp(data, "\x89PNG", 4) == 0;
    g_autofree char *path = g_canonicalize_filename(g->path, NULL);
    g_autofree char *name =
        g_strdup_printf("%s.image%d.%s", path, (int)index, is_png ? "png" : "jpg");
    build_context_add_file(&g->builder->build, name, bytes);
    return intern(name);
}

static const char *path_of(gltf *g, const json_value *img, gint64 index)
{
    const char *uri = json_text(img, "uri");
    gint64 buffer = json_whole(img, "bufferView", GLTF_MOST);
    json_value at = json_member(img, "uri");
    if (uri && !g_str_has_prefix(uri, "data:")) {
        g_autofree char *path = gltf_uri_path(g, &at, uri);
        return path ? intern(path) : NULL;
    }
    if (!uri && buffer < 0) {
        json_fail(img, "expected a \"uri\" or a \"bufferView\", found none");
        return NULL;
    }
    g_autoptr(GBytes) bytes =
        uri ? gltf_uri_bytes(g, &at, uri) : gltf_view_bytes(g, buffer);
    return bytes ? embedded_path(g, bytes, index) : NULL;
}

const char *gltf_image_path(gltf *g, const json_value *info)
{
    json_value textures, images;
    gint64 index;
    json_value tex = gltf_refer(g, info, "index", "textures", &textures, &index);
    if (!json_exists(&tex))
        return NULL;
    json_value img = image_of(g, &tex, &images, &index);
    return json_exists(&img) ? path_of(g, &img, index) : NULL;
}

static const char *wrap_name(const json_value *sampler, const char *key)
{
    gint64 wrap = json_whole(sampler, key, GLTF_MOST);
    if (wrap >= 0 && wrap != REPEAT && wrap != CLAMP_TO_EDGE && wrap != MIRRORED_REPEAT)
        json_fail(sampler, "expected \"%s\" 10497, 33071 or 33648, found %d", key,
                  (int)wrap);
    return wrap == CLAMP_TO_EDGE     ? "clamp"
           : wrap == MIRRORED_REPEAT ? "mirror"
                                     : "repeat";
}

static void give_sampler(gltf *g, params *p, const json_value *info)
{
    json_value textures, samplers;
    gint64 index;
    json_value tex = gltf_refer(g, info, "index", "textures", &textures, &index);
    json_value sampler = gltf_refer(g, &tex, "sampler", "samplers", &samplers, &index);
    give_text(p, PARAM_STRING, "uwrap", wrap_name(&sampler, "wrapS"));
    give_text(p, PARAM_STRING, "vwrap", wrap_name(&sampler, "wrapT"));
    if (json_whole(&sampler, "magFilter", GLTF_MOST) == NEAREST)
        give_text(p, PARAM_STRING, "filter", "point");
}

/* Meshes keep two sets of coordinates. */
static void give_set(gltf *g, params *p, const json_value *info, const json_value *moved)
{
    gint64 own = json_whole(info, "texCoord", 64);
    gint64 other = json_whole(moved, "texCoord", 64);
    gint64 set = MAX(0, other >= 0 ? other : own);
    if (set > 1)
        gltf_note(g, LOG_WARNING,
                  "texture coordinates beyond the second set are left out: such textures "
                  "use the first");
    if (set == 1)
        give_integer(p, "uvset", 1);
}

static void give_coordinates(gltf *g, params *p, const json_value *info)
{
    json_value extensions;
    json_value t = gltf_extension(info, "KHR_texture_transform", &extensions);
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
    give_set(g, p, info, &t);
    if (!json_exists(&t))
        return;
    json_numbers(&t, "offset", offset, 2);
    json_numbers(&t, "scale", scale, 2);
    give_float(p, "udelta", offset[0]);
    give_float(p, "vdelta", offset[1]);
    give_float(p, "uscale", scale[0]);
    give_float(p, "vscale", scale[1]);
    give_float(p, "rotation", json_real(&t, "rotation", 0.0));
}

static void give_factor(params *p, param_type type, const char *name,
                        const double *factor, unsigned n)
{
    if (n == 1)
        give_float(p, name, factor[0]);
    else
        give_triple(p, type, name, factor[0], factor[1], factor[2]);
}

/* The texture of these parameters: its name is made of them, so that equal ones are one.
 */
static char *texture_name(const params *p)
{
    g_autoptr(GString) text = g_string_new(NULL);
    for (guint i = 0; i < p->list->len; i++)
        pbrt_text_param(text, p->list->pdata[i], NULL);
    g_autofree char *sum = g_compute_checksum_for_string(G_CHECKSUM_MD5, text->str, -1);
    return g_strdup_printf("image-%.12s", sum);
}

/* Adds parameter `name` made of a texture of these parameters. */
static void give_texture(gltf *g, params *p, const char *name, const json_value *info,
                         const params *img, bool is_number)
{
    g_autofree char *unique = texture_name(img);
    GHashTable *known = is_number ? g->builder->build.float_textures
                                  : g->builder->build.spectrum_textures;
    GError *error = NULL;
    if (!gltf_failed(g) && !g_hash_table_contains(known, unique) &&
        !builder_add_texture(g->builder, unique, "gltf", !is_number, img, &error))
        gltf_take_error(g, info, error);
    give_text(p, PARAM_TEXTURE, name, unique);
}

/* What names an image and how it lies on the surface; nothing if there is none. */
static bool give_image(gltf *g, params *p, const json_value *info)
{
    const char *path = json_exists(info) ? gltf_image_path(g, info) : NULL;
    if (!path)
        return false;
    give_text(p, PARAM_STRING, "filename", path);
    give_sampler(g, p, info);
    give_coordinates(g, p, info);
    return true;
}

void gltf_give_textured(gltf *g, params *p, const char *name, const json_value *info,
                        const gltf_channel *how, const double *factor)
{
    g_autoptr(params) img = gltf_params(g);
    bool has_image = give_image(g, img, info), is_number = how->channel != NULL;
    if (gltf_failed(g))
        return;
    if (!has_image && !how->vertex_color) {
        double plain = how->invert ? 1.0 - *factor : *factor;
        give_factor(p, PARAM_RGB, name, is_number ? &plain : factor, is_number ? 1 : 3);
        return;
    }
    if (is_number)
        give_text(img, PARAM_STRING, "channel", how->channel);
    if (how->vertex_color)
        give_bool(img, "vertexcolor", true);
    if (how->invert)
        give_bool(img, "invert", true);
    if (how->is_cut)
        give_float(img, "cutoff", how->cut);
    give_factor(img, PARAM_RGB, "factor", factor, is_number ? 1 : 3);
    give_texture(g, p, name, info, img, is_number);
}

void gltf_give_normals(gltf *g, params *p, const json_value *info)
{
    g_autoptr(params) img = gltf_params(g);
    if (!give_image(g, img, info))
        return;
    give_text(img, PARAM_STRING, "encoding", "linear");
    give_texture(g, p, "normalmap", info, img, false);
    give_float(p, "normalscale", json_real(info, "scale", 1.0));
}
