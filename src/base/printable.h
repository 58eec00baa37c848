/*
 * Text from files on its way to a person: what would command a terminal rather than be
 * shown by it (escape sequences, line ends, marks that turn the direction of writing) is
 * spelt out.
 */
#pragma once

/** @brief A copy in valid UTF-8 with escapes as of C for what is no character to be
 * seen; all others stay. What has been through it once comes out the same again. Owned by
 * the caller. */
char *printable(const char *text);
