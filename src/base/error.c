#include "base/error.h"

GQuark error_quark(void)
{
    return g_quark_from_static_string("nephroid-error");
}

void error_at(GError **error, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (!place.file)
        g_set_error(error, NEPH_ERROR, ERROR_INPUT, "%s", text);
    else if (place.line == 0)
        g_set_error(error, NEPH_ERROR, ERROR_INPUT, "%s: %s", place.file, text);
    else
        g_set_error(error, NEPH_ERROR, ERROR_INPUT, "%s:%d:%d: %s", place.file,
                    place.line, place.column, text);
}

void error_set(GError **error, error_code code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_set_error_literal(error, NEPH_ERROR, code, text);
}
