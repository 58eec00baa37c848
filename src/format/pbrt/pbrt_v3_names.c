/*
 * Names in pbrt-v3, which a file may give again: what used a texture, a material or an
 * object before keeps it, what comes later has the new one, and what is given between
 * AttributeBegin and AttributeEnd ends there. The scene, as pbrt-v4, knows a name once:
 * here is what each is called there.
 *
 * pbrt-v3, too, takes colours where pbrt-v4 wants numbers (the amount of a mix of
 * materials) and noise for colours. A texture therefore has a twin of the other type,
 * made when it is asked for: of a colour its mean, of a number its grey.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/intern.h"
#include "format/given.h"
#include "format/pbrt/pbrt_v3_words.h"
#include "texture/texture.h"

#include <string.h>

/* What a name is of. */
typedef enum name_kind { NUMBER_TEXTURE, COLOR_TEXTURE, MATERIAL } name_kind;

struct v3_name {
    name_kind kind;
    const char *name;    /* interned: as the file has it */
    const char *actual;  /* interned: as the scene has it */
    const char *kind_of; /* interned: the texture's or material's, "mix" or "matte" */
    const params *given; /* kept by the parser */
    const char *twin;    /* the scene's name of the same in the other type, or NULL */
    v3_name *before;     /* in force when it was given */
    v3_name *older;      /* of the same kind and name */
    bool has_ended;
};

static bool is_taken(const pbrt_parser *parser, name_kind kind, const char *name)
{
    const build_context *known = &parser->builder->build;
    if (kind == MATERIAL)
        return builder_find_material(parser->builder, name) != NO_INDEX ||
               g_hash_table_contains(parser->interfaces, name);
    return g_hash_table_contains(
        kind == NUMBER_TEXTURE ? known->float_textures : known->spectrum_textures, name);
}

static const char *free_name(const pbrt_parser *parser, name_kind kind, const char *name)
{
    g_autofree char *candidate = g_strdup(name);
    /* From how many there are: files may give a name ten thousand times. */
    for (guint i = parser->v3_names->len + 1; is_taken(parser, kind, candidate); i++) {
        g_free(candidate);
        candidate = g_strdup_printf("%s, %u", name, i);
    }
    return intern(candidate);
}

/* Of a name that a file has, or of one that the scene has. */
static const char *key_of(name_kind kind, bool is_actual, const char *name)
{
    g_autofree char *key = g_strdup_printf("%d %d %s", (int)kind, is_actual, name);
    return intern(key);
}

/* The last one in force; of those that ended, the last one. */
static v3_name *find_name(const pbrt_parser *parser, name_kind kind, const char *name)
{
    v3_name *newest = g_hash_table_lookup(parser->v3_newest, key_of(kind, false, name));
    for (v3_name *n = newest; n; n = n->older)
        if (!n->has_ended)
            return n;
    return newest;
}

void pbrt_v3_end_names(v3_name *given, const v3_name *before)
{
    for (v3_name *n = given; n && n != before; n = n->before)
        n->has_ended = true;
}

static v3_name *give_name(pbrt_parser *parser, name_kind kind, const char *name,
                          source_place place)
{
    v3_name *n = g_new0(v3_name, 1);
    *n = (v3_name){.kind = kind,
                   .name = intern(name),
                   .actual = free_name(parser, kind, name),
                   .before = parser->state.v3_names};
    const char *key = key_of(kind, false, name);
    n->older = g_hash_table_lookup(parser->v3_newest, key);
    g_hash_table_insert(parser->v3_newest, (char *)key, n);
    g_hash_table_insert(parser->v3_newest, (char *)key_of(kind, true, n->actual), n);
    if (n->actual != n->name)
        log_at(&parser->builder->build.log, LOG_NOTE, place,
               "pbrt-v3: \"%s\" is given again; what follows has the new one", name);
    g_ptr_array_add(parser->v3_names, n);
    parser->state.v3_names = n;
    return n;
}

/* ---- Materials ---- */

const char *pbrt_v3_new_material(pbrt_parser *parser, const char *name,
                                 source_place place)
{
    return give_name(parser, MATERIAL, name, place)->actual;
}

const char *pbrt_v3_material_name(const pbrt_parser *parser, const char *name)
{
    const v3_name *n = find_name(parser, MATERIAL, name);
    return n ? n->actual : name;
}

void pbrt_v3_keep_material(pbrt_parser *parser, const char *name, const char *kind,
                           const params *p)
{
    params *given = params_new_like(p);
    for (guint i = 0; i < p->list->len; i++)
        if (p->list->pdata[i] != params_find(p, "type"))
            params_add_copy(given, p->list->pdata[i], NULL);
    g_ptr_array_add(parser->kept, given);
    v3_name *n = name ? find_name(parser, MATERIAL, name) : NULL;
    if (n) {
        n->kind_of = intern(kind);
        n->given = given;
    } else {
        parser->state.v3_material = intern(kind);
        parser->state.v3_given = given;
    }
}

void pbrt_v3_take_material(pbrt_parser *parser, const char *name)
{
    const v3_name *n = find_name(parser, MATERIAL, name);
    parser->state.v3_material = n ? n->kind_of : NULL;
    parser->state.v3_given = n ? n->given : NULL;
}

/* ---- Twins ---- */

static bool is_number_param(const char *name)
{
    static const char *const names[] = {
        "alpha", "amount",       "scale",      "displacement",       "roughness",
        "g",     "uroughness",   "vroughness", "thickness",          "metallic",
        "sheen", "transmission", "clearcoat",  "clearcoatroughness", "anisotropy",
        NULL};
    return g_strv_contains(names, name);
}

/* Of what v3 gives as a colour. */
static float mean_of(const params *p, const param *q)
{
    g_autoptr(curve) c = NULL;
    if (q->type == PARAM_RGB && q->n == 3)
        return (q->numbers[0] + q->numbers[1] + q->numbers[2]) / 3.0f;
    params_curve(p, q->name, CURVE_UNBOUNDED, &c, NULL);
    return c ? (float)((double)curve_photometric(c) / CIE_Y_INTEGRAL) : 0.0f;
}

static const char *twin_of(pbrt_parser *parser, v3_name *n);

/* The record of a texture that the scene has by that name. */
static v3_name *by_actual(const pbrt_parser *parser, name_kind kind, const char *actual)
{
    return g_hash_table_lookup(parser->v3_newest, key_of(kind, true, actual));
}

/* A colour texture's parameters as those of numbers. */
static params *in_numbers(pbrt_parser *parser, const params *p)
{
    params *out = params_new_like(p);
    for (guint i = 0; i < p->list->len; i++) {
        const param *q = p->list->pdata[i];
        bool is_texture = q->type == PARAM_TEXTURE && q->n == 1;
        v3_name *of = is_texture && !is_number_param(q->name)
                          ? by_actual(parser, COLOR_TEXTURE, q->strings[0])
                          : NULL;
        const char *twin = of ? twin_of(parser, of) : NULL;
        if (q->type == PARAM_RGB || q->type == PARAM_BLACKBODY ||
            q->type == PARAM_SPECTRUM || q->type == PARAM_SPECTRUM_NAME)
            give_float(out, q->name, (double)mean_of(p, q));
        else if (twin)
            give_text(out, PARAM_TEXTURE, q->name, twin);
        else
            params_add_copy(out, q, NULL);
    }
    return out;
}

/* The grey that a texture of numbers is. */
static params *as_grey(const params *p, const char *numbers)
{
    params *out = params_new_like(p);
    give_triple(out, PARAM_RGB, "tex1", 0.0, 0.0, 0.0);
    give_triple(out, PARAM_RGB, "tex2", 1.0, 1.0, 1.0);
    give_text(out, PARAM_TEXTURE, "amount", numbers);
    return out;
}

/* The twin's name in the scene. */
static const char *twin_of(pbrt_parser *parser, v3_name *n)
{
    if (n->twin)
        return n->twin;
    bool is_color = n->kind == COLOR_TEXTURE;
    g_autofree char *name =
        g_strconcat(n->actual, is_color ? " in numbers" : " in grey", NULL);
    g_autoptr(params) p =
        is_color ? in_numbers(parser, n->given) : as_grey(n->given, n->actual);
    n->twin = intern(name);
    pbrt_make_texture(parser, name, !is_color, is_color ? n->kind_of : "mix", p);
    return n->twin;
}

/* ---- Textures ---- */

/* Whether a texture gives numbers and no colours. */
static bool is_noise(const char *name)
{
    const texture_kind *kind;
    for (size_t i = 0; (kind = texture_kind_at(i)); i++)
        if (strcmp(kind->name, name) == 0)
            return !kind->eval_spectrum;
    return false;
}

/* Noise is a number: grey as a colour. */
static void make_noise(pbrt_parser *parser, v3_name *n, const char *kind)
{
    g_autofree char *numbers = g_strconcat(n->actual, " in numbers", NULL);
    g_autoptr(params) grey = as_grey(n->given, numbers);
    n->twin = intern(numbers);
    pbrt_make_texture(parser, numbers, false, kind, n->given);
    pbrt_make_texture(parser, n->actual, true, "mix", grey);
}

void pbrt_v3_add_texture(pbrt_parser *parser, const char *name, bool is_spectrum,
                         directive_arguments *a)
{
    pbrt_v3_resolve(parser, a->p, is_spectrum);
    v3_name *n = give_name(parser, is_spectrum ? COLOR_TEXTURE : NUMBER_TEXTURE, name,
                           a->p->place);
    n->kind_of = intern(a->kind);
    n->given = a->p;
    g_ptr_array_add(parser->kept, g_steal_pointer(&a->p));
    if (is_spectrum && is_noise(a->kind))
        make_noise(parser, n, a->kind);
    else
        pbrt_make_texture(parser, n->actual, is_spectrum, a->kind, n->given);
}

/* The name may be the one that is there. */
static void set_name(param *q, size_t i, const char *name)
{
    char *copy = g_strdup(name);
    g_free(q->strings[i]);
    q->strings[i] = copy;
}

static const char *default_material(pbrt_parser *parser, source_place place)
{
    static const char name[] = "pbrt's default";
    g_autoptr(params) p = params_new(place, parser->base_directory, parser->state.space);
    GError *error = NULL;
    if (builder_find_material(parser->builder, name) == NO_INDEX &&
        builder_add_material(parser->builder, name, "diffuse", p, &error) == NO_INDEX)
        pbrt_report(parser, error);
    return name;
}

/* pbrt-v3 mixes in "matte" for what it does not find. */
static void resolve_material(pbrt_parser *parser, param *q, size_t k)
{
    const char *name = pbrt_v3_material_name(parser, q->strings[k]);
    if (builder_find_material(parser->builder, name) == NO_INDEX) {
        pbrt_warning(parser, q->place,
                     "there is no material \"%s\" to be mixed: \"matte\" is taken for it",
                     q->strings[k]);
        name = default_material(parser, q->place);
    }
    set_name(q, k, name);
}

/* @return false: there is no such texture */
static bool resolve_texture(pbrt_parser *parser, param *q, bool is_number)
{
    name_kind kind = is_number ? NUMBER_TEXTURE : COLOR_TEXTURE;
    name_kind other = is_number ? COLOR_TEXTURE : NUMBER_TEXTURE;
    v3_name *n = find_name(parser, kind, q->strings[0]);
    v3_name *twin = n ? NULL : find_name(parser, other, q->strings[0]);
    if (n)
        set_name(q, 0, n->actual);
    else if (twin) {
        log_at(&parser->builder->build.log, LOG_NOTE, q->place,
               "pbrt-v3: texture \"%s\" is taken for %s", q->strings[0],
               is_number ? "a number, the mean of its colour" : "a grey");
        set_name(q, 0, twin_of(parser, twin));
    }
    return n || twin;
}

void pbrt_v3_resolve(pbrt_parser *parser, params *p, bool in_colors)
{
    for (guint i = p->list->len; i-- > 0;) {
        param *q = p->list->pdata[i];
        bool is_number = !in_colors || is_number_param(q->name);
        if (q->type == PARAM_STRING && strcmp(q->name, "materials") == 0)
            for (size_t k = 0; k < q->n; k++)
                resolve_material(parser, q, k);
        if (q->type != PARAM_TEXTURE || q->n != 1 ||
            resolve_texture(parser, q, is_number))
            continue;
        pbrt_warning(parser, q->place,
                     "there is no texture \"%s\"; parameter '%s' is left out",
                     q->strings[0], q->name);
        g_ptr_array_remove_index(p->list, i);
    }
}
