#include "image/image.h"

#include "base/memory.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

const char *const image_rgb_names[3] = {"R", "G", "B"};

static bool size_allowed(int width, int height, int n_channels)
{
    return width > 0 && height > 0 && n_channels > 0 &&
           (int64_t)width * height <= INT_MAX;
}

image *image_new(int width, int height, int n_channels, const char *const *channels,
                 GError **error)
{
    if (!size_allowed(width, height, n_channels)) {
        error_set(error, ERROR_INPUT,
                  "an image of %d x %d pixels, %d channels, is refused", width, height,
                  n_channels);
        return NULL;
    }
    size_t n_pixels = (size_t)width * (size_t)height;
    size_t pixel_size = (size_t)n_channels * sizeof(float);
    g_autofree char *what = g_strdup_printf("an image of %d x %d pixels", width, height);
    float *pixels = big_alloc(n_pixels, pixel_size, what, error);
    if (!pixels)
        return NULL;
    image *img = g_new0(image, 1);
    img->width = width;
    img->height = height;
    img->n_channels = n_channels;
    img->pixels = pixels;
    img->channels = g_new0(char *, n_channels);
    for (int c = 0; c < n_channels; c++)
        img->channels[c] = g_strdup(channels[c]);
    return img;
}

void image_free(image *img)
{
    if (!img)
        return;
    for (int c = 0; c < img->n_channels; c++)
        g_free(img->channels[c]);
    g_free(img->channels);
    big_free(img->pixels);
    if (img->header)
        g_hash_table_unref(img->header);
    g_free(img);
}

int image_channel(const image *img, const char *name)
{
    for (int c = 0; c < img->n_channels; c++)
        if (strcmp(img->channels[c], name) == 0)
            return c;
    return -1;
}

bool image_colors(const image *img, int rgba[4])
{
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++)
        rgba[c] = image_channel(img, names[c]);
    if (rgba[0] >= 0 && rgba[1] >= 0 && rgba[2] >= 0)
        return true;
    int grey = img->n_channels == 1 ? 0 : image_channel(img, "Y");
    rgba[0] = rgba[1] = rgba[2] = grey;
    return grey >= 0;
}

const char *image_header_get(const image *img, const char *key)
{
    return img->header ? g_hash_table_lookup(img->header, key) : NULL;
}

void image_header_set(image *img, const char *key, const char *value)
{
    if (!img->header)
        img->header = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    g_hash_table_replace(img->header, g_strdup(key), g_strdup(value));
}

float srgb_encode(float linear)
{
    if (linear <= 0.0031308f)
        return 12.92f * linear;
    return 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}

float srgb_decode(float encoded)
{
    if (encoded <= 0.04045f)
        return encoded / 12.92f;
    return powf((encoded + 0.055f) / 1.055f, 2.4f);
}
