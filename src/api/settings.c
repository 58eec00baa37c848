#include "api/objects.h"

#include "base/json.h"
#include "settings/presets.h"

#include <pthread.h>

_Static_assert(NEPH_SETTING_BOOL == (int)SETTING_BOOL, "types are one list");
_Static_assert(NEPH_SETTING_COUNT == (int)SETTING_COUNT, "types are one list");
_Static_assert(NEPH_SETTING_REAL == (int)SETTING_REAL, "types are one list");
_Static_assert(NEPH_SETTING_CHOICE == (int)SETTING_CHOICE, "types are one list");

static NephSettingInfo *the_table;

static void export_table(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    NephSettingInfo *table = g_new(NephSettingInfo, n);
    for (size_t i = 0; i < n; i++)
        table[i] = (NephSettingInfo){.name = rows[i].name,
                                     .type = (NephSettingType)rows[i].type,
                                     .unit = rows[i].unit,
                                     .low = rows[i].low,
                                     .high = rows[i].high,
                                     .initial = rows[i].initial,
                                     .words = rows[i].words,
                                     .aliases = rows[i].aliases,
                                     .users = rows[i].users,
                                     .doc = rows[i].doc};
    the_table = table;
}

const NephSettingInfo *neph_settings_table(size_t *n)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    settings_table(n);
    pthread_once(&once, export_table);
    return the_table;
}

NephSettings *neph_settings_new(void)
{
    NephSettings *made = g_new(NephSettings, 1);
    made->values = settings_default();
    return made;
}

NephSettings *neph_settings_copy(const NephSettings *from)
{
    NephSettings *copy = g_new(NephSettings, 1);
    *copy = *from;
    return copy;
}

void neph_settings_free(NephSettings *s)
{
    g_free(s);
}

bool neph_settings_set(NephSettings *s, const char *name, const char *value,
                       GError **error)
{
    return settings_set(&s->values, name, value, error);
}

char *neph_settings_get(const NephSettings *s, const char *name)
{
    const setting_row *row = settings_find(name);
    return row ? settings_get(&s->values, row) : NULL;
}

bool neph_settings_reads(const NephSettings *s, const char *name)
{
    const setting_row *row = settings_find(name);
    return row && settings_reads(&s->values, row);
}

char **neph_settings_unread(const NephSettings *s, const NephSettings *given)
{
    return settings_unread(&s->values, &given->values);
}

bool neph_settings_load(NephSettings *s, const char *path, GError **error)
{
    return settings_load(&s->values, path, error);
}

char **neph_settings_presets(void)
{
    return settings_presets();
}

char *neph_settings_preset_text(const char *name, GError **error)
{
    return settings_preset_text(name, error);
}

bool neph_settings_load_preset(NephSettings *s, const char *name, GError **error)
{
    return settings_load_preset(&s->values, name, error);
}

static void describe_words_json(json *j, const setting_row *row)
{
    if (!row->words)
        return;
    json_array_begin(j, "words");
    for (size_t i = 0; row->words[i]; i++)
        json_string(j, NULL, row->words[i]);
    json_array_end(j);
}

static void describe_row_json(json *j, const setting_row *row, const char *initial)
{
    static const char *const types[] = {"bool", "count", "real", "choice"};
    json_object_begin(j, NULL);
    json_string(j, "name", row->name);
    json_string(j, "type", types[row->type]);
    json_string(j, "unit", row->unit);
    if (row->type == SETTING_COUNT) {
        json_integer(j, "low", (int64_t)row->low);
        json_integer(j, "high", (int64_t)row->high);
        json_integer(j, "default", (int64_t)row->initial);
        describe_words_json(j, row);
    } else if (row->type == SETTING_REAL) {
        json_number(j, "low", row->low);
        json_number(j, "high", row->high);
        json_number(j, "default", row->initial);
    } else if (row->type == SETTING_BOOL) {
        json_bool(j, "default", row->initial > 0.5);
    } else {
        json_string(j, "default", initial);
        describe_words_json(j, row);
    }
    json_string(j, "aliases", row->aliases);
    json_string(j, "users", row->users);
    json_string(j, "doc", row->doc);
    json_object_end(j);
}

static void describe_row(GString *out, const setting_row *row, const char *initial)
{
    g_string_append_printf(out, "%-20s = %s%s%s", row->name, initial,
                           *row->unit ? " " : "", row->unit);
    if (row->type == SETTING_CHOICE) {
        g_autofree char *words = g_strjoinv(" | ", (char **)row->words);
        g_string_append_printf(out, "   (%s)", words);
    } else if (row->type == SETTING_COUNT) {
        const char *apart = row->initial < row->low ? initial : "";
        g_string_append_printf(out, "   (%s%s%.0f .. %.0f)", apart, *apart ? " or " : "",
                               row->low, row->high);
    } else if (row->type == SETTING_REAL) {
        char low[G_ASCII_DTOSTR_BUF_SIZE], high[G_ASCII_DTOSTR_BUF_SIZE];
        g_string_append_printf(out, "   (%s .. %s)", number_text(row->low, low),
                               number_text(row->high, high));
    }
    g_string_append_printf(out, "\n    %s\n", row->doc);
    g_string_append_printf(out, "    Read by: %s.", row->users);
    if (*row->aliases)
        g_string_append_printf(out, " Also: %s.", row->aliases);
    g_string_append(out, "\n\n");
}

static char *table_as_json(const setting_row *rows, size_t n)
{
    const settings defaults = settings_default();
    json j = {0};
    json_array_begin(&j, NULL);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *initial = settings_get(&defaults, &rows[i]);
        describe_row_json(&j, &rows[i], initial);
    }
    json_array_end(&j);
    return json_finish(&j);
}

static char *table_as_text(const setting_row *rows, size_t n)
{
    const settings defaults = settings_default();
    GString *out = g_string_new(NULL);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *initial = settings_get(&defaults, &rows[i]);
        describe_row(out, &rows[i], initial);
    }
    return g_string_free(out, FALSE);
}

char *neph_settings_describe(bool as_json)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    return as_json ? table_as_json(rows, n) : table_as_text(rows, n);
}
