#include "message.h"

#include "command.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Names in results come from files too. */
static char *printable_lines(const char *text)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    for (char **line = lines; *line; line++) {
        char *shown = neph_text_printable(*line);
        g_free(*line);
        *line = shown;
    }
    return g_strjoinv("\n", lines);
}

int print_result(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *shown = printable_lines(text);
    if (fputs(shown, stdout) >= 0 && fflush(stdout) == 0)
        return EXIT_DONE;
    tell("error", "cannot write to standard output: %s", g_strerror(errno));
    return EXIT_FAILED;
}

void say(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *shown = neph_text_printable(text);
    fprintf(stderr, "nephroid: %s\n", shown);
}

/* Length of a place without the ":LINE" or ":LINE:COLUMN" at its end. */
static size_t without_numbers(const char *text, size_t length)
{
    for (int i = 0; i < 2; i++) {
        size_t digits = length;
        while (digits > 0 && g_ascii_isdigit(text[digits - 1]))
            digits--;
        if (digits == length || digits == 0 || text[digits - 1] != ':')
            break;
        length = digits - 1;
    }
    return length;
}

/* Where a message goes on behind the place that it begins with: a file that is there,
 * with line and column or without, and ": ". */
static const char *behind_place(const char *text)
{
    for (const char *colon = text; (colon = strstr(colon, ": ")); colon += 2) {
        size_t length = without_numbers(text, (size_t)(colon - text));
        g_autofree char *file = g_strndup(text, length);
        if (g_file_test(file, G_FILE_TEST_EXISTS))
            return colon + 2;
    }
    return text;
}

void tell(const char *level, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_autofree char *shown = neph_text_printable(text);
    const char *what = behind_place(shown);
    fprintf(stderr, "%.*s%s: %s\n", (int)(what - shown), shown, level, what);
}

static int exit_code(const GError *error)
{
    if (error->domain == G_OPTION_ERROR)
        return EXIT_USAGE;
    if (error->domain != NEPH_ERROR_DOMAIN)
        return EXIT_FAILED;
    return MIN(error->code, EXIT_FAILED);
}

int report_error(const GError *error)
{
    if (exit_code(error) == EXIT_USAGE)
        return usage_error("%s", error->message);
    g_auto(GStrv) lines = g_strsplit(error->message, "\n", -1);
    for (size_t i = 0; lines[i]; i++)
        if (*lines[i])
            tell("error", "%s", lines[i]);
    return exit_code(error);
}

int usage_error(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    tell("error", "%s", text);
    tell("note", "try '%s --help'", g_get_prgname());
    return EXIT_USAGE;
}

void log_to_stderr(NephLogLevel level, const char *text, void *data)
{
    const bool *quiet = data;
    if (level == NEPH_LOG_WARNING)
        tell("warning", "%s", text);
    else if (!*quiet)
        tell("note", "%s", text);
}
