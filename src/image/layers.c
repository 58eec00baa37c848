#include "image/layers.h"

#include <math.h>
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

/* R, G and B, to be filled; in the same colours. */
static image *picture_like(const image *img, GError **error)
{
    image *out = image_new(img->width, img->height, 3, image_rgb_names, error);
    if (out)
        memcpy(out->chromaticities, img->chromaticities, sizeof out->chromaticities);
    return out;
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
    image *out = picture_like(img, error);
    size_t n = (size_t)img->width * (size_t)img->height;
    for (size_t i = 0; out && i < n; i++)
        for (int k = 0; k < 3; k++)
            out->pixels[3 * i + (size_t)k] =
                img->pixels[i * (size_t)img->n_channels + (size_t)channels[k]];
    return out;
}

bool image_find_shown(const image *img, image_shown *out)
{
    bool found = image_colors(img, out->rgba);
    int denoised[3];
    if (layer_channels(img, "denoised", denoised))
        memcpy(out->rgba, denoised, sizeof denoised);
    bool has_lights = layer_channels(img, "lights", out->lights);
    out->lights[3] = has_lights ? image_channel(img, "lights.A") : -1;
    return found;
}

void image_shown_pixel(const image_shown *shown, const float *pixel, float white,
                       float rgb[3])
{
    float part = shown->lights[3] >= 0 ? pixel[shown->lights[3]] : 1.0f;
    for (int c = 0; c < 3; c++) {
        rgb[c] = pixel[shown->rgba[c]];
        if (part > 0.0f && part < 1.0f)
            rgb[c] -= fmaxf(pixel[shown->lights[c]] - part * white, 0.0f);
    }
}

image *image_as_shown(const image *img, float white, GError **error)
{
    image_shown shown;
    if (!image_find_shown(img, &shown)) {
        error_set(error, ERROR_INPUT, "the image has no channels 'R', 'G', 'B' or 'Y'");
        return NULL;
    }
    image *out = picture_like(img, error);
    size_t n = (size_t)img->width * (size_t)img->height;
    for (size_t i = 0; out && i < n; i++)
        image_shown_pixel(&shown, img->pixels + i * (size_t)img->n_channels, white,
                          out->pixels + 3 * i);
    return out;
}
