/*
 * A view written as pbrt directives, and put into a scene file in place of its own.
 *
 * What stands before Camera may be any sequence of transforms, so the new view begins
 * with Identity; it goes right before the Camera directive, on one line that is known
 * again:
 *
 *   Identity LookAt ...  # saved view
 *   Camera "perspective" "float fov" 40
 *
 * The old transforms stay, without effect on the camera. In the Camera directive only the
 * numbers of fov, lensradius and focaldistance are changed, or added; in one of another
 * kind than perspective, nothing.
 */
#include "api/objects.h"

#include "base/input.h"
#include "base/output.h"

#include <string.h>

#define MARK "  # saved view"

static void put_number(GString *out, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append_c(out, ' ');
    g_string_append(out, g_ascii_formatd(text, sizeof text, "%.9g", value));
}

static void put_look_at(GString *out, const NephCamera *c)
{
    if (c->mirrored)
        g_string_append(out, "Scale -1 1 1 ");
    g_string_append(out, "LookAt");
    for (int i = 0; i < 3; i++)
        put_number(out, c->position[i]);
    g_string_append_c(out, ' ');
    for (int i = 0; i < 3; i++)
        put_number(out, c->position[i] + c->direction[i]);
    g_string_append_c(out, ' ');
    for (int i = 0; i < 3; i++)
        put_number(out, c->up[i]);
}

typedef struct optic {
    const char *name;
    double value;
    bool wanted; /* false: only an existing one is changed */
} optic;

enum { N_OPTICS = 3 };

static bool is_perspective(const NephCamera *c)
{
    return !c->kind || strcmp(c->kind, "perspective") == 0;
}

static void list_optics(const NephCamera *c, optic out[N_OPTICS])
{
    const bool lens = c->lens_radius > 0.0;
    out[0] = (optic){"fov", c->fov, true};
    out[1] = (optic){"lensradius", c->lens_radius, lens};
    out[2] = (optic){"focaldistance", c->focal_distance, lens};
}

static void put_optic(GString *out, const optic *o)
{
    g_string_append_printf(out, " \"float %s\"", o->name);
    put_number(out, o->value);
}

char *neph_camera_text(const NephCamera *c)
{
    optic optics[N_OPTICS];
    GString *out = g_string_new(NULL);
    list_optics(c, optics);
    put_look_at(out, c);
    if (!is_perspective(c)) {
        g_string_append_c(out, '\n');
        return g_string_free(out, FALSE);
    }
    g_string_append(out, "\nCamera \"perspective\"");
    for (int i = 0; i < N_OPTICS; i++)
        if (optics[i].wanted)
            put_optic(out, &optics[i]);
    g_string_append_c(out, '\n');
    return g_string_free(out, FALSE);
}

/* ---- Into a file ---- */

/* The end of the token at p: a quoted string, a bracket, a comment or a word. */
static const char *token_end(const char *p)
{
    if (*p == '"') {
        const char *end = strchr(p + 1, '"');
        return end ? end + 1 : p + strlen(p);
    }
    if (*p == '#')
        return p + strcspn(p, "\n");
    if (*p == '[' || *p == ']')
        return p + 1;
    return p + strcspn(p, " \t\r\n\"[]#");
}

static const char *skip_blanks(const char *p)
{
    return p + strspn(p, " \t\r\n");
}

/* The first directive of that name, or NULL; not inside strings and comments. */
static const char *find_directive(const char *text, const char *name)
{
    for (const char *p = skip_blanks(text); *p; p = skip_blanks(token_end(p))) {
        size_t n = (size_t)(token_end(p) - p);
        if (n == strlen(name) && strncmp(p, name, n) == 0)
            return p;
    }
    return NULL;
}

/* Where the directive at p ends: at the next word that is a name of one. */
static const char *directive_end(const char *p)
{
    const char *last = token_end(p);
    for (p = skip_blanks(last); *p && !g_ascii_isalpha(*p); p = skip_blanks(last)) {
        if (*p == '#')
            break;
        last = token_end(p);
    }
    return last;
}

static bool names_optic(const char *token, const char *end, const char *name)
{
    g_autofree char *inside = g_strndup(token + 1, (gsize)MAX(end - token - 2, 0));
    g_auto(GStrv) words = g_strsplit_set(g_strstrip(inside), " \t", 0);
    guint n = g_strv_length(words);
    return n > 1 && strcmp(words[n - 1], name) == 0;
}

/* The end of the value behind a parameter's name: one token, or a bracketed list. */
static const char *value_end(const char *p)
{
    if (*p != '[')
        return token_end(p);
    return p + strcspn(p, "]") + (strchr(p, ']') ? 1 : 0);
}

/* Copies the Camera directive [p, end) with the optics changed. */
static void put_camera(GString *out, const char *p, const char *end, optic *optics, int n)
{
    while (p < end) {
        const char *token = skip_blanks(p), *after = token_end(token);
        g_string_append_len(out, p, after - p);
        p = after;
        for (int i = 0; i < n && *token == '"'; i++) {
            if (!names_optic(token, after, optics[i].name))
                continue;
            put_number(out, optics[i].value);
            optics[i].wanted = false;
            p = value_end(skip_blanks(p));
        }
    }
    for (int i = 0; i < n; i++)
        if (optics[i].wanted)
            put_optic(out, &optics[i]);
}

/* Where the line that an earlier call put before the directive begins; the directive if
   there is none. */
static const char *saved_line(const char *text, const char *directive)
{
    const char *mark = NULL, *begin;
    for (const char *p = text; (p = strstr(p, MARK)) && p < directive; p++)
        mark = p;
    if (!mark || skip_blanks(mark + strlen(MARK)) != directive)
        return directive;
    for (begin = mark; begin > text && begin[-1] != '\n'; begin--)
        ;
    return begin;
}

static char *changed_text(const NephCamera *c, const char *text, const char *directive)
{
    optic optics[N_OPTICS];
    GString *out = g_string_new(NULL);
    list_optics(c, optics);
    g_string_append_len(out, text, saved_line(text, directive) - text);
    g_string_append(out, "Identity ");
    put_look_at(out, c);
    g_string_append(out, MARK "\n");
    const char *end = directive_end(directive);
    put_camera(out, directive, end, optics, is_perspective(c) ? N_OPTICS : 0);
    g_string_append(out, end);
    return g_string_free(out, FALSE);
}

bool neph_camera_save(const NephCamera *c, const char *path, GError **error)
{
    g_autoptr(GBytes) bytes = input_bytes(path, error);
    if (!bytes)
        return false;
    const char *text = g_bytes_get_data(bytes, NULL);
    const char *directive = find_directive(text, "Camera");
    if (!directive) {
        error_set(error, ERROR_INPUT,
                  "%s: expected a Camera directive to put the view at", path);
        return false;
    }
    g_autofree char *changed = changed_text(c, text, directive);
    return output_write_text(path, changed, error);
}
