#include "api/objects.h"

#include "api/asking.h"
#include "base/json.h"
#include "image/arrange.h"
#include "image/compare.h"
#include "image/exposure.h"
#include "image/layers.h"

#include <string.h>

const char *const *neph_image_extensions(void)
{
    return image_extensions();
}

const char *const *neph_image_written_extensions(void)
{
    return image_written_extensions();
}

bool neph_image_is_written(const char *path, bool *eight_bits)
{
    bool has;
    return image_is_written(path, eight_bits ? eight_bits : &has);
}

NephImage *neph_image_wrap(image *img)
{
    if (!img)
        return NULL;
    NephImage *wrapped = g_new(NephImage, 1);
    wrapped->image = img;
    return wrapped;
}

void neph_image_free(NephImage *img)
{
    if (!img)
        return;
    image_free(img->image);
    g_free(img);
}

NephImage *neph_image_read(const char *path, GError **error)
{
    return neph_image_wrap(image_read(path, NULL, error));
}

NephImage *neph_image_new(int width, int height, const float *rgb, GError **error)
{
    static const char *const names[] = {"R", "G", "B"};
    image *made = image_new(width, height, 3, names, error);
    if (made)
        memcpy(made->pixels, rgb, 3 * sizeof *rgb * (size_t)width * (size_t)height);
    return neph_image_wrap(made);
}

bool neph_image_write(const NephImage *img, const char *path, float exposure,
                      GError **error)
{
    return neph_image_write_while(img, path, exposure, NULL, NULL, error);
}

bool neph_image_write_while(const NephImage *img, const char *path, float exposure,
                            NephGoOnFunc go_on, void *data, GError **error)
{
    asking a;
    const image_write_options options = {.exposure = exposure,
                                         .cancel = asking_begin(&a, go_on, data)};
    return image_write(img->image, path, &options, error);
}

_Static_assert(NEPH_EXPOSURE_BLACK == (int)EXPOSURE_BLACK, "states are one list");
_Static_assert(NEPH_EXPOSURE_DARK == (int)EXPOSURE_DARK, "states are one list");
_Static_assert(NEPH_EXPOSURE_BRIGHT == (int)EXPOSURE_BRIGHT, "states are one list");

NephExposure neph_image_exposure(const NephImage *img, float exposure, float *better)
{
    return (NephExposure)image_exposure(img->image, exposure, better);
}

bool neph_image_can_write(const char *path, GError **error)
{
    return image_can_write(path, error);
}

void neph_image_size(const NephImage *img, int *width, int *height, int *n_channels)
{
    *width = img->image->width;
    *height = img->image->height;
    *n_channels = img->image->n_channels;
}

const char *neph_image_channel_name(const NephImage *img, int channel)
{
    bool exists = channel >= 0 && channel < img->image->n_channels;
    return exists ? img->image->channels[channel] : NULL;
}

const float *neph_image_pixels(const NephImage *img)
{
    return img->image->pixels;
}

bool neph_image_compare(const NephImage *img, const NephImage *reference,
                        NephImageDifference *out, GError **error)
{
    image_difference found;
    if (!image_compare(img->image, reference->image, &found, error))
        return false;
    *out = (NephImageDifference){.mean_a = found.mean_a,
                                 .mean_b = found.mean_b,
                                 .rmse = found.rmse,
                                 .relmse = found.relmse,
                                 .psnr = found.psnr,
                                 .flip = found.flip,
                                 .n_not_finite = found.n_not_finite};
    return true;
}

NephImage *neph_image_difference_map(const NephImage *img, const NephImage *reference,
                                     GError **error)
{
    return neph_image_wrap(image_difference_map(img->image, reference->image, error));
}

NephImage *neph_image_scale(const NephImage *img, int width, int height, GError **error)
{
    if (width >= 1 && height >= 1)
        return neph_image_wrap(image_scaled(img->image, width, height, error));
    error_set(error, ERROR_USAGE, "size %dx%d: expected at least one pixel a side", width,
              height);
    return NULL;
}

NephImage *neph_image_layer(const NephImage *img, const char *name, GError **error)
{
    return neph_image_wrap(image_layer(img->image, name, error));
}

NephImage *neph_image_shown(const NephImage *img, float white, GError **error)
{
    return neph_image_wrap(image_as_shown(img->image, white, error));
}

NephImage *neph_image_sheet(const NephImage *const *images, size_t n, size_t columns,
                            GError **error)
{
    if (n == 0 || columns == 0) {
        error_set(error, ERROR_USAGE, "a sheet has an image and a column at least");
        return NULL;
    }
    g_autofree const image **inner = g_new(const image *, n);
    for (size_t i = 0; i < n; i++)
        inner[i] = images[i]->image;
    return neph_image_wrap(image_sheet(inner, n, columns, error));
}

static char *difference_json(const NephImageDifference *d)
{
    json j = {0};
    json_object_begin(&j, NULL);
    json_number(&j, "mean_a", d->mean_a);
    json_number(&j, "mean_b", d->mean_b);
    json_number(&j, "rmse", d->rmse);
    json_number(&j, "relmse", d->relmse);
    json_number(&j, "psnr", d->psnr);
    json_number(&j, "flip", d->flip);
    json_count(&j, "not_finite", d->n_not_finite);
    json_object_end(&j);
    return json_finish(&j);
}

char *neph_image_difference_text(const NephImageDifference *d, bool as_json)
{
    if (as_json)
        return difference_json(d);
    return g_strdup_printf("mean luminance  %.6g, reference %.6g\n"
                           "rmse            %.6g\n"
                           "relmse          %.6g\n"
                           "psnr            %.4g dB\n"
                           "flip            %.6g\n"
                           "not finite      %zu pixels left out\n",
                           d->mean_a, d->mean_b, d->rmse, d->relmse, d->psnr, d->flip,
                           d->n_not_finite);
}
