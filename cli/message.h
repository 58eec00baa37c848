/*
 * What the program says. Results go to stdout; notes, progress and errors to stderr, as
 * compilers have it and editors follow it: "FILE:LINE:COLUMN: error: what is wrong", or
 * "error: what is wrong" where it has no place; likewise "warning: " and "note: ".
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief Prints a result. @return EXIT_DONE, or EXIT_FAILED if stdout takes no more. */
int print_result(const char *format, ...) G_GNUC_PRINTF(1, 2);
/** @brief Tells of an error. @return the exit code it stands for. */
int report_error(const GError *error);
/** @brief Tells what is wrong with the command line. @return EXIT_USAGE. */
int usage_error(const char *format, ...) G_GNUC_PRINTF(1, 2);
/** @brief One line to stderr: an "error", a "warning" or a "note", whose name goes behind
 * the place that the text begins with. */
void tell(const char *level, const char *format, ...) G_GNUC_PRINTF(2, 3);
/** @brief One line of progress to stderr, begun with the program's name. */
void say(const char *format, ...) G_GNUC_PRINTF(1, 2);

/** @brief The library's log on stderr; data: const bool *quiet, true to leave out
 * notes. */
void log_to_stderr(NephLogLevel level, const char *text, void *data);
