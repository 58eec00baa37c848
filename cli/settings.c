/*
 * nephroid settings: the table of settings, for people, programs or the manual.
 */
#include "arguments.h"
#include "command.h"
#include "message.h"

#include <string.h>

static gboolean as_json, as_markdown, all_presets;
static char *preset;

static const GOptionEntry entries[] = {
    {"json", 0, 0, G_OPTION_ARG_NONE, &as_json, "For programs", NULL},
    {"markdown", 0, 0, G_OPTION_ARG_NONE, &as_markdown, "As a table of a manual", NULL},
    {"presets", 0, 0, G_OPTION_ARG_NONE, &all_presets,
     "List the presets: settings as a text on photon mapping describes them", NULL},
    {"preset", 0, 0, G_OPTION_ARG_STRING, &preset, "Print a preset's settings", "NAME"},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "settings",
    .summary = "Lists all settings with their defaults and ranges. They are given in a "
               "scene's Integrator\ndirective, in a settings file, or with --set.",
    .entries = entries};

/* What the row accepts; a bar must not end the table's cell. */
static char *range_text(const NephSettingInfo *row, const char *initial)
{
    if (row->type == NEPH_SETTING_BOOL)
        return g_strdup("true, false");
    if (row->type == NEPH_SETTING_CHOICE)
        return g_strjoinv(", ", (char **)row->words);
    const char *apart = row->initial < row->low ? initial : "";
    if (row->type == NEPH_SETTING_COUNT)
        return g_strdup_printf("%s%s%.0f … %.0f", apart, *apart ? ", " : "", row->low,
                               row->high);
    return g_strdup_printf("%.10g … %.10g", row->low, row->high);
}

static char *markdown(void)
{
    GString *out = g_string_new("| name | default | unit | range | also | read by | |\n"
                                "|---|---|---|---|---|---|---|\n");
    g_autoptr(NephSettings) defaults = neph_settings_new();
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *initial = neph_settings_get(defaults, rows[i].name);
        g_autofree char *range = range_text(&rows[i], initial);
        g_string_append_printf(out, "| `%s` | %s | %s | %s | %s | %s | %s |\n",
                               rows[i].name, initial, rows[i].unit, range,
                               rows[i].aliases, rows[i].users, rows[i].doc);
    }
    return g_string_free(out, FALSE);
}

/* A line a preset: its name, and what it follows. */
static int list_presets(void)
{
    g_auto(GStrv) names = neph_settings_presets();
    g_autoptr(GString) out = g_string_new(NULL);
    for (char **name = names; *name; name++) {
        g_autofree char *text = neph_settings_preset_text(*name, NULL);
        g_autofree char *first = g_strndup(text, text ? strcspn(text, "\n") : 0);
        g_string_append_printf(out, "%s  %s\n", *name, first + strspn(first, "# "));
    }
    return print_result("%s", out->str);
}

static int print_preset(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *text = neph_settings_preset_text(preset, &error);
    return text ? print_result("%s", text) : report_error(error);
}

int command_settings(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    if (as_json && as_markdown)
        return usage_error("--json and --markdown exclude each other");
    if (all_presets)
        return list_presets();
    if (preset)
        return print_preset();
    g_autofree char *text = as_markdown ? markdown() : neph_settings_describe(as_json);
    return print_result("%s", text);
}
