/*
 * Errors are values: a function that can fail returns bool or a pointer, and its last
 * parameter is a GError **.
 *
 * The codes are the exit codes of the command line, so that the reason for a failure
 * survives from the deepest reader up to the shell. Messages name what stands in files,
 * and come out printable (printable.h): one line, and nothing that a terminal would obey.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>

/** @brief Why a call failed. The values equal NephError in the installed header. */
typedef enum error_code {
    ERROR_INPUT = 1,     /**< a scene, image or value that came from outside is wrong */
    ERROR_USAGE = 2,     /**< a call or a command line is wrong */
    ERROR_FAILED = 3,    /**< memory, disk or another resource failed while running */
    ERROR_CANCELLED = 4, /**< the caller's callback asked to stop */
} error_code;

/** @brief The GError domain of every error this library makes. */
#define NEPH_ERROR (error_quark())
GQuark error_quark(void);

/** @brief A place in an input file; line 0: the whole file, file NULL: not from a file.
 */
typedef struct source_place {
    const char *file; /**< interned (intern.h), never freed */
    int line;         /**< from 1 */
    int column;       /**< from 1 */
} source_place;

/** @brief "FILE:LINE:COLUMN: ", "file: " of a whole file, or "" of no place; owned by the
 * caller. */
char *source_place_text(source_place place);

/** @brief Sets an ERROR_INPUT whose message begins with "FILE:LINE:COLUMN: ". */
void error_at(GError **error, source_place place, const char *format, ...)
    G_GNUC_PRINTF(3, 4);

/** @brief Sets an error with the code of `inner` and the place before its message; frees
 * inner. */
void error_move_at(GError **error, source_place place, GError *inner);

/** @brief Sets an ERROR_INPUT of several messages (char *), a line each. */
void error_set_lines(GError **error, const GPtrArray *messages);

/** @brief Sets an error with the given code. */
void error_set(GError **error, error_code code, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
