/*
 * Strings that are kept once each for as long as the program runs: names of files and of
 * parameters, which places in error messages and scenes point at without owning them.
 */
#pragma once

/** @brief The kept copy of a text; the same pointer for equal texts. Any thread.
 *  @param text may be NULL @return NULL for that */
const char *intern(const char *text);
