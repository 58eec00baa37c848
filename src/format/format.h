/*
 * Scene files, whatever their format, become a committed scene.
 */
#pragma once

#include "scene/builder.h"

/** @brief Gives a builder what is in a file, without the commit; false with an error as
 * format_load has it. */
bool format_read(scene_builder *to, const char *path, GError **error);

/** @brief What names of scene files end in, with the dot, lower case; NULL-terminated,
 * static. */
const char *const *format_extensions(void);

/** @brief How to load. */
typedef struct load_options {
    unsigned threads;          /**< for the acceleration structure; 0 = all */
    bool lenient;              /**< see format/lenient.h */
    bool thin_glass;           /**< see scene/builder.h */
    bool at_time;              /**< see scene/builder.h ... */
    double time;               /**< ... s; 0 else */
    const log_sink *log;       /**< may be NULL */
    scene_sources *sources;    /**< told the files that are read; borrowed, may be NULL */
    const cancel_flag *cancel; /**< heard while a model is imported, and by wanted.h
                                  where that is set, too; may be NULL */
} load_options;

/** @brief An empty builder that reads as the options say. */
scene_builder *format_builder(const load_options *options);
/** @brief format_load by options. */
scene *format_load_with(const char *path, const load_options *options, GError **error);
/** @brief The same with the view that the file describes, to which the scene belongs. */
view *format_load_view(const char *path, const load_options *options, GError **error);
/**
 * @brief Reads a scene file and commits the scene.
 * @param threads for the acceleration structure; 0 = all
 * @param log may be NULL
 * @return the scene, owned by the caller; NULL with ERROR_INPUT whose message holds up to
 * 20 lines "FILE:LINE:COLUMN: expected ..., found ...", or with ERROR_FAILED
 */
scene *format_load(const char *path, unsigned threads, const log_sink *log,
                   GError **error);
