/*
 * Images as textures, in pbrt-v4's conventions: t upwards, so that (0, 0) is the lower
 * left corner of the picture.
 *
 * Texels are mixed as RGB and the mixture is made a spectrum: coefficients of smooth
 * spectra must not be mixed, they are not linear. "point" and "bilinear" look at the
 * image itself; "trilinear", and "EWA" as trilinear, at the levels of its pyramid that
 * are as coarse as what the eye sees at once. Photons, which have no such width, and rays
 * whose width is not known look at the image itself in any case.
 */
#include "params/build_context.h"
#include "texture/mapping.h"
#include "texture/picture.h"
#include "texture/texture_kinds.h"

#include <string.h>

enum { FILTER_BILINEAR, FILTER_POINT, FILTER_TRILINEAR, FILTER_EWA };

typedef struct imagemap {
    picture *pic;
    mapping2 mapping;
    bool use_alpha; /* as a number it is the alpha channel */
    int wrap, filter;
    float scale;
    bool invert;
} imagemap;

static void imagemap_free(void *self)
{
    imagemap *m = self;
    picture_unref(m->pic);
    g_free(m);
}

/* Stretched footprints are looked up as round ones, so the limit has nothing to limit;
 * pbrt reads it with every filter, and uses it with "EWA". */
static bool read_anisotropy(const params *p, GError **error)
{
    float most = 8.0f;
    return params_float(p, "maxanisotropy", &most, error);
}

static bool read_options(imagemap *m, const params *p, GError **error)
{
    static const char *const wraps[] = {"repeat", "black", "clamp", "octahedralsphere",
                                        NULL};
    static const char *const filters[] = {"bilinear", "point", "trilinear",
                                          "EWA",      "ewa",   NULL};
    m->scale = 1.0f;
    bool done = mapping2_init(&m->mapping, p, error) &&
                params_choice(p, "wrap", wraps, &m->wrap, error) &&
                params_choice(p, "filter", filters, &m->filter, error) &&
                params_float(p, "scale", &m->scale, error) &&
                params_bool(p, "invert", &m->invert, error);
    m->filter = MIN(m->filter, FILTER_EWA);
    return done && read_anisotropy(p, error);
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

static void *imagemap_create(const build_context *context, bool is_spectrum,
                             const params *p, GError **error)
{
    image_read_options options;
    imagemap *m = g_new0(imagemap, 1);
    if (!read_options(m, p, error) || !read_encoding(p, &options, error) ||
        !(m->pic = picture_read(context, p, "filename", &options, error)) ||
        (m->filter >= FILTER_TRILINEAR && !picture_build_levels(m->pic, error))) {
        imagemap_free(m);
        return NULL;
    }
    m->use_alpha = !is_spectrum && picture_has_alpha(m->pic);
    return m;
}

/* A look-up: one or two mixtures of texels and the share of the second. */
typedef struct filtered {
    texel_mix near, far;
    float share;
} filtered;

static filtered look_up(const imagemap *m, const surface_hit *hit)
{
    texture_point2 at = mapping2_eval(&m->mapping, hit);
    vec2 st = {at.st.x, 1.0f - at.st.y};
    const picture_wrap wrap = (picture_wrap)m->wrap;
    if (m->filter == FILTER_POINT)
        return (filtered){.near = picture_nearest(m->pic, 0, st, wrap)};
    float level = m->filter == FILTER_BILINEAR
                      ? 0.0f
                      : picture_level(m->pic, 2.0f * maxf(at.ds, at.dt));
    float last = (float)(m->pic->n_levels - 1);
    level = clampf(level, 0.0f, last);
    int whole = (int)level;
    filtered out = {.near = picture_bilinear(m->pic, whole, st, wrap),
                    .share = level - (float)whole};
    if (out.share > 0.0f)
        out.far = picture_bilinear(m->pic, whole + 1, st, wrap);
    return out;
}

static float mixed(const filtered *f, int channel)
{
    float value = texel_mix_channel(&f->near, channel);
    if (!(f->share > 0.0f))
        return value;
    return lerpf(value, texel_mix_channel(&f->far, channel), f->share);
}

static float imagemap_eval_float(const void *self, const surface_hit *hit)
{
    const imagemap *m = self;
    const int *channels = m->pic->channels;
    filtered f = look_up(m, hit);
    float value;
    if (m->use_alpha)
        value = mixed(&f, channels[3]);
    else if (m->pic->grey)
        value = mixed(&f, channels[0]);
    else
        value =
            (mixed(&f, channels[0]) + mixed(&f, channels[1]) + mixed(&f, channels[2])) *
            (1.0f / 3.0f);
    value *= m->scale;
    return m->invert ? maxf(0.0f, 1.0f - value) : value;
}

static spectrum imagemap_eval_spectrum(const void *self, const surface_hit *hit,
                                       const wavelengths *w, curve_role role)
{
    const imagemap *m = self;
    filtered f = look_up(m, hit);
    float rgb[3];
    for (int i = 0; i < 3; i++) {
        float value = m->scale * mixed(&f, m->pic->channels[i]);
        rgb[i] = maxf(0.0f, m->invert ? 1.0f - value : value);
    }
    if (m->pic->grey && role != CURVE_EMISSION)
        return spectrum_fill(rgb[0]);
    return rgb_eval(m->pic->space, rgb, role, w);
}

const texture_kind texture_imagemap = {
    .name = "imagemap",
    .parameters =
        "filename wrap filter maxanisotropy encoding scale invert " MAPPING_PARAMETERS,
    .create = imagemap_create,
    .free = imagemap_free,
    .eval_float = imagemap_eval_float,
    .eval_spectrum = imagemap_eval_spectrum,
};
