#include "api/render/fingerprint.h"

#include "base/input.h"
#include "base/wanted.h"
#include "format/pbrt/pbrt_sum.h"

#include <stdio.h>
#include <string.h>

enum { PIECE = 1 << 16 };

static void add_text(GChecksum *sum, const char *text)
{
    g_checksum_update(sum, (const guchar *)text, (gssize)strlen(text) + 1);
}

static void add_numbers(GChecksum *sum, const double *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        char text[G_ASCII_DTOSTR_BUF_SIZE];
        add_text(sum, g_ascii_dtostr(text, sizeof text, numbers[i]));
    }
}

/* Its contents, not its name: the scene may have been moved. What is missing is part of a
   scene that does without. */
static void add_file(GChecksum *sum, const char *path)
{
    g_autofree guchar *piece = g_malloc(PIECE);
    FILE *from = fopen(path, "rb");
    add_text(sum, from ? "file" : "missing");
    if (!from)
        return;
    size_t n, size = 0;
    for (; still_wanted(NULL) && (n = fread(piece, 1, PIECE, from)) > 0; size += n)
        g_checksum_update(sum, piece, (gssize)n);
    fclose(from);
    const double end = (double)size;
    add_numbers(sum, &end, 1);
}

static void add_camera(GChecksum *sum, const NephScene *of)
{
    NephCamera c;
    neph_scene_camera(of, &c);
    const double rest[] = {c.mirrored ? 1.0 : 0.0, c.fov, c.lens_radius,
                           c.focal_distance};
    add_text(sum, c.kind);
    add_numbers(sum, c.position, 3);
    add_numbers(sum, c.direction, 3);
    add_numbers(sum, c.up, 3);
    add_numbers(sum, c.screen, 4);
    add_numbers(sum, rest, G_N_ELEMENTS(rest));
}

static void add_reading(GChecksum *sum, const NephScene *of)
{
    bool is_frame = of->at_time && of->scene->is_animated;
    const double how[] = {of->lenient ? 1.0 : 0.0, of->thin_glass ? 1.0 : 0.0,
                          is_frame ? 1.0 : 0.0, is_frame ? of->time : 0.0};
    add_numbers(sum, how, G_N_ELEMENTS(how));
}

char *scene_fingerprint(const NephScene *of)
{
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    const char *const *files = neph_scene_files(of);
    add_reading(sum, of);
    for (; *files; files++)
        add_file(sum, *files);
    add_camera(sum, of);
    return g_strdup(g_checksum_get_string(sum));
}

/* Of pbrt's text no more than what photons meet. */
static void add_world(GChecksum *sum, const char *path)
{
    input in;
    bool is_pbrt = g_str_has_suffix(path, ".pbrt") || g_str_has_suffix(path, ".pbrt.gz");
    if (!is_pbrt || !input_open(&in, path, NULL)) {
        add_file(sum, path);
        return;
    }
    pbrt_sum_world(sum, in.data, in.size);
    input_close(&in);
}

/* The shutter matters only to what moves while it is open. */
char *world_fingerprint(const NephScene *of)
{
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    const char *const *files = neph_scene_files(of);
    const scene *s = of->scene;
    const double time[] = {(double)s->shutter[0], (double)s->shutter[1]};
    add_reading(sum, of);
    if (s->moves)
        add_numbers(sum, time, G_N_ELEMENTS(time));
    add_world(sum, files[0]);
    for (files++; *files; files++)
        add_file(sum, *files);
    return g_strdup(g_checksum_get_string(sum));
}
