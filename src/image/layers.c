#include "image/layers.h"

#include <string.h>

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
    image *out = image_new(img->width, img->height, 3, image_rgb_names, error);
    size_t n = (size_t)img->width * (size_t)img->height;
    for (size_t i = 0; out && i < n; i++)
        for (int k = 0; k < 3; k++)
            out->pixels[3 * i + (size_t)k] =
                img->pixels[i * (size_t)img->n_channels + (size_t)channels[k]];
    if (out)
        memcpy(out->chromaticities, img->chromaticities, sizeof out->chromaticities);
    return out;
}

bool image_shown_colors(const image *img, int rgba[4])
{
    bool found = image_colors(img, rgba);
    int denoised[3];
    if (layer_channels(img, "denoised", denoised))
        memcpy(rgba, denoised, sizeof denoised);
    return found;
}
