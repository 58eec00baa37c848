/*
 * Files that are either whole or not there: written under a temporary name in the same
 * folder, synced, and renamed at the end.
 *
 *   output_open ─► write to output_stream ─► output_commit   or   output_discard
 *
 * What is not a regular file (/dev/stdout, a pipe) is written directly.
 */
#pragma once

#include "base/error.h"

#include <stdio.h>

typedef struct output output;

/** @brief Begins a file. ERROR_INPUT naming the path if it can not be written. */
output *output_open(const char *path, GError **error);
/** @brief Where to write; owned by the output. Write errors may be left to the commit. */
FILE *output_stream(output *out);
/** @brief Ends the file and frees out. ERROR_FAILED if anything was not written; then the
 * old file, if any, is still there. */
bool output_commit(output *out, GError **error);
/** @brief Drops the file and frees out; NULL is allowed. */
void output_discard(output *out);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(output, output_discard)

/** @brief Whether output_open would succeed, without leaving a trace. */
bool output_possible(const char *path, GError **error);
/** @brief A whole small file at once. */
bool output_write_text(const char *path, const char *text, GError **error);
