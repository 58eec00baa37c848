/*
 * Parameter lists: "type name" followed by one value or a bracketed list.
 */
#include "base/wanted.h"
#include "format/pbrt/pbrt_parser.h"

#include "base/memory.h"
#include "format/number.h"
#include "format/spectrum_file.h"

#include <math.h>
#include <string.h>

typedef enum value_class { NUMBERS, INTEGERS, BOOLS, STRINGS, SPECTRA } value_class;

typedef struct type_row {
    const char *name;
    param_type type;
    value_class values;
    size_t n; /**< numbers that belong together */
} type_row;

static const type_row types[] = {
    {"float", PARAM_FLOAT, NUMBERS, 1},       {"integer", PARAM_INTEGER, INTEGERS, 1},
    {"bool", PARAM_BOOL, BOOLS, 1},           {"string", PARAM_STRING, STRINGS, 1},
    {"point2", PARAM_POINT2, NUMBERS, 2},     {"vector2", PARAM_VECTOR2, NUMBERS, 2},
    {"point3", PARAM_POINT3, NUMBERS, 3},     {"point", PARAM_POINT3, NUMBERS, 3},
    {"vector3", PARAM_VECTOR3, NUMBERS, 3},   {"vector", PARAM_VECTOR3, NUMBERS, 3},
    {"normal", PARAM_NORMAL, NUMBERS, 3},     {"normal3", PARAM_NORMAL, NUMBERS, 3},
    {"rgb", PARAM_RGB, NUMBERS, 3},           {"blackbody", PARAM_BLACKBODY, NUMBERS, 1},
    {"spectrum", PARAM_SPECTRUM, SPECTRA, 1}, {"texture", PARAM_TEXTURE, STRINGS, 1},
};

/** A parameter being read. */
typedef struct declaration {
    const type_row *type; /**< NULL: none that pbrt-v3 knows, to be passed over */
    bool is_xyz;
    char *name;
    token token;
} declaration;

static const type_row *find_type(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(types); i++)
        if (strcmp(types[i].name, name) == 0)
            return &types[i];
    return NULL;
}

bool pbrt_is_declaration(const token *t)
{
    if (t->kind != TOKEN_STRING)
        return false;
    g_autofree char *text = token_string(t);
    g_strstrip(text);
    text[strcspn(text, " \t")] = '\0';
    return find_type(text) || strcmp(text, "color") == 0 || strcmp(text, "xyz") == 0;
}

static bool read_declaration(pbrt_parser *parser, declaration *d)
{
    d->token = lexer_next(parser->words);
    g_autofree char *text = token_string(&d->token);
    g_auto(GStrv) words = g_strsplit_set(g_strstrip(text), " \t", 2);
    if (parser->is_v3 && g_strv_length(words) == 1 && *words[0]) {
        d->name = g_strdup(words[0]);
        return true;
    }
    if (g_strv_length(words) != 2 || strpbrk(g_strstrip(words[1]), " \t"))
        return pbrt_expected(parser, "\"type name\"", &d->token);
    d->is_xyz = parser->is_v3 && strcmp(words[0], "xyz") == 0;
    bool old_rgb = d->is_xyz || (parser->is_v3 && strcmp(words[0], "color") == 0);
    d->type = find_type(old_rgb ? "rgb" : words[0]);
    if (!d->type && !parser->is_v3) {
        pbrt_error(
            parser, d->token.place,
            "expected a parameter type (float, integer, bool, string, point2, "
            "vector2, point3, vector3, normal, rgb, blackbody, spectrum, texture), "
            "found '%s'",
            words[0]);
        return false;
    }
    d->name = g_strdup(words[1]);
    return true;
}

/** Room for one more number. NULL and reported if memory is short. */
static void *push(pbrt_parser *parser)
{
    scratch *s = &parser->values;
    if (s->n == s->capacity) {
        size_t capacity = s->capacity ? 2 * s->capacity : 1024;
        GError *error = NULL;
        void *grown = s->data
                          ? big_grow(s->data, s->capacity, capacity, 4, "numbers", &error)
                          : big_alloc(capacity, 4, "numbers", &error);
        if (!grown) {
            pbrt_report(parser, error);
            return NULL;
        }
        s->data = grown;
        s->capacity = capacity;
    }
    return (char *)s->data + 4 * s->n++;
}

static bool wrong_value(pbrt_parser *parser, const declaration *d, const char *what,
                        const token *found)
{
    g_autofree char *text = token_describe(found);
    pbrt_error(parser, found->place, "parameter '%s': expected %s, found %s", d->name,
               what, text);
    return false;
}

static bool push_float(pbrt_parser *parser, const declaration *d, const token *t)
{
    float value;
    double cut;
    if (t->kind == TOKEN_WORD && !number_float(t->text, t->length, &value) &&
        pbrt_v3_number(parser, t, &cut))
        value = (float)cut;
    else if (t->kind != TOKEN_WORD || !number_float(t->text, t->length, &value))
        return wrong_value(parser, d, "a number", t);
    float *to = push(parser);
    if (to)
        *to = value;
    return to != NULL;
}

/* What is no whole number is cut to one, as pbrt does. */
static bool cut_number(pbrt_parser *parser, const declaration *d, const token *t,
                       int *out)
{
    double x;
    if (!number_double(t->text, t->length, &x) && !pbrt_v3_number(parser, t, &x))
        return false;
    *out = (int)CLAMP(x, (double)INT_MIN, (double)INT_MAX);
    if (fabs((double)*out - x) > 0.0)
        pbrt_warning(parser, t->place, "parameter '%s': %.*s is taken as %d", d->name,
                     (int)t->length, t->text, *out);
    return true;
}

static bool push_integer(pbrt_parser *parser, const declaration *d, const token *t)
{
    int value;
    if (t->kind != TOKEN_WORD ||
        (!number_int(t->text, t->length, &value) && !cut_number(parser, d, t, &value)))
        return wrong_value(parser, d, "a whole number", t);
    int *to = push(parser);
    if (to)
        *to = value;
    return to != NULL;
}

static bool push_bool(pbrt_parser *parser, const declaration *d, const token *t)
{
    token word = *t;
    if (parser->is_v3 && t->kind == TOKEN_STRING)
        word.kind = TOKEN_WORD; /* pbrt-v3 writes it in quotes */
    bool is_true = token_is(&word, "true"), is_word = word.kind == TOKEN_WORD;
    bool known = is_true || token_is(&word, "false");
    if (!known && parser->is_v3 && is_word && t->kind == TOKEN_STRING)
        pbrt_warning(parser, t->place, "parameter '%s': \"%.*s\" is taken as false",
                     d->name, (int)MIN(t->length, (size_t)20), t->text);
    else if (!known)
        return wrong_value(parser, d, "true or false", t);
    int *to = push(parser);
    if (to)
        *to = is_true;
    return to != NULL;
}

static bool push_string(pbrt_parser *parser, const declaration *d, const token *t,
                        GPtrArray *strings)
{
    const size_t each = 32 + 2 * sizeof(char *);
    if (t->kind != TOKEN_STRING)
        return wrong_value(parser, d, "a string in quotes", t);
    if (!pbrt_has_room(parser, t->place, t->length + each, "strings"))
        return false;
    g_ptr_array_add(strings, token_string(t));
    return true;
}

static bool push_value(pbrt_parser *parser, const declaration *d, const token *t,
                       GPtrArray *strings)
{
    switch (d->type->values) {
    case NUMBERS:
        return push_float(parser, d, t);
    case INTEGERS:
        return push_integer(parser, d, t);
    case BOOLS:
        return push_bool(parser, d, t);
    case STRINGS:
        return push_string(parser, d, t, strings);
    case SPECTRA:
        break;
    }
    if (t->kind == TOKEN_STRING && parser->values.n == 0)
        return push_string(parser, d, t, strings);
    return push_float(parser, d, t);
}

static bool skip_values(pbrt_parser *parser, const token *first)
{
    token t = *first;
    while (t.kind != TOKEN_END && t.kind != TOKEN_RIGHT && first->kind == TOKEN_LEFT)
        t = lexer_next(parser->words);
    return true;
}

/* pbrt-v3 leaves out words where it wants numbers, and the other way round. */
static bool is_of_class(const declaration *d, const token *first)
{
    bool is_text = first->kind == TOKEN_STRING, is_word = first->kind == TOKEN_WORD;
    if (d->type->values == STRINGS)
        return !is_word;
    if (d->type->values == BOOLS)
        return !is_word || token_is(first, "true") || token_is(first, "false");
    return d->type->values == SPECTRA || !is_text;
}

/** All values of one parameter, into parser->values or strings. */
static bool read_values(pbrt_parser *parser, const declaration *d, GPtrArray *strings)
{
    parser->values.n = 0;
    token t = lexer_next(parser->words);
    token first = t.kind == TOKEN_LEFT ? lexer_peek(parser->words) : t;
    if (!d->type || (parser->is_v3 && !is_of_class(d, &first)))
        return skip_values(parser, &t);
    if (t.kind != TOKEN_LEFT)
        return push_value(parser, d, &t, strings);
    for (t = lexer_next(parser->words); t.kind != TOKEN_RIGHT;
         t = lexer_next(parser->words)) {
        size_t n = parser->values.n + strings->len;
        if (!still_wanted_at(n, parser->fatal ? NULL : &parser->fatal) ||
            !push_value(parser, d, &t, strings))
            return false;
    }
    if (parser->values.n + strings->len == 0 && !parser->is_v3)
        return wrong_value(parser, d, "a value", &t);
    return true;
}

static bool is_known_spectrum(const char *name)
{
    g_autoptr(curve) known = curve_named(name);
    return known != NULL;
}

/** A spectrum's name stays a name if it is known, else it is a file's. */
static bool add_spectrum(pbrt_parser *parser, params *p, const declaration *d,
                         const GPtrArray *strings, GError **error)
{
    source_place place = d->token.place;
    const char *const *names = (const char *const *)strings->pdata;
    if (strings->len != 1 || is_known_spectrum(names[0]))
        return params_add_strings(p, place, PARAM_SPECTRUM_NAME, d->name, names,
                                  strings->len, error);
    g_autofree char *path = g_canonicalize_filename(names[0], parser->base_directory);
    scene_sources_add(parser->builder->build.sources, path);
    if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
        error_at(error, place,
                 "parameter '%s': expected a spectrum's name or file, found \"%s\"",
                 d->name, names[0]);
        return false;
    }
    g_autoptr(GArray) numbers = spectrum_file_read(path, place, error);
    return numbers &&
           params_add_numbers(p, place, PARAM_SPECTRUM, d->name,
                              (const float *)numbers->data, numbers->len, error);
}

/** Of a parameter that is given again the last counts, but pbrt-v3 takes a texture before
 * a value. @return whether this one counts */
static bool replace_older(pbrt_parser *parser, params *p, const declaration *d)
{
    const param *older = params_find(p, d->name);
    source_place at = d->token.place;
    if (!older)
        return true;
    bool stays =
        parser->is_v3 && older->type == PARAM_TEXTURE && d->type->type != PARAM_TEXTURE;
    log_at(&parser->builder->build.log, LOG_NOTE, at, "parameter '%s' is given again: %s",
           d->name, stays ? "the texture counts" : "the last counts");
    if (!stays)
        params_remove(p, d->name);
    return !stays;
}

/* pbrt-v3's colours are sRGB's. */
static void turn_to_rgb(float *numbers, size_t n)
{
    for (size_t i = 0; i + 3 <= n; i += 3) {
        const float xyz[] = {numbers[i], numbers[i + 1], numbers[i + 2]};
        color_space_from_xyz(color_space_srgb(), xyz, numbers + i);
        for (int k = 0; k < 3; k++)
            numbers[i + k] = fmaxf(numbers[i + k], 0.0f);
    }
}

/* pbrt-v3 leaves out numbers at the end that make no colour, point or pair. */
static void drop_excess(pbrt_parser *parser, const declaration *d)
{
    if (!parser->is_v3 || !d->type || d->type->values == STRINGS)
        return;
    size_t excess =
        parser->values.n % (d->type->values == SPECTRA ? (size_t)2 : d->type->n);
    if (excess > 0)
        pbrt_warning(parser, d->token.place,
                     "parameter '%s': the last %zu of %zu numbers are left out", d->name,
                     excess, parser->values.n);
    parser->values.n -= excess;
}

/* Of pbrt-v3: without a type that it knows, or without a value. */
static bool is_passed_over(const pbrt_parser *parser, const declaration *d,
                           const GPtrArray *strings)
{
    if (d->type && parser->values.n + strings->len > 0)
        return false;
    log_at(&parser->builder->build.log, LOG_NOTE, d->token.place,
           "parameter '%s' is left out: it has no %s", d->name,
           d->type ? "value" : "type that pbrt-v3 knows");
    return true;
}

static bool add_values(pbrt_parser *parser, params *p, const declaration *d,
                       const GPtrArray *strings, GError **error)
{
    const type_row *type = d->type;
    const scratch *values = &parser->values;
    source_place place = d->token.place;
    if (d->is_xyz)
        turn_to_rgb(parser->values.data, values->n);
    if (values->n % type->n) {
        error_at(error, place,
                 "parameter '%s': expected a multiple of %zu numbers, "
                 "found %zu",
                 d->name, type->n, values->n);
        return false;
    }
    if (type->values == SPECTRA && strings->len)
        return add_spectrum(parser, p, d, strings, error);
    if (type->values == STRINGS)
        return params_add_strings(p, place, type->type, d->name,
                                  (const char *const *)strings->pdata, strings->len,
                                  error);
    if (type->values == INTEGERS || type->values == BOOLS)
        return params_add_integers(p, place, type->type, d->name, values->data, values->n,
                                   error);
    return params_add_numbers(p, place, type->type, d->name, values->data, values->n,
                              error);
}

/** One parameter. A wrong one ends its directive as broken grammar does: what would be
 * said about the rest would only follow from it. */
static bool read_param(pbrt_parser *parser, params *p)
{
    declaration d = {0};
    g_autoptr(GPtrArray) strings = g_ptr_array_new_with_free_func(g_free);
    GError *error = NULL;
    bool fine = read_declaration(parser, &d) && read_values(parser, &d, strings);
    if (fine)
        drop_excess(parser, &d);
    if (fine && !is_passed_over(parser, &d, strings) && replace_older(parser, p, &d) &&
        !add_values(parser, p, &d, strings, &error)) {
        pbrt_report(parser, error);
        fine = false;
    }
    g_free(d.name);
    return fine;
}

/* The end of an included file does not end its last directive: parameters behind the
 * Include are of that one. */
static token next_of_list(pbrt_parser *parser)
{
    token t = lexer_peek(parser->words);
    lexer *words = parser->words;
    while (t.kind == TOKEN_END && words->outer) {
        words = words->outer;
        t = lexer_peek(words);
    }
    if (t.kind == TOKEN_STRING)
        parser->words = words;
    return lexer_peek(parser->words);
}

bool pbrt_read_param_list(pbrt_parser *parser, params *p)
{
    lexer *own = parser->words;
    bool fine = true, ends = false;
    while (fine && !ends) {
        token t = next_of_list(parser);
        if (t.kind == TOKEN_STRING)
            fine = read_param(parser, p);
        else
            ends = !parser->is_v3 || !token_is(&t, "Include") ||
                   !pbrt_include_parameters(parser, p, &fine);
    }
    parser->words = own;
    return fine;
}

params *pbrt_read_params(pbrt_parser *parser, source_place place)
{
    g_autoptr(params) p = params_new(place, parser->base_directory, parser->state.space);
    p->to_world = parser->state.ctm;
    p->log = &parser->builder->build.log;
    p->lets_unknown = parser->is_v3;
    if (!pbrt_read_param_list(parser, p))
        return NULL;
    token t = lexer_peek(parser->words);
    if (t.kind == TOKEN_UNTERMINATED || t.kind == TOKEN_LEFT || t.kind == TOKEN_RIGHT) {
        pbrt_expected(parser, "a parameter or a directive", &t);
        return NULL;
    }
    return g_steal_pointer(&p);
}

/** Copies a default; it may go unused, since it is meant for many kinds. */
static bool copy_default(params *p, const params *from, const param *q, GError **error)
{
    if (q->type == PARAM_RGB && from->space != p->space) {
        error_at(error, q->place,
                 "parameter '%s': expected the colour space of the directives it is for, "
                 "found another",
                 q->name);
        return false;
    }
    if (!params_add_copy(p, q, error))
        return false;
    param *copy = p->list->pdata[p->list->len - 1];
    copy->used = copy->is_default = true;
    return true;
}

params *pbrt_read_params_for(pbrt_parser *parser, source_place place,
                             attribute_target target)
{
    params *p = pbrt_read_params(parser, place);
    if (!p)
        return NULL;
    for (const attribute *a = parser->state.attributes[target]; a; a = a->before)
        for (guint i = 0; i < a->given->list->len; i++) {
            const param *q = a->given->list->pdata[i];
            GError *error = NULL;
            if (!params_has(p, q->name) && !copy_default(p, a->given, q, &error))
                pbrt_report(parser, error);
        }
    return p;
}

void pbrt_check_used(pbrt_parser *parser, const params *p, const char *what,
                     const char *kind)
{
    g_autofree char *whole = g_strdup_printf("%s \"%s\"", what, kind);
    GError *error = NULL;
    if (!params_all_used(p, whole, &error))
        pbrt_report(parser, error);
}

/* Where an Include among parameters leads. */
typedef struct parameter_file {
    params *p;
    bool has_some, fine;
} parameter_file;

static void read_parameters(pbrt_parser *parser, lexer *words, void *data)
{
    parameter_file *file = data;
    lexer *outer = parser->words;
    parser->words = words;
    token first = lexer_peek(words);
    file->has_some = pbrt_is_declaration(&first);
    file->fine = !file->has_some || pbrt_read_param_list(parser, file->p);
    token t = lexer_peek(words);
    if (file->has_some && file->fine && t.kind != TOKEN_END)
        file->fine = pbrt_expected(parser, "a parameter", &t);
    parser->words = outer;
}

bool pbrt_include_parameters(pbrt_parser *parser, params *p, bool *fine)
{
    lexer before = *parser->words;
    lexer_next(parser->words);
    token name = lexer_peek(parser->words);
    parameter_file file = {.p = p, .fine = true};
    guint n_errors = parser->errors->len;
    if (name.kind == TOKEN_STRING) {
        lexer_next(parser->words);
        g_autofree char *text = token_string(&name);
        pbrt_read_file(parser, text, name.place, read_parameters, &file);
    }
    bool failed = parser->errors->len > n_errors;
    if (!file.has_some && !failed)
        *parser->words = before;
    *fine = file.fine && !failed;
    return file.has_some || failed;
}

void pbrt_clear_arguments(directive_arguments *a)
{
    g_free(a->kind);
    params_free(a->p);
}
