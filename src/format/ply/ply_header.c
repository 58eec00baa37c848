/*
 * The header of a PLY file: lines of words up to "end_header".
 */
#include "format/ply/ply_header.h"

#include "base/intern.h"

#include <string.h>

enum { MAX_WORDS = 6, LONGEST_LINE = 1000, MAX_PARTS = 1000 };

/** Where the reading of the header stands. */
typedef struct header_reader {
    ply_header *header;
    source_place place;
    const char *at, *end;
    char *words[MAX_WORDS]; /**< of the line; in `line` */
    int n_words;
    char line[LONGEST_LINE + 1];
} header_reader;

static const struct {
    const char *names[2];
    size_t size;
} types[] = {
    [PLY_INT8] = {{"char", "int8"}, 1},        [PLY_UINT8] = {{"uchar", "uint8"}, 1},
    [PLY_INT16] = {{"short", "int16"}, 2},     [PLY_UINT16] = {{"ushort", "uint16"}, 2},
    [PLY_INT32] = {{"int", "int32"}, 4},       [PLY_UINT32] = {{"uint", "uint32"}, 4},
    [PLY_FLOAT32] = {{"float", "float32"}, 4}, [PLY_FLOAT64] = {{"double", "float64"}, 8},
};

size_t ply_type_size(ply_type type)
{
    return types[type].size;
}

int ply_find_property(const ply_element *e, const char *name)
{
    for (guint i = 0; i < e->properties->len; i++)
        if (strcmp(ply_property_at(e, i)->name, name) == 0)
            return (int)i;
    return -1;
}

size_t ply_least_row(const ply_header *header, const ply_element *e)
{
    if (header->encoding == PLY_TEXT)
        return 2 * e->properties->len;
    size_t size = 0;
    for (guint i = 0; i < e->properties->len; i++) {
        const ply_property *p = ply_property_at(e, i);
        size += ply_type_size(p->is_list ? p->count_type : p->type);
    }
    return size;
}

static bool expected(const header_reader *r, const char *what, const char *found,
                     GError **error)
{
    g_autofree char *valid = found ? g_utf8_make_valid(found, -1) : NULL;
    error_at(error, r->place, "expected %s, found %s%s%s", what, valid ? "'" : "",
             valid ? valid : "the end of the line", valid ? "'" : "");
    return false;
}

/** The next line, split into words. */
static bool next_line(header_reader *r, GError **error)
{
    const char *newline =
        r->at < r->end ? memchr(r->at, '\n', (size_t)(r->end - r->at)) : NULL;
    r->place.line++;
    if (!newline) {
        error_at(error, r->place, "expected end_header, found the end of the file");
        return false;
    }
    size_t length = (size_t)(newline - r->at);
    if (length > LONGEST_LINE) {
        error_at(error, r->place, "expected a line of at most %d characters, found %zu",
                 LONGEST_LINE, length);
        return false;
    }
    memcpy(r->line, r->at, length);
    r->line[length] = '\0';
    r->at = newline + 1;
    r->n_words = 0;
    for (char *at = r->line; r->n_words < MAX_WORDS;) {
        at += strspn(at, " \t\r");
        if (!*at)
            break;
        r->words[r->n_words++] = at;
        at += strcspn(at, " \t\r");
        if (*at)
            *at++ = '\0';
    }
    return true;
}

static const char *word(const header_reader *r, int i)
{
    return i < r->n_words ? r->words[i] : NULL;
}

static bool read_encoding(header_reader *r, GError **error)
{
    static const char *const names[] = {[PLY_TEXT] = "ascii",
                                        [PLY_LITTLE_ENDIAN] = "binary_little_endian",
                                        [PLY_BIG_ENDIAN] = "binary_big_endian"};
    for (size_t i = 0; r->n_words >= 2 && i < G_N_ELEMENTS(names); i++)
        if (strcmp(names[i], r->words[1]) == 0) {
            r->header->encoding = (ply_encoding)i;
            return true;
        }
    return expected(r, "ascii, binary_little_endian or binary_big_endian", word(r, 1),
                    error);
}

static bool read_element(header_reader *r, GError **error)
{
    ply_element e = {0};
    guint64 count;
    if (r->n_words < 3)
        return expected(r, "an element's name and number", NULL, error);
    if (g_strlcpy(e.name, r->words[1], sizeof e.name) >= sizeof e.name)
        return expected(r, "a shorter name", r->words[1], error);
    if (!g_ascii_string_to_unsigned(r->words[2], 10, 0, G_MAXINT64, &count, NULL))
        return expected(r, "a number of elements", r->words[2], error);
    if (r->header->elements->len >= MAX_PARTS)
        return expected(r, "fewer elements", e.name, error);
    e.count = (size_t)count;
    e.properties = g_array_new(FALSE, FALSE, sizeof(ply_property));
    g_array_append_val(r->header->elements, e);
    return true;
}

static bool read_type(const header_reader *r, int i, bool is_count, ply_type *out,
                      GError **error)
{
    const char *name = word(r, i);
    int n_types = is_count ? PLY_FLOAT32 : (int)G_N_ELEMENTS(types);
    for (int t = 0; name && t < n_types; t++)
        if (strcmp(types[t].names[0], name) == 0 ||
            strcmp(types[t].names[1], name) == 0) {
            *out = (ply_type)t;
            return true;
        }
    return expected(r, is_count ? "an integer type" : "a type", name, error);
}

static bool read_property(header_reader *r, GError **error)
{
    ply_header *h = r->header;
    ply_property p = {0};
    if (h->elements->len == 0)
        return expected(r, "an element before its properties", r->words[0], error);
    const ply_element *e = ply_element_at(h, h->elements->len - 1);
    p.is_list = r->n_words > 1 && strcmp(r->words[1], "list") == 0;
    if (p.is_list && !read_type(r, 2, true, &p.count_type, error))
        return false;
    if (!read_type(r, p.is_list ? 3 : 1, false, &p.type, error))
        return false;
    const char *name = word(r, p.is_list ? 4 : 2);
    if (!name || g_strlcpy(p.name, name, sizeof p.name) >= sizeof p.name)
        return expected(r, "a property's name", name, error);
    if (ply_find_property(e, p.name) >= 0 || e->properties->len >= MAX_PARTS)
        return expected(r, "each property once", name, error);
    g_array_append_val(e->properties, p);
    return true;
}

/** One line after "ply". *done: it was the last. */
static bool read_line(header_reader *r, bool *has_encoding, bool *done, GError **error)
{
    const char *first = word(r, 0);
    if (!first || strcmp(first, "comment") == 0 || strcmp(first, "obj_info") == 0)
        return true;
    if (strcmp(first, "format") == 0) {
        *has_encoding = true;
        return read_encoding(r, error);
    }
    if (strcmp(first, "element") == 0)
        return read_element(r, error);
    if (strcmp(first, "property") == 0)
        return read_property(r, error);
    if (strcmp(first, "end_header") != 0)
        return expected(r, "format, element, property, comment or end_header", first,
                        error);
    *done = true;
    return *has_encoding || expected(r, "a format before end_header", first, error);
}

static bool read_all(header_reader *r, GError **error)
{
    bool has_encoding = false, done = false;
    if (r->end - r->at < 4 || memcmp(r->at, "ply", 3) != 0 ||
        (r->at[3] != '\n' && r->at[3] != '\r')) {
        r->place.line = 1;
        error_at(error, r->place,
                 "expected 'ply' on the first line, found something "
                 "else");
        return false;
    }
    if (!next_line(r, error))
        return false;
    while (!done)
        if (!next_line(r, error) || !read_line(r, &has_encoding, &done, error))
            return false;
    return true;
}

bool ply_header_read(ply_header *header, const char *file, const char *data, size_t size,
                     GError **error)
{
    *header = (ply_header){.elements = g_array_new(FALSE, FALSE, sizeof(ply_element))};
    header_reader r = {
        .header = header, .place = {intern(file), 0, 1}, .at = data, .end = data + size};
    bool fine = read_all(&r, error);
    header->size = (size_t)(r.at - data);
    header->n_lines = r.place.line;
    if (!fine)
        ply_header_clear(header);
    return fine;
}

void ply_header_clear(ply_header *header)
{
    for (guint i = 0; header->elements && i < header->elements->len; i++)
        g_array_unref(ply_element_at(header, i)->properties);
    g_clear_pointer(&header->elements, g_array_unref);
}
