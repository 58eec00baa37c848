/*
 * Parameter lists: adding, typed asking, and the check that nothing was left unasked.
 *
 * Lists are short (a dozen entries), so a name is found by walking them; values may be
 * long (a mesh's points), so they are big arrays.
 */
#include "params/params.h"

#include "base/intern.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static const char *const type_names[] = {
    [PARAM_FLOAT] = "float",
    [PARAM_INTEGER] = "integer",
    [PARAM_BOOL] = "bool",
    [PARAM_STRING] = "string",
    [PARAM_POINT2] = "point2",
    [PARAM_VECTOR2] = "vector2",
    [PARAM_POINT3] = "point3",
    [PARAM_VECTOR3] = "vector3",
    [PARAM_NORMAL] = "normal",
    [PARAM_RGB] = "rgb",
    [PARAM_BLACKBODY] = "blackbody",
    [PARAM_SPECTRUM] = "spectrum",
    [PARAM_SPECTRUM_NAME] = "spectrum",
    [PARAM_TEXTURE] = "texture",
};

const char *param_type_name(param_type type)
{
    return type_names[type];
}

static void param_free(void *data)
{
    param *q = data;
    big_free(q->numbers);
    big_free(q->integers);
    g_strfreev(q->strings);
    g_free(q);
}

params *params_new(source_place place, const char *base_directory,
                   const color_space *space)
{
    params *p = g_new0(params, 1);
    p->list = g_ptr_array_new_with_free_func(param_free);
    p->place = place;
    p->base_directory = intern(base_directory);
    p->space = space;
    p->to_world = transform_identity();
    return p;
}

params *params_new_like(const params *p)
{
    params *like = params_new(p->place, p->base_directory, p->space);
    like->to_world = p->to_world;
    like->log = p->log;
    like->lets_unknown = p->lets_unknown;
    return like;
}

void params_free(params *p)
{
    if (!p)
        return;
    g_ptr_array_unref(p->list);
    g_free(p);
}

param *params_look_up(const params *p, const char *name)
{
    for (guint i = 0; i < p->list->len; i++) {
        param *q = p->list->pdata[i];
        if (strcmp(q->name, name) == 0)
            return q;
    }
    return NULL;
}

static param *add(params *p, source_place place, param_type type, const char *name,
                  size_t n, GError **error)
{
    if (params_look_up(p, name)) {
        error_at(error, place, "expected each parameter once, found '%s' again", name);
        return NULL;
    }
    param *q = g_new0(param, 1);
    q->name = intern(name);
    q->type = type;
    q->place = place;
    q->n = n;
    return q;
}

bool params_add_numbers(params *p, source_place place, param_type type, const char *name,
                        const float *numbers, size_t n, GError **error)
{
    param *q = add(p, place, type, name, n, error);
    if (!q)
        return false;
    q->numbers = big_alloc(n, sizeof *numbers, name, error);
    if (!q->numbers) {
        param_free(q);
        return false;
    }
    if (n)
        memcpy(q->numbers, numbers, n * sizeof *numbers);
    g_ptr_array_add(p->list, q);
    return true;
}

bool params_add_integers(params *p, source_place place, param_type type, const char *name,
                         const int *integers, size_t n, GError **error)
{
    param *q = add(p, place, type, name, n, error);
    if (!q)
        return false;
    q->integers = big_alloc(n, sizeof *integers, name, error);
    if (!q->integers) {
        param_free(q);
        return false;
    }
    if (n)
        memcpy(q->integers, integers, n * sizeof *integers);
    g_ptr_array_add(p->list, q);
    return true;
}

bool params_add_strings(params *p, source_place place, param_type type, const char *name,
                        const char *const *strings, size_t n, GError **error)
{
    const size_t each = 32 + sizeof(char *);
    if (!memory_ask(n * each, name, error))
        return false;
    param *q = add(p, place, type, name, n, error);
    if (!q)
        return false;
    q->strings = g_new0(char *, n + 1);
    for (size_t i = 0; i < n; i++)
        q->strings[i] = g_strdup(strings[i]);
    g_ptr_array_add(p->list, q);
    return true;
}

bool params_add_copy(params *p, const param *q, GError **error)
{
    if (q->strings)
        return params_add_strings(p, q->place, q->type, q->name,
                                  (const char *const *)q->strings, q->n, error);
    if (q->integers)
        return params_add_integers(p, q->place, q->type, q->name, q->integers, q->n,
                                   error);
    return params_add_numbers(p, q->place, q->type, q->name, q->numbers, q->n, error);
}

void params_remove(params *p, const char *name)
{
    param *q = params_look_up(p, name);
    if (q)
        g_ptr_array_remove(p->list, q);
}

const param *params_find(const params *p, const char *name)
{
    param *q = params_look_up(p, name);
    if (q)
        q->used = true;
    return q;
}

bool params_has(const params *p, const char *name)
{
    return params_look_up(p, name) != NULL;
}

/* In pbrt-v3 the type belongs to the name: what has another is not known. */
static bool wrong_type(const params *p, const param *q, const char *expected,
                       GError **error)
{
    if (p->lets_unknown) {
        log_at(p->log, LOG_NOTE, q->place,
               "parameter '%s' is left out: expected %s, found %s", q->name, expected,
               type_names[q->type]);
        return true;
    }
    error_at(error, q->place, "parameter '%s': expected %s, found %s", q->name, expected,
             type_names[q->type]);
    return false;
}

static bool check_count(const param *q, size_t expected, GError **error)
{
    if (q->n == expected)
        return true;
    error_at(error, q->place, "parameter '%s': expected %zu value%s, found %zu", q->name,
             expected, expected == 1 ? "" : "s", q->n);
    return false;
}

static bool check_finite(const param *q, GError **error)
{
    for (size_t i = 0; i < q->n; i++)
        if (!isfinite(q->numbers[i])) {
            error_at(error, q->place, "parameter '%s': expected finite numbers, found %g",
                     q->name, (double)q->numbers[i]);
            return false;
        }
    return true;
}

bool params_float(const params *p, const char *name, float *out, GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    if (q->type != PARAM_FLOAT)
        return wrong_type(p, q, "float", error);
    if (!check_count(q, 1, error) || !check_finite(q, error))
        return false;
    *out = q->numbers[0];
    return true;
}

bool params_integer(const params *p, const char *name, int *out, GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    if (q->type != PARAM_INTEGER)
        return wrong_type(p, q, "integer", error);
    if (!check_count(q, 1, error))
        return false;
    *out = q->integers[0];
    return true;
}

bool params_bool(const params *p, const char *name, bool *out, GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    if (q->type != PARAM_BOOL)
        return wrong_type(p, q, "bool", error);
    if (!check_count(q, 1, error))
        return false;
    *out = q->integers[0] != 0;
    return true;
}

bool params_string(const params *p, const char *name, const char **out, GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    if (q->type != PARAM_STRING)
        return wrong_type(p, q, "string", error);
    if (!check_count(q, 1, error))
        return false;
    *out = q->strings[0];
    return true;
}

bool params_point3(const params *p, const char *name, vec3 *out, GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    if (q->type != PARAM_POINT3 && q->type != PARAM_VECTOR3 && q->type != PARAM_NORMAL)
        return wrong_type(p, q, "point3", error);
    if (!check_count(q, 3, error) || !check_finite(q, error))
        return false;
    *out = vec3_make(q->numbers[0], q->numbers[1], q->numbers[2]);
    return true;
}

bool params_choice(const params *p, const char *name, const char *const *words, int *out,
                   GError **error)
{
    const char *word = NULL;
    if (!params_string(p, name, &word, error))
        return false;
    if (!word)
        return true;
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], word) == 0) {
            *out = i;
            return true;
        }
    g_autofree char *known = g_strjoinv(", ", (char **)words);
    error_at(error, params_look_up(p, name)->place,
             "parameter '%s': expected one of %s, found '%s'", name, known, word);
    return false;
}

bool params_path(const params *p, const char *name, char **out, GError **error)
{
    const char *given = NULL;
    *out = NULL;
    if (!params_string(p, name, &given, error))
        return false;
    if (!given)
        return true;
    if (!*given) {
        error_at(error, params_look_up(p, name)->place,
                 "parameter '%s': expected a file name, found an empty string", name);
        return false;
    }
    *out = g_canonicalize_filename(given, p->base_directory);
    return true;
}

/* True if a name is one of a list's words. */
static bool is_listed(const char *name, const char *list)
{
    size_t length = strlen(name);
    for (const char *at = list; at && (at = strstr(at, name)); at += length)
        if ((at == list || at[-1] == ' ') && (!at[length] || at[length] == ' '))
            return true;
    return false;
}

/* Noted and passed over, or an error. */
static bool meet_unknown(const params *p, param *q, const char *what, GError **error)
{
    if (!p->lets_unknown) {
        error_at(error, q->place, "unknown parameter '%s' of %s", q->name, what);
        return false;
    }
    log_at(p->log, LOG_NOTE, q->place, "unknown parameter '%s' of %s is left out",
           q->name, what);
    q->used = true;
    return true;
}

bool params_known(const params *p, const char *what, const char *names, const char *more,
                  GError **error)
{
    for (guint i = 0; i < p->list->len; i++) {
        param *q = p->list->pdata[i];
        bool known = q->used || is_listed(q->name, names) || is_listed(q->name, more);
        if (!known && !meet_unknown(p, q, what, error))
            return false;
    }
    return true;
}

bool params_all_used(const params *p, const char *what, GError **error)
{
    for (guint i = 0; i < p->list->len; i++) {
        param *q = p->list->pdata[i];
        if (!q->used && !meet_unknown(p, q, what, error))
            return false;
    }
    return true;
}
