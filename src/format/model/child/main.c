/*
 * nephroid-import: reads one model with assimp, which was not written for files that
 * mean harm, where it can do none, and tells what is in it (format/model/stream.h).
 *
 *   nephroid-import EXTENSION BYTES SECONDS [NAME...]
 *
 *   0 the model    1 what is told, a pipe    3, 4 … the files that the model calls NAME
 *
 * The cage closes before the first byte of the model is looked at. The importer is chosen
 * by EXTENSION, whatever is in the file: assimp gets to see a name of ours.
 */
#define _GNU_SOURCE
#include "format/model/child/cage.h"
#include "format/model/child/files.h"
#include "format/model/child/out.h"
#include "format/model/child/tell.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <unistd.h>

enum { FIRST_NAME = 4, FIRST_FILE = 3, USAGE = 2 };

static const unsigned STEPS = aiProcess_Triangulate | aiProcess_SortByPType |
                              aiProcess_JoinIdenticalVertices |
                              aiProcess_ValidateDataStructure;

/* Whether a blank-separated list has the word. */
static bool lists(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; *at; at += strspn(at, " ")) {
        size_t n = strcspn(at, " ");
        if (n == length && strncasecmp(at, word, n) == 0)
            return true;
        at += n;
    }
    return false;
}

/* assimp goes by the extension only where there is no choice. */
static bool has_one_importer(const char *extension)
{
    int n = 0;
    for (size_t i = 0; i < aiGetImportFormatCount(); i++)
        n += lists(aiGetImportFormatDescription(i)->mFileExtensions, extension);
    return n == 1;
}

static bool take_files(given_files *files, const char *model, int n, char **names)
{
    bool done = given_files_add(files, model, STDIN_FILENO);
    for (int i = 0; i < n && done; i++)
        done = given_files_add(files, names[i], FIRST_FILE + i);
    close_range(FIRST_FILE, ~0U, 0);
    return done;
}

/* Running out of memory is all that C++ throws of its own accord. */
_Noreturn static void fail(out *o, const char *text)
{
    bool no_memory = !text || !*text || strstr(text, "bad_alloc");
    out_fail(o, no_memory ? STREAM_NO_MEMORY : STREAM_DAMAGED, text ? text : "");
}

static void import(out *o, given_files *files, const char *model)
{
    struct aiFileIO io = given_files_io(files);
    const struct aiScene *scene = aiImportFileEx(model, STEPS, &io);
    if (!scene)
        fail(o, aiGetErrorString()); /* does not return */
    /* cppcheck-suppress nullPointerRedundantCheck */
    if (!scene->mRootNode || scene->mNumMeshes == 0)
        out_fail(o, STREAM_DAMAGED, "expected a mesh, found none");
    tell_scene(o, scene);
}

int main(int argc, char **argv)
{
    static out told = {.file = STDOUT_FILENO};
    static given_files files;
    char model[32];
    if (argc < FIRST_NAME)
        return USAGE;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const cage limits = {.memory = strtoull(argv[2], NULL, 10),
                         .seconds = (unsigned)strtoul(argv[3], NULL, 10)};
    snprintf(model, sizeof model, "model.%s", argv[1]);
    out_bytes(&told, STREAM_MAGIC, strlen(STREAM_MAGIC));
    if (!has_one_importer(argv[1]))
        out_fail(&told, STREAM_DAMAGED, "assimp has no importer of its own for it");
    if (!take_files(&files, model, argc - FIRST_NAME, argv + FIRST_NAME))
        out_fail(&told, STREAM_DAMAGED, "its files can not be read");
    const char *missing = cage_close(&limits);
    if (missing)
        out_note(&told, STREAM_DEBUG, "%s", missing);
    import(&told, &files, model);
    out_finish(&told);
}
