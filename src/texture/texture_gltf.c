/*
 * "gltf": an image as glTF 2.0 uses it: one of its channels as a number, or its colours,
 * times a factor and, if asked to, the colours of the mesh's vertices; looked up by the
 * first or the second set of coordinates; repeated, clamped or mirrored along each axis;
 * turned about by KHR_texture_transform. There may be no image, where the vertices'
 * colours are all. A linear one may be a normal map.
 *
 *   (u', v') = offset + R(rotation) (uscale u, vscale v)    with v downwards, as glTF has
 * it
 *
 * Coordinates arrive with v upwards, as pbrt has it.
 */
#include "params/build_context.h"
#include "texture/mesh_attributes.h"
#include "texture/picture.h"
#include "texture/texture_kinds.h"

enum { AXIS_REPEAT, AXIS_CLAMP, AXIS_MIRROR };
enum { FILTER_BILINEAR, FILTER_POINT };

typedef struct gltf_texture {
    picture *pic;              /* NULL: white */
    int uv_set;                /* 0 or 1 */
    bool vertex_color, invert; /* invert: a number x becomes 1 - x */
    int channel;               /* of a number, 0..3 */
    int wrap_u, wrap_v, filter;
    float matrix[2][3];
    float factor[3]; /* a number's is the first */
    float cutoff;    /* of a number: it is 0 below and 1 from there on; < 0: none */
} gltf_texture;

static void gltf_free(void *self)
{
    gltf_texture *t = self;
    picture_unref(t->pic);
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
        return params_bool(p, "invert", &t->invert, error) &&
               params_float(p, "factor", &t->factor[0], error) &&
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

static bool read_attributes(gltf_texture *t, const params *p, GError **error)
{
    if (!params_integer(p, "uvset", &t->uv_set, error) ||
        !params_bool(p, "vertexcolor", &t->vertex_color, error))
        return false;
    if (t->uv_set == 0 || t->uv_set == 1)
        return true;
    error_at(error, params_find(p, "uvset")->place,
             "parameter 'uvset': expected 0 or 1, found %d", t->uv_set);
    return false;
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
           read_attributes(t, p, error) && read_transform(t, p, error) &&
           read_factor(t, is_spectrum, p, error);
}

/* Colours are sRGB, unless they are no colours; numbers are written as they are. Alpha is
   so in any encoding: that of the colours is read with them. */
static bool read_picture(gltf_texture *t, const build_context *context, bool is_spectrum,
                         const params *p, GError **error)
{
    static const char *const encodings[] = {"auto", "linear", NULL};
    int linear = 0;
    if (!params_choice(p, "encoding", encodings, &linear, error))
        return false;
    if (t->vertex_color && !params_has(p, "filename"))
        return true;
    bool with_colors = is_spectrum || t->channel == 3;
    const image_read_options options = {
        .encoding = with_colors && !linear ? ENCODING_AUTO : ENCODING_LINEAR};
    t->pic = picture_read(context, p, "filename", &options, error);
    return t->pic != NULL;
}

static void *gltf_create(const build_context *context, bool is_spectrum, const params *p,
                         GError **error)
{
    gltf_texture *t = g_new0(gltf_texture, 1);
    if (read_options(t, is_spectrum, p, error) &&
        read_picture(t, context, is_spectrum, p, error))
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

static texel_mix look_up(const gltf_texture *t, const surface_hit *hit)
{
    vec2 uv = t->uv_set == 1 ? hit_second_uv(hit) : hit->uv;
    float v = 1.0f - uv.y;
    const float(*m)[3] = t->matrix;
    vec2 st = {m[0][0] * uv.x + m[0][1] * v + m[0][2],
               m[1][0] * uv.x + m[1][1] * v + m[1][2]};
    bool repeats = t->wrap_u == AXIS_REPEAT && t->wrap_v == AXIS_REPEAT;
    if (!repeats)
        st = (vec2){folded(st.x, t->wrap_u), folded(st.y, t->wrap_v)};
    picture_wrap wrap = repeats ? WRAP_REPEAT : WRAP_CLAMP;
    return t->filter == FILTER_POINT ? picture_nearest(t->pic, 0, st, wrap)
                                     : picture_bilinear(t->pic, 0, st, wrap);
}

/* An image without alpha is opaque. */
static float gltf_eval_float(const void *self, const surface_hit *hit)
{
    const gltf_texture *t = self;
    int channel = t->pic ? t->pic->channels[t->channel] : -1;
    float value = t->factor[0];
    if (channel >= 0) {
        texel_mix mix = look_up(t, hit);
        value *= texel_mix_channel(&mix, channel);
    }
    if (t->vertex_color)
        value *= hit_vertex_color(hit, t->channel);
    if (t->invert)
        value = 1.0f - value;
    if (t->cutoff >= 0.0f)
        return value < t->cutoff ? 0.0f : 1.0f;
    return value;
}

static void look_up_rgb(const gltf_texture *t, const surface_hit *hit, float rgb[3])
{
    texel_mix mix = look_up(t, hit);
    picture_rgb(t->pic, &mix, rgb);
}

static spectrum gltf_eval_spectrum(const void *self, const surface_hit *hit,
                                   const wavelengths *w, curve_role role)
{
    const gltf_texture *t = self;
    float rgb[3] = {1.0f, 1.0f, 1.0f};
    if (t->pic)
        look_up_rgb(t, hit, rgb);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= t->factor[i] * (t->vertex_color ? hit_vertex_color(hit, i) : 1.0f);
        rgb[i] = maxf(0.0f, rgb[i]);
    }
    return rgb_eval(t->pic ? t->pic->space : color_space_srgb(), rgb, role, w);
}

/* Tangents that the mesh itself has are those of the map, wherever it takes its
 * coordinates from (glTF 2.0, 3.7.2.1). */
static void gltf_eval_normal(const void *self, const surface_hit *hit, float rgb[3],
                             vec3 *dpdu, vec3 *dpdv)
{
    const gltf_texture *t = self;
    rgb[0] = rgb[1] = 0.5f;
    rgb[2] = 1.0f;
    if (t->pic)
        look_up_rgb(t, hit, rgb);
    if (hit->mesh && hit->mesh->tangents)
        return;
    if (t->uv_set == 1)
        hit_second_tangents(hit, dpdu, dpdv);
    const float(*m)[3] = t->matrix;
    float determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    vec3 along_u = (*dpdu * m[1][1] + *dpdv * m[1][0]) / determinant;
    vec3 along_v = (*dpdu * m[0][1] + *dpdv * m[0][0]) / determinant;
    if (!finite3(along_u) || !finite3(along_v))
        return;
    *dpdu = along_u;
    *dpdv = along_v;
}

const texture_kind texture_gltf = {
    .name = "gltf",
    .parameters = "filename uwrap vwrap filter channel uscale vscale udelta vdelta "
                  "rotation factor cutoff uvset vertexcolor encoding invert",
    .create = gltf_create,
    .free = gltf_free,
    .eval_float = gltf_eval_float,
    .eval_spectrum = gltf_eval_spectrum,
    .eval_normal = gltf_eval_normal,
};
