/*
 * The pbrt-v4 reader: walks the directives of a file and of those it includes. Errors are
 * collected, so that a scene with five mistakes takes one run to mend, not five.
 */
#include "base/wanted.h"
#include "format/pbrt/pbrt_parser.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/memory.h"
#include "format/reader.h"

#include <string.h>

typedef enum directive_phase { ANYWHERE, BEFORE_WORLD, IN_WORLD } directive_phase;

typedef struct directive {
    const char *name;
    directive_phase phase;
    directive_handler handle;
} directive;

/* About what a directive leaves behind, beside arrays. */
enum { DIRECTIVE_SIZE = 1024 };

static bool handle_include(pbrt_parser *parser, source_place place);
static bool handle_import(pbrt_parser *parser, source_place place);

static const directive directives[] = {
    {"Accelerator", BEFORE_WORLD, pbrt_accelerator},
    {"ActiveTransform", ANYWHERE, pbrt_active_transform},
    {"AreaLightSource", IN_WORLD, pbrt_area_light_source},
    {"Attribute", ANYWHERE, pbrt_attribute},
    {"AttributeBegin", IN_WORLD, pbrt_attribute_begin},
    {"AttributeEnd", IN_WORLD, pbrt_attribute_end},
    {"Camera", BEFORE_WORLD, pbrt_camera},
    {"ColorSpace", ANYWHERE, pbrt_color_space},
    {"ConcatTransform", ANYWHERE, pbrt_concat_transform},
    {"CoordSysTransform", ANYWHERE, pbrt_coord_sys_transform},
    {"CoordinateSystem", ANYWHERE, pbrt_coordinate_system},
    {"Film", BEFORE_WORLD, pbrt_film},
    {"Identity", ANYWHERE, pbrt_identity},
    {"Import", IN_WORLD, handle_import},
    {"Include", ANYWHERE, handle_include},
    {"Integrator", BEFORE_WORLD, pbrt_integrator},
    {"LightSource", IN_WORLD, pbrt_light_source},
    {"LookAt", ANYWHERE, pbrt_look_at},
    {"MakeNamedMaterial", IN_WORLD, pbrt_make_named_material},
    {"MakeNamedMedium", ANYWHERE, pbrt_make_named_medium},
    {"Material", IN_WORLD, pbrt_material},
    {"MediumInterface", ANYWHERE, pbrt_medium_interface},
    {"NamedMaterial", IN_WORLD, pbrt_named_material},
    {"ObjectBegin", IN_WORLD, pbrt_object_begin},
    {"ObjectEnd", IN_WORLD, pbrt_object_end},
    {"ObjectInstance", IN_WORLD, pbrt_object_instance},
    {"Option", BEFORE_WORLD, pbrt_option},
    {"PixelFilter", BEFORE_WORLD, pbrt_pixel_filter},
    {"ReverseOrientation", IN_WORLD, pbrt_reverse_orientation},
    {"Rotate", ANYWHERE, pbrt_rotate},
    {"Sampler", BEFORE_WORLD, pbrt_sampler},
    {"Scale", ANYWHERE, pbrt_scale},
    {"Shape", IN_WORLD, pbrt_shape},
    {"Texture", IN_WORLD, pbrt_texture},
    {"Transform", ANYWHERE, pbrt_transform},
    {"TransformBegin", IN_WORLD, pbrt_attribute_begin},
    {"TransformEnd", IN_WORLD, pbrt_transform_end},
    {"TransformTimes", ANYWHERE, pbrt_transform_times},
    {"Translate", ANYWHERE, pbrt_translate},
    {"WorldBegin", BEFORE_WORLD, pbrt_world_begin},
    {"WorldEnd", IN_WORLD, pbrt_world_end},
};

static const directive *find_directive(const token *t)
{
    for (size_t i = 0; i < G_N_ELEMENTS(directives); i++)
        if (token_is(t, directives[i].name))
            return &directives[i];
    return NULL;
}

/** Skips words up to the next directive or the end. */
static void resynchronise(pbrt_parser *parser)
{
    while (!pbrt_should_stop(parser)) {
        token t = lexer_peek(parser->words);
        if (t.kind == TOKEN_END || (t.kind == TOKEN_WORD && find_directive(&t)))
            return;
        lexer_next(parser->words);
    }
}

static bool phase_fits(pbrt_parser *parser, const directive *d, source_place place)
{
    bool is_late = d->phase == BEFORE_WORLD && parser->in_world;
    bool is_early = d->phase == IN_WORLD && !parser->in_world;
    if (parser->is_v3 && (is_late || is_early))
        pbrt_warning(parser, place, "%s %s WorldBegin is left out, as pbrt-v3 does",
                     d->name, is_late ? "after" : "before");
    else if (is_late)
        pbrt_error(parser, place, "expected %s before WorldBegin, found it after",
                   d->name);
    else if (is_early)
        pbrt_error(parser, place, "expected WorldBegin before %s, found none", d->name);
    else
        return true;
    return false;
}

/** One directive with its arguments. */
static void read_directive(pbrt_parser *parser)
{
    token t = lexer_next(parser->words);
    const directive *d = t.kind == TOKEN_WORD ? find_directive(&t) : NULL;
    bool fine;
    if (!d)
        fine = pbrt_expected(parser, "a directive", &t);
    else
        fine = phase_fits(parser, d, t.place) &&
               pbrt_has_room(parser, t.place, DIRECTIVE_SIZE, d->name) &&
               d->handle(parser, t.place);
    if (!fine)
        resynchronise(parser);
}

static void read_words(pbrt_parser *parser, lexer *words)
{
    lexer *outer = parser->words;
    parser->words = words;
    while (!pbrt_should_stop(parser) && !parser->has_ended &&
           lexer_peek(words).kind != TOKEN_END) {
        read_directive(parser);
        still_wanted(parser->fatal ? NULL : &parser->fatal);
    }
    parser->words = outer;
}

/* What a scene includes may be any file that can be read here: nothing is quoted of one
 * that is not pbrt's. */
static void read_directives(pbrt_parser *parser, lexer *words, void *data)
{
    words->outer = data;
    token t = lexer_peek(words);
    if (t.kind == TOKEN_END || (t.kind == TOKEN_WORD && find_directive(&t)))
        read_words(parser, words);
    else
        pbrt_error(parser, t.place, "expected a directive, found something else");
}

void pbrt_include(pbrt_parser *parser, const char *name, source_place place)
{
    pbrt_read_file(parser, name, place, read_directives, parser->words);
}

static bool handle_include(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a file name", &at);
    if (!name)
        return false;
    pbrt_include(parser, name, at);
    return true;
}

/** As Include, but what the file does to the attributes ends with it. */
static bool handle_import(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a file name", &at);
    if (!name)
        return false;
    guint depth = parser->saved->len;
    pbrt_attribute_begin(parser, at);
    pbrt_read_file(parser, name, at, read_directives, NULL);
    pbrt_close_attributes(parser, depth + 1);
    if (parser->saved->len > depth)
        pbrt_attribute_end(parser, at);
    return true;
}

static void clear_pending(pending *d)
{
    g_free(d->kind);
    params_free(d->p);
}

static void free_params(void *p)
{
    params_free(p);
}

static void parser_init(pbrt_parser *parser, scene_builder *to, const char *path)
{
    *parser = (pbrt_parser){.builder = to,
                            .default_material = NO_INDEX,
                            .object = NO_INDEX,
                            .times = {0.0, 1.0}};
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    parser->base_directory = g_path_get_dirname(absolute);
    parser->open_files = g_ptr_array_new();
    parser->errors = g_ptr_array_new_with_free_func(g_free);
    parser->saved = g_array_new(FALSE, FALSE, sizeof(saved_state));
    parser->coordinate_systems =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    parser->given_materials =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    parser->interfaces = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    parser->empty_media = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    parser->v3_media = g_hash_table_new(g_str_hash, g_str_equal);
    parser->missing_media = g_hash_table_new(g_str_hash, g_str_equal);
    parser->awaited_media = g_array_new(FALSE, FALSE, sizeof(medium_name));
    parser->v3_names = g_ptr_array_new_with_free_func(g_free);
    parser->v3_newest = g_hash_table_new(g_direct_hash, g_direct_equal);
    parser->v3_objects = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    parser->late = pbrt_late_new();
    parser->awaited_materials = g_array_new(FALSE, FALSE, sizeof(medium_name));
    parser->kept = g_ptr_array_new_with_free_func(free_params);
    parser->attributes = g_ptr_array_new_with_free_func(g_free);
    parser->state = (graphics_state){.ctm = transform_identity(),
                                     .ctm_end = transform_identity(),
                                     .active = ACTIVE_ALL,
                                     .material = MATERIAL_DEFAULT,
                                     .space = color_space_srgb()};
}

static void parser_clear(pbrt_parser *parser)
{
    pending *const kept[] = {&parser->film, &parser->filter, &parser->sampler,
                             &parser->integrator, &parser->camera};
    for (size_t i = 0; i < G_N_ELEMENTS(kept); i++)
        clear_pending(kept[i]);
    big_free(parser->values.data);
    g_ptr_array_unref(parser->attributes);
    g_ptr_array_unref(parser->kept);
    g_array_unref(parser->awaited_materials);
    g_ptr_array_unref(parser->late);
    g_hash_table_unref(parser->v3_objects);
    g_hash_table_unref(parser->v3_newest);
    g_ptr_array_unref(parser->v3_names);
    g_array_unref(parser->awaited_media);
    g_hash_table_unref(parser->missing_media);
    g_hash_table_unref(parser->v3_media);
    g_hash_table_unref(parser->empty_media);
    g_hash_table_unref(parser->interfaces);
    g_hash_table_unref(parser->given_materials);
    g_hash_table_unref(parser->coordinate_systems);
    g_array_unref(parser->saved);
    g_ptr_array_unref(parser->errors);
    g_ptr_array_unref(parser->open_files);
    g_free(parser->base_directory);
}

/* pbrt-v3 renders at WorldEnd; what follows is another picture. */
static void check_rest(pbrt_parser *parser, lexer *words)
{
    token t = lexer_peek(words);
    if (parser->has_ended && t.kind != TOKEN_END)
        pbrt_warning(parser, t.place,
                     "what follows WorldEnd is another picture, which is left out");
}

/** What can only be said once everything has been read. */
static void check_end(pbrt_parser *parser, source_place end)
{
    pbrt_close_attributes(parser, 0);
    if (parser->object != NO_INDEX)
        pbrt_error(parser, parser->object_place,
                   "expected ObjectEnd for this ObjectBegin, found the end of the file");
    pbrt_make_late(parser);
    pbrt_check_materials(parser);
    pbrt_check_media(parser);
    pbrt_settle_integrator(parser);
    if (pbrt_should_stop(parser))
        return;
    if (!parser->in_world)
        pbrt_error(parser, end, "expected WorldBegin, found the end of the file");
}

static void read_main(pbrt_parser *parser, const char *path, const input *in)
{
    g_autofree char *canonical = g_canonicalize_filename(path, NULL);
    parser->is_v3 = pbrt_v3_recognises(in->data, in->size);
    if (parser->is_v3)
        log_message(&parser->builder->build.log, LOG_NOTE,
                    "%s: pbrt-v3: its directives are translated to pbrt-v4's", path);
    lexer words = lexer_new(path, in->data, in->size);
    g_ptr_array_add(parser->open_files, canonical);
    read_words(parser, &words);
    check_rest(parser, &words);
    if (!pbrt_should_stop(parser))
        check_end(parser, lexer_peek(&words).place);
}

static bool read_pbrt(scene_builder *to, const char *path, GError **error)
{
    input in;
    GError *inner = NULL;
    if (!input_open(&in, path, &inner)) {
        error_move_at(error, (source_place){intern(path), 0, 0}, inner);
        return false;
    }
    pbrt_parser parser;
    parser_init(&parser, to, path);
    read_main(&parser, path, &in);
    input_close(&in);
    bool fine = !parser.fatal && parser.errors->len == 0;
    if (parser.fatal) {
        g_propagate_error(error, parser.fatal);
    } else if (!fine) {
        error_set_lines(error, parser.errors);
    }
    parser_clear(&parser);
    return fine;
}

static const char *const extensions[] = {".pbrt", ".pbrt.gz", NULL};

const format_reader pbrt_reader = {
    .name = "pbrt-v4", .extensions = extensions, .read = read_pbrt};
