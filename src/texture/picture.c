#include "texture/picture.h"

#include "base/wanted.h"
#include "params/build_context.h"

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

/* The space that the image says it is in; sRGB if it says nothing; NULL if we know none
   such. */
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

/* Channels and colour space. */
static bool understand(picture *pic, const image *img, const char *path, GError **error)
{
    if (!image_colors(img, pic->channels)) {
        error_set(error, ERROR_INPUT, "%s: expected channels R, G, B or one channel",
                  path);
        return false;
    }
    pic->grey = pic->channels[0] == pic->channels[1];
    pic->space = space_of(img);
    if (!pic->space)
        error_set(error, ERROR_INPUT,
                  "%s: its primaries belong to no colour space we know", path);
    return pic->space != NULL;
}

/* The picture, with the image as its texels; both are taken. @return NULL: no memory */
static picture *picture_of(picture *pic, image *taken, GError **error)
{
    pic->levels[0] = texels_from_image(taken, error);
    pic->n_levels = 1;
    if (pic->levels[0])
        return pic;
    picture_unref(pic);
    return NULL;
}

picture *picture_of_color(int side, const color_space *space, const float rgb[3],
                          GError **error)
{
    image *img = image_new(side, side, 3, image_rgb_names, error);
    if (!img)
        return NULL;
    for (int i = 0; i < 3 * side * side; i++)
        img->pixels[i] = rgb[i % 3];
    picture *pic = g_rc_box_new0(picture);
    *pic = (picture){.channels = {0, 1, 2, -1}, .space = space};
    return picture_of(pic, img, error);
}

static picture *read_path(const build_context *context, const char *path,
                          const image_read_options *options, GError **error)
{
    image *img = build_context_read_image(context, path, options, error);
    if (!img)
        return NULL;
    picture *pic = g_rc_box_new0(picture);
    if (!understand(pic, img, path, error)) {
        image_free(img);
        picture_unref(pic);
        return NULL;
    }
    return picture_of(pic, img, error);
}

picture *picture_read_file(const build_context *context, const char *path,
                           const image_read_options *options, GError **error)
{
    if (!context)
        return read_path(context, path, options, error);
    image_encoding encoding = options ? options->encoding : ENCODING_AUTO;
    float gamma = encoding == ENCODING_GAMMA ? options->gamma : 1.0f;
    g_autofree char *key =
        g_strdup_printf("%d %a %s", (int)encoding, (double)gamma, path);
    picture *pic = g_hash_table_lookup(context->pictures, key);
    if (pic)
        return g_rc_box_acquire(pic);
    pic = read_path(context, path, options, error);
    if (pic)
        g_hash_table_insert(context->pictures, g_steal_pointer(&key),
                            g_rc_box_acquire(pic));
    return pic;
}

picture *picture_read(const build_context *context, const params *p, const char *name,
                      const image_read_options *options, GError **error)
{
    g_autofree char *path = NULL;
    if (!params_path(p, name, &path, error))
        return NULL;
    if (!path) {
        error_at(error, p->place, "expected \"string %s\", found none", name);
        return NULL;
    }
    GError *inner = NULL;
    picture *pic = picture_read_file(context, path, options, &inner);
    if (!pic)
        error_move_at(error, params_find(p, name)->place, inner);
    return pic;
}

picture *picture_from_grey(image *taken, GError **error)
{
    picture *pic = g_rc_box_new0(picture);
    pic->channels[3] = -1;
    pic->grey = true;
    pic->space = color_space_srgb();
    return picture_of(pic, taken, error);
}

static void clear(void *data)
{
    picture *pic = data;
    for (int i = 0; i < pic->n_levels; i++)
        texels_free(pic->levels[i]);
}

void picture_unref(picture *pic)
{
    if (pic)
        g_rc_box_release_full(pic, clear);
}

bool picture_has_alpha(const picture *pic)
{
    const texels *t = pic->levels[0];
    if (pic->channels[3] < 0)
        return false;
    for (size_t i = 0; i < texels_count(t) && still_wanted_at(i, NULL); i++)
        if (texels_value(t, i, pic->channels[3]) < 1.0f)
            return true;
    return false;
}

/* ---- Of lights ---- */

#define LARGEST_HALF 65504.0f

static float mend_light(float x)
{
    if (!(x > 0.0f))
        return 0.0f;
    return isfinite(x) ? x : LARGEST_HALF;
}

static bool is_light(float x)
{
    return x >= 0.0f && isfinite(x);
}

/* Texels with a colour that no light has. */
static size_t count_unlit(const picture *pic)
{
    const texels *t = pic->levels[0];
    size_t n = 0;
    for (size_t i = 0; i < texels_count(t) && still_wanted_at(i, NULL); i++)
        n += !is_light(texels_value(t, i, pic->channels[0])) ||
             !is_light(texels_value(t, i, pic->channels[1])) ||
             !is_light(texels_value(t, i, pic->channels[2]));
    return n;
}

/* A picture of its own, since others may share the one that was read. */
static picture *mended(const picture *pic, GError **error)
{
    picture *copy = g_rc_box_new0(picture);
    *copy = *pic;
    memset(copy->levels, 0, sizeof copy->levels);
    copy->levels[0] = texels_mended(pic->levels[0], mend_light, error);
    copy->n_levels = 1;
    if (copy->levels[0])
        return copy;
    picture_unref(copy);
    return NULL;
}

picture *picture_read_light(const build_context *context, const params *p,
                            const char *name, GError **error)
{
    picture *pic = picture_read(context, p, name, NULL, error);
    size_t n = pic ? count_unlit(pic) : 0;
    if (n == 0)
        return pic;
    log_at(p->log, LOG_WARNING, params_find(p, name)->place,
           "%zu texels are below zero or not finite: taken as black, or as 65504", n);
    picture *copy = mended(pic, error);
    picture_unref(pic);
    return copy;
}

/* ---- The pyramid ---- */

bool picture_build_levels(picture *pic, GError **error)
{
    while (pic->n_levels < MAX_PICTURE_LEVELS) {
        const texels *large = pic->levels[pic->n_levels - 1];
        if (large->width == 1 && large->height == 1)
            break;
        texels *small = texels_halved(large, error);
        if (!small)
            return false;
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
typedef bool (*wrap_function)(int *x, int *y, const texels *t);

static bool wrap_repeat(int *x, int *y, const texels *t)
{
    *x = modulo(*x, t->width);
    *y = modulo(*y, t->height);
    return true;
}

static bool wrap_black(int *x, int *y, const texels *t)
{
    return *x >= 0 && *x < t->width && *y >= 0 && *y < t->height;
}

static bool wrap_clamp(int *x, int *y, const texels *t)
{
    *x = CLAMP(*x, 0, t->width - 1);
    *y = CLAMP(*y, 0, t->height - 1);
    return true;
}

/* Beyond an edge of the square the sphere goes on at the edge's mirror image. */
static bool wrap_octahedral(int *x, int *y, const texels *t)
{
    int w = t->width, h = t->height;
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
static bool wrap_latlong(int *x, int *y, const texels *t)
{
    *y = modulo(*y, 2 * t->height);
    if (*y >= t->height) {
        *y = 2 * t->height - 1 - *y;
        *x += t->width / 2;
    }
    *x = modulo(*x, t->width);
    return true;
}

/* The number of the texel at column x, row y. */
static size_t texel(const texels *t, int x, int y, picture_wrap wrap)
{
    static const wrap_function wraps[] = {[WRAP_REPEAT] = wrap_repeat,
                                          [WRAP_BLACK] = wrap_black,
                                          [WRAP_CLAMP] = wrap_clamp,
                                          [WRAP_OCTAHEDRAL] = wrap_octahedral,
                                          [WRAP_LATLONG] = wrap_latlong};
    bool inside = x >= 0 && x < t->width && y >= 0 && y < t->height;
    if (!inside && !wraps[wrap](&x, &y, t))
        return NO_TEXEL;
    return (size_t)y * (size_t)t->width + (size_t)x;
}

/* Keeps the integer part representable; at 2^24 texels a float has no fraction left. */
static float limited(float x)
{
    return isfinite(x) ? clampf(x, -0x1p24f, 0x1p24f) : 0.0f;
}

texel_mix picture_nearest(const picture *pic, int level, vec2 st, picture_wrap wrap)
{
    const texels *t = pic->levels[level];
    float x = limited(st.x * (float)t->width), y = limited(st.y * (float)t->height);
    return (texel_mix){
        .of = t,
        .at = {texel(t, (int)floorf(x), (int)floorf(y), wrap), NO_TEXEL, NO_TEXEL,
               NO_TEXEL},
        .weights = {1.0f},
    };
}

texel_mix picture_bilinear(const picture *pic, int level, vec2 st, picture_wrap wrap)
{
    const texels *t = pic->levels[level];
    float x = limited(st.x * (float)t->width) - 0.5f;
    float y = limited(st.y * (float)t->height) - 0.5f;
    int i = (int)floorf(x), j = (int)floorf(y);
    float dx = x - (float)i, dy = y - (float)j;
    return (texel_mix){
        .of = t,
        .at = {texel(t, i, j, wrap), texel(t, i + 1, j, wrap), texel(t, i, j + 1, wrap),
               texel(t, i + 1, j + 1, wrap)},
        .weights = {(1.0f - dx) * (1.0f - dy), dx * (1.0f - dy), (1.0f - dx) * dy,
                    dx * dy},
    };
}

float texel_mix_channel(const texel_mix *mix, int channel)
{
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        if (mix->at[i] != NO_TEXEL)
            sum += mix->weights[i] * texels_value(mix->of, mix->at[i], channel);
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
    const texels *t = pic->levels[0];
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            size_t at = texel(t, x + i, y + j, wrap);
            for (int c = 0; c < 3 && at != NO_TEXEL; c++)
                rgb[c] += weights[i + 1] * weights[j + 1] *
                          texels_value(t, at, pic->channels[c]);
        }
}

float picture_level(const picture *pic, float width)
{
    const texels *t = pic->levels[0];
    return log2f(maxf(width * (float)MIN(t->width, t->height), 1e-8f));
}
