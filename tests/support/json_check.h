/*
 * A reader of JSON for tests: says whether a text is JSON (RFC 8259) and finds a member's
 * value. Apart from the writer, so that neither hides the other's faults.
 */
#pragma once

#include <stdbool.h>

/** @brief Whether text is one JSON value and nothing else. */
bool json_is_valid(const char *text);
/** @brief The number behind the first `"key":` in text; NaN if there is none. */
double json_find_number(const char *text, const char *key);
