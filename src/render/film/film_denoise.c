#include "render/film/film_denoise.h"

#include "base/memory.h"
#include "image/denoise/denoise.h"
#include "render/film/film_halves.h"
#include "render/film/film_lights.h"

static size_t n_pixels(const film *f)
{
    return (size_t)f->width * (size_t)f->height;
}

static size_t pixel_at(const film *f, int x, int y)
{
    return (size_t)y * (size_t)f->width + (size_t)x;
}

/* ---- Features ---- */

/* Differences of less than this part of a feature are none. */
#define NO_DIFFERENCE 1e-5f

/* What a surface is counts as its light does: by the share of the pixel that it takes,
   where there is none beside it nothing. Where weights of either sign meet, those of
   surfaces alone may come to nothing. */
static double weight_of(const half_view *v)
{
    return half_number(v, HALF_AT(weight));
}

static void mean_of(const double *sum, double weight, int n, float *out)
{
    for (int i = 0; i < n; i++)
        out[i] = fabs(weight) > 0.0 ? (float)(sum[i] / weight) : 0.0f;
}

static void get_numbers(const half_view *v, size_t first, int n, double *out)
{
    for (int i = 0; i < n; i++)
        out[i] = half_number(v, first + (size_t)i);
}

static void get_guides(const half_view *v, size_t first, int n, double *out)
{
    for (int i = 0; i < n; i++)
        out[i] = (double)half_guide(v, first + (size_t)i);
}

/* Features of a pixel: what the first surface is, and by how much the first one that is
   not specular differs. */
typedef struct surface_guide {
    float albedo[3], normal[3], depth;
} surface_guide;

enum {
    SURFACE_CHANNELS = sizeof(surface_guide) / sizeof(float),
    SURFACES = 2,
    ALBEDO = 0, /* feature by which light is divided that comes from the first surface */
};

static const int n_channels[] = {3, 3, 1, 3, 3, 1};

/* Sums over a half of a pixel. */
typedef struct surface_sums {
    double albedo[3], normal[3], depth;
} surface_sums;

static surface_guide guide_of(const film *f, const surface_sums *sum, double weight)
{
    surface_guide out;
    film_to_rgb(f, sum->albedo, weight, out.albedo);
    mean_of(sum->normal, weight, 3, out.normal);
    mean_of(&sum->depth, weight, 1, &out.depth);
    return out;
}

static surface_guide first_of(const film *f, const half_view *v)
{
    surface_sums sum = {.depth = half_number(v, HALF_AT(depth))};
    get_numbers(v, HALF_AT(color[N_LAYERS]), 3, sum.albedo);
    get_numbers(v, HALF_AT(normal), 3, sum.normal);
    return guide_of(f, &sum, weight_of(v));
}

static surface_guide seen_of(const film *f, const half_view *v)
{
    surface_sums sum = {.depth = (double)half_guide(v, GUIDE_AT(depth))};
    get_guides(v, GUIDE_AT(albedo), 3, sum.albedo);
    get_guides(v, GUIDE_AT(normal), 3, sum.normal);
    return guide_of(f, &sum, weight_of(v));
}

/* Of what is seen in a mirror only how it differs from the mirror counts: elsewhere it
   says nothing new. */
static void less_first(float *out, const float *first)
{
    for (int i = 0; i < SURFACE_CHANNELS; i++) {
        float d = out[i] - first[i];
        out[i] = fabsf(d) > NO_DIFFERENCE * fabsf(out[i]) ? d : 0.0f;
    }
}

/* All at once, since it is the film that takes long to read. */
static void read_features(const void *data, int y, float *const *const half[2],
                          float *variance)
{
    (void)variance;
    const film *f = data;
    for (int x = 0; x < f->width; x++) {
        for (int h = 0; h < 2; h++) {
            half_view v = half_view_of(f, pixel_at(f, x, y), h);
            surface_guide both[SURFACES] = {first_of(f, &v), seen_of(f, &v)};
            const float *first = (const float *)&both[0];
            less_first((float *)&both[1], first);
            for (int c = 0; c < SURFACES * SURFACE_CHANNELS; c++)
                half[h][c][x] = first[c];
        }
    }
}

/* ---- The picture ---- */

enum { MOST_PASSES_TOGETHER = 4 /* fewer than that */ };

/* With so many pixels beside it a glint is an outlier, if there are no others around it:
   it would become a smear. Relative squared errors of eleven scenes, 4 and 16 passes,
   over those with none: .98; with 2 and 8 .985, with 19 1.02. */
#define BESIDE_GLINT 4

/* Sums of what is filtered of the layer of mirrors, and of glints. */
static void specular_of(const half_view *v, int which, double sum[3])
{
    double lights[3], glints[3];
    get_guides(v, GUIDE_AT(glints), 3, glints);
    get_guides(v, GUIDE_AT(lights), 3, lights);
    get_numbers(v, HALF_AT(color[LAYER_SPECULAR]), 3, sum);
    for (int c = 0; c < 3; c++)
        sum[c] = which == GLINTS ? glints[c] : sum[c] - lights[c] - glints[c];
}

/* Sums of all that is filtered. */
static void all_lights_of(const half_view *v, double sum[3])
{
    for (size_t c = 0; c < 3; c++) {
        sum[c] = -(double)half_guide(v, GUIDE_AT(lights) + c);
        for (size_t l = 0; l < N_LIGHTS; l++)
            sum[c] += half_number(v, HALF_AT(color) + 3 * l + c);
    }
}

/* What is filtered of a light. */
static void light_of(const film *f, const half_view *v, int which, float *rgb)
{
    double sum[3];
    if (which == ALL_LIGHTS)
        all_lights_of(v, sum);
    else if (which == LAYER_SPECULAR || which == GLINTS)
        specular_of(v, which, sum);
    else
        get_numbers(v, HALF_AT(color) + 3 * (size_t)which, 3, sum);
    film_to_rgb(f, sum, weight_of(v), rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= f->scale;
}

/* Of all lights the layers' are added: NAN where one is not known. */
static float variance_of(const film *f, size_t i, int which)
{
    float sum = 0.0f;
    for (int l = 0; l < N_LIGHTS; l++)
        sum += which == l || which == ALL_LIGHTS ? halves_variance(f, i, l) : 0.0f;
    return sum;
}

/* Which light of a film is filtered. */
typedef struct film_light {
    const film *f;
    int which;
} film_light;

static void read_light(const void *data, int y, float *const *const half[2],
                       float *variance)
{
    const film_light *of = data;
    const film *f = of->f;
    for (int x = 0; x < f->width; x++) {
        size_t i = pixel_at(f, x, y);
        for (int h = 0; h < 2; h++) {
            float rgb[3];
            half_view v = half_view_of(f, i, h);
            light_of(f, &v, of->which, rgb);
            for (int c = 0; c < 3; c++)
                half[h][c][x] = rgb[c];
        }
        variance[x] = of->which == GLINTS ? NAN : variance_of(f, i, of->which);
    }
}

/* The result. */
typedef struct out_loop {
    const film *f;
    float *out;
} out_loop;

/* These are not filtered. */
static void put_lights(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const out_loop *loop = data;
    for (size_t i = begin; i < end; i++)
        film_lights_in_sight(loop->f, i, loop->out + 3 * i);
}

/* A render that was planned for less than two passes, and goes on, has more. */
bool film_filters_together(const film *f)
{
    return f->together && f->n_passes < MOST_PASSES_TOGETHER;
}

/* Filters a light and adds it. */
static bool filter_light(const film *f, const denoiser *d, int which, float *out,
                         GError **error)
{
    bool is_seen_by_way = which == LAYER_SPECULAR || which == GLINTS;
    const film_light one = {f, which};
    const denoise_source from = {read_light, &one};
    return denoiser_filter(d, &from, which == GLINTS ? BESIDE_GLINT : 0,
                           is_seen_by_way ? -1 : ALBEDO, out, error);
}

static bool filter_lights(const film *f, const denoiser *d, unsigned threads, float *out,
                          GError **error)
{
    out_loop all = {f, out};
    parallel_for(n_pixels(f), ITEMS_AT_ONCE, threads, NULL, put_lights, &all);
    if (film_filters_together(f))
        return filter_light(f, d, ALL_LIGHTS, out, error);
    for (int l = 0; l < N_FILTERED; l++) {
        if (!filter_light(f, d, l, out, error))
            return false;
    }
    return true;
}

/* Of all samples those of the even half, and of the halves' pixels those that are not
   lent by others; and the mean luminance of all that is filtered. */
typedef struct half_shares {
    float even, distinct, luminance;
} half_shares;

/* Over some pixels and their halves: weight of the pixels' own, how many of these there
   are, and of all halves luminance and weight. */
typedef struct half_sums {
    double own_weight[2], n_own, y, weight;
} half_sums;

enum { SUM_AT_ONCE = 1 << 12 /* pixels */ };

typedef struct sum_loop {
    const film *f;
    half_sums *parts;
} sum_loop;

static void sum_pixels(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const sum_loop *loop = data;
    half_sums sum = {.y = 0.0};
    for (size_t i = begin; i < end; i++) {
        for (int h = 0; h < 2; h++) {
            half_view v = half_view_of(loop->f, i, h);
            double weight = weight_of(&v), lights[3];
            bool own = v.i == i;
            sum.own_weight[h] += own ? weight : 0.0;
            sum.n_own += own ? 1.0 : 0.0;
            all_lights_of(&v, lights);
            sum.y += lights[FILM_Y];
            sum.weight += weight;
        }
    }
    loop->parts[begin / SUM_AT_ONCE] = sum;
}

/* Part by part, so that they are the same on any number of threads. */
static half_sums sum_halves(const film *f, unsigned threads)
{
    size_t n = n_pixels(f), n_parts = (n + SUM_AT_ONCE - 1) / SUM_AT_ONCE;
    sum_loop loop = {f, g_new0(half_sums, n_parts)};
    half_sums sum = {.y = 0.0};
    parallel_for(n, SUM_AT_ONCE, threads, NULL, sum_pixels, &loop);
    for (size_t i = 0; i < n_parts; i++) {
        for (int h = 0; h < 2; h++)
            sum.own_weight[h] += loop.parts[i].own_weight[h];
        sum.n_own += loop.parts[i].n_own;
        sum.y += loop.parts[i].y;
        sum.weight += loop.parts[i].weight;
    }
    g_free(loop.parts);
    return sum;
}

static half_shares shares_of(const film *f, unsigned threads)
{
    half_sums sum = sum_halves(f, threads);
    const double *own = sum.own_weight;
    bool is_lit = sum.y > 0.0 && sum.weight > 0.0;
    return (half_shares){
        .even = (float)(own[0] / (own[0] + own[1])),
        .distinct = (float)(sum.n_own / (2.0 * (double)n_pixels(f))),
        .luminance = is_lit ? (float)(sum.y / sum.weight) * f->scale : 0.0f,
    };
}

/* Processes that deal passes out may have given all to one half. */
#define LEAST_SHARE 0.05f

/* Whether there are halves. */
static bool find_shares(const film *f, unsigned threads, half_shares *out)
{
    if (!f->halves || !halves_have(f) || f->no_time)
        return false;
    *out = shares_of(f, threads);
    return out->even > LEAST_SHARE && out->even < 1.0f - LEAST_SHARE;
}

bool film_can_denoise(const film *f, unsigned threads)
{
    half_shares shares;
    return find_shares(f, threads, &shares);
}

static float *denoise(const film *f, const denoise_size *size, GError **error)
{
    const denoise_source features = {read_features, f};
    g_autoptr(denoiser) d = denoiser_new(size, error);
    float *out = NULL;
    bool done =
        d &&
        denoiser_add(d, &features, n_channels, G_N_ELEMENTS(n_channels), error) >= 0 &&
        (out = big_alloc(n_pixels(f), 3 * sizeof *out, "denoising", error)) &&
        filter_lights(f, d, size->threads, out, error);
    if (!done)
        g_clear_pointer(&out, big_free);
    return out;
}

bool film_denoise(const film *f, unsigned threads, const cancel_flag *cancel, float **out,
                  GError **error)
{
    half_shares shares;
    *out = NULL;
    if (!find_shares(f, threads, &shares))
        return true;
    const denoise_size size = {.width = f->width,
                               .height = f->height,
                               .share = shares.even,
                               .distinct = shares.distinct,
                               .brightness = shares.luminance,
                               .threads = threads,
                               .cancel = cancel,
                               .coarse = f->coarse};
    memory_release(f->denoise_size);
    *out = denoise(f, &size, error);
    memory_count(f->denoise_size);
    return *out != NULL;
}

size_t film_denoise_bytes(int width, int height)
{
    size_t out = (size_t)width * (size_t)height * 3 * sizeof(float);
    return out + denoise_bytes(width, height, G_N_ELEMENTS(n_channels),
                               SURFACES * SURFACE_CHANNELS);
}
