#include "image/arrange.h"

#include "image/layers.h"

#include <math.h>

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
    image_shown shown;
    image_find_shown(img, &shown);
    for (int c = 0; c < 3; c++) {
        const float *from = img->pixels + shown.rgba[c];
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
    image *sheet = image_new(left[n_columns], top[n_rows], 3, image_rgb_names, error);
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
