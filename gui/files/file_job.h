/*
 * Files read and written on a thread of their own, so that a slow disk or a large picture
 * never holds up the window.
 *
 * The function given is called on the main context like any GAsyncReadyCallback; if the
 * cancellable was cancelled meanwhile its data may be gone, which it has to ask first.
 */
#pragma once

#include "picture/display.h"
#include "session/held.h"

#include <gio/gio.h>
#include <stdbool.h>

/** @brief What is to be written: a picture, or a text, or a scene of any format as pbrt
 * with a view. Copied or held. */
typedef struct file_content {
    held_picture *picture;
    display_options shown; /**< how: for formats of eight bits, which hold what is seen;
                              those of floats hold the light itself */
    const char *text;
    const char *scene; /**< path */
    NephCamera camera; /**< of the scene */
} file_content;

/** @brief Reads a picture. */
void file_job_read(const char *path, GCancellable *cancellable, GAsyncReadyCallback done,
                   void *data);
/** @brief What was read, owned by the caller; NULL with *error. */
held_picture *file_job_read_finish(GAsyncResult *result, GError **error);

/** @brief Writes. Cancelling does not stop it: a file is whole or not there. */
void file_job_write(const char *path, const file_content *content,
                    GCancellable *cancellable, GAsyncReadyCallback done, void *data);
bool file_job_write_finish(GAsyncResult *result, GError **error);

/** @brief The path it is about. Borrowed from the result. */
const char *file_job_path(GAsyncResult *result);
/** @brief Whether who asked has gone. */
bool file_job_is_orphan(GAsyncResult *result);
