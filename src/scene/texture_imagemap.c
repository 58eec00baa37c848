/*
 * Images as textures, in pbrt-v4's conventions: st = scale * uv + delta, t upwards, so
 * that (0, 0) is the lower left corner of the picture.
 *
 * Texels are mixed as RGB and the mixture is made a spectrum: coefficients of smooth
 * spectra must not be mixed, they are not linear.
 */
#include "scene/scene.h"
#include "scene/texture_kinds.h"

#include <string.h>

enum { WRAP_REPEAT, WRAP_BLACK, WRAP_CLAMP };
enum { FILTER_BILINEAR, FILTER_POINT };

typedef struct imagemap {
    image *img;
    int channels[4]; /* of R, G, B and A; -1: there is none. Grey: R = G = B */
    bool grey;
    bool use_alpha; /* as a number it is the alpha channel */
    const color_space *space;
    int wrap, filter;
    float scale;
    bool invert;
    vec2 uv_scale, uv_delta;
} imagemap;

static void imagemap_free(void *self)
{
    imagemap *m = self;
    image_free(m->img);
    g_free(m);
}

static bool read_mapping(imagemap *m, const params *p, GError **error)
{
    static const char *const mappings[] = {"uv", NULL};
    static const char *const wraps[] = {"repeat", "black", "clamp", NULL};
    static const char *const filters[] = {"bilinear", "point", NULL};
    int mapping = 0;
    m->scale = m->uv_scale.x = m->uv_scale.y = 1.0f;
    return params_choice(p, "mapping", mappings, &mapping, error) &&
           params_choice(p, "wrap", wraps, &m->wrap, error) &&
           params_choice(p, "filter", filters, &m->filter, error) &&
           params_float(p, "uscale", &m->uv_scale.x, error) &&
           params_float(p, "vscale", &m->uv_scale.y, error) &&
           params_float(p, "udelta", &m->uv_delta.x, error) &&
           params_float(p, "vdelta", &m->uv_delta.y, error) &&
           params_float(p, "scale", &m->scale, error) &&
           params_bool(p, "invert", &m->invert, error);
}

/* "sRGB", "linear" or "gamma 2.2". */
static bool read_encoding(const params *p, image_read_options *out, GError **error)
{
    const char *text = NULL;
    *out = (image_read_options){.encoding = ENCODING_AUTO, .gamma = 1.0f};
    if (!params_string(p, "encoding", &text, error))
        return false;
    if (!text)
        return true;
    if (strcmp(text, "sRGB") == 0) {
        out->encoding = ENCODING_SRGB;
        return true;
    }
    if (strcmp(text, "linear") == 0) {
        out->encoding = ENCODING_LINEAR;
        return true;
    }
    char *end = NULL;
    if (g_str_has_prefix(text, "gamma "))
        out->gamma = (float)g_ascii_strtod(text + 6, &end);
    if (end && *end == '\0' && out->gamma > 0.0f && isfinite(out->gamma)) {
        out->encoding = ENCODING_GAMMA;
        return true;
    }
    error_at(error, params_find(p, "encoding")->place,
             "parameter 'encoding': expected sRGB, linear or gamma and a number, found "
             "'%s'",
             text);
    return false;
}

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

static bool find_channels(imagemap *m)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int i = 0; i < 4; i++)
        m->channels[i] = image_channel(m->img, names[i]);
    if (m->channels[0] >= 0 && m->channels[1] >= 0 && m->channels[2] >= 0)
        return true;
    int grey = image_channel(m->img, "Y");
    if (grey < 0 && m->img->n_channels == 1)
        grey = 0;
    m->channels[0] = m->channels[1] = m->channels[2] = grey;
    m->grey = true;
    return grey >= 0;
}

/* pbrt drops an alpha channel that is one everywhere. */
static bool alpha_matters(const imagemap *m)
{
    const image *img = m->img;
    if (m->channels[3] < 0)
        return false;
    size_t n = (size_t)img->width * (size_t)img->height, step = (size_t)img->n_channels;
    for (size_t i = 0; i < n; i++)
        if (img->pixels[i * step + (size_t)m->channels[3]] < 1.0f)
            return true;
    return false;
}

static bool read_image(imagemap *m, const struct scene *s, const params *p,
                       GError **error)
{
    g_autofree char *path = NULL;
    image_read_options options;
    if (!params_path(p, "filename", &path, error) || !read_encoding(p, &options, error))
        return false;
    if (!path) {
        error_at(error, p->place, "an imagemap texture needs a 'filename'");
        return false;
    }
    source_place place = params_find(p, "filename")->place;
    g_autoptr(GError) inner = NULL;
    m->img = scene_read_image(s, path, &options, &inner);
    if (!m->img) {
        error_at(error, place, "%s", inner->message);
        return false;
    }
    if (!find_channels(m)) {
        error_at(error, place, "%s: expected channels R, G, B or one channel", path);
        return false;
    }
    m->space = space_of(m->img);
    if (!m->space)
        error_at(error, place, "%s: its primaries belong to no colour space we know",
                 path);
    return m->space != NULL;
}

static void *imagemap_create(const struct scene *s, bool is_spectrum, const params *p,
                             GError **error)
{
    imagemap *m = g_new0(imagemap, 1);
    if (!read_mapping(m, p, error) || !read_image(m, s, p, error)) {
        imagemap_free(m);
        return NULL;
    }
    m->use_alpha = !is_spectrum && alpha_matters(m);
    return m;
}

/* A coordinate wrapped into 0..n-1, or -1: black. */
static int wrapped(int i, int n, int wrap)
{
    if (i >= 0 && i < n)
        return i;
    if (wrap == WRAP_BLACK)
        return -1;
    if (wrap == WRAP_CLAMP)
        return CLAMP(i, 0, n - 1);
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* The texels that a look-up mixes. */
typedef struct footprint {
    const float *texels[4]; /* NULL: black */
    float weights[4];
} footprint;

static const float *texel(const imagemap *m, int x, int y)
{
    const image *img = m->img;
    int i = wrapped(x, img->width, m->wrap), j = wrapped(y, img->height, m->wrap);
    if (i < 0 || j < 0)
        return NULL;
    size_t at = (size_t)j * (size_t)img->width + (size_t)i;
    return img->pixels + at * (size_t)img->n_channels;
}

/* Keeps the integer part representable; at 2^24 texels a float has no fraction left. */
static float limited(float x)
{
    return isfinite(x) ? clampf(x, -0x1p24f, 0x1p24f) : 0.0f;
}

static footprint look_up(const imagemap *m, vec2 uv)
{
    float s = m->uv_scale.x * uv.x + m->uv_delta.x;
    float t = 1.0f - (m->uv_scale.y * uv.y + m->uv_delta.y);
    float x = limited(s * (float)m->img->width), y = limited(t * (float)m->img->height);
    if (m->filter == FILTER_POINT)
        return (footprint){.texels = {texel(m, (int)floorf(x), (int)floorf(y))},
                           .weights = {1.0f}};
    x -= 0.5f, y -= 0.5f;
    int i = (int)floorf(x), j = (int)floorf(y);
    float dx = x - (float)i, dy = y - (float)j;
    return (footprint){
        .texels = {texel(m, i, j), texel(m, i + 1, j), texel(m, i, j + 1),
                   texel(m, i + 1, j + 1)},
        .weights = {(1.0f - dx) * (1.0f - dy), dx * (1.0f - dy), (1.0f - dx) * dy,
                    dx * dy},
    };
}

static float mix(const footprint *f, int channel)
{
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        if (f->texels[i])
            sum += f->weights[i] * f->texels[i][channel];
    return sum;
}

static float imagemap_eval_float(const void *self, const surface_hit *hit)
{
    const imagemap *m = self;
    footprint f = look_up(m, hit->uv);
    float value;
    if (m->use_alpha)
        value = mix(&f, m->channels[3]);
    else if (m->grey)
        value = mix(&f, m->channels[0]);
    else
        value = (mix(&f, m->channels[0]) + mix(&f, m->channels[1]) +
                 mix(&f, m->channels[2])) *
                (1.0f / 3.0f);
    value *= m->scale;
    return m->invert ? maxf(0.0f, 1.0f - value) : value;
}

/* RGB to spectrum as curve_rgb does it, without making a curve where time matters. */
static spectrum to_spectrum(const color_space *space, const float rgb[3],
                            const wavelengths *w, curve_role role)
{
    if (role == CURVE_EMISSION) {
        g_autoptr(curve) c = curve_rgb(space, rgb, role, NULL);
        return c ? curve_eval(c, w) : (spectrum){0};
    }
    /* An albedo fills the unit cube; other quantities are halved into its middle. */
    float top = maxf(rgb[0], maxf(rgb[1], rgb[2])), unit[3], coefficients[3];
    float scale = role == CURVE_ALBEDO ? 1.0f : 2.0f * top;
    if (!(top > 0.0f))
        return (spectrum){0};
    for (int i = 0; i < 3; i++)
        unit[i] = minf(rgb[i] / scale, 1.0f);
    smooth_from_rgb(space, unit, coefficients);
    return smooth_eval(coefficients, w) * scale;
}

static spectrum imagemap_eval_spectrum(const void *self, const surface_hit *hit,
                                       const wavelengths *w, curve_role role)
{
    const imagemap *m = self;
    footprint f = look_up(m, hit->uv);
    float rgb[3];
    for (int i = 0; i < 3; i++) {
        float value = m->scale * mix(&f, m->channels[i]);
        rgb[i] = maxf(0.0f, m->invert ? 1.0f - value : value);
    }
    if (m->grey && role != CURVE_EMISSION)
        return spectrum_fill(rgb[0]);
    return to_spectrum(m->space, rgb, w, role);
}

const texture_kind texture_imagemap = {
    .name = "imagemap",
    .create = imagemap_create,
    .free = imagemap_free,
    .eval_float = imagemap_eval_float,
    .eval_spectrum = imagemap_eval_spectrum,
};
