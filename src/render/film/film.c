#include "render/film/film.h"

#include "base/memory.h"
#include "color/balance.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"
#include "render/film/film_lights.h"
#include "render/film/gbuffer.h"

/* Pixels darker than this share of the mean count as if they were that bright. */
#define DARK_SHARE 0.1

static const char *const layer_names[FILM_COLORS] = {"direct",   "indirect", "caustic",
                                                     "specular", "emission", "albedo"};

static size_t n_pixels(const film *f)
{
    return (size_t)f->width * (size_t)f->height;
}

/* Room for light groups, where the scene has some. */
static bool open_groups(film *f, const scene *s, GError **error)
{
    size_t n = 3 * (size_t)s->n_light_groups * n_pixels(f);
    if (s->n_light_groups == 0)
        return true;
    f->n_groups = s->n_light_groups;
    f->group_names = (const char *const *)s->light_groups;
    f->pass_groups = big_alloc(n, sizeof *f->pass_groups, "the film", error);
    if (f->pass_groups)
        f->groups = big_alloc(n, sizeof *f->groups, "the film", error);
    return f->groups != NULL;
}

static GPtrArray *channel_names(const film *f, bool denoised);

/* The image that the film becomes is not refused when all is rendered. */
static bool reserve_image(film *f, GError **error)
{
    g_autoptr(GPtrArray) names = channel_names(f, f->halves);
    const size_t n_variance = 1; /* not among the names before there are passes */
    size_t size = n_pixels(f) * (names->len + n_variance) * sizeof(float);
    if (memory_reserve(size, "the image", error))
        f->image_size = size;
    return f->image_size > 0;
}

/* Nor is what denoising takes. */
static bool open_denoising(film *f, GError **error)
{
    size_t size = film_denoise_bytes(f->width, f->height);
    if (halves_open(f, error) && memory_reserve(size, "denoising", error))
        f->denoise_size = size;
    return f->denoise_size > 0;
}

bool film_open(film *f, const view *v, bool denoise, GError **error)
{
    const film_settings *how = &v->film;
    int x1 = (int)ceilf(how->crop[1] * (float)how->width);
    int y1 = (int)ceilf(how->crop[3] * (float)how->height);
    *f = (film){
        .x0 = (int)ceilf(how->crop[0] * (float)how->width),
        .y0 = (int)ceilf(how->crop[2] * (float)how->height),
        .scale = view_imaging_ratio(v),
        .least = filter_taken(&v->filter),
        .space = how->space ? how->space : color_space_srgb(),
        .most = how->most,
        .balanced = how->kelvin > 0.0f,
    };
    if (f->balanced)
        color_balance(how->kelvin, f->space, f->balance);
    f->width = x1 - f->x0;
    f->height = y1 - f->y0;
    if (f->width < 1 || f->height < 1) {
        error_set(error, ERROR_INPUT, "the crop window leaves no pixel of %d x %d",
                  how->width, how->height);
        return false;
    }
    f->pass = big_alloc(n_pixels(f), sizeof *f->pass, "the film", error);
    if (f->pass)
        f->pixels = big_alloc(n_pixels(f), sizeof *f->pixels, "the film", error);
    return f->pixels && open_groups(f, v->scene, error) && gbuffer_open(f, how, error) &&
           (!denoise || open_denoising(f, error)) && reserve_image(f, error);
}

void film_clear(film *f)
{
    big_free(f->pass);
    big_free(f->pixels);
    big_free(f->pass_groups);
    big_free(f->groups);
    big_free(f->pass_surfaces);
    big_free(f->surfaces);
    halves_clear(f);
    memory_release(f->denoise_size);
    memory_release(f->image_size);
    *f = (film){0};
}

/* ---- A pass ---- */

film_pass film_pass_for(const film *f, const wavelengths *w)
{
    g_autoptr(curve) d65 = curve_named("stdillum-D65");
    return (film_pass){w, curve_eval(d65, w) / curve_photometric(d65),
                       f->most > 0.0f ? f->most / f->scale : INFINITY};
}

float film_dimming(const film_pass *pass, spectrum radiance)
{
    float xyz[3];
    if (isinf(pass->most))
        return 1.0f;
    spectrum_to_xyz(pass->w, radiance, xyz);
    float largest = maxf(xyz[0], maxf(xyz[1], xyz[2]));
    return largest > pass->most ? pass->most / largest : 1.0f;
}

/* Most layers of a sample are black. */
static void add_color(double sum[3], const wavelengths *w, spectrum radiance,
                      float weight)
{
    float xyz[3];
    if (spectrum_is_black(radiance))
        return;
    spectrum_to_xyz(w, radiance, xyz);
    for (int i = 0; i < 3; i++)
        sum[i] += (double)(xyz[i] * weight);
}

float film_add(film_sum *sum, const film_pass *pass, const radiance_sample *sample,
               float weight)
{
    spectrum all = {0};
    for (int i = 0; i < N_LAYERS; i++)
        all += sample->layers[i];
    float dimmed = film_dimming(pass, all);
    for (int i = 0; i < N_LAYERS; i++)
        add_color(sum->color[i], pass->w, sample->layers[i], weight * dimmed);
    sum->weight += (double)weight;
    if (!(sample->depth > 0.0f))
        return dimmed;
    add_color(sum->color[N_LAYERS], pass->w, sample->albedo * pass->white, weight);
    for (int i = 0; i < 3; i++)
        sum->normal[i] += (double)(sample->normal[i] * weight);
    sum->depth += (double)(sample->depth * weight);
    sum->surface_weight += (double)weight;
    return dimmed;
}

static size_t pixel_index(const film *f, int x, int y)
{
    return (size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0);
}

/* Index of a pixel's first number of its groups. */
static size_t group_offset(const film *f, size_t pixel)
{
    return 3 * (size_t)f->n_groups * pixel;
}

void film_put_groups(film *f, const film_pass *pass, int x, int y, const spectrum *sums)
{
    if (f->n_groups == 0)
        return;
    float *xyz = f->pass_groups + group_offset(f, pixel_index(f, x, y));
    for (int i = 0; i < f->n_groups; i++)
        spectrum_to_xyz(pass->w, sums[i], xyz + 3 * i);
}

void film_put(film *f, int x, int y, const film_sum *sum)
{
    size_t i = pixel_index(f, x, y);
    const double *number = (const double *)sum;
    for (int k = 0; k < FILM_NUMBERS; k++)
        f->pass[i].number[k] = (float)number[k];
}

/* Of the beauty image, not yet divided by the weight. */
static double luminance(const film_sum *sum)
{
    double y = 0.0;
    for (int i = 0; i < N_LAYERS; i++)
        y += sum->color[i][FILM_Y];
    return y;
}

static void end_pixels(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const film *f = data;
    for (size_t i = group_offset(f, begin); i < group_offset(f, end); i++)
        f->groups[i] += (double)f->pass_groups[i];
    gbuffer_end_pass(f, begin, end);
    halves_end_pass(f, begin, end);
    for (size_t i = begin; i < end; i++) {
        film_pixel *pixel = &f->pixels[i];
        film_sum pass = {0};
        film_add_pass(&pass, &f->pass[i]);
        film_add_pass(&pixel->sum, &f->pass[i]);
        double y = luminance(&pass);
        pixel->y2 += y * y;
        pixel->yw += y * pass.weight;
        pixel->w2 += pass.weight * pass.weight;
    }
}

void film_end_pass(film *f, unsigned threads)
{
    parallel_for(n_pixels(f), 1 << 12, threads, NULL, end_pixels, f);
    f->n_passes++;
    f->n_cells = 0;
}

/* ---- Its error ---- */

/* Mean luminance of a pixel. */
static double pixel_mean(const film_pixel *pixel)
{
    return fabs(pixel->sum.weight) > 0.0 ? luminance(&pixel->sum) / pixel->sum.weight
                                         : 0.0;
}

/* Variance of that mean, by the scatter of n passes around it. */
static double pixel_variance(const film_pixel *pixel, int64_t n)
{
    double weight = pixel->sum.weight, mean = pixel_mean(pixel);
    if (n < 2 || !(fabs(weight) > 0.0))
        return 0.0;
    double scatter = pixel->y2 - 2.0 * mean * pixel->yw + mean * mean * pixel->w2;
    return fmax(scatter, 0.0) * (double)n / (double)(n - 1) / (weight * weight);
}

/* Mean over pixels of what they are beneath a ceiling. */
static double mean_below(const film *f, double ceiling)
{
    double sum = 0.0;
    for (size_t i = 0; i < n_pixels(f); i++)
        sum += fmin(pixel_mean(&f->pixels[i]), ceiling);
    return sum / (double)n_pixels(f);
}

/* Mean over a pixel and its neighbours: where light is rare, what a pixel says of its own
   brightness is as uncertain as its noise, and the ratio of the two says nothing. */
static double mean_around(const film *f, size_t i)
{
    int width = f->width, x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
    double sum = 0.0;
    int n = 0;
    for (int v = MAX(y - 1, 0); v <= MIN(y + 1, f->height - 1); v++) {
        for (int u = MAX(x - 1, 0); u <= MIN(x + 1, width - 1); u++, n++)
            sum += pixel_mean(&f->pixels[(size_t)v * (size_t)width + (size_t)u]);
    }
    return sum / n;
}

double film_noise(const film *f)
{
    if (f->n_passes < 2)
        return (double)INFINITY;
    double dark = DARK_SHARE * mean_below(f, mean_below(f, (double)INFINITY));
    double sum = 0.0;
    for (size_t i = 0; i < n_pixels(f); i++) {
        double y = mean_around(f, i);
        double variance = pixel_variance(&f->pixels[i], f->n_passes);
        sum += variance > 0.0 ? variance / (y * y + dark * dark) : 0.0;
    }
    return sqrt(sum / (double)n_pixels(f));
}

/* ---- The picture ---- */

static bool has_variance(const film *f)
{
    return f->n_passes >= 2;
}

/* Channel names: R G B, then layer.R ..., normal.X ..., depth.Z. */
static GPtrArray *channel_names(const film *f, bool denoised)
{
    GPtrArray *names = g_ptr_array_new_with_free_func(g_free);
    for (const char *c = "RGB"; *c; c++)
        g_ptr_array_add(names, g_strdup_printf("%c", *c));
    for (int i = 0; i < FILM_COLORS; i++) {
        for (const char *c = "RGB"; *c; c++)
            g_ptr_array_add(names, g_strdup_printf("%s.%c", layer_names[i], *c));
    }
    for (const char *c = "XYZ"; *c; c++)
        g_ptr_array_add(names, g_strdup_printf("normal.%c", *c));
    g_ptr_array_add(names, g_strdup("depth.Z"));
    if (has_variance(f))
        g_ptr_array_add(names, g_strdup("variance.Y"));
    for (int i = 0; i < f->n_groups; i++) {
        for (const char *c = "RGB"; *c; c++)
            g_ptr_array_add(names, g_strdup_printf("light.%s.%c", f->group_names[i], *c));
    }
    gbuffer_add_names(f, names);
    for (const char *c = "RGBA"; *c && denoised; c++)
        g_ptr_array_add(names, g_strdup_printf("lights.%c", *c));
    for (const char *c = "RGB"; *c && denoised; c++)
        g_ptr_array_add(names, g_strdup_printf("denoised.%c", *c));
    return names;
}

static void write_sum(const film *f, const film_sum *sum, float *out)
{
    double weight = film_surface_weight(f, sum);
    float *beauty = out, *layers = out + 3;
    for (int i = 0; i < FILM_COLORS; i++) {
        bool is_albedo = i == N_LAYERS;
        float *rgb = layers + 3 * i;
        film_to_rgb(f, sum->color[i], is_albedo ? weight : sum->weight, rgb);
        for (int c = 0; c < 3 && !is_albedo; c++) {
            rgb[c] *= f->scale;
            beauty[c] += rgb[c];
        }
    }
    float *rest = layers + 3 * FILM_COLORS;
    for (int i = 0; i < 3; i++)
        rest[i] = (float)(sum->normal[i] / weight);
    rest[3] = (float)(sum->depth / weight);
}

static void add_group(const film *f, size_t i, int group, double sum[3])
{
    size_t at = group_offset(f, i) + 3 * (size_t)group;
    for (size_t c = 0; c < 3; c++) {
        sum[c] += f->groups[at + c];
        if (film_pass_counts(f, i))
            sum[c] += (double)f->pass_groups[at + c];
    }
}

/* Of n pixels that stand for one. */
static void write_groups(const film *f, const size_t *from, int n, double weight,
                         float *out)
{
    for (int k = 0; k < f->n_groups; k++) {
        double sum[3] = {0};
        for (int j = 0; j < n; j++)
            add_group(f, from[j], k, sum);
        film_to_rgb(f, sum, weight, out + 3 * k);
        for (int c = 0; c < 3; c++)
            out[3 * k + c] *= f->scale;
    }
}

static void write_pixel(const film *f, size_t i, float *out)
{
    size_t from[4];
    int n = film_pixels_for(f, i, from);
    film_sum sum = {0};
    surface_sum surface = {0};
    for (int k = 0; k < n; k++) {
        film_add_pixel(f, from[k], &sum);
        gbuffer_sum(f, from[k], &surface);
    }
    write_sum(f, &sum, out);
    out += 3 + 3 * FILM_COLORS + 4;
    double scale2 = (double)f->scale * (double)f->scale;
    if (has_variance(f))
        *out++ = (float)(scale2 * pixel_variance(&f->pixels[i], f->n_passes));
    write_groups(f, from, n, sum.weight, out);
    gbuffer_write(f, &surface, &sum, out + 3 * f->n_groups);
}

typedef struct image_loop {
    const film *film;
    image *image;
    size_t first;
    const float *denoised; /* of the whole film; NULL: not among the channels */
} image_loop;

static void write_pixels(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const image_loop *loop = data;
    for (size_t i = begin; i < end; i++) {
        size_t n = (size_t)loop->image->n_channels;
        float *pixel = loop->image->pixels + i * n;
        write_pixel(loop->film, loop->first + i, pixel);
        if (!loop->denoised)
            continue;
        film_lights(loop->film, loop->first + i, pixel + n - 7);
        memcpy(pixel + n - 3, loop->denoised + 3 * i, 3 * sizeof(float));
    }
}

/* Rows of the picture; with what there is of the whole without noise, unless NULL. */
static image *make_image(const film *f, int y, int rows, const float *denoised,
                         unsigned threads, GError **error)
{
    g_autoptr(GPtrArray) names = channel_names(f, denoised);
    memory_release(f->image_size);
    image *img = image_new(f->width, rows, (int)names->len,
                           (const char *const *)names->pdata, error);
    memory_count(f->image_size);
    if (!img)
        return NULL;
    image_loop loop = {f, img, (size_t)y * (size_t)f->width, denoised};
    parallel_for((size_t)f->width * (size_t)rows, 1 << 12, threads, NULL, write_pixels,
                 &loop);
    color_space_chromaticities(f->space, img->chromaticities);
    image_header_set(img, "colorSpace", color_space_name(f->space));
    return img;
}

image *film_image(const film *f, unsigned threads, const cancel_flag *cancel,
                  GError **error)
{
    float *denoised;
    if (!film_denoise(f, threads, cancel, &denoised, error))
        return NULL;
    image *img = make_image(f, 0, f->height, denoised, threads, error);
    big_free(denoised);
    return img;
}

image *film_image_rows(const film *f, int y, int rows, unsigned threads, GError **error)
{
    return make_image(f, y, rows, NULL, threads, error);
}
