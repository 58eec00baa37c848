#include "base/error.h"

GQuark error_quark(void)
{
    return g_quark_from_static_string("nephroid-error");
}

char *source_place_text(source_place place)
{
    if (!place.file)
        return g_strdup("");
    return place.line == 0
               ? g_strdup_printf("%s: ", place.file)
               : g_strdup_printf("%s:%d:%d: ", place.file, place.line, place.column);
}

static void set_at(GError **error, int code, source_place place, const char *text)
{
    g_autofree char *at = source_place_text(place);
    g_set_error(error, NEPH_ERROR, code, "%s%s", at, text);
}

void error_at(GError **error, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    set_at(error, ERROR_INPUT, place, text);
}

void error_move_at(GError **error, source_place place, GError *inner)
{
    set_at(error, inner->code, place, inner->message);
    g_error_free(inner);
}

void error_set(GError **error, error_code code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_set_error_literal(error, NEPH_ERROR, code, text);
}
