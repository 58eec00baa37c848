#include "frames.h"

#include "arguments.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 4, MOST_FRAMES = 1000000 };

static bool refuse(GError **error, const char *format, ...) G_GNUC_PRINTF(2, 3);

static bool refuse(GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE, "%s", text);
    return false;
}

static bool read_range(frames *f, const char *range, GError **error)
{
    g_auto(GStrv) ends = g_strsplit(range, "-", 2);
    guint64 first = 0, last = 0;
    const char *second = ends[0] && ends[1] ? ends[1] : ends[0];
    if (!ends[0] || !argument_count("--frame", ends[0], 0, MOST_FRAMES, &first, NULL) ||
        !argument_count("--frame", second, first, MOST_FRAMES, &last, NULL))
        return refuse(error, "--frame: expected a number, or two as in 1-24, found '%s'",
                      range);
    f->first = (int)first;
    f->last = (int)last;
    return true;
}

/* ---- The camera's path ---- */

static bool read_look(char *line, frame_look *out)
{
    char *at = line + strspn(line, " \t\r");
    if (!g_str_has_prefix(at, "LookAt"))
        return false;
    at += strlen("LookAt");
    double *numbers[] = {out->eye, out->at, out->up};
    for (int i = 0; i < 9; i++) {
        char *end;
        numbers[i / 3][i % 3] = g_ascii_strtod(at, &end);
        if (end == at || !isfinite(numbers[i / 3][i % 3]))
            return false;
        at = end;
    }
    return at[strspn(at, " \t\r")] == '\0';
}

/* Opening a pipe that nobody writes to would wait. */
static bool is_no_file(const char *path)
{
    return g_file_test(path, G_FILE_TEST_EXISTS) &&
           !g_file_test(path, G_FILE_TEST_IS_REGULAR);
}

static bool read_looks(frames *f, const char *path, GError **error)
{
    g_autofree char *text = NULL;
    g_autoptr(GError) inner = NULL;
    if (is_no_file(path)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT,
                    "--camera: expected a file, found '%s', which is none", path);
        return false;
    }
    if (!g_file_get_contents(path, &text, NULL, &inner)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT, "--camera: %s",
                    inner->message);
        return false;
    }
    f->looks = g_array_new(FALSE, FALSE, sizeof(frame_look));
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    for (int i = 0; lines[i]; i++) {
        frame_look look;
        lines[i][strcspn(lines[i], "#")] = '\0';
        if (!*g_strstrip(lines[i]))
            continue;
        if (!read_look(lines[i], &look)) {
            g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT,
                        "%s:%d: expected LookAt and nine numbers, found '%s'",
                        path, i + 1, lines[i]);
            return false;
        }
        g_array_append_val(f->looks, look);
    }
    return f->looks->len > 0 || refuse(error, "--camera: %s has no LookAt", path);
}

/* ---- All of them ---- */

static bool check_path(frames *f, const char *range, GError **error)
{
    if (!f->looks)
        return true;
    if (!range) {
        f->first = 1;
        f->last = (int)f->looks->len;
    }
    return (f->first >= 1 && f->last <= (int)f->looks->len) ||
           refuse(error,
                  "--frame: expected frames 1 to %u, which --camera has, found %d-%d",
                  f->looks->len, f->first, f->last);
}

bool frames_init(frames *f, const char *range, const char *per_second, const char *camera,
                 const char *grain, GError **error)
{
    *f = (frames){.are_asked = range || camera, .per_second = 24.0};
    if (!f->are_asked && (per_second || grain))
        return refuse(error, "%s: expected --frame or --camera too",
                      per_second ? "--fps" : "--grain");
    f->varies = grain && strcmp(grain, "varying") == 0;
    if (grain && !f->varies && strcmp(grain, "fixed") != 0)
        return refuse(error, "--grain: expected fixed or varying, found '%s'", grain);
    return (!range || read_range(f, range, error)) &&
           (!per_second ||
            argument_between("--fps", per_second, 1e-6, 1e6, &f->per_second, error)) &&
           (!camera || read_looks(f, camera, error)) && check_path(f, range, error);
}

void frames_clear(frames *f)
{
    g_clear_pointer(&f->looks, g_array_unref);
}

char *frame_name(const char *pattern, int frame)
{
    const char *slash = strrchr(pattern, '/');
    const char *name = slash ? slash + 1 : pattern;
    const char *from = strchr(name, '#'), *dot = strrchr(name, '.');
    if (!from) {
        size_t before = dot && dot != name ? (size_t)(dot - pattern) : strlen(pattern);
        return g_strdup_printf("%.*s.%0*d%s", (int)before, pattern, DIGITS, frame,
                               pattern + before);
    }
    int n = (int)strspn(from, "#");
    return g_strdup_printf("%.*s%0*d%s", (int)(from - pattern), pattern, n, frame,
                           from + n);
}

double frame_time(const frames *f, int frame)
{
    return (double)frame / f->per_second;
}

/* ---- Where the camera is ---- */

bool frame_place(const frames *f, int frame, const NephCamera *read, NephScene *scene,
                 GError **error)
{
    if (!f->looks)
        return true;
    NephCamera camera = *read;
    const frame_look *look = &g_array_index(f->looks, frame_look, frame - 1);
    for (int i = 0; i < 3; i++) {
        camera.position[i] = look->eye[i];
        camera.direction[i] = look->at[i] - look->eye[i];
        camera.up[i] = look->up[i];
    }
    if (neph_scene_set_camera(scene, &camera, error))
        return true;
    g_prefix_error(error, "--camera, frame %d: ", frame);
    return false;
}
