/*
 * What is told of a render before it and when it ends.
 */
#pragma once

#include "progress.h"

/** @brief Prints what is decided before the first pass. Passes that time is short for are
 * planned by it: this takes of it too. @return an exit code */
int report_plan(NephRender *render);
/** @brief Tells why a render ended early. @return whether there is something to write */
bool report_end(const NephRender *render, const GError *error, int *exit_code);
/** @brief Tells why a frame ended early. Of frames there are whole ones only: those that
 * are there need not be rendered again. @return an exit code */
int report_unfinished(int frame, const GError *error);
/** @brief Tells how passes that time or noise has ended can be had again: by their
 * number. */
void report_time(const NephRender *render);
/** @brief Tells that all is written. */
void report_done(const NephRender *render, const progress *shown);
/** @brief Prints the table, with notes, unless quiet. @param stats where to write it as
 * JSON, may be NULL @return an exit code */
int report_statistics(const NephRender *render, const char *stats, bool quiet);
