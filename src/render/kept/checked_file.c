#include "render/kept/checked_file.h"

#include "base/input.h"
#include "base/wanted.h"

#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum {
    BLOCK = 1 << 20,
    MOST_HEADER = 1 << 20,
    FIRST_LINE = 96, /* at most */
};

static uint32_t checksum(const void *data, size_t size)
{
    return (uint32_t)crc32(0, data, (uInt)size);
}

/* ---- Writing ---- */

void checked_begin(FILE *to, const checked_kind *kind, const GString *header)
{
    fprintf(to, "nephroid %s %s %zu %08x\n", kind->word, kind->form, (size_t)header->len,
            checksum(header->str, header->len));
    fwrite(header->str, 1, header->len, to);
}

void checked_put(FILE *to, const void *data, size_t size)
{
    const char *bytes = data;
    for (size_t at = 0; at < size && still_wanted(NULL); at += BLOCK) {
        size_t n = MIN(size - at, (size_t)BLOCK);
        uint32_t check = checksum(bytes + at, n);
        fwrite(bytes + at, 1, n, to);
        fwrite(&check, sizeof check, 1, to);
    }
}

size_t checked_size(size_t size)
{
    return size + (size + BLOCK - 1) / BLOCK * sizeof(uint32_t);
}

/* ---- Reading ---- */

bool checked_refuse(const checked_reader *r, GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *why = g_strdup_vprintf(format, args);
    va_end(args);
    error_set(error, ERROR_INPUT, "%s: %s", r->path, why);
    return false;
}

bool checked_refuse_short(const checked_reader *r, GError **error)
{
    return checked_refuse(r, error, "the %s is cut off after %zu bytes", r->kind->name,
                          r->size);
}

bool checked_refuse_damaged(const checked_reader *r, const char *where, GError **error)
{
    return checked_refuse(r, error, "the %s is damaged: %s", r->kind->name, where);
}

/* The first line and what it is of. @return owned by the caller; NULL with an error */
static char *read_header(const checked_reader *r, GError **error)
{
    char line[FIRST_LINE];
    size_t length = 0;
    unsigned check = 0;
    char version[8] = "";
    g_autofree char *magic = g_strdup_printf("nephroid %s ", r->kind->word);
    if (!fgets(line, sizeof line, r->from) || !g_str_has_prefix(line, magic)) {
        checked_refuse(r, error, "expected a %s, found another file", r->kind->name);
        return NULL;
    }
    if (sscanf(line + strlen(magic), "%7s %zu %x", version, &length, &check) < 1 ||
        strcmp(version, r->kind->form) != 0) {
        checked_refuse(r, error, "expected a %s of form %s, found form '%s'",
                       r->kind->name, r->kind->form, version);
        return NULL;
    }
    g_autofree char *text = length <= MOST_HEADER ? g_malloc0(length + 1) : NULL;
    if (!text || fread(text, 1, length, r->from) != length) {
        checked_refuse_short(r, error);
        return NULL;
    }
    if (checksum(text, length) != check) {
        checked_refuse_damaged(r, "its header's checksum is wrong", error);
        return NULL;
    }
    return g_steal_pointer(&text);
}

char *checked_open(checked_reader *r, const checked_kind *kind, const char *path,
                   GError **error)
{
    *r = (checked_reader){.kind = kind};
    int fd = input_descriptor(path, &r->size, error);
    if (fd < 0)
        return NULL;
    r->from = fdopen(fd, "rb");
    if (!r->from) {
        close(fd);
        error_set(error, ERROR_FAILED, "cannot read %s", path);
        return NULL;
    }
    r->path = g_strdup(path);
    char *header = read_header(r, error);
    if (!header)
        checked_close(r);
    return header;
}

void checked_close(checked_reader *r)
{
    if (r->from)
        fclose(r->from);
    g_free(r->path);
    *r = (checked_reader){0};
}

bool checked_get(const checked_reader *r, void *data, size_t size, const char *what,
                 GError **error)
{
    char *bytes = data;
    for (size_t at = 0; at < size; at += BLOCK) {
        size_t n = MIN(size - at, (size_t)BLOCK);
        uint32_t check;
        if (!still_wanted(error))
            return false;
        if (fread(bytes + at, 1, n, r->from) != n ||
            fread(&check, sizeof check, 1, r->from) != 1)
            return checked_refuse_short(r, error);
        if (checksum(bytes + at, n) == check)
            continue;
        g_autofree char *where = g_strdup_printf("a checksum of its %s is wrong", what);
        return checked_refuse_damaged(r, where, error);
    }
    return true;
}

size_t checked_at(const checked_reader *r)
{
    return (size_t)ftello(r->from);
}

bool checked_skip(const checked_reader *r, size_t size, GError **error)
{
    size_t stored = checked_size(size), at = checked_at(r);
    if (stored < size || stored > r->size - MIN(at, r->size) ||
        fseeko(r->from, (off_t)(at + stored), SEEK_SET) != 0)
        return checked_refuse_short(r, error);
    return true;
}
