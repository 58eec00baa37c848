#include "message.h"

#include "command.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

int print_result(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (fputs(text, stdout) >= 0 && fflush(stdout) == 0)
        return EXIT_DONE;
    say("cannot write to standard output: %s", g_strerror(errno));
    return EXIT_FAILED;
}

void say(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    fprintf(stderr, "nephroid: %s\n", text);
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
            say("%s", lines[i]);
    return exit_code(error);
}

int usage_error(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    say("%s", text);
    say("try '%s --help'", g_get_prgname());
    return EXIT_USAGE;
}

void log_to_stderr(NephLogLevel level, const char *text, void *data)
{
    const bool *quiet = data;
    if (level == NEPH_LOG_WARNING)
        say("warning: %s", text);
    else if (!*quiet)
        say("%s", text);
}
