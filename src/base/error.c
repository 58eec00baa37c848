#include "base/error.h"

#include "base/printable.h"

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

static void set(GError **error, int code, const char *before, const char *text)
{
    g_autofree char *whole = g_strconcat(before, text, NULL), *shown = printable(whole);
    g_set_error_literal(error, NEPH_ERROR, code, shown);
}

void error_at(GError **error, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *at = source_place_text(place);
    set(error, ERROR_INPUT, at, text);
}

void error_move_at(GError **error, source_place place, GError *inner)
{
    g_autofree char *at = source_place_text(place);
    set(error, inner->code, at, inner->message);
    g_error_free(inner);
}

void error_set(GError **error, error_code code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    set(error, code, "", text);
}

void error_set_lines(GError **error, const GPtrArray *messages)
{
    g_autoptr(GString) all = g_string_new(NULL);
    for (guint i = 0; i < messages->len; i++) {
        g_autofree char *shown = printable(messages->pdata[i]);
        g_string_append_printf(all, "%s%s", i ? "\n" : "", shown);
    }
    g_set_error_literal(error, NEPH_ERROR, ERROR_INPUT, all->str);
}
