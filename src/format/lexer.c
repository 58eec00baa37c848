/*
 * The words of a pbrt file.
 */
#include "format/lexer.h"

#include "base/intern.h"

#include <string.h>

lexer lexer_new(const char *file, const char *data, size_t size)
{
    lexer l = {.file = intern(file),
               .at = data,
               .end = data + size,
               .line_start = data,
               .line = 1};
    if (size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0)
        l.at = l.line_start = data + 3;
    return l;
}

static void skip_blank(lexer *l)
{
    for (; l->at < l->end; l->at++) {
        char c = *l->at;
        if (c == '\n') {
            l->line++;
            l->line_start = l->at + 1;
        } else if (c == '#') {
            const char *newline = memchr(l->at, '\n', (size_t)(l->end - l->at));
            l->at = (newline ? newline : l->end) - 1;
        } else if (c != ' ' && c != '\t' && c != '\r') {
            return;
        }
    }
}

static void scan_string(lexer *l, token *t)
{
    t->text = ++l->at;
    t->kind = TOKEN_UNTERMINATED;
    while (l->at < l->end && *l->at != '"' && *l->at != '\n') {
        bool escapes = *l->at == '\\' && l->at + 1 < l->end && l->at[1] != '\n';
        l->at += escapes ? 2 : 1;
    }
    t->length = (size_t)(l->at - t->text);
    if (l->at < l->end && *l->at == '"') {
        t->kind = TOKEN_STRING;
        l->at++;
    }
}

static bool ends_word(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '"' || c == '[' ||
           c == ']';
}

static token scan(lexer *l)
{
    skip_blank(l);
    token t = {.kind = TOKEN_END, .text = l->at};
    t.place = (source_place){l->file, l->line, (int)(l->at - l->line_start) + 1};
    if (l->at >= l->end)
        return t;
    if (*l->at == '"') {
        scan_string(l, &t);
        return t;
    }
    if (*l->at == '[' || *l->at == ']') {
        t.kind = *l->at == '[' ? TOKEN_LEFT : TOKEN_RIGHT;
        l->at++;
    } else {
        t.kind = TOKEN_WORD;
        while (l->at < l->end && !ends_word(*l->at))
            l->at++;
    }
    t.length = (size_t)(l->at - t.text);
    return t;
}

token lexer_next(lexer *l)
{
    if (!l->has_ahead)
        return scan(l);
    l->has_ahead = false;
    return l->ahead;
}

token lexer_peek(lexer *l)
{
    if (!l->has_ahead)
        l->ahead = scan(l);
    l->has_ahead = true;
    return l->ahead;
}

bool token_is(const token *t, const char *word)
{
    return t->kind == TOKEN_WORD && strlen(word) == t->length &&
           memcmp(word, t->text, t->length) == 0;
}

char *token_string(const token *t)
{
    char *out = g_strndup(t->text, t->length);
    char *to = out;
    for (const char *from = out; *from; from++) {
        static const char names[] = "bfnrt", meant[] = "\b\f\n\r\t";
        if (*from != '\\' || !from[1]) {
            *to++ = *from;
            continue;
        }
        const char *name = strchr(names, *++from);
        *to++ = name ? meant[name - names] : *from;
    }
    *to = '\0';
    return out;
}

char *token_describe(const token *t)
{
    enum { LONGEST = 60 };
    if (t->kind == TOKEN_END)
        return g_strdup("the end of the file");
    if (t->kind == TOKEN_UNTERMINATED)
        return g_strdup("a string without its closing quote");
    g_autofree char *valid =
        g_utf8_make_valid(t->text, (gssize)MIN(t->length, (size_t)LONGEST));
    const char *more = t->length > LONGEST ? "..." : "";
    return t->kind == TOKEN_STRING ? g_strdup_printf("\"%s%s\"", valid, more)
                                   : g_strdup_printf("'%s%s'", valid, more);
}
