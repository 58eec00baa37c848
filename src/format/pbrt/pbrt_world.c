/*
 * What the world is made of: materials, textures, lights and shapes, each given to the
 * scene as it is read.
 */
#include "format/pbrt/pbrt_parser.h"

#include "format/lenient.h"
#include "format/ply/ply.h"
#include "params/kinds.h"

#include <string.h>

typedef directive_arguments arguments;

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

/* Of pbrt-v3: a kind that it knows, or, of materials, what it takes instead. */
static bool is_known(pbrt_parser *parser, pbrt_v3_target target, arguments *a)
{
    if (!parser->is_v3 || pbrt_v3_knows(parser, target, a->kind, a->at))
        return true;
    if (target == V3_MATERIAL) {
        g_free(a->kind);
        a->kind = g_strdup("matte");
    }
    return target == V3_MATERIAL;
}

/** What a pbrt-v3 file says, in pbrt-v4's words. */
static void translate(pbrt_parser *parser, pbrt_v3_target target, arguments *a)
{
    if (!parser->is_v3)
        return;
    GError *error = NULL;
    if (!pbrt_v3_translate(target, &a->kind, a->p, &parser->builder->build.log, &error))
        pbrt_report(parser, error);
    if (target != V3_TEXTURE) /* which asks what type it is of */
        pbrt_v3_resolve(parser, a->p, true);
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
        lenient_material(&parser->builder->build, &kind, p, &error);
    const params *given = replaced ? replaced : p;
    if (!error && !is_interface(kind))
        index = builder_add_material(parser->builder, name, kind, given, &error);
    if (error)
        pbrt_report(parser, error);
    else
        pbrt_check_used(parser, given, "material", kind);
    return index;
}

/** Of a name. */
static void make_material(pbrt_parser *parser, const char *name, const arguments *a)
{
    if (add_material(parser, name, a->kind, a->p) != NO_INDEX)
        return;
    g_hash_table_add(parser->interfaces, g_strdup(name));
    if (builder_material_is_awaited(parser->builder, name))
        builder_make_interface(parser->builder, name, a->p);
}

/** A material that waits has a name, by which its place in the scene is kept. */
static void let_material_wait(pbrt_parser *parser, const char *name, arguments *a)
{
    g_autofree char *own =
        name ? NULL : g_strdup_printf("material %u of the file", ++parser->n_unnamed);
    const char *by = name ? name : own;
    int index = builder_find_material(parser->builder, by);
    if (index == NO_INDEX)
        index = builder_await_material(parser->builder, by);
    if (!name)
        parser->state.material = index;
    pbrt_wait(parser, LATE_MATERIAL, make_material, by, a);
}

bool pbrt_material(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_MATERIAL, &a))
        return false;
    is_known(parser, V3_MATERIAL, &a);
    if (parser->is_v3)
        pbrt_v3_keep_material(parser, NULL, a.kind, a.p);
    translate(parser, V3_MATERIAL, &a);
    if (pbrt_must_wait(parser, a.p))
        let_material_wait(parser, NULL, &a);
    else
        parser->state.material = add_material(parser, NULL, a.kind, a.p);
    pbrt_clear_arguments(&a);
    return true;
}

/** True of what is made or waits to be, and of interfaces. */
static bool is_known_material(const pbrt_parser *parser, const char *name)
{
    return builder_find_material(parser->builder, name) != NO_INDEX ||
           g_hash_table_contains(parser->interfaces, name);
}

/** True of what MakeNamedMaterial gave already. */
static bool is_given_material(const pbrt_parser *parser, const char *name)
{
    return g_hash_table_contains(parser->given_materials, name);
}

static void add_named(pbrt_parser *parser, const arguments *named, const char *kind)
{
    arguments a = {.kind = g_strdup(kind), .at = named->at, .p = named->p};
    is_known(parser, V3_MATERIAL, &a);
    g_hash_table_add(parser->given_materials, g_strdup(named->kind));
    const char *name = parser->is_v3
                           ? pbrt_v3_new_material(parser, named->kind, named->at)
                           : named->kind;
    if (parser->is_v3)
        pbrt_v3_keep_material(parser, named->kind, a.kind, a.p);
    translate(parser, V3_MATERIAL, &a);
    make_material(parser, name, &a);
    g_free(a.kind);
}

static void let_named_wait(pbrt_parser *parser, arguments *named, const char *kind)
{
    arguments a = {
        .kind = g_strdup(kind), .at = named->at, .p = g_steal_pointer(&named->p)};
    g_hash_table_add(parser->given_materials, g_strdup(named->kind));
    let_material_wait(parser, named->kind, &a);
}

static void make_named_material(pbrt_parser *parser, arguments *a)
{
    GError *error = NULL;
    const char *kind = NULL;
    if (!params_string(a->p, "type", &kind, &error))
        pbrt_report(parser, error);
    else if (!kind && parser->is_v3)
        add_named(parser, a, "");
    else if (!kind)
        pbrt_error(parser, a->at, "expected \"string type\" of material '%s', found none",
                   a->kind);
    else if (!parser->is_v3 && is_given_material(parser, a->kind))
        pbrt_error(parser, a->at, "expected a new material's name, found \"%s\" again",
                   a->kind);
    else if (pbrt_must_wait(parser, a->p))
        let_named_wait(parser, a, kind);
    else
        add_named(parser, a, kind);
}

bool pbrt_make_named_material(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_MATERIAL, &a))
        return false;
    make_named_material(parser, &a);
    pbrt_clear_arguments(&a);
    return true;
}

bool pbrt_named_material(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a material's name", &at);
    if (!name)
        return false;
    const char *actual = parser->is_v3 ? pbrt_v3_material_name(parser, name) : name;
    if (!is_known_material(parser, actual) && parser->is_v3) {
        pbrt_warning(parser, at, "there is no material \"%s\"; the one before stays",
                     name);
        return true;
    }
    if (!is_known_material(parser, actual))
        pbrt_await_material(parser, actual, at);
    if (parser->is_v3)
        pbrt_v3_take_material(parser, name);
    bool is_none = g_hash_table_contains(parser->interfaces, actual);
    parser->state.material =
        is_none ? NO_INDEX : builder_find_material(parser->builder, actual);
    return true;
}

static void make_float_texture(pbrt_parser *parser, const char *name, const arguments *a)
{
    pbrt_make_texture(parser, name, false, a->kind, a->p);
}

static void make_spectrum_texture(pbrt_parser *parser, const char *name,
                                  const arguments *a)
{
    pbrt_make_texture(parser, name, true, a->kind, a->p);
}

static void add_texture(pbrt_parser *parser, const char *name, const char *type,
                        source_place type_at, arguments *a)
{
    bool is_spectrum = strcmp(type, "spectrum") == 0;
    late_maker make = is_spectrum ? make_spectrum_texture : make_float_texture;
    bool is_known = is_spectrum || strcmp(type, "float") == 0;
    if (!is_known && parser->is_v3)
        pbrt_warning(parser, type_at, "a texture of \"%s\" is left out", type);
    else if (!is_known)
        pbrt_error(parser, type_at, "expected \"float\" or \"spectrum\", found \"%s\"",
                   type);
    else if (parser->is_v3)
        pbrt_v3_add_texture(parser, name, is_spectrum, a);
    else if (pbrt_must_wait(parser, a->p))
        pbrt_wait(parser, LATE_TEXTURE, make, name, a);
    else
        make(parser, name, a);
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
    bool is_color = parser->is_v3 && strcmp(type, "color") == 0;
    if (is_known(parser, V3_TEXTURE, &a)) {
        translate(parser, V3_TEXTURE, &a);
        add_texture(parser, name, is_color ? "spectrum" : type, type_at, &a);
    }
    pbrt_clear_arguments(&a);
    return true;
}

/* pbrt-v4 asks an infinite light for any number of L, and takes the first. assimp writes
 * black bodies with a scale behind the temperature, as pbrt-v3 has them. */
static void take_first(pbrt_parser *parser, const arguments *a)
{
    size_t width = 1;
    for (guint i = 0; i < a->p->list->len && strcmp(a->kind, "infinite") == 0; i++) {
        param *q = a->p->list->pdata[i];
        if (strcmp(q->name, "L") != 0 ||
            (q->type != PARAM_BLACKBODY && q->type != PARAM_RGB))
            continue;
        width = q->type == PARAM_RGB ? 3 : 1;
        if (q->n > width)
            log_at(&parser->builder->build.log, LOG_NOTE, q->place,
                   "parameter 'L': the first of %zu counts", q->n / width);
        q->n = MIN(q->n, width);
    }
}

static void make_light(pbrt_parser *parser, const arguments *a, source_place place)
{
    GError *error = NULL;
    pbrt_use_media(parser, &parser->state.inside, &parser->state.outside);
    if (pbrt_is_moving(parser))
        pbrt_warning(parser, place, "a light that moves stands still where it starts");
    if (builder_add_light(parser->builder, a->kind, a->p, &parser->state.ctm, &error))
        pbrt_check_used(parser, a->p, "light", a->kind);
    else
        pbrt_report(parser, error);
}

bool pbrt_light_source(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_LIGHT, &a))
        return false;
    if (is_known(parser, V3_LIGHT, &a)) {
        translate(parser, V3_LIGHT, &a);
        take_first(parser, &a);
        make_light(parser, &a, place);
    }
    pbrt_clear_arguments(&a);
    return true;
}

bool pbrt_area_light_source(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_LIGHT, &a))
        return false;
    bool known = is_known(parser, V3_AREA_LIGHT, &a);
    if (!known)
        parser->state.area_light = NULL;
    else
        translate(parser, V3_AREA_LIGHT, &a);
    if (known && strcmp(a.kind, "diffuse") == 0) {
        parser->state.area_light = a.p;
        g_ptr_array_add(parser->kept, g_steal_pointer(&a.p));
    } else if (known) {
        pbrt_error(parser, a.at, "expected AreaLightSource \"diffuse\", found \"%s\"",
                   a.kind);
    }
    pbrt_clear_arguments(&a);
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
    scene_sources_add(parser->builder->build.sources, path);
    if (ply_read(path, &m, &inner))
        return builder_add_mesh(parser->builder, &m, at, named, error);
    error_move_at(error, named, g_steal_pointer(&inner));
    return false;
}

/* pbrt refines the mesh and moves its vertices. */
static bool pass_displacement(pbrt_parser *parser, const params *p, GError **error)
{
    float_input depth;
    float edge = 1.0f;
    const param *given = params_find(p, "displacement");
    if (!params_float(p, "displacement.edgelength", &edge, error) ||
        !float_input_init(&depth, &parser->builder->build, p, "displacement", 0.0f,
                          error))
        return false;
    if (given)
        pbrt_warning(
            parser, given->place,
            "'displacement' of a mesh moves nothing: it stays as its file has it");
    return true;
}

/** Kinds of shapes, that of files among them. */
static const char *shape_name(size_t i)
{
    return i == 0 ? "plymesh" : shape_kind_name(i - 1);
}

static bool add_still_shape(pbrt_parser *parser, const arguments *a,
                            const shape_place *at, GError **error)
{
    int kind = kind_find(shape_name, "a shape", a->kind, a->p->place, error);
    if (kind < 0)
        return false;
    bool is_ply = kind == 0;
    return is_ply ? pass_displacement(parser, a->p, error) &&
                        add_ply(parser, a->p, at, error)
                  : builder_add_shape(parser->builder, a->kind, a->p, at, error);
}

/** A shape that moves is an object with one instance. */
static bool add_made_shape(pbrt_parser *parser, const arguments *a, shape_place *at,
                           GError **error)
{
    if (!pbrt_is_moving(parser))
        return add_still_shape(parser, a, at, error);
    int object = builder_object_begin(parser->builder, NULL, a->at, error);
    if (object == NO_INDEX)
        return false;
    motion to_world = pbrt_motion(parser);
    at->to_world = transform_identity();
    bool done = add_still_shape(parser, a, at, error);
    builder_object_end(parser->builder);
    return done && builder_add_instance(parser->builder, object, &to_world, a->at, error);
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

static void make_shape(pbrt_parser *parser, const char *name, const arguments *a)
{
    (void)name;
    if (is_lost(parser, a) || !pbrt_fit_mesh(parser, a))
        return;
    shape_place at = {.to_world = parser->state.ctm,
                      .reverse_orientation = parser->state.reverse_orientation,
                      .material = current_material(parser, a->at),
                      .area_light = parser->state.area_light};
    GError *error = NULL;
    if (lenient_shape(&parser->builder->build, a->kind, a->p, &error))
        return;
    if (error) {
        pbrt_report(parser, error);
        return;
    }
    bool seen = true;
    float_input alpha;
    if (!params_bool(a->p, "camera_visible", &seen, &error) ||
        !float_input_init(&alpha, &parser->builder->build, a->p, "alpha", 1.0f, &error)) {
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
    bool shines = parser->object == NO_INDEX && !pbrt_is_moving(parser);
    if (at.area_light && shines)
        pbrt_check_used(parser, at.area_light, "light", "diffuse");
}

/* pbrt-v3: what a shape says of its material goes before what the material says. */
static void make_own_material(pbrt_parser *parser, const arguments *a)
{
    const char *kind = parser->state.v3_material;
    bool is_none = parser->state.material == NO_INDEX;
    params *p = is_none ? NULL : pbrt_v3_material_of_shape(parser, a->p);
    if (!p)
        return;
    arguments own = {.kind = g_strdup(kind ? kind : "matte"), .at = a->at, .p = p};
    translate(parser, V3_MATERIAL, &own);
    parser->state.material = add_material(parser, NULL, own.kind, own.p);
    pbrt_clear_arguments(&own);
}

bool pbrt_shape(pbrt_parser *parser, source_place place)
{
    arguments a;
    if (!read_arguments(parser, place, TARGET_SHAPE, &a))
        return false;
    if (!is_known(parser, V3_SHAPE, &a)) {
        pbrt_clear_arguments(&a);
        return true;
    }
    int material_before = parser->state.material;
    if (parser->is_v3)
        make_own_material(parser, &a);
    translate(parser, V3_SHAPE, &a);
    bool waits = pbrt_must_wait(parser, a.p) || pbrt_awaits_media(parser);
    if (waits && parser->object == NO_INDEX)
        pbrt_wait(parser, LATE_SHAPE, make_shape, NULL, &a);
    else
        make_shape(parser, NULL, &a);
    parser->state.material = material_before;
    pbrt_clear_arguments(&a);
    return true;
}
