/*
 * JSON values by their paths, over JSON-GLib.
 */
#include "format/json_read.h"

#include "base/intern.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* JSON-GLib parses by recursion. */
enum { MAX_NESTING = 200 };

/* What JSON-GLib makes of a value of two characters, of an object and of a name; it ends
 * the program where that is not to be had. */
enum { VALUE_SIZE = 96, OBJECT_SIZE = 256, NAME_SIZE = 128 };

/* Line of the first bracket that nests too deep, or 0. */
static int line_too_deep(const char *text, size_t size)
{
    int depth = 0, line = 1;
    bool in_string = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        line += c == '\n';
        if (in_string) {
            i += c == '\\';
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > MAX_NESTING)
                return line;
        } else if (c == ']' || c == '}') {
            depth--;
        }
    }
    return 0;
}

/* Asks for as much memory as the values will take, and gives it back. */
static bool has_room(const char *text, size_t size, GError **error)
{
    size_t bytes = VALUE_SIZE;
    for (size_t i = 0; i < size; i++)
        switch (text[i]) {
        case '{':
        case '[':
            bytes += OBJECT_SIZE;
            break;
        case ':':
            bytes += NAME_SIZE;
            break;
        case ',':
            bytes += VALUE_SIZE;
        }
    return memory_ask(bytes, "JSON", error);
}

/* JSON-GLib's message "<data>:LINE:COLUMN: Parse error: ..." with our place. */
static void tell_parse_error(const json_reader *reader, const char *message,
                             GError **error)
{
    source_place place = {reader->file, 0, 0};
    const char *what = strstr(message, "Parse error: ");
    int line, column;
    if (sscanf(message, "<data>:%d:%d:", &line, &column) == 2)
        place = (source_place){reader->file, line, column};
    error_at(error, place, "expected JSON: %s",
             what ? what + strlen("Parse error: ") : message);
}

bool json_open(json_reader *reader, const char *file, const char *text, size_t size,
               GError **error)
{
    *reader = (json_reader){.file = intern(file)};
    source_place place = {reader->file, line_too_deep(text, size), 1};
    if (place.line > 0) {
        error_at(error, place, "expected at most %d brackets within each other",
                 MAX_NESTING);
        return false;
    }
    if (!has_room(text, size, error))
        return false;
    g_autoptr(GError) inner = NULL;
    reader->parser = json_parser_new_immutable();
    if (!g_utf8_validate(text, (gssize)size, NULL))
        error_at(error, (source_place){reader->file, 0, 0}, "expected JSON in UTF-8");
    else if (!json_parser_load_from_data(reader->parser, text, (gssize)size, &inner))
        tell_parse_error(reader, inner->message, error);
    else if (!json_parser_get_root(reader->parser))
        error_at(error, (source_place){reader->file, 0, 0},
                 "expected JSON, found nothing");
    else
        return true;
    json_close(reader);
    return false;
}

void json_close(json_reader *reader)
{
    g_clear_object(&reader->parser);
    g_clear_error(&reader->error);
}

json_value json_root(json_reader *reader)
{
    return (json_value){.reader = reader, .node = json_parser_get_root(reader->parser)};
}

char *json_path(const json_value *v)
{
    if (!v->parent)
        return g_strdup("");
    g_autofree char *before = json_path(v->parent);
    if (!v->key)
        return g_strdup_printf("%s[%u]", before, v->index);
    return g_strdup_printf("%s%s%s", before, *before ? "." : "", v->key);
}

void json_fail(const json_value *at, const char *format, ...)
{
    if (at->reader->error)
        return;
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args), *path = json_path(at);
    va_end(args);
    error_at(&at->reader->error, (source_place){at->reader->file, 0, 0}, "%s%s%s", path,
             *path ? ": " : "", text);
}

json_value json_member(const json_value *of, const char *key)
{
    json_value v = {.reader = of->reader, .parent = of, .key = key};
    if (!of->node)
        return v;
    if (JSON_NODE_HOLDS_OBJECT(of->node))
        v.node = json_object_get_member(json_node_get_object(of->node), key);
    else
        json_fail(of, "expected an object");
    return v;
}

guint json_length(const json_value *v)
{
    if (!v->node)
        return 0;
    if (JSON_NODE_HOLDS_ARRAY(v->node))
        return json_array_get_length(json_node_get_array(v->node));
    json_fail(v, "expected an array");
    return 0;
}

json_value json_element(const json_value *of, guint index)
{
    json_value v = {.reader = of->reader, .parent = of, .index = index};
    guint n = json_length(of);
    if (index < n)
        v.node = json_array_get_element(json_node_get_array(of->node), index);
    else
        json_fail(of, "expected more than %u element%s, found %u", index,
                  index == 1 ? "" : "s", n);
    return v;
}

static bool is_number(JsonNode *node)
{
    GType type = JSON_NODE_HOLDS_VALUE(node) ? json_node_get_value_type(node) : 0;
    return type == G_TYPE_INT64 || type == G_TYPE_DOUBLE;
}

static bool read_number(const json_value *v, double *out)
{
    if (is_number(v->node)) {
        double x = json_node_get_double(v->node);
        if (isfinite(x) && isfinite((float)x)) {
            *out = x;
            return true;
        }
    }
    json_fail(v, "expected a number");
    return false;
}

double json_real(const json_value *of, const char *key, double fallback)
{
    json_value v = json_member(of, key);
    if (v.node)
        read_number(&v, &fallback);
    return fallback;
}

bool json_flag(const json_value *of, const char *key, bool fallback)
{
    json_value v = json_member(of, key);
    if (!v.node)
        return fallback;
    if (JSON_NODE_HOLDS_VALUE(v.node) &&
        json_node_get_value_type(v.node) == G_TYPE_BOOLEAN)
        return json_node_get_boolean(v.node);
    json_fail(&v, "expected true or false");
    return fallback;
}

const char *json_text(const json_value *of, const char *key)
{
    json_value v = json_member(of, key);
    if (!v.node)
        return NULL;
    if (JSON_NODE_HOLDS_VALUE(v.node) &&
        json_node_get_value_type(v.node) == G_TYPE_STRING)
        return json_node_get_string(v.node);
    json_fail(&v, "expected a string");
    return NULL;
}

static gint64 read_whole(const json_value *v, gint64 most)
{
    double x = is_number(v->node) ? json_node_get_double(v->node) : -1.0;
    if (x >= 0.0 && x <= (double)most && !(x > floor(x)))
        return (gint64)x;
    json_fail(v, "expected a whole number in 0..%" G_GINT64_FORMAT, most);
    return -1;
}

gint64 json_whole(const json_value *of, const char *key, gint64 most)
{
    json_value v = json_member(of, key);
    return v.node ? read_whole(&v, most) : -1;
}

gint64 json_whole_at(const json_value *of, guint index, gint64 most)
{
    json_value v = json_element(of, index);
    return v.node ? read_whole(&v, most) : -1;
}

double json_real_at(const json_value *of, guint index)
{
    json_value v = json_element(of, index);
    double x = 0.0;
    if (v.node)
        read_number(&v, &x);
    return x;
}

bool json_numbers(const json_value *of, const char *key, double *out, guint n)
{
    json_value v = json_member(of, key);
    double all[16];
    if (!v.node)
        return false;
    if (json_length(&v) != n || n > G_N_ELEMENTS(all)) {
        json_fail(&v, "expected %u numbers, found %u", n, json_length(&v));
        return false;
    }
    for (guint i = 0; i < n; i++) {
        json_value element = json_element(&v, i);
        if (!read_number(&element, &all[i]))
            return false;
    }
    memcpy(out, all, n * sizeof *out);
    return true;
}
