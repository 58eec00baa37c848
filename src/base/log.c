#include "base/log.h"

#include "base/printable.h"

void log_message(const log_sink *sink, log_level level, const char *format, ...)
{
    if (!sink || !sink->write)
        return;
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *shown = printable(text);
    sink->write(level, shown, sink->data);
}

void log_at(const log_sink *sink, log_level level, source_place place, const char *format,
            ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *at = source_place_text(place);
    log_message(sink, level, "%s%s", at, text);
}
