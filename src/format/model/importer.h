/*
 * Running nephroid-import, the program that reads a model where it can do no harm.
 */
#pragma once

#include "base/error.h"
#include "base/parallel.h"

/** @brief What a model may take to read. */
typedef struct import_limits {
    size_t memory;  /**< bytes of address space of the child, and of what it tells */
    double seconds; /**< of its computing; four times that by the clock */
} import_limits;

/** @brief What a file of that many bytes may take: more than assimp needs of any honest
 * one, and no more memory than is left of the limit. */
import_limits import_limits_of(size_t file_size);

/** @brief A file that the model may name. */
typedef struct import_file {
    const char *name; /**< as the model has it */
    const char *path;
} import_file;

typedef struct import_job {
    const char *path;      /**< the model */
    const char *extension; /**< "obj": which importer */
    const char *format;    /**< as messages call it: "OBJ" */
    const import_file *files;
    size_t n_files;       /**< at most MOST_IMPORT_FILES */
    import_limits limits; /**< memory 0: import_limits_of the file */
    const cancel_flag
        *cancel; /**< its progress is called about twenty times a second; NULL */
} import_job;

enum { MOST_IMPORT_FILES = 60 };

/**
 * @brief Starts the program and waits for its end.
 *
 * It is $NEPHROID_IMPORTER, if that is set, else where it was installed with this
 * library, else beside this library. No signal handler of the process is touched; its
 * children are waited for by number.
 * @param size of what it told (stream.h)
 * @return its bytes, owned by the caller (big_free); NULL with ERROR_INPUT if the file is
 * to blame (the child crashed or ran out of a limit), ERROR_CANCELLED, or ERROR_FAILED
 */
void *importer_run(const import_job *job, size_t *size, GError **error);
