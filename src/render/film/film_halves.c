#include "render/film/film_halves.h"

#include "base/memory.h"
#include "image/denoise/denoise.h"
#include "render/film/film_lights.h"

enum { LUMINANCE = 1 /* of X, Y, Z */ };

static size_t n_pixels(const film *f)
{
    return (size_t)f->width * (size_t)f->height;
}

bool halves_open(film *f, GError **error)
{
    f->pass_guides = big_alloc(n_pixels(f), sizeof *f->pass_guides, "the film", error);
    if (f->pass_guides)
        f->halves = big_alloc(n_pixels(f), sizeof *f->halves, "the film", error);
    if (!f->halves)
        return false;
    size_t size = film_denoise_bytes(f->width, f->height);
    if (memory_reserve(size, "denoising", error))
        f->denoise_size = size;
    return f->denoise_size > 0;
}

void halves_clear(film *f)
{
    big_free(f->pass_guides);
    big_free(f->halves);
    memory_release(f->denoise_size);
}

size_t film_guide_bytes(void)
{
    return sizeof(struct guide_sum);
}

/* ---- Sums ---- */

static void add_xyz(float sum[3], const wavelengths *w, spectrum value, float weight)
{
    float xyz[3];
    spectrum_to_xyz(w, value, xyz);
    for (int i = 0; i < 3; i++)
        sum[i] += xyz[i] * weight;
}

void guide_add(guide_sum *sum, const film_pass *pass, const radiance_sample *sample,
               float weight)
{
    const light_guide *guide = &sample->guide;
    const spectrum in_sight = sample->layers[LAYER_EMISSION] + guide->lights;
    add_xyz(sum->lights, pass->w, guide->lights, weight);
    sum->lit += spectrum_is_black(in_sight) ? 0.0f : weight;
    if (!(guide->weight > 0.0f))
        return;
    float share = weight / guide->weight;
    add_xyz(sum->albedo, pass->w, guide->albedo * pass->white, share);
    for (int i = 0; i < 3; i++)
        sum->normal[i] += guide->normal[i] * share;
    sum->depth += guide->depth * share;
    sum->weight += weight;
}

void halves_put(film *f, int x, int y, const guide_sum *sum)
{
    if (f->halves)
        f->pass_guides[(size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0)] =
            *sum;
}

static void add_floats(void *to, const void *from, int n)
{
    float *sum = to;
    const float *number = from;
    for (int i = 0; i < n; i++)
        sum[i] += number[i];
}

/* Lights in mirrors are in sight too: what they are of a layer. */
static double lights_luminance(const guide_sum *guides, int layer)
{
    return layer == LAYER_SPECULAR ? (double)guides->lights[LUMINANCE] : 0.0;
}

void halves_end_pass(const film *f, size_t begin, size_t end)
{
    const size_t color = offsetof(film_sum, color) / sizeof(double);
    for (size_t i = begin; i < end && f->halves; i++) {
        half_pixel *pixel = &f->halves[i];
        const float *number = f->pass[i].number;
        double w = fabs((double)number[offsetof(film_sum, weight) / sizeof(double)]);
        add_floats(&pixel->guides, &f->pass_guides[i], GUIDE_NUMBERS);
        for (size_t l = 0; l < N_LIGHTS; l++) {
            double y = (double)number[color + 3 * l + LUMINANCE];
            y -= lights_luminance(&f->pass_guides[i], (int)l);
            pixel->y2[l] += w > 0.0 ? y * y / w : 0.0;
        }
        if (f->n_passes % 2 == 0) {
            add_floats(&pixel->even, number, FILM_NUMBERS);
            add_floats(&pixel->guides_even, &f->pass_guides[i], GUIDE_NUMBERS);
        }
    }
}

/* ---- Halves of a pixel ---- */

/* Whether what there is of a pass that is not whole is in this half of a pixel. */
static bool has_pass(const film *f, size_t i, int half)
{
    return f->n_cells > 0 && half == (int)(f->n_passes % 2) && film_pass_counts(f, i);
}

/* Numbers of film_sum, where they begin. */
#define AT(field) (offsetof(film_sum, field) / sizeof(double))

/* So many numbers of half 0 or 1 of a pixel's film_sum, from one on. */
static void get_half(const film *f, size_t i, int half, size_t first, int n, double *out)
{
    const double *all = (const double *)&f->pixels[i].sum + first;
    const float *even = f->halves[i].even.number + first;
    const float *pass = has_pass(f, i, half) ? f->pass[i].number + first : NULL;
    for (int k = 0; k < n; k++) {
        out[k] = half == 0 ? (double)even[k] : all[k] - (double)even[k];
        out[k] += pass ? (double)pass[k] : 0.0;
    }
}

static double number_of_half(const film *f, size_t i, int half, size_t at)
{
    double number;
    get_half(f, i, half, at, 1, &number);
    return number;
}

static guide_sum guides_of(const film *f, size_t i, int half)
{
    guide_sum sum = f->halves[i].guides_even;
    float *number = (float *)&sum;
    const float *all = (const float *)&f->halves[i].guides;
    for (int k = 0; k < GUIDE_NUMBERS && half == 1; k++)
        number[k] = all[k] - number[k];
    if (has_pass(f, i, half))
        add_floats(number, &f->pass_guides[i], GUIDE_NUMBERS);
    return sum;
}

/* Variance of the luminance of a layer's mean, by the scatter of its passes, each of
   which has the more the less it weighs. */
static float layer_variance(const film *f, size_t i, int layer)
{
    const film_sum *sum = &f->pixels[i].sum;
    double y = sum->color[layer][LUMINANCE], w = fabs(sum->weight);
    y -= lights_luminance(&f->halves[i].guides, layer);
    double y2 = f->halves[i].y2[layer], n = (double)f->n_passes;
    if (f->n_cells > 0 && film_pass_counts(f, i)) {
        film_sum pass = {0};
        film_add_pass(&pass, &f->pass[i]);
        double more = pass.color[layer][LUMINANCE], by = fabs(pass.weight);
        more -= lights_luminance(&f->pass_guides[i], layer);
        y += more;
        w += by;
        y2 += by > 0.0 ? more * more / by : 0.0;
        n += 1.0;
    }
    if (!(w > 0.0))
        return 0.0f;
    double scatter = fmax(y2 - y * y / w, 0.0);
    double scale2 = (double)f->scale * (double)f->scale;
    return (float)(scale2 * scatter / (w * (n - 1.0)));
}

/* ---- Features ---- */

/* Differences of less than this part of a feature are none. */
#define NO_DIFFERENCE 1e-5f

static void mean_of(const double *sum, double weight, int n, float *out)
{
    for (int i = 0; i < n; i++)
        out[i] = fabs(weight) > 0.0 ? (float)(sum[i] / weight) : 0.0f;
}

static void first_albedo(const film *f, size_t i, int half, float *out)
{
    double sum[3];
    get_half(f, i, half, AT(color[N_LAYERS]), 3, sum);
    film_to_rgb(f, sum, number_of_half(f, i, half, AT(surface_weight)), out);
}

static void first_normal(const film *f, size_t i, int half, float *out)
{
    double sum[3];
    get_half(f, i, half, AT(normal), 3, sum);
    mean_of(sum, number_of_half(f, i, half, AT(surface_weight)), 3, out);
}

static void first_depth(const film *f, size_t i, int half, float *out)
{
    double sum = number_of_half(f, i, half, AT(depth));
    mean_of(&sum, number_of_half(f, i, half, AT(surface_weight)), 1, out);
}

static void guide_color(const film *f, const float xyz[3], float weight, float *out)
{
    double sum[3] = {(double)xyz[0], (double)xyz[1], (double)xyz[2]};
    film_to_rgb(f, sum, (double)weight, out);
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

static void seen_albedo(const film *f, size_t i, int half, float *out)
{
    float first[3];
    guide_sum sum = guides_of(f, i, half);
    guide_color(f, sum.albedo, sum.weight, out);
    first_albedo(f, i, half, first);
    less_first(out, first, 3);
}

static void seen_normal(const film *f, size_t i, int half, float *out)
{
    float first[3];
    guide_sum sum = guides_of(f, i, half);
    for (int k = 0; k < 3; k++)
        out[k] = sum.weight > 0.0f ? sum.normal[k] / sum.weight : 0.0f;
    first_normal(f, i, half, first);
    less_first(out, first, 3);
}

static void seen_depth(const film *f, size_t i, int half, float *out)
{
    float first;
    guide_sum sum = guides_of(f, i, half);
    *out = sum.weight > 0.0f ? sum.depth / sum.weight : 0.0f;
    first_depth(f, i, half, &first);
    less_first(out, &first, 1);
}

typedef struct feature {
    int n_channels;
    void (*read)(const film *f, size_t i, int half, float *out);
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

/* Memory while a layer is read. */
typedef struct layer_room {
    float *half[2], *variance, *out;
} layer_room;

/* What is filtered of a layer. */
static void light_of(const film *f, size_t i, int half, int layer, float *rgb)
{
    double sum[3];
    get_half(f, i, half, AT(color) + 3 * (size_t)layer, 3, sum);
    if (layer == LAYER_SPECULAR) {
        guide_sum guides = guides_of(f, i, half);
        for (int c = 0; c < 3; c++)
            sum[c] -= (double)guides.lights[c];
    }
    film_to_rgb(f, sum, number_of_half(f, i, half, AT(weight)), rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= f->scale;
}

typedef struct read_loop {
    const film *f;
    layer_room *room;
    const feature *feature; /* NULL: light */
    int layer;
} read_loop;

static void read_pixels(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const read_loop *loop = data;
    const film *f = loop->f;
    for (size_t i = begin; i < end; i++) {
        for (int h = 0; h < 2; h++) {
            if (loop->feature) {
                size_t at = i * (size_t)loop->feature->n_channels;
                loop->feature->read(f, i, h, loop->room->half[h] + at);
                continue;
            }
            light_of(f, i, h, loop->layer, loop->room->half[h] + 3 * i);
        }
        if (!loop->feature)
            loop->room->variance[i] = layer_variance(f, i, loop->layer);
    }
}

static void read_all(read_loop *loop, unsigned threads)
{
    parallel_for(n_pixels(loop->f), 1 << 12, threads, NULL, read_pixels, loop);
}

static bool add_features(const film *f, denoiser *d, layer_room *room, unsigned threads,
                         GError **error)
{
    for (size_t k = 0; k < G_N_ELEMENTS(features); k++) {
        read_loop loop = {f, room, &features[k], 0};
        const denoise_layer layer = {
            features[k].n_channels, {room->half[0], room->half[1]}, NULL};
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

static bool filter_lights(const film *f, const denoiser *d, layer_room *room,
                          unsigned threads, float *out, GError **error)
{
    out_loop all = {f, room->out, out};
    parallel_for(n_pixels(f), ITEMS_AT_ONCE, threads, NULL, put_lights, &all);
    for (int l = 0; l < N_LIGHTS; l++) {
        read_loop loop = {f, room, NULL, l};
        const denoise_layer layer = {3, {room->half[0], room->half[1]}, room->variance};
        read_all(&loop, threads);
        if (!denoiser_filter(d, &layer, l == LAYER_SPECULAR ? -1 : ALBEDO, room->out,
                             error))
            return false;
        parallel_for(n_pixels(f), ITEMS_AT_ONCE, threads, NULL, add_light, &all);
    }
    return true;
}

/* Of all samples, those of the even passes. */
static float share_of_even(const film *f)
{
    double even = 0.0, odd = 0.0;
    for (size_t i = 0; i < n_pixels(f); i++) {
        even += number_of_half(f, i, 0, AT(weight));
        odd += number_of_half(f, i, 1, AT(weight));
    }
    return (float)(even / (even + odd));
}

/* Mean luminance of what is filtered. */
static float mean_luminance(const film *f)
{
    double y = 0.0, weight = 0.0;
    for (size_t i = 0; i < n_pixels(f); i++) {
        const film_sum *sum = &f->pixels[i].sum;
        for (int l = 0; l < N_LIGHTS; l++)
            y += sum->color[l][LUMINANCE] - lights_luminance(&f->halves[i].guides, l);
        weight += sum->weight;
    }
    return y > 0.0 && weight > 0.0 ? (float)(y / weight) * f->scale : 0.0f;
}

/* Processes that deal passes out may have given all to one half. */
#define LEAST_SHARE 0.05f

bool film_can_denoise(const film *f)
{
    if (!f->halves || f->n_passes < 2 || f->no_time)
        return false;
    float share = share_of_even(f);
    return share > LEAST_SHARE && share < 1.0f - LEAST_SHARE;
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
    float even = clampf(share_of_even(f), LEAST_SHARE, 1.0f - LEAST_SHARE);
    const denoise_size size = {.width = f->width,
                               .height = f->height,
                               .share = even,
                               .brightness = mean_luminance(f),
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
