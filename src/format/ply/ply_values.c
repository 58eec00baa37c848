/*
 * The values of a PLY file's body.
 */
#include "format/ply/ply_values.h"

#include "format/number.h"

#include <math.h>
#include <string.h>

bool ply_fail(const ply_reader *r, GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (r->header.encoding == PLY_TEXT)
        error_set(error, ERROR_INPUT, "%s:%d:%d: %s", r->file, r->line,
                  (int)(r->at - r->line_start) + 1, text);
    else
        error_set(error, ERROR_INPUT, "%s: byte %zu: %s", r->file,
                  (size_t)(r->at - r->begin), text);
    return false;
}

size_t ply_remaining(const ply_reader *r)
{
    return (size_t)(r->end - r->at);
}

double ply_load(const char *from, ply_type type, bool swap)
{
    union {
        uint8_t u8;
        int8_t i8;
        uint16_t u16;
        int16_t i16;
        uint32_t u32;
        int32_t i32;
        uint64_t u64;
        float f32;
        double f64;
    } v;
    memcpy(&v, from, ply_type_size(type));
    if (swap && ply_type_size(type) == 2)
        v.u16 = GUINT16_SWAP_LE_BE(v.u16);
    else if (swap && ply_type_size(type) == 4)
        v.u32 = GUINT32_SWAP_LE_BE(v.u32);
    else if (swap && ply_type_size(type) == 8)
        v.u64 = GUINT64_SWAP_LE_BE(v.u64);
    switch (type) {
    case PLY_INT8:
        return v.i8;
    case PLY_UINT8:
        return v.u8;
    case PLY_INT16:
        return v.i16;
    case PLY_UINT16:
        return v.u16;
    case PLY_INT32:
        return v.i32;
    case PLY_UINT32:
        return v.u32;
    case PLY_FLOAT32:
        return (double)v.f32;
    case PLY_FLOAT64:
        break;
    }
    return v.f64;
}

/** The next word of a text file; 0 long at its end. */
static size_t next_word(ply_reader *r)
{
    for (; r->at < r->end && g_ascii_isspace(*r->at); r->at++)
        if (*r->at == '\n') {
            r->line++;
            r->line_start = r->at + 1;
        }
    const char *p = r->at;
    while (p < r->end && !g_ascii_isspace(*p))
        p++;
    return (size_t)(p - r->at);
}

/* "nan", "-nan(ind)", "inf": what is no number, as programs write it. */
static bool is_no_number(const char *word, size_t length)
{
    size_t sign = length > 0 && (*word == '-' || *word == '+');
    return length >= sign + 3 && (g_ascii_strncasecmp(word + sign, "nan", 3) == 0 ||
                                  g_ascii_strncasecmp(word + sign, "inf", 3) == 0);
}

static bool read_word(ply_reader *r, ply_type type, double *out, GError **error)
{
    size_t length = next_word(r);
    if (length == 0)
        return ply_fail(r, error, "expected a number, found the end of the file");
    float single = 0.0f;
    bool is_single = type == PLY_FLOAT32;
    bool fine = is_single ? number_float(r->at, length, &single)
                          : number_double(r->at, length, out);
    if (!fine && is_no_number(r->at, length)) {
        *out = (double)NAN;
        single = NAN;
    } else if (!fine) {
        g_autofree char *found = g_utf8_make_valid(r->at, (gssize)MIN(length, 60));
        return ply_fail(r, error, "expected a number, found '%s'", found);
    }
    if (is_single)
        *out = (double)single;
    r->at += length;
    return true;
}

bool ply_read_number(ply_reader *r, ply_type type, double *out, GError **error)
{
    if (r->header.encoding == PLY_TEXT)
        return read_word(r, type, out, error);
    if (ply_remaining(r) < ply_type_size(type))
        return ply_fail(r, error, "expected a number, found the end of the file");
    *out = ply_load(r->at, type, r->swap);
    r->at += ply_type_size(type);
    return true;
}

bool ply_read_length(ply_reader *r, const ply_property *p, size_t *n, GError **error)
{
    double length;
    if (!ply_read_number(r, p->count_type, &length, error))
        return false;
    if (!(length >= 0.0 && length <= 4294967295.0) || length > floor(length))
        return ply_fail(r, error, "expected a list's length, found %g", length);
    *n = (size_t)length;
    return true;
}

static bool skip_numbers(ply_reader *r, ply_type type, size_t n, GError **error)
{
    if (r->header.encoding == PLY_TEXT) {
        double ignored;
        for (size_t i = 0; i < n; i++)
            if (!read_word(r, PLY_FLOAT64, &ignored, error))
                return false;
        return true;
    }
    if (ply_remaining(r) / ply_type_size(type) < n)
        return ply_fail(r, error, "expected %zu numbers, found the end of the file", n);
    r->at += n * ply_type_size(type);
    return true;
}

bool ply_skip_property(ply_reader *r, const ply_property *p, GError **error)
{
    size_t n = 1;
    return (!p->is_list || ply_read_length(r, p, &n, error)) &&
           skip_numbers(r, p->type, n, error);
}
