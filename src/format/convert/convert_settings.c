#include "format/convert/convert_settings.h"

#include <string.h>

void convert_append_settings(GString *out, const settings *s)
{
    static const char *const types[] = {
        [SETTING_BOOL] = "bool", [SETTING_COUNT] = "integer", [SETTING_REAL] = "float"};
    size_t n;
    const setting_row *rows = settings_table(&n);
    const settings defaults = settings_default();
    g_string_append(out, "Integrator \"auto\"");
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(s, &rows[i]);
        g_autofree char *initial = settings_get(&defaults, &rows[i]);
        bool word = rows[i].words && g_strv_contains(rows[i].words, value);
        const char *quote = word ? "\"" : "";
        if (strcmp(value, initial) != 0)
            g_string_append_printf(out, " \"%s %s\" %s%s%s",
                                   word ? "string" : types[rows[i].type], rows[i].name,
                                   quote, value, quote);
    }
    g_string_append_c(out, '\n');
}

void convert_append_switches(GString *out, const scene_switches *on)
{
    if (on->fixed_pixels)
        g_string_append(out, "Option \"bool disablepixeljitter\" true\n");
    if (on->fixed_wavelengths)
        g_string_append(out, "Option \"bool disablewavelengthjitter\" true\n");
    if (on->sharp_textures)
        g_string_append(out, "Option \"bool disabletexturefiltering\" true\n");
}
