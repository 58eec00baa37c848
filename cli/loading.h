/*
 * How scenes are loaded from the command line: options that every command takes that
 * loads one.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief --lenient, --thin-glass; see usage.loads_scene. */
extern const GOptionEntry loading_entries[];

/** @brief What they ask for, with the log on stderr. threads: 0 = all. quiet leaves out
 * notes. */
NephLoadOptions loading_options(unsigned threads, bool quiet);
