/*
 * The command line of nephroid-mpi: that of "nephroid render", as far as many ranks go.
 */
#pragma once

#include "overrides.h"

typedef struct options {
    const char *scene;
    char **outputs;    /**< NULL-terminated; NULL: the scene's name with .exr */
    int width, height; /**< 0: the scene's */
    char *stats, *checkpoint, *resume; /**< NULL: none */
    double checkpoint_every;           /**< s */
    gboolean quiet;
    overrides settings;
} options;

/** @brief All ranks read the same; the root says what is wrong.
 * @return false: *exit_code says how to end */
bool options_parse(options *o, int argc, char **argv, int *exit_code);
