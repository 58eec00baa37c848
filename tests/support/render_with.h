/*
 * Short ways to render a scene and to measure the image, for tests of whole renders.
 */
#pragma once

#include "image/compare.h"
#include "render/render.h"
#include "scene_text.h"

/** Settings as "name=value" words; photon mapping where they say nothing else, and no
 * picture without noise beside. */
static inline settings settings_with(const scene *s, const char *words)
{
    settings how = s->settings;
    how.integrator = INTEGRATOR_PHOTONMAP;
    how.denoise = false;
    g_auto(GStrv) list = g_strsplit(words, " ", -1);
    for (char **word = list; *word; word++) {
        g_auto(GStrv) pair = g_strsplit(*word, "=", 2);
        g_autoptr(GError) error = NULL;
        settings_set(&how, pair[0], pair[1], &error);
        g_assert_no_error(error);
    }
    return how;
}

static inline render *render_of(const view *v, const char *words)
{
    g_autoptr(GError) error = NULL;
    settings how = settings_with(v->scene, words);
    render *r = render_new(v, &how, &error);
    g_assert_no_error(error);
    return r;
}

static inline image *image_of(const render *r)
{
    g_autoptr(GError) error = NULL;
    image *img = render_image(r, &error);
    g_assert_no_error(error);
    return img;
}

static inline image *render_with(const view *v, const char *words)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_of(v, words);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(render_get_statistics(r).n_not_finite, ==, 0);
    return image_of(r);
}

/** Index of a channel that must be there. */
static inline size_t channel_of(const image *img, const char *name)
{
    int channel = image_channel(img, name);
    g_assert_cmpint(channel, >=, 0);
    return (size_t)channel;
}

static inline size_t pixels_of(const image *img)
{
    return (size_t)img->width * (size_t)img->height;
}

static inline double at(const image *img, size_t pixel, size_t channel)
{
    return (double)img->pixels[pixel * (size_t)img->n_channels + channel];
}

/** Mean over pixels of the channel sum R+G+B over three, of the layer ("" for the
 * beauty).
 */
static inline double mean_of(const image *img, const char *layer)
{
    double sum = 0;
    for (const char *c = "RGB"; *c; c++) {
        g_autofree char *name = g_strdup_printf("%s%s%c", layer, *layer ? "." : "", *c);
        size_t channel = channel_of(img, name);
        for (size_t i = 0; i < pixels_of(img); i++)
            sum += at(img, i, channel);
    }
    return sum / (3.0 * (double)pixels_of(img));
}

/** Rec. 709 luminance of a pixel of the beauty. */
static inline double luminance_at(const image *img, size_t pixel)
{
    return 0.2126 * at(img, pixel, channel_of(img, "R")) +
           0.7152 * at(img, pixel, channel_of(img, "G")) +
           0.0722 * at(img, pixel, channel_of(img, "B"));
}

/** Every channel of two images is the same, bit for bit. */
static inline void assert_same_bits(const image *a, const image *b)
{
    g_assert_cmpint(a->n_channels, ==, b->n_channels);
    size_t n = pixels_of(a) * (size_t)a->n_channels;
    g_assert_cmpmem(a->pixels, n * sizeof(float), b->pixels, n * sizeof(float));
}
