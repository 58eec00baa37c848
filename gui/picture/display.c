#include "picture/display.h"

#include <math.h>
#include <string.h>

/* Bits of a float that pick an entry: 8 of exponent, 9 of mantissa. */
enum { TABLE_SHIFT = 14, TABLE_SIZE = 1 << (31 - TABLE_SHIFT) };

/* Stops that the false colours span, the middle grey of a picture in their middle. */
#define FALSE_STOPS 10.0f

const char *const tone_curve_names[] = {"sRGB",   "Gamma",  "Reinhard",
                                        "Filmic", "Linear", NULL};

display_options display_defaults(void)
{
    return (display_options){.gamma = 2.2f, .mark_bad = true};
}

/* ---- Layers ---- */

static int find_channel(const NephImage *image, const char *layer, const char *suffix)
{
    g_autofree char *wanted =
        *layer ? g_strconcat(layer, ".", suffix, NULL) : g_strdup(suffix);
    const char *name;
    for (int c = 0; (name = neph_image_channel_name(image, c)); c++)
        if (strcmp(name, wanted) == 0)
            return c;
    return -1;
}

/* The picture without noise, where there is one; else as it was rendered. */
#define SHOWN "denoised"
#define AS_RENDERED "raw"

static bool has_denoised(const NephImage *image)
{
    return find_channel(image, SHOWN, "R") >= 0;
}

bool display_channels(const NephImage *image, const char *layer, int channel[3])
{
    if (has_denoised(image))
        layer = !*layer ? SHOWN : strcmp(layer, AS_RENDERED) == 0 ? "" : layer;
    static const char *const sets[][3] = {
        {"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "Y", "Y"}, {"Z", "Z", "Z"}};
    for (size_t i = 0; i < G_N_ELEMENTS(sets); i++) {
        bool all = true;
        for (int k = 0; k < 3; k++) {
            channel[k] = find_channel(image, layer, sets[i][k]);
            all &= channel[k] >= 0;
        }
        if (all)
            return true;
    }
    return false;
}

char **display_layers(const NephImage *image)
{
    g_autoptr(GStrvBuilder) names = g_strv_builder_new();
    g_autofree char *last = g_strdup("");
    const char *name;
    g_strv_builder_add(names, "");
    for (int c = 0; (name = neph_image_channel_name(image, c)); c++) {
        const char *dot = strrchr(name, '.');
        if (!dot)
            continue;
        g_autofree char *layer = g_strndup(name, (gsize)(dot - name));
        if (strcmp(layer, last) == 0)
            continue;
        g_strv_builder_add(names, strcmp(layer, SHOWN) == 0 ? AS_RENDERED : layer);
        g_free(last);
        last = g_steal_pointer(&layer);
    }
    return g_strv_builder_end(names);
}

/* ---- Curves ---- */

static float encode_srgb(float x)
{
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

/* Hable's curve (2010), white at 11.2. */
static float hable(float x)
{
    return (x * (0.15f * x + 0.05f) + 0.004f) / (x * (0.15f * x + 0.5f) + 0.06f) -
           0.0666667f;
}

static float apply_curve(const display_options *o, float x)
{
    switch (o->curve) {
    case TONE_GAMMA:
        return powf(x, 1.0f / o->gamma);
    case TONE_REINHARD:
        return encode_srgb(x / (1.0f + x));
    case TONE_FILMIC:
        return encode_srgb(fminf(hable(2.0f * x) / hable(11.2f), 1.0f));
    case TONE_LINEAR:
        return x;
    case TONE_SRGB:
    default:
        return encode_srgb(fminf(x, 1.0f));
    }
}

/* What comes out as white, before the exposure; INFINITY: nothing is cut. */
static float white_of(const display_options *o)
{
    if (o->false_colour || o->curve == TONE_REINHARD)
        return INFINITY;
    return (o->curve == TONE_FILMIC ? 5.6f : 1.0f) / exp2f(o->exposure);
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float entry_value(uint32_t index)
{
    uint32_t bits = (index << TABLE_SHIFT) | (1u << (TABLE_SHIFT - 1));
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint8_t to_byte(float x)
{
    return (uint8_t)(fminf(fmaxf(x, 0.0f), 1.0f) * 255.0f + 0.5f);
}

static uint8_t *make_table(const display_options *o)
{
    uint8_t *table = g_malloc(TABLE_SIZE);
    float gain = exp2f(o->exposure);
    for (uint32_t i = 0; i < TABLE_SIZE; i++) {
        float x = gain * entry_value(i);
        table[i] = isfinite(x) ? to_byte(apply_curve(o, x)) : 255;
    }
    return table;
}

void display_false_colour(float x, float rgb[3])
{
    static const float stops[][3] = {{0.04f, 0.02f, 0.20f}, {0.10f, 0.25f, 0.75f},
                                     {0.05f, 0.62f, 0.70f}, {0.25f, 0.72f, 0.25f},
                                     {0.93f, 0.80f, 0.15f}, {0.88f, 0.25f, 0.12f},
                                     {1.00f, 0.97f, 0.92f}};
    float at = fminf(fmaxf(x, 0.0f), 1.0f) * (float)(G_N_ELEMENTS(stops) - 1);
    size_t i = MIN((size_t)at, G_N_ELEMENTS(stops) - 2);
    float t = at - (float)i;
    for (int k = 0; k < 3; k++)
        rgb[k] = (1.0f - t) * stops[i][k] + t * stops[i + 1][k];
}

/* ---- Pixels ---- */

static float luminance(const float v[3])
{
    return 0.2126f * v[0] + 0.7152f * v[1] + 0.0722f * v[2];
}

static uint32_t pack(float r, float g, float b)
{
    return 0xff000000u | (uint32_t)to_byte(r) << 16 | (uint32_t)to_byte(g) << 8 |
           to_byte(b);
}

/* The colour of a pixel that is no light; 0 if it is. */
static uint32_t mark(const float v[3])
{
    bool nan = false, infinite = false;
    for (int k = 0; k < 3; k++) {
        nan |= isnan(v[k]);
        infinite |= isinf(v[k]) != 0;
    }
    if (nan)
        return pack(1.0f, 0.0f, 1.0f);
    return infinite ? pack(1.0f, 1.0f, 0.0f) : 0;
}

static uint32_t false_pixel(const display_options *o, const float v[3])
{
    float rgb[3], y = fmaxf(luminance(v), 1e-20f);
    display_false_colour((log2f(y) + o->exposure + 0.75f * FALSE_STOPS) / FALSE_STOPS,
                         rgb);
    return pack(rgb[0], rgb[1], rgb[2]);
}

/* What is converted. */
typedef struct source {
    NephImage *made; /* owned; NULL: a layer of the image, as it is */
    const NephImage *image;
    int channel[3];
} source;

/* @return false: no such layer */
static bool source_open(source *s, const NephImage *image, const display_options *o)
{
    *s = (source){.image = image};
    if (!display_channels(image, o->layer, s->channel))
        return false;
    if (!*o->layer && (s->made = neph_image_shown(image, white_of(o), NULL))) {
        s->image = s->made;
        for (int k = 0; k < 3; k++)
            s->channel[k] = k;
    }
    return true;
}

typedef struct converter {
    const display_options *options;
    uint8_t *table;
    bool is_normal; /* -1..1, shown as 0..1 */
} converter;

static uint8_t look_up(const converter *c, float x)
{
    return x > 0.0f ? c->table[bits_of(x) >> TABLE_SHIFT] : 0;
}

static uint32_t convert(const converter *c, const float v[3])
{
    if (c->is_normal)
        return pack(0.5f + 0.5f * v[0], 0.5f + 0.5f * v[1], 0.5f + 0.5f * v[2]);
    uint32_t marked = c->options->mark_bad ? mark(v) : 0;
    if (marked)
        return marked;
    if (c->options->false_colour)
        return false_pixel(c->options, v);
    return 0xff000000u | (uint32_t)look_up(c, v[0]) << 16 |
           (uint32_t)look_up(c, v[1]) << 8 | look_up(c, v[2]);
}

static void fill(cairo_surface_t *surface, const source *from, const converter *c)
{
    int width, height, n;
    const int *channel = from->channel;
    neph_image_size(from->image, &width, &height, &n);
    unsigned char *rows = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    const float *pixel = neph_image_pixels(from->image);
    for (int y = 0; y < height; y++) {
        uint32_t *out = (uint32_t *)(void *)(rows + (ptrdiff_t)y * stride);
        for (int x = 0; x < width; x++, pixel += n) {
            const float v[3] = {pixel[channel[0]], pixel[channel[1]], pixel[channel[2]]};
            out[x] = convert(c, v);
        }
    }
}

cairo_surface_t *display_surface(const NephImage *image, const display_options *options)
{
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    source from;
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS ||
        !source_open(&from, image, options)) {
        cairo_surface_destroy(surface);
        return NULL;
    }
    converter c = {options, make_table(options), strcmp(options->layer, "normal") == 0};
    cairo_surface_flush(surface);
    fill(surface, &from, &c);
    cairo_surface_mark_dirty(surface);
    g_free(c.table);
    neph_image_free(from.made);
    return surface;
}

static float decode_srgb(float x)
{
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

/* Linear values of the bytes that are shown, three a pixel. */
static void fill_linear(float *rgb, size_t n_pixels, const source *from,
                        const display_options *options)
{
    int width, height, n;
    float linear[256];
    for (int i = 0; i < 256; i++)
        linear[i] = decode_srgb((float)i / 255.0f);
    converter c = {options, make_table(options), strcmp(options->layer, "normal") == 0};
    const int *channel = from->channel;
    const float *pixel = neph_image_pixels(from->image);
    neph_image_size(from->image, &width, &height, &n);
    for (size_t i = 0; i < n_pixels; i++, pixel += n) {
        const float v[3] = {pixel[channel[0]], pixel[channel[1]], pixel[channel[2]]};
        uint32_t seen = convert(&c, v);
        for (int k = 0; k < 3; k++)
            rgb[3 * i + (size_t)k] = linear[seen >> (16 - 8 * k) & 0xff];
    }
    g_free(c.table);
}

NephImage *display_image(const NephImage *image, const display_options *options,
                         GError **error)
{
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    size_t n_pixels = (size_t)width * (size_t)height;
    g_autofree float *rgb = g_try_new(float, 3 * n_pixels);
    source from;
    if (!rgb) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_FAILED,
                    "there is no memory for the picture");
        return NULL;
    }
    if (!source_open(&from, image, options)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT,
                    "the picture has no layer '%s'", options->layer);
        return NULL;
    }
    fill_linear(rgb, n_pixels, &from, options);
    neph_image_free(from.made);
    return neph_image_new(width, height, rgb, error);
}

size_t display_histogram(const NephImage *image, const char *layer, float low, float high,
                         size_t n, size_t counts[3][256])
{
    int width, height, n_channels, channel[3];
    memset(counts, 0, 3 * sizeof *counts);
    if (!display_channels(image, layer, channel))
        return 0;
    neph_image_size(image, &width, &height, &n_channels);
    const float *pixel = neph_image_pixels(image);
    size_t n_pixels = (size_t)width * (size_t)height, largest = 0;
    for (size_t i = 0; i < n_pixels; i++, pixel += n_channels)
        for (int k = 0; k < 3; k++) {
            float v = pixel[channel[k]];
            if (!isfinite(v) || v <= 0.0f)
                continue;
            float at = (log2f(v) - low) / (high - low) * (float)n;
            size_t bin = (size_t)fminf(fmaxf(at, 0.0f), (float)n - 1.0f);
            counts[k][bin]++;
            largest = MAX(largest, counts[k][bin]);
        }
    return largest;
}
