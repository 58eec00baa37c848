/*
 * The subcommands, one file each. They get their arguments with the command's name first
 * and give the exit code of the program.
 */
#pragma once

#include <stdint.h>

/** @brief What the shell is told. 1..3 are NephError's values. */
enum { EXIT_DONE = 0, EXIT_INPUT = 1, EXIT_USAGE = 2, EXIT_FAILED = 3 };

/** @brief When the program began, monotonic µs. */
extern int64_t program_start;

typedef struct command {
    const char *name;
    const char *summary; /**< one line */
    int (*run)(int argc, char **argv);
} command;

int command_render(int argc, char **argv);
int command_photons(int argc, char **argv);
int command_info(int argc, char **argv);
int command_convert(int argc, char **argv);
int command_compare(int argc, char **argv);
int command_image(int argc, char **argv);
int command_settings(int argc, char **argv);
int command_features(int argc, char **argv);
int command_bsdf(int argc, char **argv);
int command_view(int argc, char **argv);
