#include "params/kinds.h"

#include <string.h>

int kind_find(kind_name name_of, const char *what, const char *name, source_place place,
              GError **error)
{
    for (int i = 0; name_of((size_t)i); i++)
        if (strcmp(name_of((size_t)i), name) == 0)
            return i;
    kind_unknown(name_of, what, name, place, error);
    return -1;
}

void kind_unknown(kind_name name_of, const char *what, const char *name,
                  source_place place, GError **error)
{
    g_autoptr(GString) known = g_string_new(NULL);
    const char *last = "";
    for (size_t i = 0; name_of(i); i++) {
        if (!*name_of(i) || strcmp(name_of(i), last) == 0)
            continue;
        last = name_of(i);
        g_string_append_printf(known, "%s%s", known->len ? ", " : "", last);
    }
    error_at(error, place, "expected %s of kind %s, found '%s'", what, known->str, name);
}
