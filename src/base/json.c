#include "base/json.h"

#include <math.h>
#include <string.h>

enum { FLOAT_DIGITS = 9, DOUBLE_DIGITS = 17 };

static bool reads_back(const char *text, double value, int digits)
{
    const double back = g_ascii_strtod(text, NULL);
    if (digits == DOUBLE_DIGITS)
        return memcmp(&back, &value, sizeof back) == 0;
    const float near = (float)back, wanted = (float)value;
    return memcmp(&near, &wanted, sizeof near) == 0;
}

/* Few digits, but 100 rather than 1e+02. */
static const char *shortest(double value, int most_digits, char *buffer)
{
    const bool plain = fabs(value) >= 1.0 && fabs(value) < 1e15;
    const int least = plain ? 1 + (int)floor(log10(fabs(value)) + 1e-9) : 1;
    for (int digits = least; digits <= MAX(least, most_digits); digits++) {
        char format[8];
        g_snprintf(format, sizeof format, "%%.%dg", digits);
        g_ascii_formatd(buffer, G_ASCII_DTOSTR_BUF_SIZE, format, value);
        if (reads_back(buffer, value, most_digits))
            break;
    }
    return buffer;
}

const char *number_text(double value, char buffer[G_ASCII_DTOSTR_BUF_SIZE])
{
    return shortest(value, DOUBLE_DIGITS, buffer);
}

static void put_quoted(GString *out, const char *text)
{
    g_autofree char *valid = g_utf8_make_valid(text, -1);
    g_string_append_c(out, '"');
    for (const char *c = valid; *c; c++) {
        if (*c == '"' || *c == '\\')
            g_string_append_printf(out, "\\%c", *c);
        else if (*c == '\n')
            g_string_append(out, "\\n");
        else if (*c == '\t')
            g_string_append(out, "\\t");
        else if ((unsigned char)*c < 0x20 || *c == 0x7f)
            g_string_append_printf(out, "\\u%04x", (unsigned char)*c);
        else
            g_string_append_c(out, *c);
    }
    g_string_append_c(out, '"');
}

static void new_line(json *j)
{
    g_string_append_printf(j->text, "\n%*s", (int)(2 * j->depth), "");
}

/* What stands before every value: comma, place and key. */
static void begin_member(json *j, const char *key)
{
    if (!j->text)
        j->text = g_string_new(NULL);
    if (j->has_members)
        g_string_append_c(j->text, ',');
    if (j->depth)
        new_line(j);
    if (key) {
        put_quoted(j->text, key);
        g_string_append(j->text, ": ");
    }
    j->has_members = true;
}

static void open_bracket(json *j, const char *key, char bracket)
{
    begin_member(j, key);
    g_string_append_c(j->text, bracket);
    j->depth++;
    j->has_members = false;
}

static void close_bracket(json *j, char bracket)
{
    j->depth--;
    if (j->has_members)
        new_line(j);
    g_string_append_c(j->text, bracket);
    j->has_members = true;
}

void json_object_begin(json *j, const char *key)
{
    open_bracket(j, key, '{');
}

void json_object_end(json *j)
{
    close_bracket(j, '}');
}

void json_array_begin(json *j, const char *key)
{
    open_bracket(j, key, '[');
}

void json_array_end(json *j)
{
    close_bracket(j, ']');
}

void json_string(json *j, const char *key, const char *value)
{
    begin_member(j, key);
    if (value)
        put_quoted(j->text, value);
    else
        g_string_append(j->text, "null");
}

static void put_number(GString *out, double value, int most_digits)
{
    char buffer[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append(out, isfinite(value) ? shortest(value, most_digits, buffer) : "null");
}

void json_number(json *j, const char *key, double value)
{
    begin_member(j, key);
    put_number(j->text, value, DOUBLE_DIGITS);
}

void json_float(json *j, const char *key, float value)
{
    begin_member(j, key);
    put_number(j->text, (double)value, FLOAT_DIGITS);
}

void json_integer(json *j, const char *key, int64_t value)
{
    begin_member(j, key);
    g_string_append_printf(j->text, "%" G_GINT64_FORMAT, value);
}

void json_count(json *j, const char *key, uint64_t value)
{
    begin_member(j, key);
    g_string_append_printf(j->text, "%" G_GUINT64_FORMAT, value);
}

void json_bool(json *j, const char *key, bool value)
{
    begin_member(j, key);
    g_string_append(j->text, value ? "true" : "false");
}

void json_floats(json *j, const char *key, const float *values, size_t n)
{
    begin_member(j, key);
    g_string_append_c(j->text, '[');
    for (size_t i = 0; i < n; i++) {
        if (i)
            g_string_append(j->text, ", ");
        put_number(j->text, (double)values[i], FLOAT_DIGITS);
    }
    g_string_append_c(j->text, ']');
}

char *json_finish(json *j)
{
    g_string_append_c(j->text, '\n');
    char *text = g_string_free(j->text, FALSE);
    *j = (json){0};
    return text;
}
