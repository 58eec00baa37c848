#include "base/printable.h"

#include <glib.h>
#include <stdbool.h>
#include <string.h>

/* Joiners stand within words of some scripts. */
static bool is_seen(gunichar c)
{
    enum { NON_JOINER = 0x200c, JOINER = 0x200d, LAST_OF_FIRST_PLANE = 0xffff };
    switch (g_unichar_type(c)) {
    case G_UNICODE_CONTROL:
    case G_UNICODE_LINE_SEPARATOR:
    case G_UNICODE_PARAGRAPH_SEPARATOR:
        return false;
    case G_UNICODE_FORMAT:
        return c == NON_JOINER || c == JOINER || c > LAST_OF_FIRST_PLANE;
    default:
        return true;
    }
}

static void put_escaped(GString *out, gunichar c)
{
    if (c == '\n')
        g_string_append(out, "\\n");
    else if (c == '\t')
        g_string_append(out, "\\t");
    else
        g_string_append_printf(out, c < 0x80 ? "\\x%02x" : "\\u%04x", c);
}

char *printable(const char *text)
{
    GString *out = g_string_new(NULL);
    const char *end = text + strlen(text);
    while (text < end) {
        gunichar c = g_utf8_get_char_validated(text, end - text);
        if (c == (gunichar)-1 || c == (gunichar)-2) {
            g_string_append_printf(out, "\\x%02x", (unsigned char)*text++);
            continue;
        }
        if (is_seen(c))
            g_string_append_unichar(out, c);
        else
            put_escaped(out, c);
        text = g_utf8_next_char(text);
    }
    return g_string_free(out, FALSE);
}
