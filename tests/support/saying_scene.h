/*
 * Scenes of texts, with all that is said of them.
 */
#pragma once

#include "render_with.h"

#include <string.h>

static inline void keep_line(log_level level, const char *text, void *data)
{
    g_string_append_printf(data, "%s%s\n", level == LOG_WARNING ? "warning" : "note",
                           strchr(text, ':'));
}

/* The scene of a text that must be right, and what must be said of it: all lines, each
 * "note:line:column: text" or "warning:..". */
static inline view *read_saying(const char *text, const char *said)
{
    scene_folder f = folder_new(text);
    g_autoptr(GString) lines = g_string_new(NULL);
    g_autoptr(GError) error = NULL;
    const log_sink sink = {keep_line, lines};
    view *v = load_view(f.main, &sink, &error);
    if (!v)
        g_error("%s\nof\n%s", error->message, text);
    if (strcmp(lines->str, said) != 0)
        g_error("of\n%s\nexpected\n%s\nfound\n%s", text, said, lines->str);
    folder_remove(&f);
    return v;
}
