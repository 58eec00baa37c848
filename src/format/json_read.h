/*
 * Reading JSON by paths: a value knows where it stands, so that a message can say
 * "scene.gltf: materials[3].alphaMode: expected ...". Asking for what is absent gives the
 * fallback; what is there but wrong is noted in the reader, first come first kept, and
 * gives the fallback too, so that code that reads asks once at its end.
 */
#pragma once

#include "base/error.h"

#include <json-glib/json-glib.h>
#include <stddef.h>

/** @brief A document being read. */
typedef struct json_reader {
    const char *file; /**< interned, for messages */
    JsonParser *parser;
    GError *error; /**< the first; NULL: none */
} json_reader;

/** @brief A value with the way to it. Plain; its parents must outlive it. */
typedef struct json_value {
    json_reader *reader;
    JsonNode *node; /**< NULL: absent */
    const struct json_value *parent;
    const char *key; /**< NULL: an element */
    guint index;
} json_value;

/** @brief Parses text. ERROR_INPUT with line and column, also for what nests too deep. */
bool json_open(json_reader *reader, const char *file, const char *text, size_t size,
               GError **error);
void json_close(json_reader *reader);
json_value json_root(json_reader *reader);

/** @brief The member of an object, absent if there is none. */
json_value json_member(const json_value *of, const char *key);
/** @brief The element of an array; an error if there is none. */
json_value json_element(const json_value *of, guint index);
static inline bool json_exists(const json_value *v)
{
    return v->node != NULL;
}
/** @brief Elements of an array; 0 if absent, an error if it is none. */
guint json_length(const json_value *v);

/* Members by key, or the fallback. */
double json_real(const json_value *of, const char *key, double fallback);
bool json_flag(const json_value *of, const char *key, bool fallback);
/** @brief Valid as long as the document; NULL if absent. */
const char *json_text(const json_value *of, const char *key);
/** @brief A whole number in 0..most, or -1 if absent. */
gint64 json_whole(const json_value *of, const char *key, gint64 most);
/** @brief The same of an array's element. */
gint64 json_whole_at(const json_value *of, guint index, gint64 most);
/** @brief A number of an array's element; 0 with an error. */
double json_real_at(const json_value *of, guint index);
/** @brief Fills n numbers. @return false, out untouched, if absent or wrong. */
bool json_numbers(const json_value *of, const char *key, double *out, guint n);

/** @brief Notes an error at a value. */
void json_fail(const json_value *at, const char *format, ...) G_GNUC_PRINTF(2, 3);
/** @brief "materials[3].alphaMode"; owned by the caller. */
char *json_path(const json_value *v);
