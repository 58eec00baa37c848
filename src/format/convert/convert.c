/*
 * Writing a scene down while it is built: every call that a reader makes becomes the
 * directive that makes pbrt's reader do the same.
 *
 *   reader ─► builder_add_* ─► listener ─► world, options (text) ─► OUT.pbrt
 *                                  └──► OUT-files/  meshes as PLY, images as they were
 *
 * The options (film, camera ...) may come last, so both texts are kept till the end.
 * Meshes stay in their own space and transforms keep all digits, so that the scene that
 * is read back is the same to the last bit, or nearly.
 */
#include "format/convert/convert.h"

#include "base/output.h"
#include "format/convert/convert_files.h"
#include "format/convert/convert_settings.h"
#include "format/format.h"
#include "format/pbrt/pbrt_text.h"
#include "format/ply/ply_write.h"

#include <string.h>

typedef struct converter {
    scene_builder *builder; /**< being built; its tables name textures */
    converted_files files;
    GString *world, *film, *filter, *media, *camera;
    GString *around;      /**< the MediumInterface that holds now; empty: none yet */
    bool around_changed;  /**< since the object began that is open */
    GPtrArray *objects;   /**< names by index, owned */
    GPtrArray *materials; /**< names by index, owned */
    unsigned n_meshes;
} converter;

static bool is_identity(const transform *t)
{
    const transform identity = transform_identity();
    return transform_equal(t, &identity);
}

/* ---- Parameters ---- */

/* Strings that name files, in all the directives that know any. */
static bool names_file(const param *q)
{
    static const char *const names[] = {"filename", "normalmap", "lensfile", NULL};
    return q->type == PARAM_STRING && q->n == 1 && g_strv_contains(names, q->name);
}

static void append_param(converter *c, GString *out, const params *p, const param *q)
{
    const char *moved = NULL;
    if (names_file(q)) {
        g_autofree char *path = g_canonicalize_filename(q->strings[0], p->base_directory);
        moved = converted_files_copy(&c->files, path);
    }
    char *strings[] = {(char *)moved, NULL};
    pbrt_text_param(out, q, moved ? strings : NULL);
}

static void append_params(converter *c, GString *out, const params *p,
                          const char *without)
{
    for (guint i = 0; i < p->list->len; i++) {
        const param *q = p->list->pdata[i];
        if (!q->is_default && !(without && strcmp(q->name, without) == 0))
            append_param(c, out, p, q);
    }
    g_string_append_c(out, '\n');
}

/* What an Attribute has said of directives of this sort: they need not know it. */
static void append_defaults(converter *c, GString *out, const params *p, const char *sort)
{
    bool any = false;
    for (guint i = 0; i < p->list->len; i++) {
        const param *q = p->list->pdata[i];
        if (!q->is_default)
            continue;
        if (!any)
            g_string_append_printf(out, "Attribute \"%s\"", sort);
        any = true;
        append_param(c, out, p, q);
    }
    if (any)
        g_string_append_c(out, '\n');
}

static bool is_srgb(const params *p)
{
    return !p->space || p->space == color_space_srgb();
}

/* A directive that stands in a space of its own, as all those here. */
static void begin(converter *c, const params *p, const char *sort,
                  const transform *to_world)
{
    GString *out = c->world;
    g_string_append(out, "AttributeBegin\n");
    if (!is_srgb(p))
        g_string_append_printf(out, "ColorSpace \"%s\"\n", color_space_name(p->space));
    append_defaults(c, out, p, sort);
    if (!is_identity(to_world))
        pbrt_text_transform(out, to_world->m);
}

static void end(GString *out)
{
    g_string_append(out, "AttributeEnd\n");
}

/* ---- The calls ---- */

static void on_texture(void *data, const char *name, const char *kind, bool is_spectrum,
                       const params *p)
{
    converter *c = data;
    begin(c, p, "texture", &p->to_world);
    g_string_append(c->world, "Texture ");
    pbrt_text_string(c->world, name);
    g_string_append_printf(c->world, " \"%s\" \"%s\"", is_spectrum ? "spectrum" : "float",
                           kind);
    append_params(c, c->world, p, NULL);
    end(c->world);
}

/* Its name, for shapes that come before it. */
static void on_material_awaited(void *data, int index, const char *name)
{
    converter *c = data;
    g_ptr_array_set_size(c->materials, MAX((int)c->materials->len, index + 1));
    c->materials->pdata[index] = g_strdup(name);
}

static void on_material(void *data, int index, const char *name, const char *kind,
                        const params *p)
{
    converter *c = data;
    char *known = name ? g_strdup(name) : g_strdup_printf("material-%d", index);
    const transform identity = transform_identity();
    g_ptr_array_set_size(c->materials, MAX((int)c->materials->len, index + 1));
    g_free(c->materials->pdata[index]);
    c->materials->pdata[index] = known;
    begin(c, p, "material", &identity);
    g_string_append(c->world, "MakeNamedMaterial ");
    pbrt_text_string(c->world, known);
    g_string_append_printf(c->world, " \"string type\" \"%s\"", kind);
    append_params(c, c->world, p, "type");
    end(c->world);
}

/* A preset goes before what an Attribute gave; "preset" "" is none. */
static bool is_measured(const params *p)
{
    const char *name = "";
    return params_string(p, "preset", &name, NULL) && *name;
}

/* An Attribute may say what homogeneous media do not know, or need not. */
static bool medium_needs(const params *p, const param *q)
{
    static const char *const measured[] = {"sigma_a", "sigma_s", NULL};
    g_auto(GStrv) known = g_strsplit(medium_kind_parameters(0), " ", -1);
    if (strcmp(q->name, "type") == 0)
        return false;
    return !q->is_default || (g_strv_contains((const char *const *)known, q->name) &&
                              !(is_measured(p) && g_strv_contains(measured, q->name)));
}

/* Before the camera, which may stand in it: there are no AttributeBegins. */
static void on_medium(void *data, const char *name, const char *kind, const params *p)
{
    converter *c = data;
    if (!is_srgb(p))
        g_string_append_printf(c->media, "ColorSpace \"%s\"\n",
                               color_space_name(p->space));
    g_string_append(c->media, "MakeNamedMedium ");
    pbrt_text_string(c->media, name);
    g_string_append_printf(c->media, " \"string type\" \"%s\"", kind);
    for (guint i = 0; i < p->list->len; i++)
        if (medium_needs(p, p->list->pdata[i]))
            append_param(c, c->media, p, p->list->pdata[i]);
    g_string_append(c->media, is_srgb(p) ? "\n" : "\nColorSpace \"srgb\"\n");
}

static void on_medium_interface(void *data, const char *inside, const char *outside)
{
    converter *c = data;
    g_string_assign(c->around, "MediumInterface ");
    pbrt_text_string(c->around, inside ? inside : "");
    g_string_append_c(c->around, ' ');
    pbrt_text_string(c->around, outside ? outside : "");
    g_string_append_c(c->around, '\n');
    g_string_append(c->world, c->around->str);
    c->around_changed = true;
}

static void on_light(void *data, const char *kind, const params *p,
                     const transform *to_world)
{
    converter *c = data;
    begin(c, p, "light", to_world);
    g_string_append_printf(c->world, "LightSource \"%s\"", kind);
    append_params(c, c->world, p, NULL);
    end(c->world);
}

/* What stands before a shape: its material, light and transform. */
static void begin_shape(converter *c, const shape_place *at, const params *p)
{
    const params *light_is = at->area_light;
    g_string_append(c->world, "AttributeBegin\n");
    if (at->material == NO_INDEX) {
        g_string_append(c->world, "Material \"interface\"\n");
    } else {
        g_string_append(c->world, "NamedMaterial ");
        pbrt_text_string(c->world, c->materials->pdata[at->material]);
        g_string_append_c(c->world, '\n');
    }
    if (light_is) {
        g_string_append_printf(
            c->world, "ColorSpace \"%s\"\n",
            color_space_name(light_is->space ? light_is->space : color_space_srgb()));
        append_defaults(c, c->world, light_is, "light");
        g_string_append(c->world, "AreaLightSource \"diffuse\"");
        append_params(c, c->world, light_is, NULL);
    }
    if (p && p->space)
        g_string_append_printf(c->world, "ColorSpace \"%s\"\n",
                               color_space_name(p->space));
    if (p)
        append_defaults(c, c->world, p, "shape");
    if (at->reverse_orientation)
        g_string_append(c->world, "ReverseOrientation\n");
    if (!is_identity(&at->to_world))
        pbrt_text_transform(c->world, at->to_world.m);
}

static void on_shape(void *data, const char *kind, const params *p, const shape_place *at)
{
    converter *c = data;
    begin_shape(c, at, p);
    g_string_append_printf(c->world, "Shape \"%s\"", kind);
    append_params(c, c->world, p, NULL);
    end(c->world);
}

/* The name of a float texture. */
static const char *texture_name(const converter *c, const texture *t)
{
    GHashTableIter iter;
    gpointer name, value;
    g_hash_table_iter_init(&iter, c->builder->build.float_textures);
    while (g_hash_table_iter_next(&iter, &name, &value))
        if (value == t)
            return name;
    return "";
}

/* What a mesh's parameters would have said. */
static void append_place(converter *c, const shape_place *at)
{
    if (at->camera_hidden)
        g_string_append(c->world, " \"bool camera_visible\" false");
    if (at->alpha && at->alpha->texture) {
        g_string_append(c->world, " \"texture alpha\" ");
        pbrt_text_string(c->world, texture_name(c, at->alpha->texture));
    } else if (at->alpha && at->alpha->constant < 1.0f) {
        g_autoptr(params) p = params_new((source_place){0}, "/", NULL);
        params_add_numbers(p, p->place, PARAM_FLOAT, "alpha", &at->alpha->constant, 1,
                           NULL);
        pbrt_text_param(c->world, p->list->pdata[0], NULL);
    }
    g_string_append_c(c->world, '\n');
}

static void on_mesh(void *data, const mesh *m, const shape_place *at)
{
    converter *c = data;
    begin_shape(c, at, NULL);
    g_autofree char *name = g_strdup_printf("mesh-%u.ply", ++c->n_meshes);
    output *out = converted_files_open(&c->files, name);
    if (out) {
        g_autofree char *shown = g_strdup_printf("%s/%s", c->files.folder, name);
        ply_write(out, m);
        converted_files_close(&c->files, name, out);
        g_string_append(c->world, "Shape \"plymesh\" \"string filename\" ");
        pbrt_text_string(c->world, shown);
    }
    append_place(c, at);
    end(c->world);
}

static void on_option(converter *c, GString *out, const char *directive, const char *kind,
                      const params *p)
{
    g_string_truncate(out, 0);
    if (!is_srgb(p))
        g_string_append_printf(out, "ColorSpace \"%s\"\n", color_space_name(p->space));
    g_string_append_printf(out, "%s \"%s\"", directive, kind);
    append_params(c, out, p, NULL);
    if (!is_srgb(p))
        g_string_append(out, "ColorSpace \"srgb\"\n");
}

static void on_film(void *data, const char *kind, const params *p)
{
    converter *c = data;
    g_string_truncate(c->film, 0);
    g_string_append_printf(c->film, "Film \"%s\"", kind);
    for (guint i = 0; i < p->list->len; i++)
        pbrt_text_param(c->film, p->list->pdata[i], NULL);
    g_string_append_c(c->film, '\n');
    if (!is_srgb(p)) {
        g_autofree char *space =
            g_strdup_printf("ColorSpace \"%s\"\n", color_space_name(p->space));
        g_string_prepend(c->film, space);
        g_string_append(c->film, "ColorSpace \"srgb\"\n");
    }
}

static void on_filter(void *data, const char *kind, const params *p)
{
    converter *c = data;
    on_option(c, c->filter, "PixelFilter", kind, p);
}

static void on_camera(void *data, const char *kind, const params *p,
                      const transform *to_world)
{
    converter *c = data;
    on_option(c, c->camera, "Camera", kind, p);
    g_string_prepend(c->camera, c->around->str);
    g_autoptr(GString) look = g_string_new(NULL);
    pbrt_text_transform(look, to_world->inverse);
    g_string_prepend(c->camera, look->str);
    g_string_append(c->camera, "Identity\n");
}

/* ---- What moves, and what stands many times ---- */

/* "Transform" of something that may move, by pbrt's two times. */
static void append_motion(GString *out, const motion *m, bool inverse)
{
    if (!m->moves) {
        pbrt_text_transform(out, inverse ? m->start.inverse : m->start.m);
        return;
    }
    g_string_append(out, "ActiveTransform StartTime ");
    pbrt_text_transform(out, inverse ? m->start.inverse : m->start.m);
    g_string_append(out, "ActiveTransform EndTime ");
    pbrt_text_transform(out, inverse ? m->end.inverse : m->end.m);
    g_string_append(out, "ActiveTransform All\n");
}

static void append_times(GString *out, const motion *m)
{
    char text[2][G_ASCII_DTOSTR_BUF_SIZE];
    if (m->moves)
        g_string_append_printf(
            out, "TransformTimes %s %s\n",
            g_ascii_formatd(text[0], sizeof text[0], "%.17g", m->start_time),
            g_ascii_formatd(text[1], sizeof text[1], "%.17g", m->end_time));
}

/* The transform that on_camera wrote gives way to two. */
static void on_camera_motion(void *data, const motion *to_world)
{
    converter *c = data;
    if (!to_world->moves)
        return;
    const char *rest = strchr(c->camera->str, '\n') + 1;
    g_autoptr(GString) moving = g_string_new(NULL);
    append_times(moving, to_world);
    append_motion(moving, to_world, true);
    g_string_append(moving, rest);
    g_string_assign(c->camera, moving->str);
}

static void on_object_begin(void *data, int index, const char *name)
{
    converter *c = data;
    char *known = name ? g_strdup(name) : g_strdup_printf("object-%d", index);
    g_ptr_array_set_size(c->objects, MAX((int)c->objects->len, index + 1));
    c->objects->pdata[index] = known;
    c->around_changed = false;
    g_string_append(c->world, "ObjectBegin ");
    pbrt_text_string(c->world, known);
    g_string_append_c(c->world, '\n');
}

static void on_object_end(void *data)
{
    converter *c = data;
    g_string_append(c->world, "ObjectEnd\n");
    if (c->around_changed) /* which ObjectEnd takes back */
        g_string_append(c->world, c->around->str);
}

static void on_instance(void *data, int object, const motion *to_world)
{
    converter *c = data;
    g_string_append(c->world, "AttributeBegin\n");
    append_times(c->world, to_world);
    append_motion(c->world, to_world, false);
    g_string_append(c->world, "ObjectInstance ");
    pbrt_text_string(c->world, c->objects->pdata[object]);
    g_string_append(c->world, "\nAttributeEnd\n");
}

/* ---- All of it ---- */

static bool write_scene(converter *c, const char *in, const char *path, GError **error)
{
    g_autofree char *base = g_path_get_basename(in);
    g_autoptr(GString) text = g_string_new(NULL);
    g_string_append_printf(text, "# %s\n", g_strdelimit(base, "\r\n", ' '));
    g_string_append_len(text, c->film->str, (gssize)c->film->len);
    g_string_append(text, c->filter->str);
    convert_append_switches(text, &c->builder->scene->switches);
    convert_append_settings(text, &c->builder->scene->settings);
    g_string_append(text, c->media->str);
    g_string_append(text, c->camera->str);
    g_string_append(text, "WorldBegin\n");
    g_string_append_len(text, c->world->str, (gssize)c->world->len);
    return output_write_text(path, text->str, error);
}

static void converter_init(converter *c, const char *out)
{
    *c = (converter){.world = g_string_new(NULL),
                     .film = g_string_new(NULL),
                     .filter = g_string_new(NULL),
                     .camera = g_string_new(NULL),
                     .media = g_string_new(NULL),
                     .around = g_string_new(NULL),
                     .objects = g_ptr_array_new_with_free_func(g_free),
                     .materials = g_ptr_array_new_with_free_func(g_free)};
    converted_files_init(&c->files, out);
}

static void converter_clear(converter *c)
{
    g_string_free(c->world, TRUE);
    g_string_free(c->film, TRUE);
    g_string_free(c->filter, TRUE);
    g_string_free(c->camera, TRUE);
    g_string_free(c->media, TRUE);
    g_string_free(c->around, TRUE);
    g_ptr_array_unref(c->objects);
    g_ptr_array_unref(c->materials);
    converted_files_clear(&c->files);
}

bool format_convert(const char *in, const char *out, const load_options *options,
                    GError **error)
{
    if (!g_str_has_suffix(out, ".pbrt")) {
        error_set(error, ERROR_USAGE, "%s: expected a name that ends in .pbrt", out);
        return false;
    }
    converter c;
    converter_init(&c, out);
    const scene_listener listener = {.data = &c,
                                     .texture = on_texture,
                                     .material = on_material,
                                     .material_awaited = on_material_awaited,
                                     .medium = on_medium,
                                     .medium_interface = on_medium_interface,
                                     .light = on_light,
                                     .shape = on_shape,
                                     .mesh = on_mesh,
                                     .film = on_film,
                                     .filter = on_filter,
                                     .camera = on_camera,
                                     .camera_motion = on_camera_motion,
                                     .object_begin = on_object_begin,
                                     .object_end = on_object_end,
                                     .instance = on_instance};
    const load_options nothing_said = {0};
    g_autoptr(scene_builder) b = format_builder(options ? options : &nothing_said);
    scene_sources *own = b->build.sources ? NULL : scene_sources_new(NULL, NULL);
    if (own)
        b->build.sources = own;
    b->listener = &listener;
    c.builder = b;
    c.files.builder = b;
    bool done = output_possible(out, error) && format_read(b, in, error);
    if (done && c.files.error) {
        g_propagate_error(error, g_steal_pointer(&c.files.error));
        done = false;
    }
    done = done && output_spares(out, scene_sources_paths(b->build.sources), error) &&
           converted_files_commit(&c.files, error) && write_scene(&c, in, out, error);
    converter_clear(&c);
    scene_sources_free(own);
    return done;
}
