/*
 * Values of settings, and the one way in and out of them: text.
 *
 * Numbers are read and written independently of the locale, and what settings_get writes
 * settings_set reads back to the same value.
 */
#include "settings/settings.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/json.h"
#include "settings/settings_table.h"

#include <math.h>
#include <string.h>

enum { USUAL_PASSES = 16, USUAL_PHOTONS = 400000 };

static void store(settings *s, const setting_row *row, double value)
{
    void *field = (char *)s + row->offset;
    switch (row->type) {
    case SETTING_BOOL:
        *(bool *)field = value > 0.5;
        break;
    case SETTING_COUNT:
        *(int64_t *)field = (int64_t)value;
        break;
    case SETTING_REAL:
        *(double *)field = value;
        break;
    case SETTING_CHOICE:
        *(int *)field = (int)value;
        break;
    }
}

settings settings_default(void)
{
    settings s;
    size_t n;
    const setting_row *table = settings_table(&n);
    memset(&s, 0, sizeof s);
    for (size_t i = 0; i < n; i++)
        store(&s, &table[i], table[i].initial);
    return s;
}

bool settings_reads(const settings *s, const setting_row *row)
{
    const char *integrator = settings_find("integrator")->words[s->integrator];
    g_auto(GStrv) users = g_strsplit(row->users, " ", -1);
    return g_strv_contains((const char *const *)users, "all") ||
           g_strv_contains((const char *const *)users, integrator);
}

char *settings_unread_note(const settings *s, const setting_row *row)
{
    const char *integrator = settings_find("integrator")->words[s->integrator];
    if (settings_reads(s, row))
        return NULL;
    g_auto(GStrv) users = g_strsplit(row->users, " ", -1);
    g_autofree char *only = g_strjoinv(", ", users);
    return g_strdup_printf("%s is not read by %s, only by %s", row->name, integrator,
                           only);
}

GStrv settings_unread(const settings *s, const settings *given)
{
    g_autoptr(GStrvBuilder) builder = g_strv_builder_new();
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        bool was_given = given->given >> i & 1;
        g_autofree char *line = was_given ? settings_unread_note(s, &rows[i]) : NULL;
        if (line)
            g_strv_builder_add(builder, line);
    }
    return g_strv_builder_end(builder);
}

void settings_forget_unread(settings *s)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++)
        if (!settings_reads(s, &rows[i]))
            store(s, &rows[i], rows[i].initial);
}

double settings_most_passes(const settings *s)
{
    bool other_rule = s->time > 0.0 || s->noise > 0.0;
    return s->passes > 0.0 ? s->passes : other_rule ? MOST_PASSES : USUAL_PASSES;
}

double settings_planned_passes(const settings *s)
{
    return s->planned_passes > 0.0 ? s->planned_passes
           : s->passes > 0.0       ? s->passes
                                   : USUAL_PASSES;
}

bool settings_takes_noise_out(const settings *s, double passes)
{
    return s->denoise &&
           (passes >= 2.0 || (passes >= 0.5 && s->spp <= MOST_LENT_SAMPLES));
}

bool settings_filters_together(const settings *s)
{
    return s->denoise && settings_planned_passes(s) * (double)s->spp < SAMPLES_APART;
}

bool settings_one_map(const settings *s)
{
    return s->one_map && !s->final_gather;
}

int64_t settings_photons(const settings *s)
{
    return s->photons > 0 ? s->photons : USUAL_PHOTONS;
}

/** pbrt's name, which sets two settings at once. */
static bool is_depth(const char *name)
{
    return g_ascii_strcasecmp(name, "maxdepth") == 0;
}

/* A name that is given to a row with numbers of its own. */
typedef struct counted_name {
    const char *name;
    double least, shift; /* ours is as much more */
    const char *why;     /* what is below the least */
    bool once;           /* the number is of the render, which has one pass */
    bool per_light;
} counted_name;

static const counted_name *find_counted(const char *name)
{
    static const char none[] = "; with 0 no photon would be stored";
    static const counted_name names[] = {
        {"maxForwardBounces", 1, -1, none, false, false},
        {"maxBackwardBounces", 0, 1, "", false, false},
        {"numEmitted", 1, 0, none, true, false},
        {"DIRECT_PHOTONS_PER_LIGHT", 1, 0, none, true, true},
        {"INDIRECT_PHOTONS_PER_LIGHT", 1, 0, none, true, true},
        {"CAUSTIC_PHOTONS_PER_LIGHT", 1, 0, none, true, true},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (g_ascii_strcasecmp(names[i].name, name) == 0)
            return &names[i];
    return NULL;
}

static bool is_render_mode(const char *name)
{
    return g_ascii_strcasecmp(name, "RENDERMODE") == 0;
}

/** Owned by the caller. */
static char *count_text(const setting_row *row, int64_t value)
{
    if (row->words && (double)value < row->low)
        return g_strdup(row->words[0]);
    return g_strdup_printf("%" G_GINT64_FORMAT, value);
}

/** What the row accepts, in words; owned by the caller. */
static char *expected(const setting_row *row, const char *name)
{
    if (row->type == SETTING_BOOL)
        return g_strdup("true or false");
    if (is_render_mode(name))
        return g_strdup("PHOTONMAP or MONTECARLO");
    if (row->type == SETTING_CHOICE) {
        g_autofree char *words = g_strjoinv(", ", (char **)row->words);
        return g_strdup_printf("one of %s", words);
    }
    const counted_name *counted = find_counted(name);
    g_autofree char *apart = count_text(row, (int64_t)row->initial);
    bool stands = row->initial < row->low && !is_depth(name);
    double shift = counted ? counted->shift : 0.0;
    return g_strdup_printf("%s%s%s from %.16g to %.16g%s%s%s", stands ? apart : "",
                           stands ? " or " : "",
                           row->type == SETTING_COUNT ? "a whole number" : "a number",
                           counted ? counted->least : row->low, row->high - shift,
                           *row->unit ? " " : "", row->unit, counted ? counted->why : "");
}

static bool read_bool(const char *text, double *out)
{
    static const char *const words[] = {"false", "true", "off", "on",
                                        "no",    "yes",  "0",   "1"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (g_ascii_strcasecmp(words[i], text) == 0) {
            *out = i % 2 ? 1.0 : 0.0;
            return true;
        }
    return false;
}

static bool read_choice(const char *const *words, const char *text, double *out)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], text) == 0) {
            *out = i;
            return true;
        }
    return false;
}

/** The name of what stands apart from numbers. */
static bool read_apart(const setting_row *row, const char *text, double *out)
{
    *out = row->initial;
    return row->words && strcmp(row->words[0], text) == 0;
}

/** Decimal numbers only: no hexadecimal, infinity or nan. */
static bool read_number(const char *text, double *out)
{
    if (!*text || strspn(text, "+-.0123456789eE") != strlen(text))
        return false;
    char *end = NULL;
    *out = g_ascii_strtod(text, &end);
    return end != text && !*end && isfinite(*out);
}

static bool is_in_range(const setting_row *row, double x)
{
    bool is_none = row->initial < row->low && fabs(x - row->initial) <= 0.0;
    return (x >= row->low && x <= row->high) || is_none;
}

/** The row's unit may stand behind a number, as in "30s" or "0.5 m". */
static bool read_quantity(const setting_row *row, const char *text, double *out)
{
    g_autofree char *number = g_strdup(text);
    if (*row->unit && g_str_has_suffix(number, row->unit)) {
        number[strlen(number) - strlen(row->unit)] = '\0';
        g_strchomp(number);
    }
    return read_number(number, out);
}

static bool is_whole(double x)
{
    return fabs(x - rint(x)) <= 0.0;
}

static bool read_value(const setting_row *row, const char *text, double *out)
{
    switch (row->type) {
    case SETTING_BOOL:
        return read_bool(text, out);
    case SETTING_CHOICE:
        return read_choice(row->words, text, out);
    case SETTING_COUNT:
        return read_apart(row, text, out) || (read_quantity(row, text, out) &&
                                              is_whole(*out) && is_in_range(row, *out));
    case SETTING_REAL:
        return read_quantity(row, text, out) && is_in_range(row, *out);
    }
    return false;
}

/** The class whose cone kernel an alias sets, or -1. */
static int class_of_cone_alias(const setting_row *row, const char *name)
{
    for (int c = 0; c < N_CLASSES; c++)
        if (row->offset == offsetof(settings, class_cone_k) + (size_t)c * sizeof(double))
            return strcmp(row->name, name) == 0 ? -1 : c;
    return -1;
}

/** pbrt's maxdepth d: a path of d bounces, so d seen specularly, and d - 1 of a photon
 * before the one the camera sees. */
static bool set_depth(settings *s, const char *text)
{
    const setting_row *row = settings_find("max_backward_bounces");
    double depth;
    if (!read_value(row, text, &depth) || depth < 0.0)
        return false;
    s->max_backward_bounces = (int64_t)depth;
    s->max_forward_bounces = MAX(s->max_backward_bounces - 1, 0);
    return true;
}

/** Stochastic progressive photon mapping (Hachisuka & Jensen 2009) is photon mapping with
 * certain settings. */
static void set_sppm(settings *s)
{
    s->integrator = INTEGRATOR_PHOTONMAP;
    s->spp = 1;
    s->final_gather = false;
    s->alpha = 2.0 / 3.0;
    for (int c = 0; c < N_CLASSES; c++)
        s->class_nearest[c] = 0;
}

static bool set_render_mode(settings *s, const char *text)
{
    bool maps = g_ascii_strcasecmp(text, "PHOTONMAP") == 0;
    if (!maps && g_ascii_strcasecmp(text, "MONTECARLO") != 0)
        return false;
    s->integrator = maps ? INTEGRATOR_PHOTONMAP : INTEGRATOR_PATH;
    return true;
}

static bool set_counted(settings *s, const setting_row *row, const counted_name *name,
                        const char *text)
{
    double n, none = row->initial;
    bool stands_apart = read_apart(row, text, &n);
    if (!stands_apart && (!read_quantity(row, text, &n) || !is_whole(n)))
        return false;
    stands_apart |= row->words && fabs(n - none) <= 0.0;
    if (!stands_apart && (n < name->least || n + name->shift > row->high))
        return false;
    store(s, row, stands_apart ? none : n + name->shift);
    if (name->once)
        s->passes = 1;
    if (name->per_light)
        s->photons_per_light = true;
    return true;
}

static bool set_row(settings *s, const setting_row *row, const char *name,
                    const char *text)
{
    double number;
    if (row->offset == offsetof(settings, integrator) && strcmp(text, "sppm") == 0) {
        set_sppm(s);
        return true;
    }
    if (is_depth(name))
        return set_depth(s, text);
    if (is_render_mode(name))
        return set_render_mode(s, text);
    const counted_name *counted = find_counted(name);
    if (counted)
        return set_counted(s, row, counted, text);
    int cone = class_of_cone_alias(row, name);
    if (cone >= 0 && read_number(text, &number) && number < 1.0) {
        s->class_kernel[cone] = KERNEL_CONSTANT;
        return true;
    }
    if (!read_value(row, text, &number))
        return false;
    store(s, row, number);
    if (cone >= 0)
        s->class_kernel[cone] = KERNEL_CONE;
    return true;
}

static void refuse_name(const char *name, GError **error)
{
    const char *nearest = settings_nearest_name(name);
    if (nearest)
        error_set(error, ERROR_USAGE,
                  "expected a setting's name, found '%s'; did you mean '%s'?", name,
                  nearest);
    else
        error_set(error, ERROR_USAGE, "expected a setting's name, found '%s'", name);
}

bool settings_set(settings *s, const char *name, const char *value, GError **error)
{
    const setting_row *row = settings_find(name);
    if (!row) {
        refuse_name(name, error);
        return false;
    }
    g_autofree char *text = g_strstrip(g_strdup(value));
    if (set_row(s, row, name, text)) {
        size_t n;
        s->given |= (uint64_t)1 << (row - settings_table(&n));
        return true;
    }
    g_autofree char *words = expected(row, name);
    error_set(error, ERROR_USAGE, "setting '%s': expected %s, found '%s'", name, words,
              text);
    return false;
}

char *settings_get(const settings *s, const setting_row *row)
{
    const void *field = (const char *)s + row->offset;
    switch (row->type) {
    case SETTING_BOOL:
        return g_strdup(*(const bool *)field ? "true" : "false");
    case SETTING_COUNT:
        return count_text(row, *(const int64_t *)field);
    case SETTING_CHOICE:
        return g_strdup(row->words[*(const int *)field]);
    case SETTING_REAL:
        break;
    }
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(number_text(*(const double *)field, text));
}

/** One line of a settings file, without its newline; blank ones are fine. */
static bool load_line(settings *s, char *line, source_place place, GError **error)
{
    line[strcspn(line, "#\r")] = '\0';
    size_t begin = strspn(line, " \t");
    if (!line[begin])
        return true;
    place.column = (int)begin + 1;
    size_t equals = strcspn(line, "=");
    if (!line[equals]) {
        error_at(error, place, "expected name = value, found no '='");
        return false;
    }
    line[equals] = '\0';
    char *name = g_strstrip(line + begin);
    if (settings_find(name)) {
        const char *value = line + equals + 1;
        place.column = (int)(equals + 1 + strspn(value, " \t")) + 1;
    }
    g_autoptr(GError) inner = NULL;
    if (settings_set(s, name, line + equals + 1, &inner))
        return true;
    error_at(error, place, "%s", inner->message);
    return false;
}

static bool load_lines(settings *s, char *text, source_place place, GError **error)
{
    settings loaded = *s;
    char *line = text;
    while (line) {
        char *next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        place.line++;
        if (!load_line(&loaded, line, place, error))
            return false;
        line = next;
    }
    *s = loaded;
    return true;
}

bool settings_load(settings *s, const char *path, GError **error)
{
    g_autoptr(GError) inner = NULL;
    source_place place = {intern(path), 0, 0};
    input in;
    if (!input_read(&in, path, &inner)) {
        error_at(error, place, "cannot read settings: %s", inner->message);
        return false;
    }
    bool done = load_lines(s, in.data, place, error);
    input_close(&in);
    return done;
}
