#include "render/film/film_denoise.h"

#include "base/memory.h"
#include "image/denoise/denoise.h"
#include "render/film/film_halves.h"
#include "render/film/film_lights.h"

static size_t n_pixels(const film *f)
{
    return (size_t)f->width * (size_t)f->height;
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

/* A colour is none in most pixels of most layers. */
static void to_rgb(const film *f, const half_view *v, const double sum[3], float out[3])
{
    if (fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) > 0.0)
        film_to_rgb(f, sum, weight_of(v), out);
    else
        out[0] = out[1] = out[2] = 0.0f;
}

static void first_albedo(const film *f, const half_view *v, float *out)
{
    double sum[3];
    get_numbers(v, HALF_AT(color[N_LAYERS]), 3, sum);
    to_rgb(f, v, sum, out);
}

static void first_normal(const film *f, const half_view *v, float *out)
{
    (void)f;
    double sum[3];
    get_numbers(v, HALF_AT(normal), 3, sum);
    mean_of(sum, weight_of(v), 3, out);
}

static void first_depth(const film *f, const half_view *v, float *out)
{
    (void)f;
    double sum = half_number(v, HALF_AT(depth));
    mean_of(&sum, weight_of(v), 1, out);
}

/* Of what is seen in a mirror only how it differs from the mirror counts: elsewhere it
   says nothing new. */
static void less_first(float *out, const float *first, int n)
{
    for (int i = 0; i < n; i++) {
        float d = out[i] - first[i];
        out[i] = fabsf(d) > NO_DIFFERENCE * fabsf(out[i]) ? d : 0.0f;
    }
}

static void seen_albedo(const film *f, const half_view *v, float *out)
{
    float first[3];
    double sum[3];
    get_guides(v, GUIDE_AT(albedo), 3, sum);
    to_rgb(f, v, sum, out);
    first_albedo(f, v, first);
    less_first(out, first, 3);
}

static void seen_normal(const film *f, const half_view *v, float *out)
{
    float first[3];
    double sum[3];
    get_guides(v, GUIDE_AT(normal), 3, sum);
    mean_of(sum, weight_of(v), 3, out);
    first_normal(f, v, first);
    less_first(out, first, 3);
}

static void seen_depth(const film *f, const half_view *v, float *out)
{
    float first;
    double sum = (double)half_guide(v, GUIDE_AT(depth));
    mean_of(&sum, weight_of(v), 1, out);
    first_depth(f, v, &first);
    less_first(out, &first, 1);
}

typedef struct feature {
    int n_channels;
    void (*read)(const film *f, const half_view *v, float *out);
} feature;

enum { ALBEDO = 0 }; /* by which light is divided that comes from the first surface */

static const feature features[] = {
    [ALBEDO] = {3, first_albedo},
    {3, first_normal},
    {1, first_depth},
    {3, seen_albedo},
    {3, seen_normal},
    {1, seen_depth},
};

/* ---- The picture ---- */

enum { MOST_PASSES_TOGETHER = 4 /* fewer than that */ };

/* With so many pixels beside it a glint is an outlier, if there are no others around it:
   it would become a smear. Relative squared errors of eleven scenes, 4 and 16 passes,
   over those with none: .98; with 2 and 8 .985, with 19 1.02. */
#define BESIDE_GLINT 4

/* Memory while a layer is read. */
typedef struct layer_room {
    float *half[2], *variance, *out;
} layer_room;

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
    to_rgb(f, v, sum, rgb);
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

typedef struct read_loop {
    const film *f;
    layer_room *room;
    const feature *feature; /* NULL: light */
    int light;
    atomic_bool *shines; /* set where there is any */
} read_loop;

static void read_pixels(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const read_loop *loop = data;
    const film *f = loop->f;
    bool shines = false;
    for (size_t i = begin; i < end; i++) {
        for (int h = 0; h < 2; h++) {
            half_view v = half_view_of(f, i, h);
            if (loop->feature) {
                size_t to = i * (size_t)loop->feature->n_channels;
                loop->feature->read(f, &v, loop->room->half[h] + to);
                continue;
            }
            float *rgb = loop->room->half[h] + 3 * i;
            light_of(f, &v, loop->light, rgb);
            shines |= rgb[0] != 0.0f || rgb[1] != 0.0f || rgb[2] != 0.0f;
        }
        if (!loop->feature && loop->light != GLINTS)
            loop->room->variance[i] = variance_of(f, i, loop->light);
    }
    if (shines)
        atomic_store(loop->shines, true);
}

static void read_all(read_loop *loop, unsigned threads)
{
    parallel_for(n_pixels(loop->f), 1 << 12, threads, NULL, read_pixels, loop);
}

static bool add_features(const film *f, denoiser *d, layer_room *room, unsigned threads,
                         GError **error)
{
    for (size_t k = 0; k < G_N_ELEMENTS(features); k++) {
        read_loop loop = {f, room, &features[k], 0, NULL};
        const denoise_layer layer = {
            features[k].n_channels, {room->half[0], room->half[1]}, NULL, 0};
        read_all(&loop, threads);
        if (denoiser_add(d, &layer, error) < 0)
            return false;
    }
    return true;
}

/* The result. */
typedef struct out_loop {
    const film *f;
    const float *light; /* a filtered layer */
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

static void add_light(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const out_loop *loop = data;
    for (size_t i = 3 * begin; i < 3 * end; i++)
        loop->out[i] += loop->light[i];
}

/* A render that was planned for less than two passes, and goes on, has more. */
bool film_filters_together(const film *f)
{
    return f->together && f->n_passes < MOST_PASSES_TOGETHER;
}

/* Filters a light and adds it, if there is any. */
static bool filter_light(const out_loop *all, const denoiser *d, int which,
                         layer_room *room, unsigned threads, GError **error)
{
    atomic_bool shines = false;
    bool is_seen_by_way = which == LAYER_SPECULAR || which == GLINTS;
    read_loop loop = {all->f, room, NULL, which, &shines};
    const denoise_layer layer = {3,
                                 {room->half[0], room->half[1]},
                                 which == GLINTS ? NULL : room->variance,
                                 which == GLINTS ? BESIDE_GLINT : 0};
    read_all(&loop, threads);
    if (!atomic_load(&shines))
        return true;
    if (!denoiser_filter(d, &layer, is_seen_by_way ? -1 : ALBEDO, room->out, error))
        return false;
    parallel_for(n_pixels(all->f), ITEMS_AT_ONCE, threads, NULL, add_light, (void *)all);
    return true;
}

static bool filter_lights(const film *f, const denoiser *d, layer_room *room,
                          unsigned threads, float *out, GError **error)
{
    out_loop all = {f, room->out, out};
    parallel_for(n_pixels(f), ITEMS_AT_ONCE, threads, NULL, put_lights, &all);
    if (film_filters_together(f))
        return filter_light(&all, d, ALL_LIGHTS, room, threads, error);
    for (int l = 0; l < N_FILTERED; l++) {
        if (!filter_light(&all, d, l, room, threads, error))
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

bool film_can_denoise(const film *f, unsigned threads)
{
    if (!f->halves || !halves_have(f) || f->no_time)
        return false;
    float even = shares_of(f, threads).even;
    return even > LEAST_SHARE && even < 1.0f - LEAST_SHARE;
}

static bool open_room(const film *f, layer_room *room, GError **error)
{
    size_t n = n_pixels(f), size = 3 * sizeof(float);
    room->half[0] = big_alloc(n, size, "denoising", error);
    room->half[1] = room->half[0] ? big_alloc(n, size, "denoising", error) : NULL;
    room->out = room->half[1] ? big_alloc(n, size, "denoising", error) : NULL;
    room->variance = room->out ? big_alloc(n, sizeof(float), "denoising", error) : NULL;
    return room->variance != NULL;
}

static void close_room(layer_room *room)
{
    big_free(room->half[0]);
    big_free(room->half[1]);
    big_free(room->out);
    big_free(room->variance);
}

static float *denoise(const film *f, const denoise_size *size, GError **error)
{
    layer_room room = {0};
    float *out = NULL;
    g_autoptr(denoiser) d = denoiser_new(size, error);
    bool done = d && open_room(f, &room, error) &&
                add_features(f, d, &room, size->threads, error) &&
                (out = big_alloc(n_pixels(f), 3 * sizeof *out, "denoising", error)) &&
                filter_lights(f, d, &room, size->threads, out, error);
    close_room(&room);
    if (!done)
        g_clear_pointer(&out, big_free);
    return out;
}

float *film_denoise(const film *f, unsigned threads, const cancel_flag *cancel,
                    GError **error)
{
    const half_shares shares = shares_of(f, threads);
    const denoise_size size = {.width = f->width,
                               .height = f->height,
                               .share =
                                   clampf(shares.even, LEAST_SHARE, 1.0f - LEAST_SHARE),
                               .distinct = shares.distinct,
                               .brightness = shares.luminance,
                               .threads = threads,
                               .cancel = cancel,
                               .coarse = f->coarse};
    memory_release(f->denoise_size);
    float *out = denoise(f, &size, error);
    memory_count(f->denoise_size);
    return out;
}

size_t film_denoise_bytes(int width, int height)
{
    const int n_features = G_N_ELEMENTS(features);
    size_t pixel = sizeof(float) * (size_t)(4 * 3 + 1); /* layer_room, and the result */
    int n = 0;
    for (int k = 0; k < n_features; k++)
        n += features[k].n_channels;
    return (size_t)width * (size_t)height * pixel +
           denoise_bytes(width, height, n_features, n);
}
