/*
 * The words of a pbrt file: bare words (directives, numbers), strings and brackets, each
 * with its place. Comments run from '#' to the end of the line.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

typedef enum token_kind {
    TOKEN_END,
    TOKEN_WORD,
    TOKEN_STRING,
    TOKEN_LEFT,         /**< [ */
    TOKEN_RIGHT,        /**< ] */
    TOKEN_UNTERMINATED, /**< a string without its closing quote on the line */
} token_kind;

/** @brief A word; text points into the file, for a string at what is between its quotes.
 */
typedef struct token {
    token_kind kind;
    const char *text;
    size_t length;
    source_place place;
} token;

/** @brief Where the reading stands. A plain value; the bytes must stay. */
typedef struct lexer {
    const char *file; /**< interned */
    const char *at, *end, *line_start;
    int line;
    token ahead;
    bool has_ahead;
    struct lexer *outer; /**< where a list goes on that this file's end leaves open */
} lexer;

lexer lexer_new(const char *file, const char *data, size_t size);
/** @brief The next word, consumed. */
token lexer_next(lexer *l);
/** @brief The next word, left where it is. */
token lexer_peek(lexer *l);

bool token_is(const token *t, const char *word); /**< a bare word, spelt so */
/** @brief A string with its escapes resolved; owned by the caller. */
char *token_string(const token *t);
/** @brief The word as an error message names it, "'Shape'"; owned by the caller. */
char *token_describe(const token *t);
