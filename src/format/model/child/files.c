/*
 * assimp asks for files by name; what it gets is memory, mapped before the cage closed.
 */
#include "format/model/child/files.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct cursor {
    const given_file *file;
    size_t at;
} cursor;

bool given_files_add(given_files *files, const char *name, int file)
{
    struct stat about;
    if (files->n == MOST_FILES || fstat(file, &about) != 0 || !S_ISREG(about.st_mode))
        return false;
    size_t size = (size_t)about.st_size;
    void *bytes =
        size > 0 ? mmap(NULL, size, PROT_READ, MAP_PRIVATE, file, 0) : (void *)"";
    if (bytes == MAP_FAILED)
        return false;
    close(file);
    files->all[files->n++] = (given_file){name, bytes, size};
    return true;
}

static cursor *cursor_of(struct aiFile *file)
{
    return (cursor *)(void *)file->UserData;
}

static size_t read_some(struct aiFile *file, char *to, size_t size, size_t n)
{
    cursor *c = cursor_of(file);
    size_t left = size > 0 ? (c->file->size - c->at) / size : 0;
    n = n < left ? n : left;
    memcpy(to, c->file->bytes + c->at, n * size);
    c->at += n * size;
    return n;
}

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
    return cursor_of(file)->at;
}

static size_t size_of(struct aiFile *file)
{
    return cursor_of(file)->file->size;
}

/* Steps back come as size_t, too. */
static enum aiReturn seek(struct aiFile *file, size_t to, enum aiOrigin from)
{
    cursor *c = cursor_of(file);
    const size_t origins[] = {
        [aiOrigin_SET] = 0, [aiOrigin_CUR] = c->at, [aiOrigin_END] = c->file->size};
    size_t at = (size_t)from < 3 ? origins[from] + to : SIZE_MAX;
    if (at > c->file->size)
        return aiReturn_FAILURE;
    c->at = at;
    return aiReturn_SUCCESS;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* The names are equal but for blanks around that of the model. */
static bool is_named(const given_file *file, const char *path)
{
    size_t length = strlen(path);
    while (length > 0 && is_blank(path[length - 1]))
        length--;
    while (length > 0 && is_blank(*path))
        path++, length--;
    return strlen(file->name) == length && memcmp(file->name, path, length) == 0;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    (void)mode;
    const given_files *files = (const given_files *)(void *)io->UserData;
    int i = 0;
    while (i < files->n && !is_named(&files->all[i], path))
        i++;
    cursor *c = i < files->n ? calloc(1, sizeof *c) : NULL;
    struct aiFile *file = c ? malloc(sizeof *file) : NULL;
    if (!file) {
        free(c);
        return NULL;
    }
    c->file = &files->all[i];
    *file = (struct aiFile){.ReadProc = read_some,
                            .WriteProc = write_nothing,
                            .TellProc = tell,
                            .FileSizeProc = size_of,
                            .SeekProc = seek,
                            .FlushProc = flush_nothing,
                            .UserData = (char *)c};
    return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(cursor_of(file));
    free(file);
}

struct aiFileIO given_files_io(given_files *files)
{
    return (struct aiFileIO){
        .OpenProc = open_file, .CloseProc = close_file, .UserData = (char *)files};
}
