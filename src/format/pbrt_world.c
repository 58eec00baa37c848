/*
 * What the world is made of: materials, textures, lights and shapes, each given to the
 * scene as it is read.
 */
#include "format/pbrt_parser.h"

#include "format/lenient.h"
#include "format/ply.h"

#include <string.h>

/** A quoted argument and parameters: "kind" "type name" value ... */
typedef struct arguments {
    char *kind;
    source_place at; /**< of the kind */
    params *p;       /**< owned, unless kept by the parser */
} arguments;

static bool read_arguments(pbrt_parser *parser, source_place place,
                           attribute_target target, arguments *out)
{
    *out = (arguments){.at = place};
    out->kind = pbrt_read_string(parser, "a kind", &out->at);
    out->p = out->kind ? pbrt_read_params_for(parser, place, target) : NULL;
    if (out->p)
        return true;
    g_clear_pointer(&out->kind, g_free);
    return false;
}

/** What a pbrt-v3 file says, in pbrt-v4's words. */
static void translate(const pbrt_parser *parser, pbrt_v3_target target, arguments *a)
{
    if (parser->is_v3)
        pbrt_v3_translate(target, &a->kind, a->p, &parser->scene->build.log);
}

static void clear_arguments(arguments *a)
{
    g_free(a->kind);
    params_free(a->p);
}

static bool is_interface(const char *kind)
{
    return !*kind || strcmp(kind, "interface") == 0 || strcmp(kind, "none") == 0;
}

/** Index of a new material; NO_INDEX for an interface, and, reported, if it is wrong. */
static int add_material(pbrt_parser *parser, const char *name, const char *kind,
                        const params *p)
{
    GError *error = NULL;
    int index = NO_INDEX;
    g_autoptr(params) replaced =
        lenient_material(&parser->scene->build, &kind, p, &error);
    const params *given = replaced ? replaced : p;
    if (!error && !is_interface(kind))
        index = scene_add_material(parser->scene, name, kind, given, &error);
    if (error)
        pbrt_report(parser, error);
    else
        pbrt_check_used(parser, given, "material", kind);
    return index;
}

bool pbrt_material(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_MATERIAL, &a))
        return false;
    translate(parser, V3_MATERIAL, &a);
    parser->state.material = add_material(parser, NULL, a.kind, a.p);
    clear_arguments(&a);
    return true;
}

static bool is_known_material(const pbrt_parser *parser, const char *name)
{
    return scene_find_material(parser->scene, name) != NO_INDEX ||
           g_hash_table_contains(parser->interfaces, name);
}

static int add_named(pbrt_parser *parser, const arguments *a, const char *kind)
{
    arguments of = {.kind = g_strdup(kind), .at = a->at, .p = a->p};
    translate(parser, V3_MATERIAL, &of);
    int index = add_material(parser, a->kind, of.kind, a->p);
    g_free(of.kind);
    return index;
}

static void make_named_material(pbrt_parser *parser, const arguments *a)
{
    GError *error = NULL;
    const char *kind = NULL;
    if (!params_string(a->p, "type", &kind, &error))
        pbrt_report(parser, error);
    else if (!kind)
        pbrt_error(parser, a->at, "expected \"string type\" of material '%s', found none",
                   a->kind);
    else if (is_known_material(parser, a->kind))
        pbrt_error(parser, a->at, "expected a new material's name, found \"%s\" again",
                   a->kind);
    else if (add_named(parser, a, kind) != NO_INDEX)
        return;
    g_hash_table_add(parser->interfaces, g_strdup(a->kind));
}

bool pbrt_make_named_material(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_MATERIAL, &a))
        return false;
    make_named_material(parser, &a);
    clear_arguments(&a);
    return true;
}

bool pbrt_named_material(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a material's name", &at);
    if (!name)
        return false;
    if (!is_known_material(parser, name))
        pbrt_error(parser, at,
                   "expected the name of a material made before, found \"%s\"", name);
    parser->state.material = scene_find_material(parser->scene, name);
    return true;
}

static void add_texture(pbrt_parser *parser, const char *name, const char *type,
                        source_place type_at, const arguments *a)
{
    GError *error = NULL;
    bool is_spectrum = strcmp(type, "spectrum") == 0;
    if (!is_spectrum && strcmp(type, "float") != 0) {
        pbrt_error(parser, type_at, "expected \"float\" or \"spectrum\", found \"%s\"",
                   type);
        return;
    }
    const char *kind = a->kind;
    g_autoptr(params) replaced =
        lenient_texture(&parser->scene->build, &kind, is_spectrum, a->p, &error);
    const params *given = replaced ? replaced : a->p;
    if (!error &&
        scene_add_texture(parser->scene, name, kind, is_spectrum, given, &error))
        pbrt_check_used(parser, given, "texture", kind);
    else
        pbrt_report(parser, error);
}

bool pbrt_texture(pbrt_parser *parser, source_place place)
{
    source_place type_at = place;
    g_autofree char *name = pbrt_read_string(parser, "a texture's name", NULL);
    g_autofree char *type =
        name ? pbrt_read_string(parser, "\"float\" or \"spectrum\"", &type_at) : NULL;
    arguments a;
    if (!type || !read_arguments(parser, place, TARGET_TEXTURE, &a))
        return false;
    translate(parser, V3_TEXTURE, &a);
    bool is_color = parser->is_v3 && strcmp(type, "color") == 0;
    add_texture(parser, name, is_color ? "spectrum" : type, type_at, &a);
    clear_arguments(&a);
    return true;
}

bool pbrt_light_source(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_LIGHT, &a))
        return false;
    translate(parser, V3_LIGHT, &a);
    pbrt_use_media(parser, &parser->state.inside, &parser->state.outside);
    GError *error = NULL;
    if (pbrt_is_moving(parser))
        pbrt_warning(parser, place, "a light that moves stands still where it starts");
    if (scene_add_light(parser->scene, a.kind, a.p, &parser->state.ctm, &error))
        pbrt_check_used(parser, a.p, "light", a.kind);
    else
        pbrt_report(parser, error);
    clear_arguments(&a);
    return true;
}

bool pbrt_area_light_source(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_LIGHT, &a))
        return false;
    translate(parser, V3_AREA_LIGHT, &a);
    if (strcmp(a.kind, "diffuse") == 0) {
        parser->state.area_light = a.p;
        g_ptr_array_add(parser->kept, g_steal_pointer(&a.p));
    } else {
        pbrt_error(parser, a.at, "expected AreaLightSource \"diffuse\", found \"%s\"",
                   a.kind);
    }
    clear_arguments(&a);
    return true;
}

/** The material to use; pbrt's default, a half-white wall, is made when first needed. */
static int current_material(pbrt_parser *parser, source_place place)
{
    if (parser->state.material != MATERIAL_DEFAULT)
        return parser->state.material;
    if (parser->default_material == NO_INDEX) {
        g_autoptr(params) p =
            params_new(place, parser->base_directory, parser->state.space);
        parser->default_material = add_material(parser, NULL, "diffuse", p);
    }
    return parser->default_material;
}

/** A mesh of a PLY file. Errors begin with the place in the scene file. */
static bool add_ply(pbrt_parser *parser, const params *p, const shape_place *at,
                    GError **error)
{
    g_autofree char *path = NULL;
    if (!params_path(p, "filename", &path, error))
        return false;
    if (!path) {
        error_at(error, p->place, "plymesh: expected \"string filename\", found none");
        return false;
    }
    source_place named = params_find(p, "filename")->place;
    g_autoptr(GError) inner = NULL;
    mesh m = {0};
    scene_sources_add(parser->scene->build.sources, path);
    if (ply_read(path, &m, &inner))
        return scene_add_mesh(parser->scene, &m, at, named, error);
    if (g_error_matches(inner, NEPH_ERROR, ERROR_FAILED))
        g_propagate_error(error, g_steal_pointer(&inner));
    else
        error_at(error, named, "%s", inner->message);
    return false;
}

static bool add_still_shape(pbrt_parser *parser, const arguments *a,
                            const shape_place *at, GError **error)
{
    bool is_ply = strcmp(a->kind, "plymesh") == 0;
    return is_ply ? add_ply(parser, a->p, at, error)
                  : scene_add_shape(parser->scene, a->kind, a->p, at, error);
}

/** A shape that moves is an object with one instance. */
static bool add_made_shape(pbrt_parser *parser, const arguments *a, shape_place *at,
                           GError **error)
{
    if (!pbrt_is_moving(parser))
        return add_still_shape(parser, a, at, error);
    int object = scene_object_begin(parser->scene, NULL, a->at, error);
    if (object == NO_INDEX)
        return false;
    motion to_world = pbrt_motion(parser);
    at->to_world = transform_identity();
    bool done = add_still_shape(parser, a, at, error);
    scene_object_end(parser->scene);
    return done && scene_add_instance(parser->scene, object, &to_world, a->at, error);
}

/** True of what can not be flattened; as in pbrt it is not seen then. */
static bool is_lost(const pbrt_parser *parser, const arguments *a)
{
    if (!pbrt_is_flat(parser))
        return false;
    bool is_mesh = strcmp(a->kind, "plymesh") == 0 || shape_may_be_flat(a->kind);
    if (is_mesh && !pbrt_is_moving(parser))
        return false;
    pbrt_warning(parser, a->at, "a shape \"%s\"%s that is flattened is not seen", a->kind,
                 is_mesh ? " that moves and" : "");
    return true;
}

static void add_shape(pbrt_parser *parser, const arguments *a)
{
    if (is_lost(parser, a))
        return;
    shape_place at = {.to_world = parser->state.ctm,
                      .reverse_orientation = parser->state.reverse_orientation,
                      .material = current_material(parser, a->at),
                      .area_light = parser->state.area_light};
    GError *error = NULL;
    bool seen = true;
    float_input alpha;
    if (!params_bool(a->p, "camera_visible", &seen, &error) ||
        !float_input_init(&alpha, &parser->scene->build, a->p, "alpha", 1.0f, &error)) {
        pbrt_report(parser, error);
        return;
    }
    pbrt_use_media(parser, &parser->state.inside, &parser->state.outside);
    at.camera_hidden = !seen;
    at.alpha = &alpha;
    if (!add_made_shape(parser, a, &at, &error)) {
        pbrt_report(parser, error);
        return;
    }
    pbrt_check_used(parser, a->p, "shape", a->kind);
    if (at.area_light)
        pbrt_check_used(parser, at.area_light, "light", "diffuse");
}

bool pbrt_shape(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_SHAPE, &a))
        return false;
    translate(parser, V3_SHAPE, &a);
    add_shape(parser, &a);
    clear_arguments(&a);
    return true;
}
