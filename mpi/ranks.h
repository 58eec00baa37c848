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
/** @brief How many times as long this rank's work takes while all on its machine work,
 * each with so many threads (0: as many as there are processors). All ranks call it. */
double ranks_crowd(double threads);
/** @brief Waits for what may take as long as a pass, and leaves the processor to who
 * works meanwhile; MPI's own waiting does not. */
void ranks_wait(MPI_Request *request);
/** @brief The root's numbers, in all ranks, waiting so. */
void ranks_share(void *data, int n, MPI_Datatype type);
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
