/*
 * What the translators from pbrt-v3 do with parameters.
 */
#pragma once

#include "base/intern.h"
#include "format/given.h"
#include "format/pbrt/pbrt_v3.h"

#include <string.h>

/* ∫ ȳ dλ, which v3 divides luminances by. */
#define CIE_Y_INTEGRAL 106.856895

/* A directive being translated. */
typedef struct translation {
    char **kind;
    params *p;
    const log_sink *log;
    GError **error; /* of what there is no memory for */
} translation;

static inline void note(const translation *t, const param *q, const char *text)
{
    source_place at = q ? q->place : t->p->place;
    log_at(t->log, LOG_NOTE, at, "pbrt-v3: %s", text);
}

static inline param *find(const translation *t, const char *name)
{
    for (guint i = 0; i < t->p->list->len; i++) {
        param *q = t->p->list->pdata[i];
        if (strcmp(q->name, name) == 0)
            return q;
    }
    return NULL;
}

static inline void drop(const translation *t, const char *name)
{
    param *q = find(t, name);
    if (q)
        g_ptr_array_remove(t->p->list, q);
}

/* Gone without a trace, or with a word about what it meant. */
static inline void drop_noted(const translation *t, const char *name, const char *text)
{
    if (find(t, name))
        note(t, find(t, name), text);
    drop(t, name);
}

static inline void rename_to(const translation *t, const char *name, const char *other)
{
    param *q = find(t, name);
    if (q && !find(t, other))
        q->name = intern(other);
}

static inline void set_kind(const translation *t, const char *kind)
{
    g_free(*t->kind);
    *t->kind = g_strdup(kind);
}

static inline bool is_number(const param *q)
{
    return q && q->type == PARAM_FLOAT && q->n == 1;
}

static inline bool is_rgb(const param *q)
{
    return q && q->type == PARAM_RGB && q->n == 3;
}

static inline double number(const translation *t, const char *name, double fallback)
{
    const param *q = find(t, name);
    return is_number(q) ? (double)q->numbers[0] : fallback;
}

static inline void set_number(const translation *t, const char *name, double value)
{
    param *q = find(t, name);
    if (is_number(q))
        q->numbers[0] = (float)value;
    else if (!q)
        give_float(t->p, name, value);
}

/* "rgb name" with a value where nothing is given. */
static inline void default_rgb(const translation *t, const char *name, double value)
{
    if (!find(t, name))
        give_triple(t->p, PARAM_RGB, name, value, value, value);
}

static inline void scale_rgb(const translation *t, const char *name,
                             const double factor[3])
{
    param *q = find(t, name);
    if (is_rgb(q))
        for (int i = 0; i < 3; i++)
            q->numbers[i] = (float)((double)q->numbers[i] * factor[i]);
}

/* Cut to what an albedo may be. */
static inline void clamp_rgb(const translation *t, const char *name)
{
    param *q = find(t, name);
    for (int i = 0; is_rgb(q) && i < 3; i++)
        q->numbers[i] = CLAMP(q->numbers[i], 0.0f, 1.0f);
}

/* ---- pbrt_v3_surface.c ---- */

void pbrt_v3_material(const translation *t);
void pbrt_v3_texture(const translation *t);

/* ---- pbrt_v3_shape.c ---- */

void pbrt_v3_shape(const translation *t);

/* ---- pbrt_v3_values.c ---- */

/* Black bodies with a scale become spectra. */
void pbrt_v3_heat(const translation *t);
/* The luminance of a spectrum, 1 for one that is 1; false: it is none. */
bool pbrt_v3_luminance(const translation *t, const param *q, double *out);
