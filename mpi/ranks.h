/*
 * What all ranks do together, and how one of them ends the job for all.
 */
#pragma once

#include <glib.h>
#include <mpi.h>
#include <stdbool.h>

enum { ROOT = 0 };

int ranks_me(void);
int ranks_count(void);
/** @brief Threads of this rank where none are asked for: its share of the processors of
 * its machine. All ranks call it. */
int ranks_threads(void);
/** @brief The root's text, in all ranks; owned by the caller. text: the root's, else
 * NULL */
char *ranks_share_text(const char *text);
/** @brief The root's bytes, in all ranks; owned by the caller. bytes: the root's, else
 * NULL */
GBytes *ranks_share_bytes(GBytes *bytes);
/** @brief Whether all ranks say true. */
bool ranks_agree(bool well);
/** @brief Tells of the error, by rank, and ends all ranks with its exit code. */
_Noreturn void ranks_abort(const GError *error);
