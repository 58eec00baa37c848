/*
 * Writing what pbrt_params.c reads. Nine digits keep a float, seventeen a double.
 */
#include "format/pbrt/pbrt_text.h"

enum { PER_LINE = 12 };

static void append_number(GString *out, const char *format, double x)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append(out, g_ascii_formatd(text, sizeof text, format, x));
}

void pbrt_text_transform(GString *out, const double m[4][4])
{
    g_string_append(out, "Transform [");
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            g_string_append_c(out, ' ');
            append_number(out, "%.17g", m[row][column]);
        }
    g_string_append(out, " ]\n");
}

void pbrt_text_string(GString *out, const char *text)
{
    g_string_append_c(out, '"');
    for (const char *c = text; *c; c++) {
        if (*c == '"' || *c == '\\')
            g_string_append_c(out, '\\');
        if (*c == '\n')
            g_string_append(out, "\\n");
        else
            g_string_append_c(out, *c);
    }
    g_string_append_c(out, '"');
}

static void append_value(GString *out, const param *q, char *const *strings, size_t i)
{
    if (q->strings)
        pbrt_text_string(out, strings[i]);
    else if (q->type == PARAM_BOOL)
        g_string_append(out, q->integers[i] ? "true" : "false");
    else if (q->integers)
        g_string_append_printf(out, "%d", q->integers[i]);
    else
        append_number(out, "%.9g", (double)q->numbers[i]);
}

void pbrt_text_param(GString *out, const param *q, char *const *strings)
{
    g_string_append_printf(out, " \"%s %s\" [", param_type_name(q->type), q->name);
    for (size_t i = 0; i < q->n; i++) {
        g_string_append_c(out, i > 0 && i % PER_LINE == 0 ? '\n' : ' ');
        append_value(out, q, strings ? strings : q->strings, i);
    }
    g_string_append(out, " ]");
}
