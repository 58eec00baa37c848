/*
 * "gltf": an image as glTF 2.0 uses it: one of its channels as a number, or its colours,
 * times a factor; repeated, clamped or mirrored along each axis; turned about by
 * KHR_texture_transform.
 *
 *   (u', v') = offset + R(rotation) (uscale u, vscale v)    with v downwards, as glTF has
 * it
 *
 * Coordinates arrive with v upwards, as pbrt has it.
 */
#include "scene/picture.h"
#include "scene/scene.h"
#include "scene/texture_kinds.h"

enum { AXIS_REPEAT, AXIS_CLAMP, AXIS_MIRROR };
enum { FILTER_BILINEAR, FILTER_POINT };

typedef struct gltf_texture {
    picture pic;
    int channel; /* of a number, 0..3 */
    int wrap_u, wrap_v, filter;
    float matrix[2][3];
    float factor[3]; /* a number's is the first */
    float cutoff;    /* of a number: it is 0 below and 1 from there on; < 0: none */
} gltf_texture;

static void gltf_free(void *self)
{
    gltf_texture *t = self;
    picture_clear(&t->pic);
    g_free(t);
}

static bool read_transform(gltf_texture *t, const params *p, GError **error)
{
    float du = 0.0f, dv = 0.0f, su = 1.0f, sv = 1.0f, angle = 0.0f;
    if (!params_float(p, "udelta", &du, error) ||
        !params_float(p, "vdelta", &dv, error) ||
        !params_float(p, "uscale", &su, error) ||
        !params_float(p, "vscale", &sv, error) ||
        !params_float(p, "rotation", &angle, error))
        return false;
    float c = cosf(angle), s = sinf(angle);
    const float matrix[2][3] = {{c * su, s * sv, du}, {-s * su, c * sv, dv}};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            t->matrix[i][j] = matrix[i][j];
    return true;
}

static bool read_factor(gltf_texture *t, bool is_spectrum, const params *p,
                        GError **error)
{
    t->factor[0] = t->factor[1] = t->factor[2] = 1.0f;
    t->cutoff = -1.0f;
    if (!is_spectrum)
        return params_float(p, "factor", &t->factor[0], error) &&
               params_float(p, "cutoff", &t->cutoff, error);
    const param *q = params_find(p, "factor");
    if (q && (q->type != PARAM_RGB || q->n != 3)) {
        error_at(error, q->place, "parameter 'factor': expected an rgb");
        return false;
    }
    for (int i = 0; q && i < 3; i++) {
        t->factor[i] = q->numbers[i];
        if (!(t->factor[i] >= 0.0f && isfinite(t->factor[i]))) {
            error_at(error, q->place, "parameter 'factor': expected numbers >= 0");
            return false;
        }
    }
    return true;
}

static bool read_options(gltf_texture *t, bool is_spectrum, const params *p,
                         GError **error)
{
    static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
    static const char *const filters[] = {"bilinear", "point", NULL};
    static const char *const channels[] = {"R", "G", "B", "A", NULL};
    return params_choice(p, "uwrap", wraps, &t->wrap_u, error) &&
           params_choice(p, "vwrap", wraps, &t->wrap_v, error) &&
           params_choice(p, "filter", filters, &t->filter, error) &&
           (is_spectrum || params_choice(p, "channel", channels, &t->channel, error)) &&
           read_transform(t, p, error) && read_factor(t, is_spectrum, p, error);
}

/* Colours are sRGB; what is not a colour is written as it is. */
static void *gltf_create(const struct scene *s, bool is_spectrum, const params *p,
                         GError **error)
{
    const image_read_options options = {
        .encoding = is_spectrum ? ENCODING_AUTO : ENCODING_LINEAR, .gamma = 1.0f};
    gltf_texture *t = g_new0(gltf_texture, 1);
    if (read_options(t, is_spectrum, p, error) &&
        picture_read(&t->pic, s, p, "filename", &options, error))
        return t;
    gltf_free(t);
    return NULL;
}

/* A coordinate within the image, folded as the axis says. */
static float folded(float x, int wrap)
{
    if (wrap == AXIS_CLAMP)
        return clampf(x, 0.0f, 1.0f);
    if (wrap == AXIS_REPEAT)
        return x - floorf(x);
    float y = x - 2.0f * floorf(0.5f * x);
    return y > 1.0f ? 2.0f - y : y;
}

static texel_mix look_up(const gltf_texture *t, vec2 uv)
{
    float v = 1.0f - uv.y;
    const float(*m)[3] = t->matrix;
    vec2 st = {m[0][0] * uv.x + m[0][1] * v + m[0][2],
               m[1][0] * uv.x + m[1][1] * v + m[1][2]};
    bool repeats = t->wrap_u == AXIS_REPEAT && t->wrap_v == AXIS_REPEAT;
    if (!repeats)
        st = (vec2){folded(st.x, t->wrap_u), folded(st.y, t->wrap_v)};
    picture_wrap wrap = repeats ? WRAP_REPEAT : WRAP_CLAMP;
    return t->filter == FILTER_POINT ? picture_nearest(&t->pic, 0, st, wrap)
                                     : picture_bilinear(&t->pic, 0, st, wrap);
}

/* An image without alpha is opaque. */
static float gltf_eval_float(const void *self, const surface_hit *hit)
{
    const gltf_texture *t = self;
    int channel = t->pic.channels[t->channel];
    float value = t->factor[0];
    if (channel >= 0) {
        texel_mix mix = look_up(t, hit->uv);
        value *= texel_mix_channel(&mix, channel);
    }
    if (t->cutoff >= 0.0f)
        return value < t->cutoff ? 0.0f : 1.0f;
    return value;
}

static spectrum gltf_eval_spectrum(const void *self, const surface_hit *hit,
                                   const wavelengths *w, curve_role role)
{
    const gltf_texture *t = self;
    float rgb[3];
    texel_mix mix = look_up(t, hit->uv);
    picture_rgb(&t->pic, &mix, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = maxf(0.0f, rgb[i] * t->factor[i]);
    return rgb_eval(t->pic.space, rgb, role, w);
}

const texture_kind texture_gltf = {
    .name = "gltf",
    .parameters = "filename uwrap vwrap filter channel uscale vscale udelta vdelta "
                  "rotation factor cutoff",
    .create = gltf_create,
    .free = gltf_free,
    .eval_float = gltf_eval_float,
    .eval_spectrum = gltf_eval_spectrum,
};
