/*
 * What a scene's settings are, where they are not the defaults.
 */
#include "api/describe/describe.h"

#include <string.h>

void visit_changed_settings(const settings *s, setting_visitor visit, void *data)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    const settings defaults = settings_default();
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(s, &rows[i]);
        g_autofree char *initial = settings_get(&defaults, &rows[i]);
        if (strcmp(value, initial) != 0)
            visit(&rows[i], value, data);
    }
}
