/*
 * image: TGA and BMP files written by hand, byte for byte, as their formats say: one
 * picture of 2 x 2 pixels, in every order of rows and every packing, and each cut off
 * everywhere.
 */
#include "image/image.h"

#include <stdint.h>
#include <string.h>

#define TGA(map, kind, map_length, map_bits, bits, descriptor)                           \
    0, map, kind, 0, 0, map_length, 0, map_bits, 0, 0, 0, 0, 2, 0, 2, 0, bits, descriptor
#define BMP(begin, height, bits, n_colors)                                               \
    'B', 'M', 0, 0, 0, 0, 0, 0, 0, 0, begin, 0, 0, 0, 40, 0, 0, 0, 2, 0, 0, 0, height,   \
        1, 0, bits, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, n_colors, 0, 0,   \
        0, 0, 0, 0, 0
#define TWO 2, 0, 0, 0
#define MINUS_TWO 0xfe, 0xff, 0xff, 0xff
/* Blue comes first. */
#define RED 0, 0, 255
#define GREEN 0, 255, 0
#define BLUE 255, 0, 0
#define DARK 30, 20, 10

static const uint8_t
    tga_up[] = {TGA(0, 2, 0, 0, 24, 0), BLUE, DARK, RED, GREEN},
    tga_down[] = {TGA(0, 2, 0, 0, 24, 0x20), RED, GREEN, BLUE, DARK},
    tga_packed[] = {TGA(0, 10, 0, 0, 24, 0x20), 1, RED, GREEN, 0x80, BLUE, 0x80, DARK},
    tga_mapped[] = {TGA(1, 1, 4, 24, 8, 0x20), RED, GREEN, BLUE, DARK, 0, 1, 2, 3},
    tga_alpha[] = {TGA(0, 2, 0, 0, 32, 0x28), RED, 255, GREEN, 51, BLUE, 0, DARK, 102},
    tga_grey[] = {TGA(0, 3, 0, 0, 8, 0x20), 0, 255, 51, 102},
    bmp_up[] = {BMP(54, TWO, 24, 0), BLUE, DARK, 0, 0, RED, GREEN, 0, 0},
    bmp_down[] = {BMP(54, MINUS_TWO, 24, 0), RED, GREEN, 0, 0, BLUE, DARK, 0, 0},
    bmp_mapped[] = {
        BMP(70, TWO, 8, 4), RED, 0, GREEN, 0, BLUE, 0, DARK, 0, 2, 3, 0, 0, 0, 1, 0, 0};

/* Codes by pixels, rows down. */
static const uint8_t colors[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30},
                     alphas[] = {255, 0, 0,   255, 0,  255, 0,  51,
                                 0,   0, 255, 0,   10, 20,  30, 102},
                     greys[] = {0, 0, 0, 255, 255, 255, 51, 51, 51, 102, 102, 102};

typedef struct kind {
    const char *name;
    const uint8_t *bytes;
    size_t size;
    int n_channels;
    const uint8_t *codes;
} kind;

static const kind kinds[] = {
    {"tga-up", tga_up, sizeof tga_up, 3, colors},
    {"tga-down", tga_down, sizeof tga_down, 3, colors},
    {"tga-packed", tga_packed, sizeof tga_packed, 3, colors},
    {"tga-mapped", tga_mapped, sizeof tga_mapped, 3, colors},
    {"tga-alpha", tga_alpha, sizeof tga_alpha, 4, alphas},
    {"tga-grey", tga_grey, sizeof tga_grey, 3, greys},
    {"bmp-up", bmp_up, sizeof bmp_up, 3, colors},
    {"bmp-down", bmp_down, sizeof bmp_down, 3, colors},
    {"bmp-mapped", bmp_mapped, sizeof bmp_mapped, 3, colors},
};

static image *read(const uint8_t *bytes, size_t size, GError **error)
{
    g_autoptr(GBytes) all = g_bytes_new(bytes, size);
    const image_read_options linear = {.encoding = ENCODING_LINEAR};
    return image_read_bytes("by hand", all, &linear, error);
}

static void test_pixels(gconstpointer data)
{
    const kind *of = data;
    g_autoptr(GError) error = NULL;
    g_autoptr(image) img = read(of->bytes, of->size, &error);
    g_assert_no_error(error);
    g_assert_cmpint(img->width, ==, 2);
    g_assert_cmpint(img->height, ==, 2);
    g_assert_cmpint(img->n_channels, ==, of->n_channels);
    for (int i = 0; i < 4 * of->n_channels; i++)
        g_assert_cmpfloat(img->pixels[i], ==, (float)of->codes[i] / 255.0f);
}

/* Whatever is missing at the end, half a picture is none. */
static void test_cut(gconstpointer data)
{
    const kind *of = data;
    for (size_t size = 0; size < of->size; size++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(image) img = read(of->bytes, size, &error);
        g_assert_null(img);
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        g_assert_nonnull(strstr(error->message, "by hand"));
    }
}

static void expect_refused(const uint8_t *bytes, size_t size, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(read(bytes, size, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, part));
}

static void test_refused(void)
{
    uint8_t packed[sizeof bmp_mapped], wide[sizeof tga_down];
    memcpy(packed, bmp_mapped, sizeof packed);
    packed[30] = 1; /* RLE8 */
    expect_refused(packed, sizeof packed, "compressed BMP");
    memcpy(wide, tga_down, sizeof wide);
    wide[13] = 0xff;
    expect_refused(wide, sizeof wide, "cannot hold");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        g_autofree char *pixels = g_strdup_printf("/image-pixbuf/%s", kinds[i].name),
                        *cut = g_strdup_printf("%s/cut", pixels);
        g_test_add_data_func(pixels, &kinds[i], test_pixels);
        g_test_add_data_func(cut, &kinds[i], test_cut);
    }
    g_test_add_func("/image-pixbuf/refused", test_refused);
    return g_test_run();
}
