/*
 * Whole input files, mapped or inflated.
 */
#include "format/input.h"

#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

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
    size_t room = MIN(out->capacity - out->size, (size_t)1 << 30);
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
        if (!make_room(out, error))
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
    in->inflated = out.data;
    in->data = out.data;
    in->size = out.size;
    return true;
}

static GMappedFile *map_file(const char *path, GError **error)
{
    GStatBuf status;
    int fd = g_open(path, O_RDONLY | O_CLOEXEC, 0);
    if (fd < 0 || fstat(fd, &status) != 0) {
        error_set(error, ERROR_INPUT, "cannot open '%s': %s", path, g_strerror(errno));
        return NULL;
    }
    GMappedFile *map = NULL;
    g_autoptr(GError) inner = NULL;
    if (!S_ISREG(status.st_mode))
        error_set(error, ERROR_INPUT, "expected a file, found '%s', which is none", path);
    else if (!(map = g_mapped_file_new_from_fd(fd, FALSE, &inner)))
        error_set(error, ERROR_INPUT, "cannot read '%s': %s", path, inner->message);
    g_close(fd, NULL);
    return map;
}

bool input_open(input *in, const char *path, GError **error)
{
    *in = (input){0};
    in->map = map_file(path, error);
    if (!in->map)
        return false;
    in->size = g_mapped_file_get_length(in->map);
    in->data = in->size ? g_mapped_file_get_contents(in->map) : "";
    bool is_gzip = in->size >= 2 && memcmp(in->data, "\x1f\x8b", 2) == 0;
    if (!is_gzip || unpack(in, error))
        return true;
    g_prefix_error(error, "cannot read '%s': ", path);
    input_close(in);
    return false;
}

void input_close(input *in)
{
    if (in->map)
        g_mapped_file_unref(in->map);
    big_free(in->inflated);
    *in = (input){0};
}
