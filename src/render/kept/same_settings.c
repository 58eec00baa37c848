#include "render/kept/same_settings.h"

#include <glib.h>
#include <string.h>

bool same_settings(const settings_question *question, const char *what, GError **error)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *a = settings_get(question->now, &rows[i]);
        g_autofree char *b = settings_get(question->then, &rows[i]);
        if (g_strv_contains(question->free_rows, rows[i].name) || strcmp(a, b) == 0)
            continue;
        error_set(error, ERROR_INPUT, "%s: %s with %s = %s, not %s", question->path, what,
                  rows[i].name, b, a);
        return false;
    }
    return true;
}

void take_settings_of(settings *to, const settings *from, const char *const *rows)
{
    const uint64_t given = to->given;
    for (; *rows; rows++) {
        g_autofree char *value = settings_get(from, settings_find(*rows));
        settings_set(to, *rows, value, NULL);
    }
    to->given = given;
}
