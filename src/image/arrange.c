#include "image/arrange.h"

#include <math.h>
#include <string.h>

static const char *const rgb_names[3] = {"R", "G", "B"};

/* ---- Scaling ---- */

/* Pixels of one line that lie under one of the new ones: the first and the last count by
   their share. */
typedef struct span {
    int first, last;
    double from, to;
} span;

static span span_of(int i, int n, int of)
{
    double from = (double)i * of / n, to = (double)(i + 1) * of / n;
    int first = (int)from, last = (int)ceil(to) - 1;
    return (span){MIN(first, of - 1), MIN(MAX(last, first), of - 1), from, to};
}

static double share(const span *s, int at)
{
    return fmin(s->to, at + 1.0) - fmax(s->from, (double)at);
}

static double mean_under(const image *img, const span *across, const span *down, int c)
{
    double sum = 0.0;
    for (int y = down->first; y <= down->last; y++) {
        const float *row =
            img->pixels + (size_t)y * (size_t)img->width * (size_t)img->n_channels;
        double line = 0.0;
        for (int x = across->first; x <= across->last; x++)
            line += share(across, x) * (double)row[x * img->n_channels + c];
        sum += share(down, y) * line;
    }
    return sum / ((across->to - across->from) * (down->to - down->from));
}

image *image_scaled(const image *img, int width, int height, GError **error)
{
    image *out = image_new(width, height, img->n_channels,
                           (const char *const *)img->channels, error);
    float *to = out ? out->pixels : NULL;
    for (int y = 0; out && y < height; y++) {
        span down = span_of(y, height, img->height);
        for (int x = 0; x < width; x++) {
            span across = span_of(x, width, img->width);
            for (int c = 0; c < img->n_channels; c++)
                *to++ = (float)mean_under(img, &across, &down, c);
        }
    }
    return out;
}

/* ---- Layers ---- */

static int channel_named(const image *img, const char *layer, const char *suffix)
{
    g_autofree char *name = g_strconcat(layer, suffix, NULL);
    return image_channel(img, name);
}

static bool layer_channels(const image *img, const char *name, int channels[3])
{
    static const char *const sets[][3] = {{".R", ".G", ".B"},
                                          {".X", ".Y", ".Z"},
                                          {".Y", ".Y", ".Y"},
                                          {".Z", ".Z", ".Z"},
                                          {"", "", ""}};
    for (size_t i = 0; i < G_N_ELEMENTS(sets); i++) {
        bool all = true;
        for (int k = 0; k < 3 && all; k++) {
            channels[k] = channel_named(img, name, sets[i][k]);
            all = channels[k] >= 0;
        }
        if (all)
            return true;
    }
    return false;
}

/* Names with commas between, each once; owned by the caller. */
static char *list_layers(const image *img)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
    for (int c = 0; c < img->n_channels; c++) {
        const char *channel = img->channels[c], *dot = strrchr(channel, '.');
        if (strlen(channel) == 1 && strchr("RGBA", *channel))
            continue;
        char *name = dot ? g_strndup(channel, (gsize)(dot - channel)) : g_strdup(channel);
        if (g_ptr_array_find_with_equal_func(names, name, g_str_equal, NULL))
            g_free(name);
        else
            g_ptr_array_add(names, name);
    }
    if (image_channel(img, "R") >= 0)
        g_ptr_array_add(names, g_strdup("raw"));
    g_ptr_array_add(names, NULL);
    return g_strjoinv(", ", (char **)names->pdata);
}

image *image_layer(const image *img, const char *name, GError **error)
{
    int channels[4];
    bool raw = strcmp(name, "raw") == 0 && image_colors(img, channels);
    if (!raw && !layer_channels(img, name, channels)) {
        g_autofree char *list = list_layers(img);
        error_set(error, ERROR_USAGE, "expected a layer's name (%s), found '%s'",
                  *list ? list : "the image has none", name);
        return NULL;
    }
    image *out = image_new(img->width, img->height, 3, rgb_names, error);
    size_t n = (size_t)img->width * (size_t)img->height;
    for (size_t i = 0; out && i < n; i++)
        for (int k = 0; k < 3; k++)
            out->pixels[3 * i + (size_t)k] =
                img->pixels[i * (size_t)img->n_channels + (size_t)channels[k]];
    if (out)
        memcpy(out->chromaticities, img->chromaticities, sizeof out->chromaticities);
    return out;
}

/* ---- A sheet ---- */

enum { GAP = 4 };
#define PAPER 0.03f

/* Where rows or columns begin; at[n] is the end of all. */
static int *edges(const image *const *images, size_t n, size_t columns, bool of_rows)
{
    size_t n_lines = of_rows ? (n + columns - 1) / columns : MIN(columns, n);
    int *at = g_new0(int, n_lines + 1);
    for (size_t i = 0; i < n; i++) {
        size_t line = of_rows ? i / columns : i % columns;
        int size = of_rows ? images[i]->height : images[i]->width;
        at[line + 1] = MAX(at[line + 1], size);
    }
    at[0] = GAP;
    for (size_t i = 0; i < n_lines; i++)
        at[i + 1] += at[i] + GAP;
    return at;
}

static void put(image *sheet, const image *img, int left, int top)
{
    int rgba[4];
    image_shown_colors(img, rgba);
    for (int c = 0; c < 3; c++) {
        const float *from = img->pixels + rgba[c];
        for (int y = 0; y < img->height; y++)
            for (int x = 0; x < img->width; x++) {
                size_t at = (size_t)(top + y) * (size_t)sheet->width + (size_t)(left + x);
                sheet->pixels[3 * at + (size_t)c] = *from;
                from += img->n_channels;
            }
    }
}

static bool all_have_colours(const image *const *images, size_t n, GError **error)
{
    int rgba[4];
    for (size_t i = 0; i < n; i++)
        if (!image_colors(images[i], rgba)) {
            error_set(error, ERROR_INPUT,
                      "image %zu has no channels 'R', 'G', 'B' or 'Y'", i + 1);
            return false;
        }
    return true;
}

image *image_sheet(const image *const *images, size_t n, size_t columns, GError **error)
{
    if (!all_have_colours(images, n, error))
        return NULL;
    g_autofree int *left = edges(images, n, columns, false);
    g_autofree int *top = edges(images, n, columns, true);
    size_t n_columns = MIN(columns, n), n_rows = (n + columns - 1) / columns;
    image *sheet = image_new(left[n_columns], top[n_rows], 3, rgb_names, error);
    if (!sheet)
        return NULL;
    for (size_t i = 0; i < 3 * (size_t)sheet->width * (size_t)sheet->height; i++)
        sheet->pixels[i] = PAPER;
    for (size_t i = 0; i < n; i++) {
        size_t column = i % columns, row = i / columns;
        int wide = left[column + 1] - GAP - left[column];
        int high = top[row + 1] - GAP - top[row];
        put(sheet, images[i], left[column] + (wide - images[i]->width) / 2,
            top[row] + (high - images[i]->height) / 2);
    }
    return sheet;
}
