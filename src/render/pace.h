/*
 * How large passes are where time is short. A trial pass of few photons and samples tells
 * what they cost; a pass is then made so small that many fit into the time.
 *
 *   pace_measure ─► pace_costs ─► pace_choose ─► settings of all passes
 *
 * What is chosen are settings, so that who sets them by hand gets the same passes.
 */
#pragma once

#include "render/film/film.h"
#include "transport/transport.h"

/** @brief What a pass takes, s. */
typedef struct pace_costs {
    double pass;    /**< whatever its size */
    double photons; /**< all that the settings ask for */
    double sample;  /**< one of the camera, where all threads look */
} pace_costs;

/** @brief Measures with a pass that no one sees.
 *  @param left seconds there are; the trial takes a small part of them
 *  @return false with an error, also when cancelled */
bool pace_measure(const transport_plan *plan, const film *f, double left,
                  const cancel_flag *cancel, pace_costs *out, GError **error);

/** @brief Settings under which a good number of passes fits into `left` seconds, if one
 * of a sample a pixel does; and whose planning counts on them. Where the settings say how
 * many passes there are, these stay as they are. */
settings pace_choose(const settings *how, const pace_costs *costs, double n_pixels,
                     double left);

/** @brief What a pass by chosen settings will take, s.
 * @param asked those that the costs were measured for */
double pace_pass_seconds(const pace_costs *costs, const settings *asked,
                         const settings *chosen, double n_pixels);

/** @brief About how long it takes to make the picture and write it to files of these
 * names, s: tries it with a few rows, and with more while that fits in a budget of
 * seconds. @param paths NULL-terminated; NULL: none */
double pace_write_seconds(const film *f, unsigned threads, char **paths, double budget);
