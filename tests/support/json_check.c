#include "json_check.h"

#include <ctype.h>
#include <glib.h>
#include <math.h>
#include <string.h>

static const char *read_value(const char *c);

static const char *skip_blanks(const char *c)
{
    return c ? c + strspn(c, " \t\r\n") : NULL;
}

static const char *read_char(const char *c, char wanted)
{
    c = skip_blanks(c);
    return c && *c == wanted ? c + 1 : NULL;
}

static const char *read_string(const char *c)
{
    c = read_char(c, '"');
    for (; c && *c != '"'; c++) {
        if ((unsigned char)*c < 0x20)
            return NULL;
        if (*c == '\\' && !strchr("\"\\/bfnrtu", *++c))
            return NULL;
    }
    return c ? c + 1 : NULL;
}

static const char *read_number(const char *c)
{
    const char *begin = c;
    c += *c == '-';
    if (*c == '0' && isdigit((unsigned char)c[1]))
        return NULL;
    size_t whole = strspn(c, "0123456789");
    c += whole;
    if (whole == 0)
        return NULL;
    if (*c == '.' && !isdigit((unsigned char)c[1]))
        return NULL;
    char *end = NULL;
    g_ascii_strtod(begin, &end);
    return end;
}

/* Members of an object (with keys) or an array, from behind the opening bracket. */
static const char *read_members(const char *c, bool keys, char close)
{
    if (read_char(c, close))
        return read_char(c, close);
    do {
        if (keys)
            c = read_char(read_string(skip_blanks(c)), ':');
        c = skip_blanks(read_value(c));
    } while (c && *c == ',' && c++);
    return read_char(c, close);
}

static const char *read_value(const char *c)
{
    static const char *const words[] = {"true", "false", "null"};
    c = skip_blanks(c);
    if (!c || !*c)
        return NULL;
    if (*c == '{' || *c == '[')
        return read_members(c + 1, *c == '{', *c == '{' ? '}' : ']');
    if (*c == '"')
        return read_string(c);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (g_str_has_prefix(c, words[i]))
            return c + strlen(words[i]);
    return read_number(c);
}

bool json_is_valid(const char *text)
{
    const char *end = skip_blanks(read_value(text));
    return end && !*end && g_utf8_validate(text, -1, NULL);
}

double json_find_number(const char *text, const char *key)
{
    g_autofree char *quoted = g_strdup_printf("\"%s\":", key);
    const char *at = strstr(text, quoted);
    char *end = NULL;
    double value = at ? g_ascii_strtod(at + strlen(quoted), &end) : (double)NAN;
    return at && end > at + strlen(quoted) ? value : (double)NAN;
}
