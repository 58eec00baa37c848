/*
 * What all parts of the reader tell: errors into the list, warnings, and what was
 * expected where a word is wrong.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/memory.h"

void pbrt_report(pbrt_parser *parser, GError *error)
{
    bool ends = g_error_matches(error, NEPH_ERROR, ERROR_FAILED) ||
                g_error_matches(error, NEPH_ERROR, ERROR_CANCELLED);
    if (!ends || parser->fatal) {
        g_ptr_array_add(parser->errors, g_strdup(error->message));
        g_error_free(error);
        return;
    }
    parser->fatal = error;
}

bool pbrt_has_room(pbrt_parser *parser, source_place place, size_t bytes,
                   const char *what)
{
    GError *error = NULL;
    if (memory_ask(bytes, what, &error))
        return true;
    GError *placed = NULL;
    error_move_at(&placed, place, error);
    pbrt_report(parser, placed);
    return false;
}

void pbrt_error(pbrt_parser *parser, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    GError *error = NULL;
    error_at(&error, place, "%s", text);
    pbrt_report(parser, error);
}

void pbrt_warning(const pbrt_parser *parser, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    log_at(&parser->builder->build.log, LOG_WARNING, place, "%s", text);
}

bool pbrt_expected(pbrt_parser *parser, const char *what, const token *found)
{
    g_autofree char *text = token_describe(found);
    pbrt_error(parser, found->place, "expected %s, found %s", what, text);
    return false;
}

bool pbrt_should_stop(const pbrt_parser *parser)
{
    return parser->fatal || parser->errors->len >= MAX_ERRORS;
}

char *pbrt_read_string(pbrt_parser *parser, const char *what, source_place *place)
{
    token t = lexer_peek(parser->words);
    if (t.kind != TOKEN_STRING) {
        g_autofree char *quoted = g_strdup_printf("%s in quotes", what);
        pbrt_expected(parser, quoted, &t);
        return NULL;
    }
    lexer_next(parser->words);
    if (place)
        *place = t.place;
    return token_string(&t);
}
