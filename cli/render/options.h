/*
 * The words of nephroid render, as given.
 */
#pragma once

#include "overrides.h"

/** @brief NULL, or false: not given. */
typedef struct render_options {
    char **outputs, **layers;
    char *size, *exposure, *stats, *every, *checkpoint, *checkpoint_every, *resume,
        *photons, *frame, *fps, *camera, *grain;
    gboolean quiet, explain;
    overrides settings;
} render_options;

/** @brief Parses the arguments after the command's name; the operand stays in (*argv)[1].
 * @return NULL: *exit_code says how to end, all is said already */
const render_options *render_options_parse(int *argc, char ***argv, int *exit_code);
