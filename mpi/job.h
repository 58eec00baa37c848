/*
 * A render by all ranks.
 */
#pragma once

#include "options.h"

/** @brief All ranks call it. @param start monotonic s, when the program began
 * @return the exit code, in the root that of the job */
int job_run(const options *o, double start);
