/*
 * Heights as normals, texel by texel: the usual reading where a file gives no scale. The
 * image goes on around its borders, as textures do.
 */
#include "format/gltf/height_map.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { RGB = 3 };

/* Its value if it is grey, or the mean of the first three channels. */
static double height_at(const image *img, int x, int y)
{
    x = (x + img->width) % img->width;
    y = (y + img->height) % img->height;
    size_t n = (size_t)MIN(img->n_channels, RGB);
    const float *texel = img->pixels + (size_t)img->n_channels *
                                           ((size_t)y * (size_t)img->width + (size_t)x);
    double sum = 0.0;
    for (size_t c = 0; c < n; c++)
        sum += (double)texel[c];
    return sum / (double)n;
}

bool height_map_is_normals(const image *img)
{
    double mean[RGB] = {0};
    size_t n = (size_t)img->width * (size_t)img->height;
    if (img->n_channels < RGB)
        return false;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < RGB; c++)
            mean[c] += (double)img->pixels[i * (size_t)img->n_channels + c] / (double)n;
    return mean[2] > 0.7 && fabs(mean[0] - 0.5) < 0.15 && fabs(mean[1] - 0.5) < 0.15;
}

/* Rows of the image go down, v goes up. */
static void normal_at(const image *img, double strength, int x, int y, float out[RGB])
{
    double slope[2] = {
        0.5 * strength * (height_at(img, x + 1, y) - height_at(img, x - 1, y)),
        0.5 * strength * (height_at(img, x, y - 1) - height_at(img, x, y + 1))};
    double length = sqrt(slope[0] * slope[0] + slope[1] * slope[1] + 1.0);
    const double n[RGB] = {-slope[0] / length, -slope[1] / length, 1.0 / length};
    for (int c = 0; c < RGB; c++)
        out[c] = (float)(0.5 + 0.5 * n[c]);
}

/* PFM has its lowest row first. */
GBytes *height_map_as_normals(const image *img, double strength)
{
    const char *order = G_BYTE_ORDER == G_LITTLE_ENDIAN ? "-1.0" : "1.0";
    g_autofree char *head =
        g_strdup_printf("PF\n%d %d\n%s\n", img->width, img->height, order);
    size_t n_head = strlen(head), row = (size_t)img->width * RGB * sizeof(float);
    size_t size = n_head + row * (size_t)img->height;
    char *out = big_alloc(size, 1, "height map", NULL);
    if (!out)
        return NULL;
    char *to = g_stpcpy(out, head);
    for (int y = img->height - 1; y >= 0; y--)
        for (int x = 0; x < img->width; x++) {
            float n[RGB];
            normal_at(img, strength, x, y, n);
            memcpy(to, n, sizeof n);
            to += sizeof n;
        }
    return g_bytes_new_with_free_func(out, size, big_free, out);
}
