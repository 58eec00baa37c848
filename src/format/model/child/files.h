/*
 * The files that the importer may read: those that it was started with, and no others.
 */
#pragma once

#include <assimp/cfileio.h>
#include <stdbool.h>
#include <stddef.h>

enum { MOST_FILES = 64 };

typedef struct given_file {
    const char *name; /**< as the model names it */
    const unsigned char *bytes;
    size_t size;
} given_file;

typedef struct given_files {
    given_file all[MOST_FILES];
    int n;
} given_files;

/** @brief Maps an open file and closes it. false if that can not be. */
bool given_files_add(given_files *files, const char *name, int file);
/** @brief How assimp gets at them; files must outlive it. */
struct aiFileIO given_files_io(given_files *files);
