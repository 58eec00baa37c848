/*
 * Files that are either whole or not there: written under a temporary name in the same
 * folder, synced, and renamed at the end.
 *
 *   output_open ─► write to output_stream ─► output_commit   or   output_discard
 *
 * A file that was there keeps its owner and permissions; a new one has those that the
 * umask leaves. What is not a regular file (/dev/stdout, a pipe) is written directly.
 */
#pragma once

#include "base/error.h"
#include "base/parallel.h"

#include <stdio.h>

typedef struct output output;

/** @brief Begins a file. ERROR_INPUT naming the path if it can not be written. */
output *output_open(const char *path, GError **error);
/** @brief Where to write; owned by the output. Write errors may be left to the commit. */
FILE *output_stream(output *out);
/** @brief From now on closing and committing end soon, with ERROR_CANCELLED and the old
 * file as it was, once cancel is set; its progress is called. Who writes asks by himself.
 * @param cancel may be NULL; stays the caller's */
void output_watch(output *out, const cancel_flag *cancel);
/** @brief Ends writing, so that nothing but the renaming is left to the commit: for files
 * that are to appear together. ERROR_FAILED if anything was not written. */
bool output_close(output *out, GError **error);
/** @brief Ends the file and frees out. ERROR_FAILED if anything was not written; then the
 * old file, if any, is still there. */
bool output_commit(output *out, GError **error);
/** @brief Drops the file and frees out; NULL is allowed. */
void output_discard(output *out);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(output, output_discard)

/** @brief Whether output_open would succeed, without leaving a trace. */
bool output_possible(const char *path, GError **error);
/** @brief Refuses a path whose file is one of others (NULL-terminated; NULL: none), by
 * whatever name or link: what was read must not be replaced. ERROR_USAGE naming both. */
bool output_spares(const char *path, const char *const *others, GError **error);
/** @brief Removes the temporary files of all that is being written. For a signal handler
 * that is about to end the program; no file can be committed afterwards. */
void output_abandon_all(void);
/** @brief A whole small file at once. */
bool output_write_text(const char *path, const char *text, GError **error);
