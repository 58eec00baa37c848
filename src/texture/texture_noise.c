/*
 * Textures of Perlin's noise in space: fbm, wrinkled and windy, which are numbers, and
 * marble, which is an albedo. Noise finer than the eye resolves is not left out: the
 * samples of a pixel smooth it.
 */
#include "math/noise.h"
#include "texture/texture_kinds.h"

typedef struct cloud {
    transform to_texture;
    int octaves;
    float omega, scale, variation;
    float (*eval)(const struct cloud *c, vec3 p);
} cloud;

static bool read_octaves(cloud *c, const params *p, GError **error)
{
    c->octaves = 8;
    c->omega = 0.5f;
    if (!params_integer(p, "octaves", &c->octaves, error) ||
        !params_float(p, "roughness", &c->omega, error))
        return false;
    if (c->octaves >= 1 && c->octaves <= 64 && c->omega >= 0.0f)
        return true;
    error_at(error, p->place,
             "expected 1 to 64 'octaves' and a 'roughness' >= 0, found %d and %g",
             c->octaves, (double)c->omega);
    return false;
}

static void *create(bool is_spectrum, bool wanted, const params *p, const char *type,
                    float (*eval)(const cloud *c, vec3 p), GError **error)
{
    if (is_spectrum != wanted) {
        error_at(error, p->place, "this kind of texture is of type %s", type);
        return NULL;
    }
    cloud *c = g_new0(cloud, 1);
    c->to_texture = transform_inverse(&p->to_world);
    c->eval = eval;
    return c;
}

static float cloud_eval(const void *self, const surface_hit *hit)
{
    const cloud *c = self;
    return c->eval(c, transform_point(&c->to_texture, hit->p));
}

static void *with_octaves(cloud *c, const params *p, GError **error)
{
    if (c && read_octaves(c, p, error))
        return c;
    g_free(c);
    return NULL;
}

/* ---- fbm, wrinkled, windy ---- */

static float eval_fbm(const cloud *c, vec3 p)
{
    return noise_fbm(p, c->omega, c->octaves);
}

static void *fbm_create(const build_context *context, bool is_spectrum, const params *p,
                        GError **error)
{
    (void)context;
    return with_octaves(create(is_spectrum, false, p, "float", eval_fbm, error), p,
                        error);
}

static float eval_wrinkled(const cloud *c, vec3 p)
{
    return noise_turbulence(p, c->omega, c->octaves);
}

static void *wrinkled_create(const build_context *context, bool is_spectrum,
                             const params *p, GError **error)
{
    (void)context;
    return with_octaves(create(is_spectrum, false, p, "float", eval_wrinkled, error), p,
                        error);
}

/* Waves, higher where the wind is strong. */
static float eval_windy(const cloud *c, vec3 p)
{
    (void)c;
    return fabsf(noise_fbm(0.1f * p, 0.5f, 3)) * noise_fbm(p, 0.5f, 6);
}

static void *windy_create(const build_context *context, bool is_spectrum, const params *p,
                          GError **error)
{
    (void)context;
    return create(is_spectrum, false, p, "float", eval_windy, error);
}

/* ---- marble ---- */

/* Where in the veins a point lies, 0..1. */
static float eval_marble(const cloud *c, vec3 p)
{
    p *= c->scale;
    float phase = p[1] + c->variation * noise_fbm(p, c->omega, c->octaves);
    return 0.5f + 0.5f * sinf(phase);
}

static void *marble_create(const build_context *context, bool is_spectrum,
                           const params *p, GError **error)
{
    (void)context;
    cloud *c = with_octaves(create(is_spectrum, true, p, "spectrum", eval_marble, error),
                            p, error);
    if (!c)
        return NULL;
    c->scale = 1.0f;
    c->variation = 0.2f;
    if (params_float(p, "scale", &c->scale, error) &&
        params_float(p, "variation", &c->variation, error))
        return c;
    g_free(c);
    return NULL;
}

/* pbrt-v4's colours of the veins, control points of cubic Bézier curves. */
static void vein_colour(float t, float rgb[3])
{
    enum { N = 9, SEGMENTS = N - 3 };
    static const float colours[N][3] = {
        {.58f, .58f, .6f}, {.58f, .58f, .6f}, {.58f, .58f, .6f},
        {.5f, .5f, .5f},   {.6f, .59f, .58f}, {.58f, .58f, .6f},
        {.58f, .58f, .6f}, {.2f, .2f, .33f},  {.58f, .58f, .6f},
    };
    int first = MIN((int)(t * SEGMENTS), SEGMENTS - 1);
    float x = t * SEGMENTS - (float)first, y = 1.0f - x;
    const float weights[4] = {y * y * y, 3.0f * y * y * x, 3.0f * y * x * x, x * x * x};
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0.0f;
        for (int k = 0; k < 4; k++)
            rgb[c] += 1.5f * weights[k] * colours[first + k][c];
    }
}

static spectrum marble_eval(const void *self, const surface_hit *hit,
                            const wavelengths *w, curve_role role)
{
    float rgb[3];
    vein_colour(cloud_eval(self, hit), rgb);
    return rgb_eval(color_space_srgb(), rgb, role, w);
}

#define FLOAT_KIND(name_, parameters_, create_)                                          \
    {                                                                                    \
        .name = (name_), .parameters = (parameters_), .create = (create_),               \
        .free = g_free, .eval_float = cloud_eval,                                        \
    }

const texture_kind texture_fbm = FLOAT_KIND("fbm", "octaves roughness", fbm_create);
const texture_kind texture_wrinkled =
    FLOAT_KIND("wrinkled", "octaves roughness", wrinkled_create);
const texture_kind texture_windy = FLOAT_KIND("windy", "", windy_create);
const texture_kind texture_marble = {
    .name = "marble",
    .parameters = "octaves roughness scale variation",
    .create = marble_create,
    .free = g_free,
    .eval_spectrum = marble_eval,
};
