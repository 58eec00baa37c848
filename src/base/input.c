/*
 * Input files, read whole rather than mapped: a file that someone cuts short while it is
 * mapped ends the program. Names come from scenes, and a scene may be a stranger's: a
 * pipe or a device is not waited for but refused.
 */
#include "base/input.h"

#include "base/memory.h"
#include "base/wanted.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { PIECE = 1 << 22 }; /* bytes that are read or inflated at once */

/** Inflated bytes; grows by doubling. */
typedef struct growing {
    char *data;
    size_t size, capacity;
} growing;

static bool make_room(growing *out, GError **error)
{
    if (out->size < out->capacity)
        return true;
    size_t capacity = out->capacity ? 2 * out->capacity : 1 << 16;
    char *data = out->data
                     ? big_grow(out->data, out->capacity, capacity, 1, "file", error)
                     : big_alloc(capacity, 1, "file", error);
    if (!data)
        return false;
    out->data = data;
    out->capacity = capacity;
    return true;
}

/** One call of inflate; Z_OK to go on, Z_STREAM_END, or an error. */
static int step(z_stream *z, growing *out)
{
    size_t room = MIN(out->capacity - out->size, (size_t)PIECE);
    z->next_out = (Bytef *)out->data + out->size;
    z->avail_out = (uInt)room;
    int status = inflate(z, Z_NO_FLUSH);
    out->size += room - z->avail_out;
    return status;
}

/** A gzip file may hold several members, one after the other. */
static bool inflate_all(z_stream *z, const char *data, size_t size, growing *out,
                        GError **error)
{
    size_t read = 0;
    int status = Z_OK;
    for (;;) {
        if (!still_wanted(error) || !make_room(out, error))
            return false;
        size_t piece = MIN(size - read, (size_t)1 << 30);
        z->next_in = (Bytef *)data + read;
        z->avail_in = (uInt)piece;
        status = step(z, out);
        read += piece - z->avail_in;
        if (status == Z_STREAM_END) {
            if (read == size)
                return true;
            status = inflateReset(z);
        }
        bool starved = status == Z_BUF_ERROR && out->size == out->capacity;
        if (status != Z_OK && !starved)
            break;
    }
    error_set(error, ERROR_INPUT, "expected whole gzip data, found %s at byte %zu",
              status == Z_BUF_ERROR ? "the end of the file" : "damaged data", read);
    return false;
}

static bool unpack(input *in, GError **error)
{
    z_stream z = {0};
    if (inflateInit2(&z, 16 + MAX_WBITS) != Z_OK) {
        error_set(error, ERROR_FAILED, "zlib refuses to start");
        return false;
    }
    growing out = {0};
    bool done = inflate_all(&z, in->data, in->size, &out, error);
    inflateEnd(&z);
    if (!done) {
        big_free(out.data);
        return false;
    }
    big_free(in->data);
    *in = (input){out.data, out.size};
    return true;
}

/* Opening a pipe that nobody writes to would wait. */
int input_descriptor(const char *path, size_t *size, GError **error)
{
    GStatBuf status;
    int fd = g_open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, 0);
    if (fd < 0 || fstat(fd, &status) != 0)
        error_set(error, ERROR_INPUT, "cannot open '%s': %s", path, g_strerror(errno));
    else if (!S_ISREG(status.st_mode))
        error_set(error, ERROR_INPUT, "expected a file, found '%s', which is none", path);
    else {
        *size = (size_t)status.st_size;
        return fd;
    }
    if (fd >= 0)
        close(fd);
    return -1;
}

/* Bytes read, up to size or the end of the file; -1 with errno. */
static ssize_t fill(int fd, char *to, size_t size)
{
    size_t done = 0;
    while (done < size && still_wanted(NULL)) {
        ssize_t n = read(fd, to + done, MIN(size - done, (size_t)PIECE));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return -1;
        if (n == 0)
            break;
        done += (size_t)n;
    }
    return (ssize_t)done;
}

static bool read_all(input *in, int fd, size_t size, const char *path, GError **error)
{
    in->data = big_alloc(size + 1, 1, path, error);
    if (!in->data)
        return false;
    ssize_t n = fill(fd, in->data, size);
    if (n >= 0 && !still_wanted(error)) {
        input_close(in);
        return false;
    }
    if (n >= 0) {
        in->size = (size_t)n;
        return true;
    }
    error_set(error, ERROR_INPUT, "cannot read '%s': %s", path, g_strerror(errno));
    input_close(in);
    return false;
}

bool input_read(input *in, const char *path, GError **error)
{
    size_t size;
    *in = (input){0};
    int fd = input_descriptor(path, &size, error);
    if (fd < 0)
        return false;
    bool done = read_all(in, fd, size, path, error);
    close(fd);
    return done;
}

bool input_open(input *in, const char *path, GError **error)
{
    if (!input_read(in, path, error))
        return false;
    bool is_gzip = in->size >= 2 && memcmp(in->data, "\x1f\x8b", 2) == 0;
    if (!is_gzip || unpack(in, error))
        return true;
    g_prefix_error(error, "cannot read '%s': ", path);
    input_close(in);
    return false;
}

size_t input_peek(const char *path, char *to, size_t size)
{
    size_t whole;
    int fd = input_descriptor(path, &whole, NULL);
    ssize_t n = fd < 0 ? 0 : fill(fd, to, size);
    if (fd >= 0)
        close(fd);
    return n < 0 ? 0 : (size_t)n;
}

GBytes *input_bytes(const char *path, GError **error)
{
    input in;
    if (!input_read(&in, path, error))
        return NULL;
    return g_bytes_new_with_free_func(in.data, in.size, big_free, in.data);
}

void input_close(input *in)
{
    big_free(in->data);
    *in = (input){0};
}
