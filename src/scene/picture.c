#include "scene/picture.h"

#include "scene/scene.h"

#include <string.h>

/* ---- Reading ---- */

static bool has_chromaticities(const color_space *space, const float xy[8])
{
    float own[8], off = 0.0f;
    color_space_chromaticities(space, own);
    for (int i = 0; i < 8; i++)
        off = maxf(off, fabsf(own[i] - xy[i]));
    return off < 2e-3f;
}

/* The space that the image says it is in; sRGB if it says nothing. */
static const color_space *space_of(const image *img)
{
    static const char *const names[] = {"srgb", "rec2020", "dci-p3", "aces2065-1"};
    if (!(fabsf(img->chromaticities[0]) > 0.0f))
        return color_space_srgb();
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        const color_space *space = color_space_find(names[i]);
        if (has_chromaticities(space, img->chromaticities))
            return space;
    }
    return NULL;
}

static bool find_channels(picture *pic)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int i = 0; i < 4; i++)
        pic->channels[i] = image_channel(pic->levels[0], names[i]);
    if (pic->channels[0] >= 0 && pic->channels[1] >= 0 && pic->channels[2] >= 0)
        return true;
    int grey = image_channel(pic->levels[0], "Y");
    if (grey < 0 && pic->levels[0]->n_channels == 1)
        grey = 0;
    pic->channels[0] = pic->channels[1] = pic->channels[2] = grey;
    pic->grey = true;
    return grey >= 0;
}

/* Channels and colour space; false with an error at the place. */
static bool understand(picture *pic, const char *path, source_place place, GError **error)
{
    if (!find_channels(pic)) {
        error_at(error, place, "%s: expected channels R, G, B or one channel", path);
        return false;
    }
    pic->space = space_of(pic->levels[0]);
    if (!pic->space)
        error_at(error, place, "%s: its primaries belong to no colour space we know",
                 path);
    return pic->space != NULL;
}

bool picture_read(picture *out, const struct scene *s, const params *p, const char *name,
                  const image_read_options *options, GError **error)
{
    g_autofree char *path = NULL;
    *out = (picture){0};
    if (!params_path(p, name, &path, error))
        return false;
    if (!path) {
        error_at(error, p->place, "expected \"string %s\", found none", name);
        return false;
    }
    source_place place = params_find(p, name)->place;
    g_autoptr(GError) inner = NULL;
    out->levels[0] = scene_read_image(s, path, options, &inner);
    out->n_levels = 1;
    if (!out->levels[0])
        error_at(error, place, "%s", inner->message);
    else if (understand(out, path, place, error))
        return true;
    picture_clear(out);
    return false;
}

void picture_from_grey(picture *out, image *taken)
{
    *out = (picture){.levels = {taken},
                     .n_levels = 1,
                     .channels = {0, 0, 0, -1},
                     .grey = true,
                     .space = color_space_srgb()};
}

void picture_clear(picture *pic)
{
    for (int i = 0; i < pic->n_levels; i++)
        image_free(pic->levels[i]);
    *pic = (picture){0};
}

static size_t n_texels(const image *img)
{
    return (size_t)img->width * (size_t)img->height;
}

bool picture_check_light(const picture *pic, source_place place, GError **error)
{
    const image *img = pic->levels[0];
    for (size_t i = 0; i < n_texels(img); i++)
        for (int c = 0; c < 3; c++) {
            float x = img->pixels[i * (size_t)img->n_channels + (size_t)pic->channels[c]];
            if (isfinite(x) && x >= 0.0f)
                continue;
            error_at(error, place,
                     "expected an image of a light, found %g in it (column %zu, row %zu)",
                     (double)x, i % (size_t)img->width, i / (size_t)img->width);
            return false;
        }
    return true;
}

bool picture_has_alpha(const picture *pic)
{
    const image *img = pic->levels[0];
    if (pic->channels[3] < 0)
        return false;
    size_t step = (size_t)img->n_channels;
    for (size_t i = 0; i < n_texels(img); i++)
        if (img->pixels[i * step + (size_t)pic->channels[3]] < 1.0f)
            return true;
    return false;
}

/* ---- The pyramid ---- */

/* The source texels that a texel of the next level covers, of n for n / 2 rounded up. */
static void children(int i, int n, int *first, int *last)
{
    *first = 2 * i;
    *last = MIN(2 * i + 1, n - 1);
}

static void fill_level(image *small, const image *large)
{
    size_t step = (size_t)large->n_channels;
    for (int y = 0; y < small->height; y++)
        for (int x = 0; x < small->width; x++) {
            float *to =
                small->pixels + ((size_t)y * (size_t)small->width + (size_t)x) * step;
            int x0, x1, y0, y1;
            children(x, large->width, &x0, &x1);
            children(y, large->height, &y0, &y1);
            const float *rows[2] = {
                large->pixels + (size_t)y0 * (size_t)large->width * step,
                large->pixels + (size_t)y1 * (size_t)large->width * step};
            for (size_t c = 0; c < step; c++)
                to[c] = 0.25f *
                        (rows[0][(size_t)x0 * step + c] + rows[0][(size_t)x1 * step + c] +
                         rows[1][(size_t)x0 * step + c] + rows[1][(size_t)x1 * step + c]);
        }
}

bool picture_build_levels(picture *pic, GError **error)
{
    while (pic->n_levels < MAX_PICTURE_LEVELS) {
        const image *large = pic->levels[pic->n_levels - 1];
        if (large->width == 1 && large->height == 1)
            break;
        image *small =
            image_new((large->width + 1) / 2, (large->height + 1) / 2, large->n_channels,
                      (const char *const *)large->channels, error);
        if (!small)
            return false;
        fill_level(small, large);
        pic->levels[pic->n_levels++] = small;
    }
    return true;
}

/* ---- Looking up ---- */

static int modulo(int i, int n)
{
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* Each moves texel coordinates into the image; false: black. */
typedef bool (*wrap_function)(int *x, int *y, const image *img);

static bool wrap_repeat(int *x, int *y, const image *img)
{
    *x = modulo(*x, img->width);
    *y = modulo(*y, img->height);
    return true;
}

static bool wrap_black(int *x, int *y, const image *img)
{
    return *x >= 0 && *x < img->width && *y >= 0 && *y < img->height;
}

static bool wrap_clamp(int *x, int *y, const image *img)
{
    *x = CLAMP(*x, 0, img->width - 1);
    *y = CLAMP(*y, 0, img->height - 1);
    return true;
}

/* Beyond an edge of the square the sphere goes on at the edge's mirror image. */
static bool wrap_octahedral(int *x, int *y, const image *img)
{
    int w = img->width, h = img->height;
    *x = modulo(*x, 2 * w);
    *y = modulo(*y, 2 * h);
    if (*x >= w) {
        *x = 2 * w - 1 - *x;
        *y = modulo(h - 1 - *y, 2 * h);
    }
    if (*y >= h) {
        *y = 2 * h - 1 - *y;
        *x = w - 1 - *x;
    }
    return true;
}

/* Beyond a pole lies the meridian on the other side. */
static bool wrap_latlong(int *x, int *y, const image *img)
{
    *y = modulo(*y, 2 * img->height);
    if (*y >= img->height) {
        *y = 2 * img->height - 1 - *y;
        *x += img->width / 2;
    }
    *x = modulo(*x, img->width);
    return true;
}

static const float *texel(const image *img, int x, int y, picture_wrap wrap)
{
    static const wrap_function wraps[] = {[WRAP_REPEAT] = wrap_repeat,
                                          [WRAP_BLACK] = wrap_black,
                                          [WRAP_CLAMP] = wrap_clamp,
                                          [WRAP_OCTAHEDRAL] = wrap_octahedral,
                                          [WRAP_LATLONG] = wrap_latlong};
    bool inside = x >= 0 && x < img->width && y >= 0 && y < img->height;
    if (!inside && !wraps[wrap](&x, &y, img))
        return NULL;
    size_t at = (size_t)y * (size_t)img->width + (size_t)x;
    return img->pixels + at * (size_t)img->n_channels;
}

/* Keeps the integer part representable; at 2^24 texels a float has no fraction left. */
static float limited(float x)
{
    return isfinite(x) ? clampf(x, -0x1p24f, 0x1p24f) : 0.0f;
}

texel_mix picture_nearest(const picture *pic, int level, vec2 st, picture_wrap wrap)
{
    const image *img = pic->levels[level];
    float x = limited(st.x * (float)img->width), y = limited(st.y * (float)img->height);
    return (texel_mix){.texels = {texel(img, (int)floorf(x), (int)floorf(y), wrap)},
                       .weights = {1.0f}};
}

texel_mix picture_bilinear(const picture *pic, int level, vec2 st, picture_wrap wrap)
{
    const image *img = pic->levels[level];
    float x = limited(st.x * (float)img->width) - 0.5f;
    float y = limited(st.y * (float)img->height) - 0.5f;
    int i = (int)floorf(x), j = (int)floorf(y);
    float dx = x - (float)i, dy = y - (float)j;
    return (texel_mix){
        .texels = {texel(img, i, j, wrap), texel(img, i + 1, j, wrap),
                   texel(img, i, j + 1, wrap), texel(img, i + 1, j + 1, wrap)},
        .weights = {(1.0f - dx) * (1.0f - dy), dx * (1.0f - dy), (1.0f - dx) * dy,
                    dx * dy},
    };
}

float texel_mix_channel(const texel_mix *mix, int channel)
{
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        if (mix->texels[i])
            sum += mix->weights[i] * mix->texels[i][channel];
    return sum;
}

void picture_rgb(const picture *pic, const texel_mix *mix, float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = texel_mix_channel(mix, pic->channels[c]);
}

void picture_texel_mean(const picture *pic, picture_wrap wrap, int x, int y, float rgb[3])
{
    static const float weights[3] = {0.125f, 0.75f, 0.125f};
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const float *t = texel(pic->levels[0], x + i, y + j, wrap);
            for (int c = 0; c < 3 && t; c++)
                rgb[c] += weights[i + 1] * weights[j + 1] * t[pic->channels[c]];
        }
}

float picture_level(const picture *pic, float width)
{
    const image *img = pic->levels[0];
    return log2f(maxf(width * (float)MIN(img->width, img->height), 1e-8f));
}
