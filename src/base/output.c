#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output {
    char *path;      /* symbolic links resolved, so that they survive the rename */
    char *temporary; /* NULL: path is not a regular file and is written directly */
    FILE *stream;
};

static void output_free(output *out)
{
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

/* Not mkstemp: the file is to have the permissions that the user's umask gives. */
static FILE *open_temporary(output *out)
{
    g_autofree char *folder = g_path_get_dirname(out->path);
    g_autofree char *name = g_path_get_basename(out->path);
    for (int attempt = 0; attempt < 100; attempt++) {
        g_free(out->temporary);
        out->temporary = g_strdup_printf("%s/.%s.%08x", folder, name, g_random_int());
        int fd = open(out->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
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
        out->stream = open_temporary(out);
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

/* Flushes and syncs; devices and pipes know no sync. */
static bool finish(output *out)
{
    bool written = !ferror(out->stream) && fflush(out->stream) == 0 &&
                   (!out->temporary || fsync(fileno(out->stream)) == 0);
    int reason = errno;
    bool closed = fclose(out->stream) == 0;
    if (!written)
        errno = reason;
    return written && closed &&
           (!out->temporary || rename(out->temporary, out->path) == 0);
}

bool output_commit(output *out, GError **error)
{
    errno = 0;
    bool done = finish(out);
    if (!done) {
        error_set(error, ERROR_FAILED, "cannot write %s: %s", out->path,
                  g_strerror(errno ? errno : EIO));
        if (out->temporary)
            unlink(out->temporary);
    }
    output_free(out);
    return done;
}

void output_discard(output *out)
{
    if (!out)
        return;
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

bool output_write_text(const char *path, const char *text, GError **error)
{
    output *out = output_open(path, error);
    if (!out)
        return false;
    fputs(text, out->stream);
    return output_commit(out, error);
}
