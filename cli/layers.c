#include "layers.h"

#include "exposure.h"

#include <math.h>
#include <string.h>

const char *layer_file(const char *word)
{
    return strchr(word, '=') + 1;
}

static char *layer_name(const char *word)
{
    return g_strndup(word, (gsize)(strchr(word, '=') - word));
}

bool layers_check(char **words, GError **error)
{
    for (char **word = words; word && *word; word++) {
        if (!strchr(*word, '=')) {
            g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                        "--layer: expected NAME=FILE, found '%s'", *word);
            return false;
        }
        if (!neph_image_can_write(layer_file(*word), error))
            return false;
    }
    return true;
}

bool layers_known(char **words, const NephImage *image, GError **error)
{
    for (char **word = words; word && *word; word++) {
        g_autofree char *name = layer_name(*word);
        if (strcmp(name, "variance") == 0)
            continue;
        g_autoptr(NephImage) layer = neph_image_layer(image, name, error);
        if (!layer) {
            g_prefix_error(error, "--layer: ");
            return false;
        }
    }
    return true;
}

static bool is_normal(const char *name)
{
    return strcmp(name, "normal") == 0 || strcmp(name, "N") == 0 ||
           strcmp(name, "Ns") == 0;
}

static bool is_depth(const char *name)
{
    return strcmp(name, "depth") == 0;
}

/* The same with x a + b for x. */
static NephImage *mapped(const NephImage *image, float a, float b, GError **error)
{
    int width, height, n_channels;
    neph_image_size(image, &width, &height, &n_channels);
    size_t n = (size_t)width * (size_t)height * 3;
    g_autofree float *rgb = g_memdup2(neph_image_pixels(image), n * sizeof *rgb);
    for (size_t i = 0; i < n; i++)
        rgb[i] = a * rgb[i] + b;
    return neph_image_new(width, height, rgb, error);
}

static float largest(const NephImage *image)
{
    int width, height, n_channels;
    float most = 0.0f;
    neph_image_size(image, &width, &height, &n_channels);
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; i++)
        if (isfinite(neph_image_pixels(image)[i]))
            most = fmaxf(most, neph_image_pixels(image)[i]);
    return most;
}

NephImage *layer_picture(const NephImage *image, const char *name, const char *path,
                         GError **error)
{
    NephImage *layer = neph_image_layer(image, name, error);
    if (!layer || !has_eight_bits(path) || !(is_normal(name) || is_depth(name)))
        return layer;
    NephImage *tame =
        is_normal(name)
            ? mapped(layer, 0.5f, 0.5f, error)
            : mapped(layer, 1.0f / fmaxf(largest(layer), 1e-30f), 0.0f, error);
    neph_image_free(layer);
    return tame;
}

bool layers_write(char **words, const NephImage *image, float stops, GError **error)
{
    for (char **word = words; word && *word; word++) {
        g_autofree char *name = layer_name(*word);
        const char *path = layer_file(*word);
        g_autoptr(NephImage) layer = layer_picture(image, name, path, error);
        bool is_data = is_normal(name) || is_depth(name);
        if (!layer || !neph_image_write(layer, path, is_data ? 0.0f : stops, error))
            return false;
    }
    return true;
}
