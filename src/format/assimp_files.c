/*
 * How assimp opens files: as it would by itself, and each is told of first, since only it
 * knows which others a model names (an OBJ's materials, a scene's parts).
 */
#include "format/assimp.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <sys/stat.h>

static FILE *stream_of(struct aiFile *file)
{
    return (FILE *)(void *)file->UserData;
}

static size_t read_some(struct aiFile *file, char *to, size_t size, size_t n)
{
    return fread(to, size, n, stream_of(file));
}

/* Nothing is ever opened for writing. */
static size_t write_nothing(struct aiFile *file, const char *from, size_t size, size_t n)
{
    (void)file, (void)from, (void)size, (void)n;
    return 0;
}

static void flush_nothing(struct aiFile *file)
{
    (void)file;
}

static size_t tell(struct aiFile *file)
{
    long at = ftell(stream_of(file));
    return at < 0 ? 0 : (size_t)at;
}

static size_t size_of(struct aiFile *file)
{
    struct stat about;
    return fstat(fileno(stream_of(file)), &about) == 0 ? (size_t)about.st_size : 0;
}

static enum aiReturn seek(struct aiFile *file, size_t to, enum aiOrigin from)
{
    static const int origins[] = {
        [aiOrigin_SET] = SEEK_SET, [aiOrigin_CUR] = SEEK_CUR, [aiOrigin_END] = SEEK_END};
    bool known = (size_t)from < G_N_ELEMENTS(origins);
    bool done = known && fseek(stream_of(file), (long)to, origins[from]) == 0;
    return done ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    (void)mode;
    scene_sources_add((scene_sources *)(void *)io->UserData, path);
    if (!g_file_test(path, G_FILE_TEST_IS_REGULAR))
        return NULL;
    FILE *stream = g_fopen(path, "rbe");
    if (!stream)
        return NULL;
    struct aiFile *file = g_new(struct aiFile, 1);
    *file = (struct aiFile){.ReadProc = read_some,
                            .WriteProc = write_nothing,
                            .TellProc = tell,
                            .FileSizeProc = size_of,
                            .SeekProc = seek,
                            .FlushProc = flush_nothing,
                            .UserData = (char *)stream};
    return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    fclose(stream_of(file));
    g_free(file);
}

const struct aiScene *assimp_import(scene_sources *sources, const char *path,
                                    unsigned steps)
{
    struct aiFileIO io = {
        .OpenProc = open_file, .CloseProc = close_file, .UserData = (char *)sources};
    return aiImportFileEx(path, steps, &io);
}
