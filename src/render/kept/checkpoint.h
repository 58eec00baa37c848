/*
 * A checkpoint: a file with all that a render needs to go on in another process.
 *
 *   nephroid checkpoint 1 BYTES CRC     one line; of the header that follows
 *   name value                          lines of it: program, scene, settings, plan,
 * counts plane NAME BYTES                    ... last of these what follows it: sums
 * planes of the film in the machine's byte order, in blocks of a mebibyte, each with its
 * CRC-32 behind
 *
 * It is written under another name and renamed when it is whole and on the disk, so that
 * whatever ends the program, the old one or the new one is there. Passes are functions of
 * settings and their number, so a render that goes on from it gives the same bits; that
 * is only true of the same program, so another's file is refused.
 */
#pragma once

#include "render/film/film.h"
#include "render/render.h"

/** @brief What stands in the header. Strings are owned. */
typedef struct checkpoint {
    char *program; /**< which one, and how it was built */
    char *scene;   /**< fingerprint of what is rendered */
    char *plan;    /**< render_plan_digest */
    int width, height;
    settings how;   /**< by which passes are rendered ... */
    settings asked; /**< ... and those that were asked for */
    render_statistics statistics;
} checkpoint;

void checkpoint_clear(checkpoint *c);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(checkpoint, checkpoint_clear)

/** @brief Writes it with the film's sums. */
bool checkpoint_write(const checkpoint *c, const film *f, const char *path,
                      GError **error);
/** @brief Reads the header, and the film's sums into f if that is not NULL: its planes
 * must be those of the file. ERROR_INPUT, beginning with the path, says what is wrong
 * with the file; then the film is empty. */
bool checkpoint_read(checkpoint *c, film *f, const char *path, GError **error);
