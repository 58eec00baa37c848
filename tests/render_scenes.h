/*
 * Small scenes and short ways to render them, for tests of whole renders.
 */
#pragma once

#include "render/render.h"
#include "scene_text.h"

/** Settings as "name=value" words; photon mapping where they say nothing else. */
static inline settings settings_with(const scene *s, const char *words)
{
    settings how = s->settings;
    how.integrator = INTEGRATOR_PHOTONMAP;
    g_auto(GStrv) list = g_strsplit(words, " ", -1);
    for (char **word = list; *word; word++) {
        g_auto(GStrv) pair = g_strsplit(*word, "=", 2);
        g_autoptr(GError) error = NULL;
        settings_set(&how, pair[0], pair[1], &error);
        g_assert_no_error(error);
    }
    return how;
}

static inline render *render_of(const scene *s, const char *words)
{
    g_autoptr(GError) error = NULL;
    settings how = settings_with(s, words);
    render *r = render_new(s, &how, &error);
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

static inline image *render_with(const scene *s, const char *words)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_of(s, words);
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

#define SIZE(n)                                                                          \
    "Film \"rgb\" \"integer xresolution\" " #n " \"integer yresolution\" " #n            \
    "\nPixelFilter \"box\"\n"

#define ROOM_CAMERA                                                                      \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55\n"

/** The walls of a room of 4 x 6 x 2 m. */
#define ROOM_WALLS                                                                       \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                           \
    "Shape \"trianglemesh\" \"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0 -2 -4 2 2 -4 2 "   \
    "2 2 2 -2 2 2] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 "  \
    "7 "                                                                                 \
    "0 3 7 0 7 4 1 5 6 1 6 2]\n"

/** A lamp beneath its ceiling; parameters come between. */
#define ROOM_LAMP(parameters)                                                            \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] " parameters           \
    " Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"trianglemesh\" "          \
    "\"point3 P\" [-0.7 -0.7 1.98 -0.7 0.7 1.98 0.7 0.7 1.98 0.7 -0.7 1.98] "            \
    "\"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"

#define GLASS_BALL                                                                       \
    "Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n"
