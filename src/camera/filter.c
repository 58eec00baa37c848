/*
 * All filters are products f(x) f(y) of one profile, so each axis is sampled by itself:
 * |f| is tabulated at nodes, taken as linear between them, and inverted. The weight is
 * f / (density * integral of f), whose mean is one; it is one everywhere for box and
 * triangle, nearly so for the Gaussian, and changes its sign with the filter.
 *
 *   nodes  |f|  .  :  |  |  :  .      cell i between nodes i and i + 1
 *              -r      0      r
 *
 * Mitchell & Netravali, "Reconstruction Filters in Computer Graphics", 1988; names and
 * defaults of parameters are pbrt-v4's.
 */
#include "camera/filter.h"

#include "math/distribution.h"
#include "math/sampler.h"

#include <string.h>

enum { N_CELLS = 512, N_SHAPE = 2 };

typedef struct filter_kind filter_kind;

/* One axis of a filter. */
typedef struct profile {
    const filter_kind *kind;
    float radius;
    float shape[N_SHAPE]; /* what else the kind has: sigma, tau, or B and C */
} profile;

struct filter_kind {
    const char *name;
    float (*eval)(const profile *f, float x); /* |x| <= radius */
    float radius;
    const char *shape_names[N_SHAPE]; /* parameters, NULL = none */
    float shape[N_SHAPE];             /* their defaults */
    bool positive;                    /* shape parameters must be > 0 */
};

typedef struct axis {
    profile f;
    float nodes[N_CELLS + 1]; /* |f| */
    distribution cells;
    double integral, absolute; /* of f, and of |f| as tabulated */
} axis;

struct filter_table {
    axis x, y;
    double negative; /* probability of a weight below 0 */
    uint64_t block;  /* in so many samples there is at most one; 0: by chance alone */
};

/* ---- the profiles ---- */

static float eval_box(const profile *f, float x)
{
    (void)f;
    (void)x;
    return 1.0f;
}

static float eval_triangle(const profile *f, float x)
{
    return f->radius - fabsf(x);
}

static float eval_gaussian(const profile *f, float x)
{
    float s = -0.5f / square(f->shape[0]);
    return maxf(0.0f, expf(s * x * x) - expf(s * square(f->radius)));
}

static float eval_mitchell(const profile *f, float x)
{
    float b = f->shape[0], c = f->shape[1], t = fabsf(2.0f * x / f->radius);
    if (t <= 1.0f)
        return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t +
                (6 - 2 * b)) /
               6.0f;
    return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t +
            (8 * b + 24 * c)) /
           6.0f;
}

static float sinc(float x)
{
    x = fabsf(PI_F * x);
    return x < 1e-3f ? 1.0f - x * x / 6.0f : sinf(x) / x;
}

/* Lanczos: a sinc in a window that is the first lobe of another, tau times as wide. */
static float eval_sinc(const profile *f, float x)
{
    return sinc(x) * sinc(x / f->shape[0]);
}

static const filter_kind kinds[] = {
    {"box", eval_box, 0.5f, {NULL, NULL}, {0, 0}, false},
    {"triangle", eval_triangle, 2.0f, {NULL, NULL}, {0, 0}, false},
    {"gaussian", eval_gaussian, 1.5f, {"sigma", NULL}, {0.5f, 0}, true},
    {"mitchell", eval_mitchell, 2.0f, {"B", "C"}, {1.0f / 3.0f, 1.0f / 3.0f}, false},
    {"sinc", eval_sinc, 4.0f, {"tau", NULL}, {3.0f, 0}, true},
};

const char *filter_kind_name(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].name : NULL;
}

char *filter_kind_parameters(size_t i)
{
    const char *const *shape = kinds[i].shape_names;
    return g_strjoin(" ", "xradius", "yradius", shape[0], shape[0] ? shape[1] : NULL,
                     NULL);
}

static float eval(const profile *f, float x)
{
    return fabsf(x) <= f->radius ? f->kind->eval(f, x) : 0.0f;
}

/* ---- one axis ---- */

/* The shape of |f| between nodes, and the integral of f by Simpson's rule. */
static bool axis_init(axis *a, GError **error)
{
    float weights[N_CELLS];
    double step = 2.0 * (double)a->f.radius / N_CELLS;
    for (int i = 0; i <= N_CELLS; i++) {
        float x = (float)i / (N_CELLS / 2) - 1.0f,
              v = a->f.kind->eval(&a->f, x * a->f.radius);
        double simpson = i == 0 || i == N_CELLS ? 1.0 : i % 2 ? 4.0 : 2.0;
        a->nodes[i] = fabsf(v);
        a->integral += simpson / 3.0 * step * (double)v;
    }
    for (int i = 0; i < N_CELLS; i++)
        weights[i] = 0.5f * (a->nodes[i] + a->nodes[i + 1]);
    if (!distribution_init(&a->cells, weights, N_CELLS, error))
        return false;
    a->absolute = distribution_total(&a->cells) * step;
    return true;
}

/* Where in 0..1 a density that grows linearly from f0 to f1 has the share u below it. */
static float invert_linear(float f0, float f1, float u)
{
    float root = sqrtf(lerpf(f0 * f0, f1 * f1, u));
    return f0 + root > 0.0f ? minf(u * (f0 + f1) / (f0 + root), 1.0f) : u;
}

static float axis_sample(const axis *a, float u, float *weight)
{
    size_t cell = distribution_sample(&a->cells, &u);
    float f0 = a->nodes[cell], f1 = a->nodes[cell + 1];
    float t = invert_linear(f0, f1, u), tabulated = lerpf(f0, f1, t);
    float x = (((float)cell + t) / (N_CELLS / 2) - 1.0f) * a->f.radius;
    double norm = a->absolute / a->integral;
    *weight *= tabulated > 0.0f ? (float)norm * eval(&a->f, x) / tabulated : 0.0f;
    return x;
}

/* Of so many samples an axis' share of weights below 0 is told by. */
#define SIGN_SAMPLES 4096

static double axis_negative(const axis *a)
{
    int n = 0;
    for (int i = 0; i < SIGN_SAMPLES; i++) {
        float weight = 1.0f;
        axis_sample(a, ((float)i + 0.5f) / SIGN_SAMPLES, &weight);
        n += weight < 0.0f;
    }
    return (double)n / SIGN_SAMPLES;
}

/* Below 0 where one of both axes is. Shorter blocks would not keep sums above 0. */
static void find_signs(filter_table *t)
{
    enum { SHORTEST = 4 };
    double x = axis_negative(&t->x), y = axis_negative(&t->y);
    t->negative = x * (1.0 - y) + y * (1.0 - x);
    if (t->negative > 0.0 && t->negative * SHORTEST <= 1.0)
        t->block = (uint64_t)(1.0 / t->negative);
}

/* ---- making one ---- */

static const filter_kind *find_kind(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    return NULL;
}

static bool read_positive(const params *p, const char *name, float *out, GError **error)
{
    if (!params_float(p, name, out, error))
        return false;
    if (*out > 0.0f)
        return true;
    error_at(error, params_find(p, name)->place, "\"%s\" must be greater than 0, not %g",
             name, (double)*out);
    return false;
}

static bool read_params(const params *p, pixel_filter *f, profile *shape, GError **error)
{
    const filter_kind *kind = shape->kind;
    if (!read_positive(p, "xradius", &f->x_radius, error) ||
        !read_positive(p, "yradius", &f->y_radius, error))
        return false;
    for (int i = 0; i < N_SHAPE && kind->shape_names[i]; i++)
        if (kind->positive
                ? !read_positive(p, kind->shape_names[i], &shape->shape[i], error)
                : !params_float(p, kind->shape_names[i], &shape->shape[i], error))
            return false;
    g_autofree char *what = g_strdup_printf("filter \"%s\"", kind->name);
    return params_all_used(p, what, error);
}

static bool make_table(pixel_filter *f, const profile *shape, source_place place,
                       GError **error)
{
    f->table = g_new0(filter_table, 1);
    f->table->x.f = f->table->y.f = *shape;
    f->table->x.f.radius = f->x_radius;
    f->table->y.f.radius = f->y_radius;
    if (!axis_init(&f->table->x, error) || !axis_init(&f->table->y, error))
        return false;
    find_signs(f->table);
    const double tiny = 1e-6;
    if (f->table->x.integral > tiny * f->table->x.absolute &&
        f->table->y.integral > tiny * f->table->y.absolute)
        return true;
    error_at(error, place, "filter \"%s\" has no positive integral with these parameters",
             f->name);
    return false;
}

/* @param p NULL = the defaults */
static bool init(pixel_filter *f, const filter_kind *kind, const params *p,
                 GError **error)
{
    profile shape = {.kind = kind};
    memcpy(shape.shape, kind->shape, sizeof shape.shape);
    *f = (pixel_filter){kind->name, kind->radius, kind->radius, NULL};
    source_place place = p ? p->place : (source_place){0};
    if ((!p || read_params(p, f, &shape, error)) && make_table(f, &shape, place, error))
        return true;
    filter_clear(f);
    return false;
}

bool filter_init(pixel_filter *f, const char *kind_name, const params *p, GError **error)
{
    const filter_kind *kind = find_kind(kind_name);
    if (kind)
        return init(f, kind, p, error);
    error_at(
        error, p->place,
        "filter \"%s\" is not supported; known are box, triangle, gaussian, mitchell "
        "and sinc",
        kind_name);
    return false;
}

bool filter_init_default(pixel_filter *f, GError **error)
{
    return init(f, find_kind("gaussian"), NULL, error);
}

void filter_clear(pixel_filter *f)
{
    if (f->table) {
        distribution_clear(&f->table->x.cells);
        distribution_clear(&f->table->y.cells);
    }
    g_free(f->table);
    *f = (pixel_filter){0};
}

vec2 filter_sample(const pixel_filter *f, vec2 u, float *weight)
{
    *weight = 1.0f;
    float x = axis_sample(&f->table->x, u.x, weight);
    float y = axis_sample(&f->table->y, u.y, weight);
    return (vec2){x, y};
}

/* One sample of a block at most, anywhere in it; of the first block in its later half, so
   that there are others before it. */
static bool is_negative(const filter_table *t, uint64_t key, uint64_t number)
{
    uint64_t block = number / t->block, at = number % t->block;
    uint64_t random = hash_mix(key, block);
    if (!((double)(random >> 11) * 0x1p-53 < t->negative * (double)t->block))
        return false;
    uint64_t first = block == 0 ? (t->block + 1) / 2 : 0;
    return at == first + hash_mix(random, 1) % (t->block - first);
}

vec2 filter_sample_nth(const pixel_filter *f, uint64_t key, uint64_t number, vec2 u,
                       float *weight)
{
    enum { MOST_DRAWS = 1 << 12 };
    vec2 at = filter_sample(f, u, weight);
    if (f->table->block == 0)
        return at;
    bool negative = is_negative(f->table, key, number);
    sampler again = sampler_make(hash_mix(key, 1), number);
    for (int i = 0; (*weight < 0.0f) != negative && i < MOST_DRAWS; i++)
        at = filter_sample(f, sampler_2d(&again), weight);
    return at;
}

float filter_taken(const pixel_filter *f)
{
    double negative = f->table->negative;
    return (float)(negative / (1.0 - negative));
}

float filter_eval(const pixel_filter *f, vec2 offset)
{
    return eval(&f->table->x.f, offset.x) * eval(&f->table->y.f, offset.y);
}

float filter_density(const pixel_filter *f, vec2 offset)
{
    double integral = f->table->x.integral * f->table->y.integral;
    return (float)((double)filter_eval(f, offset) / integral);
}

bool filter_reaches(const pixel_filter *f, vec2 raster, int width, int height)
{
    /* The centre of a pixel lies half a pixel inside of the film. */
    float x = f->x_radius - 0.5f, y = f->y_radius - 0.5f;
    return raster.x >= -x && raster.x <= (float)width + x && raster.y >= -y &&
           raster.y <= (float)height + y;
}
