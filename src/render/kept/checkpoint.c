#include "render/kept/checkpoint.h"

#include "base/output.h"
#include "base/wanted.h"
#include "render/film/film_planes.h"
#include "render/kept/checked_file.h"

#include <string.h>

static const checked_kind kind = {"checkpoint", "checkpoint", "1"};

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
    output_watch(out, wanted_flag());
    checked_begin(to, &kind, header);
    g_string_free(header, TRUE);
    for (size_t i = 0; i < n; i++)
        checked_put(to, planes[i].data, film_plane_bytes(&planes[i]));
    return output_commit(out, error);
}

/* ---- Reading ---- */

typedef struct reader {
    checked_reader file;
    GPtrArray *planes; /* char *, "NAME BYTES" */
} reader;

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
        return checked_refuse_damaged(&r->file, line, error);
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
    return checked_refuse(&r->file, error, "the checkpoint is damaged: '%s %s'", line,
                          rest);
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
           checked_refuse_damaged(&r->file, "its header is not whole", error);
}

/* The film's planes are those of the file. */
static bool check_planes(const reader *r, const film_plane *planes, size_t n,
                         GError **error)
{
    size_t bytes = checked_at(&r->file);
    bool same = n == r->planes->len;
    for (size_t i = 0; i < n && same; i++) {
        size_t size = film_plane_bytes(&planes[i]);
        g_autofree char *expected = g_strdup_printf("%s %zu", planes[i].name, size);
        same = strcmp(expected, r->planes->pdata[i]) == 0;
        bytes += checked_size(size);
    }
    if (!same)
        return checked_refuse(&r->file, error,
                              "the checkpoint is of a picture with other layers");
    if (r->file.size < bytes)
        return checked_refuse_short(&r->file, error);
    return r->file.size == bytes ||
           checked_refuse_damaged(&r->file, "something follows its end", error);
}

static bool read_film(const reader *r, film *f, GError **error)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes);
    bool ok = check_planes(r, planes, n, error);
    for (size_t i = 0; i < n && ok; i++)
        ok = checked_get(&r->file, planes[i].data, film_plane_bytes(&planes[i]), "film",
                         error);
    if (!ok)
        film_reset(f);
    return ok;
}

bool checkpoint_read(checkpoint *c, film *f, const char *path, GError **error)
{
    reader r;
    *c = (checkpoint){0};
    g_autofree char *header = checked_open(&r.file, &kind, path, error);
    if (!header)
        return false;
    r.planes = g_ptr_array_new_with_free_func(g_free);
    bool ok = read_lines(&r, c, header, error) && (!f || read_film(&r, f, error));
    g_ptr_array_unref(r.planes);
    checked_close(&r.file);
    if (ok && f)
        f->n_passes = c->statistics.passes;
    if (!ok)
        checkpoint_clear(c);
    return ok;
}
