/*
 * Command lines: options by GLib, strictly; --help and --version for every command.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief What a command takes. */
typedef struct usage {
    const char *name;        /**< of the command */
    const char *operands;    /**< as shown in the help, e.g. "SCENE" */
    int n_operands;          /**< exactly so many must be given, */
    bool or_more;            /**< or at least */
    const char *summary;     /**< a sentence or two */
    const char *description; /**< shown below the options; NULL if none */
    const GOptionEntry *entries;
    bool loads_scene; /**< takes the options of loading.h too */
} usage;

/**
 * @brief Parses the arguments after the command's name; the operands stay in
 * (*argv)[1..].
 * @return true to go on; false: *exit_code says how to end, all is said already
 */
bool arguments_parse(const usage *how, int *argc, char ***argv, int *exit_code);

/** @brief A decimal number and nothing else. ERROR_USAGE naming the option. */
bool argument_real(const char *option, const char *text, double *out, GError **error);
/** @brief The same from low to high. */
bool argument_between(const char *option, const char *text, double low, double high,
                      double *out, GError **error);
/** @brief A whole number from low to high and nothing else. */
bool argument_count(const char *option, const char *text, guint64 low, guint64 high,
                    guint64 *out, GError **error);
/** @brief "640x480". */
bool argument_size(const char *option, const char *text, int *width, int *height,
                   GError **error);
