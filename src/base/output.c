#define _GNU_SOURCE /* sync_file_range */
#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE = 8 << 20 }; /* size: of a file, that a disk takes soon */

/* A temporary file that a signal must not leave behind. A handler may look at any moment,
   so nodes stay once they are there, and whoever takes the path out of one owns it. */
typedef struct unfinished {
    _Atomic(char *) path; /* NULL: the node is free */
    char *abandoned;      /* what it was then: a signal's handler may not free it */
    struct unfinished *next;
} unfinished;

static _Atomic(unfinished *) all_unfinished;

struct output {
    char *path;       /* symbolic links resolved, so that they survive the rename */
    char *temporary;  /* NULL: path is not a regular file and is written directly */
    unfinished *node; /* of temporary */
    FILE *stream;     /* NULL: closed */
    const cancel_flag *cancel;
};

static unfinished *note_unfinished(const char *path)
{
    char *copy = g_strdup(path);
    for (unfinished *u = atomic_load(&all_unfinished); u; u = u->next) {
        char *none = NULL;
        if (atomic_compare_exchange_strong(&u->path, &none, copy))
            return u;
    }
    unfinished *made = g_new0(unfinished, 1);
    atomic_init(&made->path, copy);
    made->next = atomic_load(&all_unfinished);
    while (!atomic_compare_exchange_weak(&all_unfinished, &made->next, made))
        ;
    return made;
}

void output_abandon_all(void)
{
    for (unfinished *u = atomic_load(&all_unfinished); u; u = u->next) {
        char *path = atomic_exchange(&u->path, NULL);
        if (path) {
            unlink(path);
            u->abandoned = path;
        }
    }
}

static void output_free(output *out)
{
    if (out->node)
        g_free(atomic_exchange(&out->node->path, NULL));
    g_free(out->path);
    g_free(out->temporary);
    g_free(out);
}

static char *resolve(const char *path)
{
    char *real = realpath(path, NULL);
    char *copy = g_strdup(real ? real : path);
    free(real);
    return copy;
}

/* The new file takes the old one's place with its owner and its permissions, but where it
 * cannot be given to that group, the group loses them. */
static bool take_over(int fd, const struct stat *old)
{
    mode_t mode = old->st_mode & 0777;
    if (fchown(fd, old->st_uid, old->st_gid) != 0 &&
        fchown(fd, (uid_t)-1, old->st_gid) != 0)
        mode &= ~(mode_t)S_IRWXG;
    return fchmod(fd, mode) == 0;
}

/* Not mkstemp: a new file is to have the permissions that the user's umask gives, and one
 * that replaces another is nobody else's before it has those of the old one. */
static FILE *open_temporary(output *out, const struct stat *old)
{
    g_autofree char *folder = g_path_get_dirname(out->path);
    g_autofree char *name = g_path_get_basename(out->path);
    for (int attempt = 0; attempt < 100; attempt++) {
        g_free(out->temporary);
        out->temporary = g_strdup_printf("%s/.%s.%08x", folder, name, g_random_int());
        if (out->node)
            g_free(atomic_exchange(&out->node->path, NULL));
        out->node = note_unfinished(out->temporary);
        int fd = open(out->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                      old ? 0600 : 0666);
        if (fd >= 0 && old && !take_over(fd, old)) {
            int reason = errno;
            close(fd);
            unlink(out->temporary);
            errno = reason;
            break;
        }
        if (fd >= 0)
            return fdopen(fd, "wb");
        if (errno != EEXIST)
            break;
    }
    return NULL;
}

output *output_open(const char *path, GError **error)
{
    output *out = g_new0(output, 1);
    out->path = resolve(path);
    struct stat info;
    bool exists = stat(out->path, &info) == 0;
    if (!*path)
        errno = ENOENT;
    else if (exists && S_ISDIR(info.st_mode))
        errno = EISDIR;
    else if (exists && !S_ISREG(info.st_mode))
        out->stream = fopen(out->path, "wb");
    else
        out->stream = open_temporary(out, exists ? &info : NULL);
    if (!out->stream) {
        error_set(error, ERROR_INPUT, "cannot write %s: %s", path, g_strerror(errno));
        output_free(out);
        return NULL;
    }
    return out;
}

FILE *output_stream(output *out)
{
    return out->stream;
}

void output_watch(output *out, const cancel_flag *cancel)
{
    out->cancel = cancel;
}

static bool refuse(const output *out, GError **error)
{
    if (cancelled(out->cancel)) {
        error_set(error, ERROR_CANCELLED, "cancelled");
        return false;
    }
    error_set(error, ERROR_FAILED, "cannot write %s: %s", out->path,
              g_strerror(errno ? errno : EIO));
    return false;
}

/* What was not written long ago has left no reason: who tries again hears it. The file is
   given up in any case. */
static bool is_written(FILE *stream)
{
    bool failed = ferror(stream);
    errno = 0;
    if (failed)
        fputc(0, stream);
    return fflush(stream) == 0 && !failed;
}

/* What is on its way to a slow disk cannot be called back, so it is sent in pieces. */
static bool sync_pieces(int fd, const cancel_flag *cancel)
{
    struct stat info;
    off_t size = fstat(fd, &info) == 0 ? info.st_size : 0;
    for (off_t at = 0; cancel && at < size && !cancel_tell_progress(cancel); at += PIECE)
        if (sync_file_range(fd, at, PIECE,
                            SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE |
                                SYNC_FILE_RANGE_WAIT_AFTER) != 0)
            break; /* a file system without it: what follows does all */
    return !cancelled(cancel) && fsync(fd) == 0;
}

/* Devices and pipes know no sync. */
static bool is_on_disk(const output *out, FILE *stream)
{
    if (!is_written(stream))
        return false;
    return !out->temporary || sync_pieces(fileno(stream), out->cancel);
}

bool output_close(output *out, GError **error)
{
    FILE *stream = g_steal_pointer(&out->stream);
    if (!stream)
        return true;
    bool written = !cancel_tell_progress(out->cancel) && is_on_disk(out, stream);
    int reason = errno;
    bool closed = fclose(stream) == 0;
    if (!written)
        errno = reason;
    return (written && closed) || refuse(out, error);
}

/* The file's new name, too, is on the disk then. Not every file system knows that. */
static void sync_folder(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path);
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return;
    if (fsync(fd) != 0)
        errno = 0;
    close(fd);
}

bool output_commit(output *out, GError **error)
{
    bool done = output_close(out, error);
    if (done && out->temporary && rename(out->temporary, out->path) != 0)
        done = refuse(out, error);
    if (done && out->temporary)
        sync_folder(out->path);
    if (!done && out->temporary)
        unlink(out->temporary);
    output_free(out);
    return done;
}

void output_discard(output *out)
{
    if (!out)
        return;
    if (out->stream)
        fclose(out->stream);
    if (out->temporary)
        unlink(out->temporary);
    output_free(out);
}

bool output_possible(const char *path, GError **error)
{
    output *out = output_open(path, error);
    output_discard(out);
    return out != NULL;
}

/* Of what is not there yet: its folder's true path with its name. */
static char *true_name(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *name = g_path_get_basename(path);
    g_autofree char *resolved = resolve(folder);
    return g_build_filename(resolved, name, NULL);
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat of_a, of_b;
    if (stat(a, &of_a) == 0 && stat(b, &of_b) == 0)
        return S_ISREG(of_a.st_mode) && of_a.st_dev == of_b.st_dev &&
               of_a.st_ino == of_b.st_ino;
    g_autofree char *name_a = true_name(a), *name_b = true_name(b);
    return strcmp(name_a, name_b) == 0;
}

bool output_spares(const char *path, const char *const *others, GError **error)
{
    for (; others && *others; others++) {
        if (!is_same_file(path, *others))
            continue;
        error_set(error, ERROR_USAGE, "cannot write %s: it would replace %s", path,
                  *others);
        return false;
    }
    return true;
}

bool output_write_text(const char *path, const char *text, GError **error)
{
    output *out = output_open(path, error);
    if (!out)
        return false;
    fputs(text, out->stream);
    return output_commit(out, error);
}
