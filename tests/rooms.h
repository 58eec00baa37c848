/*
 * Small scenes that several algorithms render, and how to render and measure them: a
 * furnace, and a room with, by turns, something in it.
 */
#pragma once

#include "image/compare.h"
#include "render/render.h"
#include "scene_text.h"

#define SIZE(n)                                                                          \
    "Film \"rgb\" \"integer xresolution\" " #n " \"integer yresolution\" " #n            \
    "\nPixelFilter \"box\"\n"

/* Settings as "name=value" words; photon mapping where they say nothing else. */
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

static inline image *render_with(const scene *s, const char *words)
{
    g_autoptr(GError) error = NULL;
    settings how = settings_with(s, words);
    g_autoptr(render) r = render_new(s, &how, &error);
    g_assert_no_error(error);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(render_get_statistics(r).n_not_finite, ==, 0);
    image *img = render_image(r, &error);
    g_assert_no_error(error);
    return img;
}

/* Mean over pixels of the channel sum R+G+B over three, of the layer ("" for the beauty).
 */
static inline double mean_of(const image *img, const char *layer)
{
    double sum = 0;
    size_t n = (size_t)img->width * (size_t)img->height;
    for (const char *c = "RGB"; *c; c++) {
        g_autofree char *name = g_strdup_printf("%s%s%c", layer, *layer ? "." : "", *c);
        int channel = image_channel(img, name);
        g_assert_cmpint(channel, >=, 0);
        for (size_t i = 0; i < n; i++)
            sum += (double)img->pixels[i * (size_t)img->n_channels + (size_t)channel];
    }
    return sum / (3.0 * (double)n);
}

/* ---- Scenes ---- */

/* A closed box that shines Le = 1 and reflects 0.5 everywhere: radiance is 2 in every
   place and direction. The camera stands in the middle and sees the middle of a wall. */
#define FURNACE                                                                          \
    "Camera \"perspective\" \"float fov\" 40\n" SIZE(                                    \
        8) "WorldBegin\n"                                                                \
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                    \
           "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n"      \
           "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 " \
           "1 1 -1 1 1 1 1 "                                                             \
           "-1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 " \
           "7 0 3 7 0 7 4 1 "                                                            \
           "5 6 1 6 2]\n"

/* A room with one small and one large lamp and, by turns, something in it. */
#define ROOM                                                                             \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55\n" SIZE(  \
        16) "WorldBegin\n"                                                               \
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] Material "     \
            "\"diffuse\" \"rgb "                                                         \
            "reflectance\" [0 0 0] Shape \"trianglemesh\" \"point3 P\" [-0.7 -0.7 1.98 " \
            "-0.7 0.7 1.98 "                                                             \
            "0.7 0.7 1.98 0.7 -0.7 1.98] \"integer indices\" [0 1 2 0 2 3] "             \
            "AttributeEnd\n"                                                             \
            "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                   \
            "Shape \"trianglemesh\" \"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0 -2 -4 2 "  \
            "2 -4 2 2 2 2 -2 "                                                           \
            "2 2] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 7 " \
            "0 3 7 0 7 4 1 5 6 "                                                         \
            "1 6 2]\n"

typedef struct furnishing {
    const char *name, *text;
    double tolerance; /* of means; the noise of so few samples is half of it */
} furnishing;

static const furnishing furnishings[] = {
    {"empty", "", 0.008},
    {"mirror",
     "Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
     "\"metal-Ag-k\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"glass",
     "Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" "
     "0.5\n",
     0.01},
    {"dispersive",
     "Material \"dielectric\" \"spectrum eta\" \"glass-N-SF11\" Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.012},
    {"rough-metal",
     "Material \"conductor\" \"float roughness\" 0.15 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"very-rough-metal",
     "Material \"conductor\" \"float roughness\" 0.5 \"bool "
     "remaproughness\" false Translate 0 0 0.6 Shape \"sphere\" \"float "
     "radius\" 0.5\n",
     0.02},
    {"rough-glass",
     "Material \"dielectric\" \"float roughness\" 0.4 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"plastic",
     "Material \"coateddiffuse\" \"rgb reflectance\" [0.2 0.4 0.8] Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"point-light",
     "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5] Material "
     "\"conductor\" \"float roughness\" 0.1 Translate 0 0 0.6 Shape \"sphere\" "
     "\"float radius\" 0.5\n",
     0.02},
};
