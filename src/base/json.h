/*
 * Writing JSON (RFC 8259): escaped strings, numbers with a point in every locale that
 * read back to the same value, null for what is not finite, two blanks a level.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** @brief A text being written. Zero-initialise, end with json_finish. */
typedef struct json {
    GString *text;
    unsigned depth;
    bool has_members; /**< the object or array that is open has a member already */
} json;

/* Each takes the member's key; NULL in an array and at the top. */
void json_object_begin(json *j, const char *key);
void json_object_end(json *j);
void json_array_begin(json *j, const char *key);
void json_array_end(json *j);
/** @brief value NULL: null. Bytes that are not UTF-8 are replaced. */
void json_string(json *j, const char *key, const char *value);
void json_number(json *j, const char *key, double value);
void json_integer(json *j, const char *key, int64_t value);
void json_count(json *j, const char *key, uint64_t value);
void json_bool(json *j, const char *key, bool value);
/** @brief The shortest text that reads back to the same float. */
void json_float(json *j, const char *key, float value);
/** @brief An array of n such numbers on one line. */
void json_floats(json *j, const char *key, const float *values, size_t n);

/** @brief The text, ending with a newline; owned by the caller. j is zero again. */
char *json_finish(json *j);

/** @brief The shortest text that reads back to value, without exponent from 1 to 1e15; in
 * buffer, which is returned. */
const char *number_text(double value, char buffer[G_ASCII_DTOSTR_BUF_SIZE]);
