/*
 * A file whose every byte is checked: for what another process is to go on from.
 *
 *   nephroid KIND FORM BYTES CRC        one line; of the header that follows
 *   name value                          lines of it
 *   data in the machine's byte order, in blocks of a mebibyte, each with its CRC-32
 * behind
 *
 * It is written under another name and renamed when it is whole and on the disk
 * (base/output.h). What is cut off, damaged or of something else is refused with the
 * reason, which begins with the path.
 */
#pragma once

#include "base/error.h"

#include <glib.h>
#include <stdint.h>
#include <stdio.h>

/** @brief A kind of file. Static. */
typedef struct checked_kind {
    const char *word; /**< on the first line */
    const char *name; /**< as errors say it: "checkpoint" */
    const char *form; /**< its version */
} checked_kind;

/* ---- Writing ---- */

/** @brief The first line and the header. Here and below write errors are left to
 * output_commit. */
void checked_begin(FILE *to, const checked_kind *kind, const GString *header);
/** @brief Data, in blocks. */
void checked_put(FILE *to, const void *data, size_t size);
/** @brief What checked_put writes of so many bytes. */
size_t checked_size(size_t size);

/* ---- Reading ---- */

typedef struct checked_reader {
    const checked_kind *kind;
    char *path; /**< owned */
    FILE *from;
    size_t size; /**< of the file */
} checked_reader;

/** @brief Opens a file. @return its header, owned by the caller; NULL with an error, and
 * nothing is open */
char *checked_open(checked_reader *r, const checked_kind *kind, const char *path,
                   GError **error);
void checked_close(checked_reader *r);
/** @brief Reads what checked_put wrote of so many bytes. @param what it is, for errors */
bool checked_get(const checked_reader *r, void *data, size_t size, const char *what,
                 GError **error);
/** @brief Where the reading stands. */
size_t checked_at(const checked_reader *r);
/** @brief Goes on behind size bytes of data. */
bool checked_skip(const checked_reader *r, size_t size, GError **error);
/** @brief Sets ERROR_INPUT: "PATH: why". @return false */
bool checked_refuse(const checked_reader *r, GError **error, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/** @brief The same: it is cut off. */
bool checked_refuse_short(const checked_reader *r, GError **error);
/** @brief The same: it is damaged. */
bool checked_refuse_damaged(const checked_reader *r, const char *where, GError **error);
