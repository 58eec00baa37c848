/*
 * Textures that choose between or mix others with weights that change over the surface:
 *
 *   scale        tex times scale
 *   mix          (1 - amount) tex1 + amount tex2
 *   directionmix |n·dir| tex1 + (1 - |n·dir|) tex2, n the true normal
 *   checkerboard tex1 and tex2 in turn, in the plane or in space
 *   dots         discs strewn over the plane, some cells without; inside is around them
 *   bilerp       between four corners of the unit square
 *
 * Each is Σ weight input; what they differ in is how the weights come about. Edges are
 * sharp: the samples of a pixel smooth them.
 */
#include "math/noise.h"
#include "texture/mapping.h"
#include "texture/texture_input.h"
#include "texture/texture_kinds.h"

enum { MAX_INPUTS = 4 };

typedef struct blend blend;
typedef void (*weigh_function)(const blend *b, const surface_hit *hit,
                               float weights[MAX_INPUTS]);

struct blend {
    texture_input inputs[MAX_INPUTS];
    int n;
    weigh_function weigh;
    float_input amount; /* of mix, or the scale */
    mapping2 mapping;   /* in the plane */
    transform to_texture;
    vec3 direction;
};

static void blend_free(void *self)
{
    blend *b = self;
    for (int i = 0; i < MAX_INPUTS; i++)
        texture_input_clear(&b->inputs[i]);
    g_free(b);
}

typedef struct blend_input {
    const char *name;
    float fallback;
} blend_input;

static blend *blend_new(const build_context *context, bool is_spectrum, const params *p,
                        const blend_input *inputs, int n, GError **error)
{
    blend *b = g_new0(blend, 1);
    b->n = n;
    for (int i = 0; i < n; i++)
        if (!texture_input_init(&b->inputs[i], context, p, inputs[i].name, is_spectrum,
                                inputs[i].fallback, error)) {
            blend_free(b);
            return NULL;
        }
    return b;
}

static blend *finish(blend *b, bool done, weigh_function weigh)
{
    if (done) {
        b->weigh = weigh;
        return b;
    }
    blend_free(b);
    return NULL;
}

static float blend_eval_float(const void *self, const surface_hit *hit)
{
    const blend *b = self;
    float weights[MAX_INPUTS], sum = 0.0f;
    b->weigh(b, hit, weights);
    for (int i = 0; i < b->n; i++)
        if (fabsf(weights[i]) > 0.0f)
            sum += weights[i] * texture_input_float(&b->inputs[i], hit);
    return sum;
}

static spectrum blend_eval_spectrum(const void *self, const surface_hit *hit,
                                    const wavelengths *w, curve_role role)
{
    const blend *b = self;
    float weights[MAX_INPUTS];
    spectrum sum = {0};
    b->weigh(b, hit, weights);
    for (int i = 0; i < b->n; i++)
        if (fabsf(weights[i]) > 0.0f)
            sum += weights[i] * texture_input_spectrum(&b->inputs[i], hit, w, role);
    return sum;
}

/* ---- scale ---- */

static void weigh_scale(const blend *b, const surface_hit *hit, float weights[MAX_INPUTS])
{
    weights[0] = float_input_eval(&b->amount, hit);
}

static void *scale_create(const build_context *context, bool is_spectrum, const params *p,
                          GError **error)
{
    static const blend_input inputs[] = {{"tex", 1.0f}};
    blend *b = blend_new(context, is_spectrum, p, inputs, 1, error);
    return b ? finish(b, float_input_init(&b->amount, context, p, "scale", 1.0f, error),
                      weigh_scale)
             : NULL;
}

/* ---- mix ---- */

static void weigh_mix(const blend *b, const surface_hit *hit, float weights[MAX_INPUTS])
{
    weights[1] = float_input_eval(&b->amount, hit);
    weights[0] = 1.0f - weights[1];
}

static const blend_input dark_and_light[] = {{"tex1", 0.0f}, {"tex2", 1.0f}};

static void *mix_create(const build_context *context, bool is_spectrum, const params *p,
                        GError **error)
{
    blend *b = blend_new(context, is_spectrum, p, dark_and_light, 2, error);
    return b ? finish(b, float_input_init(&b->amount, context, p, "amount", 0.5f, error),
                      weigh_mix)
             : NULL;
}

/* ---- directionmix ---- */

static void weigh_direction(const blend *b, const surface_hit *hit,
                            float weights[MAX_INPUTS])
{
    weights[0] = minf(1.0f, fabsf(dot3(hit->n_geom, b->direction)));
    weights[1] = 1.0f - weights[0];
}

static bool read_direction(blend *b, const params *p, GError **error)
{
    vec3 direction = vec3_make(0.0f, 1.0f, 0.0f);
    if (!params_point3(p, "dir", &direction, error))
        return false;
    b->direction = normalize3(transform_vector(&p->to_world, direction));
    if (length3_2(b->direction) > 0.0f)
        return true;
    error_at(error, params_find(p, "dir")->place,
             "parameter 'dir': expected a vector that is not zero");
    return false;
}

static void *direction_create(const build_context *context, bool is_spectrum,
                              const params *p, GError **error)
{
    blend *b = blend_new(context, is_spectrum, p, dark_and_light, 2, error);
    return b ? finish(b, read_direction(b, p, error), weigh_direction) : NULL;
}

/* ---- checkerboard ---- */

static bool is_odd(float x)
{
    return fmodf(fabsf(floorf(x)), 2.0f) > 0.5f;
}

static void weigh_checks2(const blend *b, const surface_hit *hit,
                          float weights[MAX_INPUTS])
{
    vec2 st = mapping2_eval(&b->mapping, hit).st;
    bool second = is_odd(st.x) != is_odd(st.y);
    weights[0] = second ? 0.0f : 1.0f;
    weights[1] = second ? 1.0f : 0.0f;
}

static void weigh_checks3(const blend *b, const surface_hit *hit,
                          float weights[MAX_INPUTS])
{
    vec3 p = transform_point(&b->to_texture, hit->p);
    bool second = is_odd(p[0]) != (is_odd(p[1]) != is_odd(p[2]));
    weights[0] = second ? 0.0f : 1.0f;
    weights[1] = second ? 1.0f : 0.0f;
}

static void *checks_create(const build_context *context, bool is_spectrum,
                           const params *p, GError **error)
{
    static const blend_input inputs[] = {{"tex1", 1.0f}, {"tex2", 0.0f}};
    int dimension = 2;
    if (!params_integer(p, "dimension", &dimension, error))
        return NULL;
    if (dimension != 2 && dimension != 3) {
        error_at(error, params_find(p, "dimension")->place,
                 "parameter 'dimension': expected 2 or 3, found %d", dimension);
        return NULL;
    }
    blend *b = blend_new(context, is_spectrum, p, inputs, 2, error);
    if (!b)
        return NULL;
    b->to_texture = transform_inverse(&p->to_world);
    return dimension == 3
               ? finish(b, true, weigh_checks3)
               : finish(b, mapping2_init(&b->mapping, p, error), weigh_checks2);
}

/* ---- dots ---- */

static bool is_in_dot(vec2 st)
{
    const float radius = 0.35f, most = 0.5f - radius;
    float x = floorf(st.x + 0.5f), y = floorf(st.y + 0.5f);
    if (!(noise3(vec3_make(x + 0.5f, y + 0.5f, 0.5f)) > 0.0f))
        return false;
    float dx = st.x - x - most * noise3(vec3_make(x + 1.5f, y + 2.8f, 0.5f));
    float dy = st.y - y - most * noise3(vec3_make(x + 4.5f, y + 9.8f, 0.5f));
    return dx * dx + dy * dy < radius * radius;
}

/* pbrt's two names are exchanged in versions 3 and 4: the discs show "outside", and
   scenes are made by looking at what pbrt draws. */
static void weigh_dots(const blend *b, const surface_hit *hit, float weights[MAX_INPUTS])
{
    bool in_dot = is_in_dot(mapping2_eval(&b->mapping, hit).st);
    weights[0] = in_dot ? 0.0f : 1.0f;
    weights[1] = in_dot ? 1.0f : 0.0f;
}

static void *dots_create(const build_context *context, bool is_spectrum, const params *p,
                         GError **error)
{
    static const blend_input inputs[] = {{"inside", 1.0f}, {"outside", 0.0f}};
    blend *b = blend_new(context, is_spectrum, p, inputs, 2, error);
    return b ? finish(b, mapping2_init(&b->mapping, p, error), weigh_dots) : NULL;
}

/* ---- bilerp ---- */

static void weigh_corners(const blend *b, const surface_hit *hit,
                          float weights[MAX_INPUTS])
{
    vec2 st = mapping2_eval(&b->mapping, hit).st;
    for (int i = 0; i < 4; i++)
        weights[i] = (i >> 1 ? st.x : 1.0f - st.x) * (i & 1 ? st.y : 1.0f - st.y);
}

static void *bilerp_create(const build_context *context, bool is_spectrum,
                           const params *p, GError **error)
{
    static const blend_input inputs[] = {
        {"v00", 0.0f}, {"v01", 1.0f}, {"v10", 0.0f}, {"v11", 1.0f}};
    blend *b = blend_new(context, is_spectrum, p, inputs, 4, error);
    return b ? finish(b, mapping2_init(&b->mapping, p, error), weigh_corners) : NULL;
}

static unsigned blend_steps(const void *self)
{
    const blend *b = self;
    unsigned steps = texture_steps(b->amount.texture);
    for (int i = 0; i < b->n; i++)
        steps += texture_steps(b->inputs[i].texture);
    return steps;
}

#define BLEND_KIND(name_, parameters_, create_)                                          \
    {                                                                                    \
        .name = (name_), .parameters = (parameters_), .create = (create_),               \
        .free = blend_free, .eval_float = blend_eval_float,                              \
        .eval_spectrum = blend_eval_spectrum, .input_steps = blend_steps,                \
    }

const texture_kind texture_scale = BLEND_KIND("scale", "tex scale", scale_create);
const texture_kind texture_mix = BLEND_KIND("mix", "tex1 tex2 amount", mix_create);
const texture_kind texture_direction_mix =
    BLEND_KIND("directionmix", "tex1 tex2 dir", direction_create);
const texture_kind texture_checkerboard =
    BLEND_KIND("checkerboard", "tex1 tex2 dimension " MAPPING_PARAMETERS, checks_create);
const texture_kind texture_dots =
    BLEND_KIND("dots", "inside outside " MAPPING_PARAMETERS, dots_create);
const texture_kind texture_bilerp =
    BLEND_KIND("bilerp", "v00 v01 v10 v11 " MAPPING_PARAMETERS, bilerp_create);
