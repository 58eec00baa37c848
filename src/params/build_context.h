/*
 * What is known while a scene is built and forgotten once it is whole: names that
 * parameters may refer to, images read already, files that came within files, and where
 * notes go. Who makes a texture, a material or a light from parameters is handed one.
 */
#pragma once

#include "base/log.h"
#include "base/parallel.h"
#include "image/image.h"
#include "params/sources.h"

#include <stdbool.h>

/** @brief Everything may be asked of a context that is NULL: it knows nothing. */
typedef struct build_context {
    GHashTable *float_textures, *spectrum_textures; /**< name -> texture*, borrowed */
    GHashTable *materials;                          /**< name -> material*, borrowed */
    GHashTable *files;      /**< path -> GBytes*: images that came within another file */
    GHashTable *pictures;   /**< how and what was read -> picture* */
    scene_sources *sources; /**< borrowed; NULL: nobody asks for them */
    log_sink log;
    const cancel_flag *cancel; /**< borrowed, for readers that wait; NULL: none */
    bool
        lenient; /**< what can not be rendered is replaced, and said (build_is_lenient) */
} build_context;

/** @param free_picture for the values of pictures */
void build_context_init(build_context *context, const log_sink *log,
                        GDestroyNotify free_picture);
void build_context_clear(build_context *context);

/** @brief Makes bytes known as a file: an image that came within the scene's file. A
 * parameter that names the path finds them. */
void build_context_add_file(build_context *context, const char *path, GBytes *bytes);
/** @brief image_read of a file on the disk or one that was added. */
image *build_context_read_image(const build_context *context, const char *path,
                                const image_read_options *options, GError **error);

/** @brief True if the scene is read leniently; then the text, which says what is taken
 * for what, has been logged as a warning at the place. */
bool build_is_lenient(const build_context *context, source_place place,
                      const char *format, ...) G_GNUC_PRINTF(3, 4);
