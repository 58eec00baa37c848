#include "render/checkpoint.h"

#include "base/input.h"
#include "base/output.h"
#include "render/film_planes.h"

#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum {
    BLOCK = 1 << 20,
    MOST_HEADER = 1 << 20,
    FIRST_LINE = 64, /* at most */
};

static const char magic[] = "nephroid checkpoint ";
static const char form[] = "1";

void checkpoint_clear(checkpoint *c)
{
    g_free(c->program);
    g_free(c->scene);
    g_free(c->plan);
    *c = (checkpoint){0};
}

/* ---- The header's fields ---- */

#define COUNT(field)                                                                     \
    {                                                                                    \
#field, offsetof(render_statistics, field), false                                \
    }
#define REAL(field)                                                                      \
    {                                                                                    \
#field, offsetof(render_statistics, field), true                                 \
    }

/* What of the statistics goes on; all of 8 bytes. */
static const struct count_row {
    const char *name;
    size_t offset;
    bool is_real; /* else int64_t or uint64_t */
} counts[] = {
    COUNT(passes),      REAL(time_total),   REAL(time_prepare),  REAL(time_trace),
    REAL(time_build),   REAL(time_gather),  REAL(time_camera),   COUNT(photon_rays),
    COUNT(camera_rays), COUNT(shadow_rays), COUNT(n_not_finite), COUNT(memory_photons),
    COUNT(emitted[0]),  COUNT(emitted[1]),  COUNT(emitted[2]),   COUNT(stored[0]),
    COUNT(stored[1]),   COUNT(stored[2]),   REAL(radius[0]),     REAL(radius[1]),
    REAL(radius[2]),
};

_Static_assert(N_PHOTON_CLASSES == 3, "one row each");

static char **text_field(checkpoint *c, const char *name)
{
    return strcmp(name, "program") == 0 ? &c->program
           : strcmp(name, "scene") == 0 ? &c->scene
           : strcmp(name, "plan") == 0  ? &c->plan
                                        : NULL;
}

static void put_settings(GString *out, const char *word, const settings *s)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(s, &rows[i]);
        g_string_append_printf(out, "%s %s = %s\n", word, rows[i].name, value);
    }
}

static void put_counts(GString *out, const render_statistics *st)
{
    for (size_t i = 0; i < G_N_ELEMENTS(counts); i++) {
        const void *field = (const char *)st + counts[i].offset;
        char text[G_ASCII_DTOSTR_BUF_SIZE];
        if (counts[i].is_real)
            g_ascii_dtostr(text, sizeof text, *(const double *)field);
        else
            g_snprintf(text, sizeof text, "%" G_GUINT64_FORMAT, *(const uint64_t *)field);
        g_string_append_printf(out, "count %s = %s\n", counts[i].name, text);
    }
}

static GString *header_text(const checkpoint *c, const film *f)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n_planes = film_planes(f, planes);
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "program %s\nscene %s\nplan %s\nsize %d %d\n", c->program,
                           c->scene, c->plan, c->width, c->height);
    put_settings(out, "how", &c->how);
    put_settings(out, "asked", &c->asked);
    put_counts(out, &c->statistics);
    for (size_t i = 0; i < n_planes; i++)
        g_string_append_printf(out, "plane %s %zu\n", planes[i].name,
                               film_plane_bytes(&planes[i]));
    return out;
}

/* ---- Writing ---- */

static uint32_t checksum(const void *data, size_t size)
{
    return (uint32_t)crc32(0, data, (uInt)size);
}

static void write_plane(FILE *to, const film_plane *plane)
{
    size_t size = film_plane_bytes(plane);
    const char *data = plane->data;
    for (size_t at = 0; at < size; at += BLOCK) {
        size_t n = MIN(size - at, (size_t)BLOCK);
        uint32_t check = checksum(data + at, n);
        fwrite(data + at, 1, n, to);
        fwrite(&check, sizeof check, 1, to);
    }
}

bool checkpoint_write(const checkpoint *c, const film *f, const char *path,
                      GError **error)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes);
    output *out = output_open(path, error);
    if (!out)
        return false;
    GString *header = header_text(c, f);
    FILE *to = output_stream(out);
    fprintf(to, "%s%s %zu %08x\n", magic, form, (size_t)header->len,
            checksum(header->str, header->len));
    fwrite(header->str, 1, header->len, to);
    g_string_free(header, TRUE);
    for (size_t i = 0; i < n; i++)
        write_plane(to, &planes[i]);
    return output_commit(out, error);
}

/* ---- Reading ---- */

typedef struct reader {
    const char *path;
    FILE *from;
    size_t size;       /* of the file */
    GPtrArray *planes; /* char *, "NAME BYTES" */
} reader;

static bool refuse(const reader *r, GError **error, const char *format, ...)
    G_GNUC_PRINTF(3, 4);

static bool refuse(const reader *r, GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *why = g_strdup_vprintf(format, args);
    va_end(args);
    error_set(error, ERROR_INPUT, "%s: %s", r->path, why);
    return false;
}

static bool refuse_short(const reader *r, GError **error)
{
    return refuse(r, error, "the checkpoint is cut off after %zu bytes", r->size);
}

/* The first line. @return the header, owned by the caller; NULL with an error */
static char *read_header(const reader *r, GError **error)
{
    char line[FIRST_LINE];
    size_t length = 0;
    unsigned check = 0;
    char version[8] = "";
    if (!fgets(line, sizeof line, r->from) || !g_str_has_prefix(line, magic)) {
        refuse(r, error, "expected a checkpoint, found another file");
        return NULL;
    }
    if (sscanf(line + strlen(magic), "%7s %zu %x", version, &length, &check) < 1 ||
        strcmp(version, form) != 0) {
        refuse(r, error, "expected a checkpoint of form %s, found form '%s'", form,
               version);
        return NULL;
    }
    g_autofree char *text = length <= MOST_HEADER ? g_malloc0(length + 1) : NULL;
    if (!text || fread(text, 1, length, r->from) != length) {
        refuse_short(r, error);
        return NULL;
    }
    if (checksum(text, length) != check) {
        refuse(r, error, "the checkpoint is damaged: its header's checksum is wrong");
        return NULL;
    }
    return g_steal_pointer(&text);
}

static bool read_count(render_statistics *st, const char *name, const char *value)
{
    for (size_t i = 0; i < G_N_ELEMENTS(counts); i++) {
        if (strcmp(counts[i].name, name) != 0)
            continue;
        void *field = (char *)st + counts[i].offset;
        if (counts[i].is_real)
            *(double *)field = g_ascii_strtod(value, NULL);
        else
            *(uint64_t *)field = g_ascii_strtoull(value, NULL, 10);
        return !counts[i].is_real || isfinite(*(double *)field);
    }
    return false;
}

/* "KIND NAME = VALUE" or "KIND TEXT". */
static bool read_line(reader *r, checkpoint *c, char *line, GError **error)
{
    char *rest = strchr(line, ' ');
    if (!rest)
        return refuse(r, error, "the checkpoint is damaged: '%s'", line);
    *rest++ = '\0';
    char *value = strstr(rest, " = "), **text = text_field(c, line);
    bool is_how = strcmp(line, "how") == 0, is_asked = strcmp(line, "asked") == 0;
    if (text) {
        g_free(*text);
        *text = g_strdup(rest);
        return true;
    }
    if (strcmp(line, "plane") == 0) {
        g_ptr_array_add(r->planes, g_strdup(rest));
        return true;
    }
    if (strcmp(line, "size") == 0)
        return sscanf(rest, "%d %d", &c->width, &c->height) == 2;
    if (value)
        *value = '\0', value += strlen(" = ");
    if (value && (is_how || is_asked))
        return settings_set(is_how ? &c->how : &c->asked, rest, value, error);
    if (value && strcmp(line, "count") == 0 && read_count(&c->statistics, rest, value))
        return true;
    return refuse(r, error, "the checkpoint is damaged: '%s %s'", line, rest);
}

static bool read_lines(reader *r, checkpoint *c, const char *header, GError **error)
{
    g_auto(GStrv) lines = g_strsplit(header, "\n", -1);
    c->how = c->asked = settings_default();
    c->statistics.noise = (double)INFINITY;
    for (char **line = lines; *line; line++)
        if (**line && !read_line(r, c, *line, error))
            return false;
    int64_t passes = c->statistics.passes;
    bool has_passes = passes > 0 && passes <= G_MAXINT32;
    return (c->program && c->scene && c->plan && has_passes) ||
           refuse(r, error, "the checkpoint is damaged: its header is not whole");
}

/* The film's planes are those of the file. */
static bool check_planes(const reader *r, const film_plane *planes, size_t n,
                         GError **error)
{
    size_t bytes = (size_t)ftell(r->from);
    bool same = n == r->planes->len;
    for (size_t i = 0; i < n && same; i++) {
        size_t size = film_plane_bytes(&planes[i]);
        g_autofree char *expected = g_strdup_printf("%s %zu", planes[i].name, size);
        same = strcmp(expected, r->planes->pdata[i]) == 0;
        bytes += size + (size + BLOCK - 1) / BLOCK * sizeof(uint32_t);
    }
    if (!same)
        return refuse(r, error, "the checkpoint is of a picture with other layers");
    if (r->size < bytes)
        return refuse_short(r, error);
    return r->size == bytes ||
           refuse(r, error, "the checkpoint is damaged: something follows its end");
}

static bool read_plane(const reader *r, const film_plane *plane, GError **error)
{
    size_t size = film_plane_bytes(plane);
    char *data = plane->data;
    for (size_t at = 0; at < size; at += BLOCK) {
        size_t n = MIN(size - at, (size_t)BLOCK);
        uint32_t check;
        if (fread(data + at, 1, n, r->from) != n ||
            fread(&check, sizeof check, 1, r->from) != 1)
            return refuse_short(r, error);
        if (checksum(data + at, n) != check)
            return refuse(r, error,
                          "the checkpoint is damaged: a checksum of its film is wrong");
    }
    return true;
}

static bool read_film(const reader *r, film *f, GError **error)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes);
    bool ok = check_planes(r, planes, n, error);
    for (size_t i = 0; i < n && ok; i++)
        ok = read_plane(r, &planes[i], error);
    if (!ok)
        film_reset(f);
    return ok;
}

static bool read_all(reader *r, checkpoint *c, film *f, GError **error)
{
    g_autofree char *header = read_header(r, error);
    return header && read_lines(r, c, header, error) && (!f || read_film(r, f, error));
}

bool checkpoint_read(checkpoint *c, film *f, const char *path, GError **error)
{
    reader r = {.path = path};
    *c = (checkpoint){0};
    int fd = input_descriptor(path, &r.size, error);
    if (fd < 0)
        return false;
    r.from = fdopen(fd, "rb");
    if (!r.from) {
        close(fd);
        error_set(error, ERROR_FAILED, "cannot read %s", path);
        return false;
    }
    r.planes = g_ptr_array_new_with_free_func(g_free);
    bool ok = read_all(&r, c, f, error);
    g_ptr_array_unref(r.planes);
    fclose(r.from);
    if (ok && f)
        f->n_passes = c->statistics.passes;
    if (!ok)
        checkpoint_clear(c);
    return ok;
}
