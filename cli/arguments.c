#include "arguments.h"

#include "command.h"
#include "loading.h"
#include "message.h"

#include <math.h>
#include <string.h>

static gboolean wants_help, wants_version;
static char *memory;

static const GOptionEntry common_entries[] = {
    {"memory", 0, 0, G_OPTION_ARG_STRING, &memory,
     "Take at most so much memory, as 2G or 500M; if not given, 80 % of what there is",
     "SIZE"},
    {"help", 'h', 0, G_OPTION_ARG_NONE, &wants_help, "Show this help", NULL},
    {"version", 'V', 0, G_OPTION_ARG_NONE, &wants_version, "Show the version", NULL},
    G_OPTION_ENTRY_NULL};

/* In help, FORMATS are those that pictures are written in. */
static const char *with_formats(const char *text, void *data)
{
    (void)data;
    static const char word[] = "FORMATS";
    const char *at = strstr(text, word);
    if (!at)
        return text;
    g_autofree char *formats = g_strjoinv(", ", (char **)neph_image_written_extensions());
    g_autofree char *whole =
        g_strdup_printf("%.*s%s%s", (int)(at - text), text, formats, at + strlen(word));
    return g_intern_string(whole);
}

static GOptionContext *context_new(const usage *how)
{
    GOptionContext *context = g_option_context_new(how->operands);
    g_option_context_set_help_enabled(context, FALSE);
    g_option_context_set_summary(context, how->summary);
    if (how->description)
        g_option_context_set_description(context, how->description);
    g_option_context_add_main_entries(context, how->entries, NULL);
    if (how->loads_scene)
        g_option_context_add_main_entries(context, loading_entries, NULL);
    g_option_context_add_main_entries(context, common_entries, NULL);
    g_option_group_set_translate_func(g_option_context_get_main_group(context),
                                      with_formats, NULL, NULL);
    return context;
}

/* ---- "-j4" ---- */

/* Of a command line's option, by its letter or its name; NULL: there is none. */
static const GOptionEntry *find_option(const usage *how, char letter, const char *name)
{
    const GOptionEntry *const lists[] = {
        how->entries, how->loads_scene ? loading_entries : common_entries,
        common_entries};
    for (size_t i = 0; i < G_N_ELEMENTS(lists); i++)
        for (const GOptionEntry *e = lists[i]; e->long_name; e++)
            if (name ? strcmp(e->long_name, name) == 0 : e->short_name == letter)
                return e;
    return NULL;
}

static bool takes_value(const GOptionEntry *e)
{
    return e && e->arg != G_OPTION_ARG_NONE;
}

/* Where in "-qj4" the value of the last option begins; 0: there is none in it. */
static size_t value_in(const usage *how, const char *argument)
{
    for (size_t i = 1; argument[i]; i++) {
        const GOptionEntry *e = find_option(how, argument[i], NULL);
        if (!e || takes_value(e))
            return e && argument[i + 1] ? i + 1 : 0;
    }
    return 0;
}

/* Whether the next argument is the value of this one. */
static bool awaits_value(const usage *how, const char *argument)
{
    size_t length = strlen(argument);
    if (g_str_has_prefix(argument, "--"))
        return takes_value(find_option(how, 0, argument + 2));
    return argument[0] == '-' && length > 1 &&
           takes_value(find_option(how, argument[length - 1], NULL));
}

/* Stay as long as the program runs, as those of main do, and are found by who looks for
   what is lost: parsing takes letters out of the list. */
static struct {
    GPtrArray *letters;
    char **list;
} detached;

static char *detach_letters(const char *argument, size_t length)
{
    char *letters = g_strndup(argument, length);
    if (!detached.letters)
        detached.letters = g_ptr_array_new();
    g_ptr_array_add(detached.letters, letters);
    return letters;
}

/* GLib wants a blank between a letter and its value. */
static void detach_values(const usage *how, int *argc, char ***argv)
{
    GPtrArray *apart = g_ptr_array_new();
    bool options = true, is_value = false;
    for (int i = 0; i < *argc; i++) {
        char *argument = (*argv)[i];
        options &= is_value || strcmp(argument, "--") != 0;
        bool may =
            i > 0 && options && !is_value && argument[0] == '-' && argument[1] != '-';
        size_t at = may ? value_in(how, argument) : 0;
        g_ptr_array_add(apart, at ? detach_letters(argument, at) : argument);
        if (at)
            g_ptr_array_add(apart, argument + at);
        is_value = options && !is_value && !at && i > 0 && awaits_value(how, argument);
    }
    *argc = (int)apart->len;
    g_ptr_array_add(apart, NULL);
    detached.list = (char **)g_ptr_array_free(apart, FALSE);
    *argv = detached.list;
}

/* GLib leaves "--" in place when an operand follows that begins with a dash. */
static void drop_separator(int *argc, char **argv)
{
    for (int i = 1; i < *argc; i++)
        if (strcmp(argv[i], "--") == 0) {
            memmove(argv + i, argv + i + 1, (size_t)(*argc - i) * sizeof *argv);
            (*argc)--;
            return;
        }
}

static int check_operands(const usage *how, int n, char **operands)
{
    if (n < how->n_operands)
        return usage_error("expected %s, found %s", how->operands,
                           n ? "too little" : "nothing");
    if (n > how->n_operands && !how->or_more)
        return usage_error("unexpected argument '%s'", operands[how->n_operands]);
    return EXIT_DONE;
}

bool arguments_parse(const usage *how, int *argc, char ***argv, int *exit_code)
{
    g_autofree char *name = g_strdup_printf("nephroid %s", how->name);
    g_set_prgname(name);
    g_autoptr(GOptionContext) context = context_new(how);
    g_autoptr(GError) error = NULL;
    detach_values(how, argc, argv);
    if (!g_option_context_parse(context, argc, argv, &error)) {
        *exit_code = report_error(error);
        return false;
    }
    if (memory && !neph_memory_set_limit(memory, &error)) {
        g_prefix_error(&error, "--");
        *exit_code = report_error(error);
        return false;
    }
    if (wants_help) {
        g_autofree char *help = g_option_context_get_help(context, TRUE, NULL);
        *exit_code = print_result("%s", help);
        return false;
    }
    if (wants_version) {
        *exit_code = print_result("nephroid %s\n", neph_version());
        return false;
    }
    drop_separator(argc, *argv);
    *exit_code = check_operands(how, *argc - 1, *argv + 1);
    return *exit_code == EXIT_DONE;
}

static bool refuse(const char *option, const char *expected, const char *text,
                   GError **error)
{
    g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE, "%s: expected %s, found '%s'",
                option, expected, text);
    return false;
}

bool argument_real(const char *option, const char *text, double *out, GError **error)
{
    char *end = NULL;
    *out = g_ascii_strtod(text, &end);
    bool is_decimal = *text && strspn(text, "+-.0123456789eE") == strlen(text);
    if (is_decimal && !*end && isfinite(*out))
        return true;
    return refuse(option, "a number", text, error);
}

bool argument_between(const char *option, const char *text, double low, double high,
                      double *out, GError **error)
{
    if (argument_real(option, text, out, NULL) && *out >= low && *out <= high)
        return true;
    g_autofree char *expected = g_strdup_printf("a number from %g to %g", low, high);
    return refuse(option, expected, text, error);
}

bool argument_count(const char *option, const char *text, guint64 low, guint64 high,
                    guint64 *out, GError **error)
{
    if (g_ascii_string_to_unsigned(text, 10, low, high, out, NULL))
        return true;
    g_autofree char *expected = g_strdup_printf(
        "a whole number from %" G_GUINT64_FORMAT " to %" G_GUINT64_FORMAT, low, high);
    return refuse(option, expected, text, error);
}

bool argument_size(const char *option, const char *text, int *width, int *height,
                   GError **error)
{
    guint64 w, h;
    g_auto(GStrv) sides = g_strsplit(text, "x", 2);
    if (g_strv_length(sides) != 2 ||
        !argument_count(option, sides[0], 1, 65536, &w, NULL) ||
        !argument_count(option, sides[1], 1, 65536, &h, NULL))
        return refuse(option, "WIDTHxHEIGHT, 1 to 65536 pixels each", text, error);
    *width = (int)w;
    *height = (int)h;
    return true;
}
