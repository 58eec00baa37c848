/*
 * The state shared by the parts of the pbrt-v4 reader.
 *
 *   pbrt.c            the table of directives
 *   pbrt_report.c     errors, warnings, what was expected
 *   pbrt_include.c    files within files
 *   pbrt_params.c     "type name" values ... lists
 *   pbrt_transform.c  the current transform
 *   pbrt_state.c      attributes: what AttributeBegin keeps and AttributeEnd brings back
 *   pbrt_medium.c     participating media, and which of them are around
 *   pbrt_options.c    what stands before WorldBegin, kept until then
 *   pbrt_integrator.c integrators and samplers as settings
 *   pbrt_lens.c       realistic cameras
 *   pbrt_late.c       what is named before it is made
 *   pbrt_v3_names.c   what is named again, in pbrt-v3
 *   pbrt_v3_values.c  numbers with something behind them, in pbrt-v3
 *   pbrt_v3_kinds.c   what pbrt-v3 does not know, and goes on
 *   pbrt_mesh.c       meshes whose arrays do not fit
 *   pbrt_texture.c    textures
 *   pbrt_world.c      materials, textures, lights and shapes, given to the scene
 *
 * A handler reads a directive's arguments. It returns false if they do not follow the
 * grammar, and reading goes on at the next directive; other errors it reports, and
 * returns true. Either way the error is in the list already.
 */
#pragma once

#include "format/lexer.h"
#include "format/pbrt/pbrt_v3.h"
#include "scene/builder.h"

enum { MAX_ERRORS = 20, MAX_DEPTH = 256, MAX_ATTRIBUTES = 1000 };

/** Kinds of directives that Attribute gives parameters to. */
typedef enum attribute_target {
    TARGET_SHAPE,
    TARGET_LIGHT,
    TARGET_MATERIAL,
    TARGET_MEDIUM,
    TARGET_TEXTURE,
    N_TARGETS
} attribute_target;

/** Parameters from one Attribute directive, and those given before it. */
typedef struct attribute {
    const params *given;
    const struct attribute *before;
} attribute;

enum { MATERIAL_DEFAULT = -2 }; /**< no Material directive yet; NO_INDEX: interface */

/** Which of the two current transforms directives act on, by ActiveTransform. */
typedef enum active_transforms {
    ACTIVE_START = 1,
    ACTIVE_END = 2,
    ACTIVE_ALL = ACTIVE_START | ACTIVE_END
} active_transforms;

/** What CoordinateSystem remembers. */
typedef struct transform_pair {
    transform start, end;
} transform_pair;

/** A medium that MediumInterface names. */
typedef struct medium_name {
    const char *name; /**< interned; NULL: none */
    source_place place;
} medium_name;

/** What a pbrt-v3 file calls by a name. */
typedef struct v3_name v3_name;

/** What AttributeBegin keeps. */
typedef struct graphics_state {
    transform ctm;     /**< at the start time */
    transform ctm_end; /**< at the end time; the same, unless something moves */
    active_transforms active;
    bool reverse_orientation;
    int material;
    const params *area_light; /**< owned by the parser; NULL: none */
    const color_space *space;
    medium_name inside, outside;
    const attribute *attributes[N_TARGETS];
    const char *v3_material; /**< interned: the material's kind in pbrt-v3; NULL: none */
    const params *v3_given;  /**< and what was said of it; owned by the parser */
    v3_name *v3_names;       /**< names in force (pbrt_v3_names.c); NULL: none */
} graphics_state;

typedef struct saved_state {
    graphics_state state;
    source_place place; /**< of the AttributeBegin */
} saved_state;

/** A quoted argument and parameters: "kind" "type name" value ... */
typedef struct directive_arguments {
    char *kind;
    source_place at; /**< of the kind */
    params *p;       /**< owned, unless kept by the parser */
} directive_arguments;

/** A directive kept until WorldBegin. */
typedef struct pending {
    char *kind; /**< NULL: not given */
    params *p;
    source_place place;
    transform ctm, ctm_end;
} pending;

/** Numbers being read, floats or ints; grows, never shrinks. */
typedef struct scratch {
    void *data;
    size_t n, capacity;
} scratch;

typedef struct pbrt_parser {
    scene_builder *builder;
    char *base_directory;  /**< of the main file: relative names start there */
    lexer *words;          /**< of the file being read */
    GPtrArray *open_files; /**< canonical names, for loops of includes */

    GPtrArray *errors; /**< char* */
    GError *fatal;     /**< what made going on pointless, such as no memory */

    bool is_v3; /**< the main file is of pbrt-v3 (pbrt_v3.h) */
    bool in_world;
    bool has_cut_numbers; /**< pbrt-v3: a word was read as the number it begins with */
    bool has_ended;       /**< pbrt-v3's WorldEnd was read */
    int object;           /**< index of the one that is being defined, or NO_INDEX */
    source_place object_place;
    double times[2]; /**< s: of the start and the end transforms */
    graphics_state state;
    GArray *saved;                  /**< saved_state */
    GHashTable *coordinate_systems; /**< name -> transform_pair* */
    GHashTable *given_materials;    /**< names that MakeNamedMaterial gave */
    GHashTable *interfaces;         /**< names of materials that are none */
    GHashTable *empty_media;        /**< names of media that are none */
    GHashTable *v3_media;           /**< name given again -> its name in the scene */
    GHashTable *missing_media;      /**< names that an error told of */
    GArray *awaited_media;          /**< medium_name, not made when it was named */
    medium_name around_camera;
    GPtrArray *v3_names;       /**< v3_name*, owned */
    GHashTable *v3_newest;     /**< kind and name, of either sort -> the newest of them */
    GHashTable *v3_objects;    /**< name -> its name in the scene, interned */
    GPtrArray *late;           /**< what waits for a name (pbrt_late.c) */
    GArray *awaited_materials; /**< medium_name: of materials not made when named */
    guint n_unnamed;           /**< materials without a name that wait */
    bool at_end;               /**< nothing waits any more */
    int default_material;      /**< its index once made, or NO_INDEX */
    GPtrArray *kept;           /**< params* that outlive their directive */
    GPtrArray *attributes;     /**< attribute* */
    pending film, filter, sampler, integrator, camera;
    scratch values; /**< of the parameter being read */
} pbrt_parser;

typedef bool (*directive_handler)(pbrt_parser *parser, source_place place);

/* ---- pbrt_report.c ---- */

/** @brief Takes an error into the list. */
void pbrt_report(pbrt_parser *parser, GError *error);
/** @brief memory_ask with a place; what is refused is reported. */
bool pbrt_has_room(pbrt_parser *parser, source_place place, size_t bytes,
                   const char *what);
/** @brief "expected `what`, found <the word>" at the word. @return false */
bool pbrt_expected(pbrt_parser *parser, const char *what, const token *found);
/** @brief An error of the reader's own at a place. */
void pbrt_error(pbrt_parser *parser, source_place place, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/** @brief A warning at a place: of what pbrt warns of too, and goes on. */
void pbrt_warning(const pbrt_parser *parser, source_place place, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/** @brief True when reading on is of no use. */
bool pbrt_should_stop(const pbrt_parser *parser);
/** @brief A quoted string argument; owned by the caller, NULL if there is none. `what`
 * names it in the error; *place, if not NULL, gets where it stands. */
char *pbrt_read_string(pbrt_parser *parser, const char *what, source_place *place);
/* ---- pbrt_include.c ---- */

/** @brief Opens another file in place of the words that named it, and has it read. */
void pbrt_read_file(pbrt_parser *parser, const char *name, source_place place,
                    void (*read)(pbrt_parser *parser, lexer *words, void *data),
                    void *data);

/* ---- pbrt.c ---- */

/** @brief Reads another file's directives as if they stood here. */
void pbrt_include(pbrt_parser *parser, const char *name, source_place place);

/** @brief pbrt-v3: an Include among parameters, of a file that begins with one, is read
 * into the list. @return false: it is a directive, and left where it is */
bool pbrt_include_parameters(pbrt_parser *parser, params *p, bool *fine);

/* ---- pbrt_params.c ---- */

/** @brief True for a string that begins with a parameter's type. */
bool pbrt_is_declaration(const token *t);

/** @brief Reads parameters into a list, up to what is none. @return false, reported, if
 * they do not follow the grammar */
bool pbrt_read_param_list(pbrt_parser *parser, params *p);

/** @brief A parameter list up to the next directive, without attributes; NULL if it does
 * not follow the grammar. Owned by the caller. */
params *pbrt_read_params(pbrt_parser *parser, source_place place);
/** @brief The same with what Attribute gave to the target filled in. */
params *pbrt_read_params_for(pbrt_parser *parser, source_place place,
                             attribute_target target);
void pbrt_clear_arguments(directive_arguments *a);
/** @brief Reports parameters that nobody asked for. */
void pbrt_check_used(pbrt_parser *parser, const params *p, const char *what,
                     const char *kind);

/* ---- pbrt_late.c ---- */

/** In which order what waits is made. */
typedef enum late_rank {
    LATE_TEXTURE,
    LATE_MATERIAL,
    LATE_SHAPE,
    LATE_INSTANCE,
    N_LATE_RANKS
} late_rank;

/** @brief Makes what waited; the parser's state is that of its directive. */
typedef void (*late_maker)(pbrt_parser *parser, const char *name,
                           const directive_arguments *a);

GPtrArray *pbrt_late_new(void);
/** @brief True if parameters name a texture or material that may still come. */
bool pbrt_must_wait(const pbrt_parser *parser, const params *p);
/** @brief Lets a directive wait; its arguments are taken. */
void pbrt_wait(pbrt_parser *parser, late_rank rank, late_maker make, const char *name,
               directive_arguments *a);
/** @brief Makes all that waits: at the end of the file. */
void pbrt_make_late(pbrt_parser *parser);
/** @brief Keeps a place for a material that is named before it is made. @return index */
int pbrt_await_material(pbrt_parser *parser, const char *name, source_place place);
/** @brief Reports names of materials that were never made. */
void pbrt_check_materials(pbrt_parser *parser);

/* ---- pbrt_mesh.c ---- */

/** @brief Makes a mesh's arrays fit together as pbrt does, with warnings. @return false:
 * the mesh is not seen */
bool pbrt_fit_mesh(pbrt_parser *parser, const directive_arguments *a);

/* ---- pbrt_texture.c ---- */

/** @brief A texture of a kind by a name; what is wrong is reported. */
void pbrt_make_texture(pbrt_parser *parser, const char *name, bool is_spectrum,
                       const char *kind, const params *p);

/* ---- pbrt_v3_values.c ---- */

/** @brief pbrt-v3: the number that a word begins with. The first time it is said. @return
 * false: it begins with none, or the scene is another's */
bool pbrt_v3_number(pbrt_parser *parser, const token *t, double *out);
/** @brief What a shape says of its material is taken from it. @return that and what the
 * material says else, in pbrt-v3's words; NULL: the shape says nothing. Owned by the
 * caller. */
params *pbrt_v3_material_of_shape(const pbrt_parser *parser, params *p);

/* ---- pbrt_v3_names.c ---- */

/** @brief A texture by a name that may be there already; a->p is taken. */
void pbrt_v3_add_texture(pbrt_parser *parser, const char *name, bool is_spectrum,
                         directive_arguments *a);
/** @brief The name in the scene for a material that the file calls so from here on. */
const char *pbrt_v3_new_material(pbrt_parser *parser, const char *name,
                                 source_place place);
/** @brief The material of that name now, or, without a name, the one of the state is of
 * that kind, said in pbrt-v3's words: shapes may say more of it. */
void pbrt_v3_keep_material(pbrt_parser *parser, const char *name, const char *kind,
                           const params *p);
/** @brief What was kept of the material that the file means by a name is the state's. */
void pbrt_v3_take_material(pbrt_parser *parser, const char *name);
/** @brief Names that were given since `before` are in force no more. */
void pbrt_v3_end_names(v3_name *given, const v3_name *before);
/** @brief What the scene calls the material that the file means by a name here. */
const char *pbrt_v3_material_name(const pbrt_parser *parser, const char *name);
/** @brief True if pbrt-v3 knows a kind of what a directive makes, or we do; else it is
 * warned of: pbrt-v3 goes on without it, and with "matte" for a material. */
bool pbrt_v3_knows(const pbrt_parser *parser, pbrt_v3_target target, const char *kind,
                   source_place at);

/** @brief Turns names of textures and materials in parameters into the scene's.
 * @param in_colors where pbrt says nothing else textures are of colours */
void pbrt_v3_resolve(pbrt_parser *parser, params *p, bool in_colors);

/* ---- handlers ---- */

bool pbrt_identity(pbrt_parser *parser, source_place place);
bool pbrt_translate(pbrt_parser *parser, source_place place);
bool pbrt_scale(pbrt_parser *parser, source_place place);
bool pbrt_rotate(pbrt_parser *parser, source_place place);
bool pbrt_look_at(pbrt_parser *parser, source_place place);
bool pbrt_transform(pbrt_parser *parser, source_place place);
bool pbrt_concat_transform(pbrt_parser *parser, source_place place);
bool pbrt_coordinate_system(pbrt_parser *parser, source_place place);
bool pbrt_coord_sys_transform(pbrt_parser *parser, source_place place);
bool pbrt_transform_times(pbrt_parser *parser, source_place place);
bool pbrt_active_transform(pbrt_parser *parser, source_place place);
/** @brief Remembers transforms under a name. */
void pbrt_name_transform(pbrt_parser *parser, const char *name, const transform *start,
                         const transform *end);
/** @brief True if the current transform flattens what stands in it. */
bool pbrt_is_flat(const pbrt_parser *parser);
/** @brief True if the current transform moves. */
bool pbrt_is_moving(const pbrt_parser *parser);
/** @brief The current transforms as a motion. */
motion pbrt_motion(const pbrt_parser *parser);

bool pbrt_attribute(pbrt_parser *parser, source_place place);
bool pbrt_attribute_begin(pbrt_parser *parser, source_place place);
bool pbrt_attribute_end(pbrt_parser *parser, source_place place);
/** @brief As AttributeEnd; in pbrt-v3 the transforms alone come back. */
bool pbrt_transform_end(pbrt_parser *parser, source_place place);
bool pbrt_reverse_orientation(pbrt_parser *parser, source_place place);
bool pbrt_color_space(pbrt_parser *parser, source_place place);
bool pbrt_object_begin(pbrt_parser *parser, source_place place);
bool pbrt_object_end(pbrt_parser *parser, source_place place);
bool pbrt_object_instance(pbrt_parser *parser, source_place place);

bool pbrt_medium_interface(pbrt_parser *parser, source_place place);
bool pbrt_make_named_medium(pbrt_parser *parser, source_place place);
/** @brief What the scene is given from here on is between these; reports names of media
 * that were not made. */
void pbrt_use_media(pbrt_parser *parser, const medium_name *inside,
                    const medium_name *outside);
/** @brief True if a medium around may still be made: pbrt-v4 asks what a shape is between
 * when all has been read. */
bool pbrt_awaits_media(const pbrt_parser *parser);
/** @brief Reports names that nothing used, of media that were never made. */
void pbrt_check_media(pbrt_parser *parser);

/** @brief Reports AttributeBegins that were never ended, down to a depth. */
void pbrt_close_attributes(pbrt_parser *parser, guint depth);

bool pbrt_film(pbrt_parser *parser, source_place place);
bool pbrt_pixel_filter(pbrt_parser *parser, source_place place);
bool pbrt_sampler(pbrt_parser *parser, source_place place);
bool pbrt_integrator(pbrt_parser *parser, source_place place);
bool pbrt_camera(pbrt_parser *parser, source_place place);
bool pbrt_accelerator(pbrt_parser *parser, source_place place);
bool pbrt_option(pbrt_parser *parser, source_place place);
bool pbrt_world_begin(pbrt_parser *parser, source_place place);
/** @brief Turns a realistic camera that was kept into a perspective one (pbrt_lens.c). */
void pbrt_flatten_lens(pbrt_parser *parser);
/** @brief pbrt-v3 ends a world explicitly. */
bool pbrt_world_end(pbrt_parser *parser, source_place place);
/** @brief Turns the integrator and sampler that were kept into settings. */
void pbrt_apply_integrator(pbrt_parser *parser);
/** @brief Takes auto for a bidirectional one that would not see the scene's media. */
void pbrt_settle_integrator(pbrt_parser *parser);

bool pbrt_material(pbrt_parser *parser, source_place place);
bool pbrt_make_named_material(pbrt_parser *parser, source_place place);
bool pbrt_named_material(pbrt_parser *parser, source_place place);
bool pbrt_texture(pbrt_parser *parser, source_place place);
bool pbrt_light_source(pbrt_parser *parser, source_place place);
bool pbrt_area_light_source(pbrt_parser *parser, source_place place);
bool pbrt_shape(pbrt_parser *parser, source_place place);

/* ---- what may stand before WorldBegin, for the features page ---- */

/** A kind of a directive, or an option. Lists of names have blanks between. */
typedef struct directive_kind {
    const char *name;
    const char *parameters; /**< those that act */
    const char *idle;       /**< those that are accepted and change nothing */
    const char *how;        /**< "rendered" ..., as the page says; NULL: rendered */
    const char *note;       /**< NULL: none */
} directive_kind;

/** Number i; a name of NULL behind the last. */
typedef directive_kind (*kind_at)(size_t i);

directive_kind pbrt_sampler_kind(size_t i);
directive_kind pbrt_integrator_kind(size_t i);
directive_kind pbrt_accelerator_kind(size_t i);
directive_kind pbrt_option_kind(size_t i);
