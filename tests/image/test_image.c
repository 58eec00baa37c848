/*
 * image: what is written is read again, what others write is read as its format says,
 * and what cannot be done is refused without leaving a file.
 */
#include "image/image.h"

#include "base/memory.h"
#include "folder.h"

#include <fcntl.h>
#include <glib/gstdio.h>
#include <math.h>
#include <png.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static const char *const rgb_names[] = {"R", "G", "B", "A"};
static char *folder;

static char *in_folder(const char *name)
{
    return g_build_filename(folder, name, NULL);
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    g_assert_true(g_file_set_contents(path, bytes, (gssize)size, NULL));
}

static image *read_bytes(const void *bytes, size_t size, GError **error)
{
    g_autofree char *path = in_folder("bytes");
    write_bytes(path, bytes, size);
    return image_read(path, NULL, error);
}

/* Numbers between 2^-10 and 2^6, of every magnitude; seeded. */
static image *noise_image(int width, int height, int n, const char *const *names)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(7);
    image *img = image_new(width, height, n, names, NULL);
    g_assert_nonnull(img);
    for (int i = 0; i < width * height * n; i++)
        img->pixels[i] = (float)exp2(g_rand_double_range(random, -10, 6));
    return img;
}

static image *write_and_read(const image *img, const char *name)
{
    GError *error = NULL;
    g_autofree char *path = in_folder(name);
    unsigned before = n_files_in(folder);
    g_assert_true(image_can_write(path, &error));
    g_assert_cmpuint(n_files_in(folder), ==, before);
    g_assert_true(image_write(img, path, NULL, &error));
    g_assert_no_error(error);
    image *back = image_read(path, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(n_files_in(folder), ==, before + 1);
    g_assert_cmpint(back->width, ==, img->width);
    g_assert_cmpint(back->height, ==, img->height);
    g_unlink(path);
    return back;
}

static void assert_refused(GError *error, error_code code, const char *text)
{
    g_assert_error(error, NEPH_ERROR, (int)code);
    if (!strstr(error->message, text))
        g_error("'%s' does not say '%s'", error->message, text);
    g_error_free(error);
}

/* ---- the buffer ---- */

static void test_new_refuses_absurd_sizes(void)
{
    const int sizes[][3] = {{0, 1, 3}, {1, -1, 3}, {65536, 65536, 3}, {1, 1, 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        GError *error = NULL;
        g_assert_null(
            image_new(sizes[i][0], sizes[i][1], sizes[i][2], rgb_names, &error));
        assert_refused(error, ERROR_INPUT, "refused");
    }
    GError *error = NULL;
    big_alloc_fail_at(1);
    g_assert_null(image_new(4, 4, 3, rgb_names, &error));
    assert_refused(error, ERROR_FAILED, "out of memory");
}

static void test_channels_and_header(void)
{
    const char *const names[] = {"direct.R", "Z"};
    g_autoptr(image) img = image_new(2, 2, 2, names, NULL);
    g_assert_cmpint(image_channel(img, "Z"), ==, 1);
    g_assert_cmpint(image_channel(img, "R"), ==, -1);
    g_assert_null(image_header_get(img, "seed"));
    image_header_set(img, "seed", "1");
    image_header_set(img, "seed", "2");
    g_assert_cmpstr(image_header_get(img, "seed"), ==, "2");
    g_assert_cmpfloat(img->pixels[7], ==, 0.0f);
}

static void test_srgb(void)
{
    for (int i = -10; i <= 300; i++) {
        float v = (float)i / 255.0f;
        g_assert_cmpfloat_with_epsilon(srgb_encode(srgb_decode(v)), v, 1e-6);
    }
    /* IEC 61966-2-1: mid grey, and the two pieces meet. */
    g_assert_cmpfloat_with_epsilon(srgb_encode(0.214041f), 0.5f, 1e-5);
    g_assert_cmpfloat_with_epsilon(srgb_decode(0.04045f), srgb_decode(0.0404501f), 1e-6);
}

/* ---- round trips ---- */

static void test_exr_keeps_every_bit(void)
{
    const char *const names[] = {"R",
                                 "G",
                                 "B",
                                 "albedo.R",
                                 "normal.X",
                                 "depth.Z",
                                 "a name of more than thirty-one letters"};
    g_autoptr(image) img = noise_image(37, 41, G_N_ELEMENTS(names), names);
    img->pixels[5] = NAN;
    img->pixels[6] = -INFINITY;
    img->pixels[7] = -1e-40f;
    const float rec2020[8] = {0.708f, 0.292f, 0.17f,   0.797f,
                              0.131f, 0.046f, 0.3127f, 0.329f};
    memcpy(img->chromaticities, rec2020, sizeof rec2020);
    image_header_set(img, "nephroid.seed", "17");
    image_header_set(img, "note", "several\nlines; Umlaut: ä");
    image_header_set(img, "empty", "");
    g_autoptr(image) back = write_and_read(img, "a.exr");
    g_assert_cmpint(back->n_channels, ==, img->n_channels);
    for (int c = 0; c < img->n_channels; c++) {
        int from = image_channel(back, img->channels[c]);
        g_assert_cmpint(from, >=, 0);
        for (int i = 0; i < 37 * 41; i++)
            g_assert_cmpmem(&img->pixels[i * img->n_channels + c], sizeof(float),
                            &back->pixels[i * img->n_channels + from], sizeof(float));
    }
    g_assert_cmpmem(back->chromaticities, sizeof rec2020, rec2020, sizeof rec2020);
    g_assert_cmpstr(image_header_get(back, "nephroid.seed"), ==, "17");
    g_assert_cmpstr(image_header_get(back, "note"), ==, "several\nlines; Umlaut: ä");
    g_assert_cmpstr(image_header_get(back, "empty"), ==, "");
    g_assert_cmpstr(image_header_get(back, "software"), ==, "Nephroid");
}

static void test_exr_refuses_what_it_cannot_name(void)
{
    GError *error = NULL;
    g_autofree char *path = in_folder("twice.exr");
    const char *const twice[] = {"R", "R"};
    g_autoptr(image) img = image_new(2, 2, 2, twice, NULL);
    g_assert_false(image_write(img, path, NULL, &error));
    assert_refused(error, ERROR_FAILED, path);
    g_autoptr(image) plain = image_new(2, 2, 3, rgb_names, NULL);
    image_header_set(plain, "compression", "none");
    error = NULL;
    g_assert_false(image_write(plain, path, NULL, &error));
    assert_refused(error, ERROR_FAILED, path);
    g_assert_cmpuint(n_files_in(folder), ==, 0);
}

static void test_pfm_keeps_every_bit(void)
{
    g_autoptr(image) img = noise_image(5, 3, 3, rgb_names);
    img->pixels[4] = NAN;
    g_autoptr(image) back = write_and_read(img, "a.PFM");
    g_assert_cmpmem(img->pixels, 45 * sizeof(float), back->pixels, 45 * sizeof(float));
}

/* Half a step of the mantissa that all three share. */
static void test_hdr_is_close(void)
{
    const int widths[] = {3, 8, 130, 500};
    for (size_t w = 0; w < G_N_ELEMENTS(widths); w++) {
        g_autoptr(image) img = noise_image(widths[w], 5, 3, rgb_names);
        for (int i = 0; i < 3 * widths[w]; i++)
            img->pixels[i] = i < widths[w] ? 0.25f : (float)(i / 60);
        img->pixels[widths[w] * 6] = NAN;
        img->pixels[widths[w] * 6 + 1] = 3e38f;
        g_autoptr(image) back = write_and_read(img, "a.hdr");
        for (int i = 0; i < widths[w] * 5; i++) {
            const float *a = img->pixels + 3 * i, *b = back->pixels + 3 * i;
            float largest = fmaxf(a[0], fmaxf(a[1], a[2]));
            for (int c = 0; c < 3 && largest < 1e38f && !isnan(a[c]); c++)
                g_assert_cmpfloat(fabsf(a[c] - b[c]), <=, largest / 255.0f);
        }
        g_assert_cmpfloat(back->pixels[widths[w] * 6], ==, 0.0f);
        g_assert_cmpfloat(back->pixels[widths[w] * 6 + 1], >, 1e38f);
    }
}

static void test_png_keeps_every_code(void)
{
    g_autoptr(image) img = image_new(256, 2, 4, rgb_names, NULL);
    for (int i = 0; i < 256; i++) {
        float *p = img->pixels + 4 * i;
        p[0] = srgb_decode((float)i / 255.0f);
        p[1] = srgb_decode((float)(255 - i) / 255.0f);
        p[3] = (float)i / 255.0f;
    }
    img->pixels[4 * 256] = NAN;
    img->pixels[4 * 256 + 1] = 7.0f;
    img->pixels[4 * 256 + 2] = -7.0f;
    g_autoptr(image) back = write_and_read(img, "a.png");
    g_assert_cmpint(back->n_channels, ==, 4);
    for (int i = 0; i < 4 * 256; i++)
        g_assert_cmpfloat_with_epsilon(img->pixels[i], back->pixels[i], 1e-6);
    const float clipped[3] = {0, 1, 0};
    for (int c = 0; c < 3; c++)
        g_assert_cmpfloat_with_epsilon(back->pixels[4 * 256 + c], clipped[c], 1e-6);
}

static void test_exposure(void)
{
    const image_write_options brighter = {.exposure = 1.5f};
    const char *const names[] = {"a.png", "a.jpg"};
    for (int i = 0; i < 2; i++) {
        g_autofree char *path = in_folder(names[i]);
        g_autoptr(image) img = image_new(16, 16, 3, rgb_names, NULL);
        for (int j = 0; j < 16 * 16 * 3; j++)
            img->pixels[j] = 0.1f;
        g_assert_true(image_write(img, path, &brighter, NULL));
        g_autoptr(image) back = image_read(path, NULL, NULL);
        float step = i == 0 ? 0.5f : 1.0f;
        g_assert_cmpfloat_with_epsilon(255.0f * srgb_encode(back->pixels[100]),
                                       255.0f * srgb_encode(0.1f * exp2f(1.5f)),
                                       (double)step);
        g_unlink(path);
    }
}

static void test_jpeg_is_close(void)
{
    g_autoptr(image) img = image_new(64, 48, 3, rgb_names, NULL);
    for (int i = 0; i < 64 * 48; i++) {
        img->pixels[3 * i] = (float)(i % 64) / 64.0f;
        img->pixels[3 * i + 1] = (float)(i / 64) / 48.0f;
        img->pixels[3 * i + 2] = 0.25f;
    }
    g_autoptr(image) back = write_and_read(img, "a.jpeg");
    for (int i = 0; i < 64 * 48 * 3; i++)
        g_assert_cmpfloat_with_epsilon(srgb_encode(img->pixels[i]),
                                       srgb_encode(back->pixels[i]), 0.03);
}

static void test_encoding(void)
{
    g_autofree char *path = in_folder("a.png");
    g_autoptr(image) img = image_new(1, 1, 4, rgb_names, NULL);
    for (int c = 0; c < 4; c++)
        img->pixels[c] = srgb_decode(51.0f / 255.0f);
    img->pixels[3] = 0.2f;
    g_assert_true(image_write(img, path, NULL, NULL));
    const image_read_options options[] = {
        {ENCODING_SRGB, 0}, {ENCODING_LINEAR, 0}, {ENCODING_GAMMA, 2.2f}};
    const float expected[] = {srgb_decode(0.2f), 0.2f, powf(0.2f, 2.2f)};
    for (int i = 0; i < 3; i++) {
        g_autoptr(image) back = image_read(path, &options[i], NULL);
        g_assert_cmpfloat_with_epsilon(back->pixels[1], expected[i], 1e-6);
        g_assert_cmpfloat_with_epsilon(back->pixels[3], 0.2f, 1e-6);
    }
    g_unlink(path);
}

/* ---- what others write ---- */

typedef struct png_kind {
    int color_type, depth, n_values;
    bool interlaced;
} png_kind;

static unsigned png_code(const png_kind *kind, int x, int y, int c)
{
    unsigned code = (unsigned)(x * 37 + y * 101 + c * 53);
    unsigned n = kind->color_type == PNG_COLOR_TYPE_PALETTE ? 3 : 1u << kind->depth;
    return kind->depth == 16 ? (code * 977) % 65536 : code % n;
}

static void pack_row(const png_kind *kind, int width, int y, png_byte *row)
{
    memset(row, 0, 64);
    for (int i = 0; i < width * kind->n_values; i++) {
        unsigned code = png_code(kind, i / kind->n_values, y, i % kind->n_values);
        int bit = i * kind->depth;
        if (kind->depth == 16) {
            row[2 * i] = (png_byte)(code >> 8);
            row[2 * i + 1] = (png_byte)(code & 255);
        } else {
            row[bit / 8] |= (png_byte)(code << (8 - kind->depth - bit % 8));
        }
    }
}

static void write_png_kind(const char *path, const png_kind *kind, int width, int height)
{
    static png_byte bytes[16][64];
    static png_bytep rows[16];
    const png_color palette[3] = {{255, 0, 0}, {0, 255, 0}, {10, 20, 30}};
    const png_byte transparent[3] = {0, 128, 255};
    FILE *f = g_fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, f);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, kind->depth,
                 kind->color_type, kind->interlaced ? PNG_INTERLACE_ADAM7 : 0, 0, 0);
    if (kind->color_type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 3);
        png_set_tRNS(png, info, transparent, 3, NULL);
    }
    for (int y = 0; y < height; y++) {
        rows[y] = bytes[y];
        pack_row(kind, width, y, rows[y]);
    }
    png_set_rows(png, info, rows);
    png_write_png(png, info, 0, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(f);
}

/* What the PNG standard says that code stands for, before linearisation. */
static double png_value(const png_kind *kind, int x, int y, int c)
{
    const int palette[3][4] = {{255, 0, 0, 0}, {0, 255, 0, 128}, {10, 20, 30, 255}};
    bool grey = !(kind->color_type & PNG_COLOR_MASK_COLOR);
    if (kind->color_type == PNG_COLOR_TYPE_PALETTE)
        return palette[png_code(kind, x, y, 0)][c] / 255.0;
    int from = c == 3 ? kind->n_values - 1 : grey ? 0 : c;
    return png_code(kind, x, y, from) / (exp2(kind->depth) - 1.0);
}

static void test_png_kinds(void)
{
    const png_kind kinds[] = {
        {PNG_COLOR_TYPE_GRAY, 1, 1, false},       {PNG_COLOR_TYPE_GRAY, 4, 1, false},
        {PNG_COLOR_TYPE_GRAY, 8, 1, true},        {PNG_COLOR_TYPE_GRAY, 16, 1, false},
        {PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2, false}, {PNG_COLOR_TYPE_RGB, 8, 3, true},
        {PNG_COLOR_TYPE_RGB, 16, 3, false},       {PNG_COLOR_TYPE_RGB_ALPHA, 16, 4, true},
        {PNG_COLOR_TYPE_PALETTE, 2, 1, false},    {PNG_COLOR_TYPE_PALETTE, 8, 1, true},
    };
    g_autofree char *path = in_folder("kind.png");
    for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++) {
        write_png_kind(path, &kinds[k], 7, 5);
        GError *error = NULL;
        g_autoptr(image) img = image_read(path, NULL, &error);
        g_assert_no_error(error);
        bool alpha = kinds[k].color_type & PNG_COLOR_MASK_ALPHA ||
                     kinds[k].color_type == PNG_COLOR_TYPE_PALETTE;
        g_assert_cmpint(img->n_channels, ==, alpha ? 4 : 3);
        for (int i = 0; i < 7 * 5 * img->n_channels; i++) {
            int c = i % img->n_channels, pixel = i / img->n_channels;
            double v = png_value(&kinds[k], pixel % 7, pixel / 7, c);
            double expected = c == 3 ? v : (double)srgb_decode((float)v);
            g_assert_cmpfloat_with_epsilon((double)img->pixels[i], expected, 1e-6);
        }
    }
    g_unlink(path);
}

static void test_hdr_by_hand(void)
{
    /* Two pixels flat; the second line repeats a pixel by the old run; +Y counts up. */
    const char file[] =
        "#?RADIANCE\n#a=b\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 +X 3\n"
        "\x80\x40\x20\x81\x80\x80\x80\x80\x00\x00\x00\x00"
        "\x08\x10\x20\x88\x01\x01\x01\x02";
    g_autoptr(image) img = read_bytes(file, sizeof file - 1, NULL);
    g_assert_nonnull(img);
    g_assert_cmpint(img->width, ==, 3);
    g_assert_cmpstr(image_header_get(img, "EXPOSURE"), ==, "2");
    g_assert_cmpuint(g_hash_table_size(img->header), ==, 1);
    const float expected[2][9] = {{8, 16, 32, 8, 16, 32, 8, 16, 32},
                                  {1, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0, 0, 0}};
    g_assert_cmpmem(img->pixels, sizeof expected, expected, sizeof expected);
    /* Columns first, from the right: pixel i of scanline s is x = 1 - s, y = i. */
    const char turned[] = "#?RGBE\n\n-X 2 -Y 1\n\x80\x80\x80\x81\x80\x80\x80\x82";
    g_autoptr(image) across = read_bytes(turned, sizeof turned - 1, NULL);
    g_assert_nonnull(across);
    g_assert_cmpint(across->width, ==, 2);
    g_assert_cmpfloat(across->pixels[0], ==, 2.0f);
    g_assert_cmpfloat(across->pixels[3], ==, 1.0f);
    GError *error = NULL;
    const char xyz[] = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\1\1\1\1";
    g_assert_null(read_bytes(xyz, sizeof xyz - 1, &error));
    assert_refused(error, ERROR_INPUT, "32-bit_rle_xyze");
}

static void test_pfm_by_hand(void)
{
    /* 1.0 is 3f800000; big endian, twofold scale, bottom row first, a comment. */
    const char grey[] = "Pf\n# made by hand\n1 2\n2.0\n\x3f\x80\0\0\x40\0\0\0";
    g_autoptr(image) img = read_bytes(grey, sizeof grey - 1, NULL);
    g_assert_nonnull(img);
    g_assert_cmpint(img->n_channels, ==, 3);
    g_assert_cmpfloat(img->pixels[2], ==, 4.0f);
    g_assert_cmpfloat(img->pixels[3], ==, 2.0f);
}

static void test_references_are_read(void)
{
    const char *const names[] = {"bitterli/cornell-box/TungstenRender.exr",
                                 "bitterli/veach-mis/TungstenRender.exr",
                                 "spectral/ring.exr", "spectral/cornell-glass.exr"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *path =
            g_build_filename(SOURCE_ROOT, "../shared/refs", names[i], NULL);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no ../shared/refs");
            return;
        }
        GError *error = NULL;
        g_autoptr(image) img = image_read(path, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpint(image_channel(img, "G"), >=, 0);
        double sum = 0;
        size_t n = (size_t)img->width * (size_t)img->height * 3;
        for (size_t j = 0; j < n; j++)
            sum += (double)img->pixels[j];
        g_assert_cmpfloat(sum / (double)n, >, 0.01);
        g_assert_cmpfloat(sum / (double)n, <, 100.0);
    }
}

/* ---- refusals ---- */

static void test_read_refuses(void)
{
    GError *error = NULL;
    g_assert_null(image_read("/no/such/file.png", NULL, &error));
    assert_refused(error, ERROR_INPUT, "/no/such/file.png");
    error = NULL;
    g_assert_null(image_read(folder, NULL, &error));
    assert_refused(error, ERROR_INPUT, "which is none");
    error = NULL;
    g_assert_null(read_bytes("GIF89a", 6, &error));
    assert_refused(error, ERROR_INPUT, "not an image");
    error = NULL;
    g_assert_null(read_bytes("", 0, &error));
    assert_refused(error, ERROR_INPUT, "not an image");
    const char *const liars[] = {
        "#?RADIANCE\n\n-Y 40000 +X 40000\n", "#?RADIANCE\n\n-Y -4 +X 4\n",
        "PF\n99999 99999\n-1\n\n",           "PF\n0 1\n-1\n",
        "PF\n1 1\n0\n123456789012",          "PF\n1 1\nnan\n123456789012"};
    for (size_t i = 0; i < G_N_ELEMENTS(liars); i++) {
        error = NULL;
        g_assert_null(read_bytes(liars[i], strlen(liars[i]), &error));
        assert_refused(error, ERROR_INPUT, "bytes");
    }
    g_autofree char *path = in_folder("bytes");
    g_unlink(path);
}

static void test_write_refuses(void)
{
    const char *const colourless[] = {"U", "V"};
    g_autoptr(image) img = image_new(2, 2, 2, colourless, NULL);
    const char *const names[] = {"a.png", "a.jpg", "a.hdr", "a.pfm"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        GError *error = NULL;
        g_autofree char *path = in_folder(names[i]);
        g_assert_false(image_write(img, path, NULL, &error));
        assert_refused(error, ERROR_INPUT, path);
    }
    const char *const impossible[] = {"/no/such/folder/a.exr", "a.tga", "a"};
    for (size_t i = 0; i < G_N_ELEMENTS(impossible); i++) {
        GError *error = NULL;
        g_assert_false(image_can_write(impossible[i], &error));
        assert_refused(error, ERROR_INPUT, impossible[i]);
        error = NULL;
        g_assert_false(image_write(img, impossible[i], NULL, &error));
        assert_refused(error, ERROR_INPUT, impossible[i]);
    }
    g_assert_cmpuint(n_files_in(folder), ==, 0);
}

/* With no more than 2 kB to a file, every writer fails, and the old file is untouched. */
static void test_full_disk_keeps_old_file(void)
{
    const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.hdr", "a.pfm"};
    g_autoptr(image) img = noise_image(64, 64, 3, rgb_names);
    struct rlimit before, small = {2048, 2048};
    signal(SIGXFSZ, SIG_IGN);
    g_assert_cmpint(getrlimit(RLIMIT_FSIZE, &before), ==, 0);
    small.rlim_max = before.rlim_max;
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        GError *error = NULL;
        g_autofree char *path = in_folder(names[i]), *text = NULL;
        write_bytes(path, "old", 3);
        setrlimit(RLIMIT_FSIZE, &small);
        bool written = image_write(img, path, NULL, &error);
        setrlimit(RLIMIT_FSIZE, &before);
        g_assert_false(written);
        assert_refused(error, ERROR_FAILED, path);
        g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
        g_assert_cmpstr(text, ==, "old");
        g_unlink(path);
        g_assert_cmpuint(n_files_in(folder), ==, 0);
    }
    signal(SIGXFSZ, SIG_DFL);
}

/* What is written is what a writer is found for, and eight bits are those of a screen. */
static void test_endings(void)
{
    static const struct {
        const char *path;
        bool written, eight_bits;
    } cases[] = {{"a.png", true, true},      {"a/b.JPEG", true, true},
                 {"a.exr", true, false},     {"a.hdr", true, false},
                 {"a.pfm", true, false},     {"a.bmp", false, false},
                 {"a.png.ply", false, false}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        bool eight_bits;
        g_assert_true(image_is_written(cases[i].path, &eight_bits) == cases[i].written);
        g_assert_true(eight_bits == cases[i].eight_bits);
    }
    for (const char *const *e = image_written_extensions(); *e; e++) {
        bool eight_bits;
        g_assert_true(image_is_written(*e, &eight_bits));
        g_assert_true(g_strv_contains(image_extensions(), *e));
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-image-XXXXXX", NULL);
    g_test_add_func("/image/endings", test_endings);
    g_test_add_func("/image/new", test_new_refuses_absurd_sizes);
    g_test_add_func("/image/channels-and-header", test_channels_and_header);
    g_test_add_func("/image/srgb", test_srgb);
    g_test_add_func("/image/exr", test_exr_keeps_every_bit);
    g_test_add_func("/image/exr-names", test_exr_refuses_what_it_cannot_name);
    g_test_add_func("/image/pfm", test_pfm_keeps_every_bit);
    g_test_add_func("/image/hdr", test_hdr_is_close);
    g_test_add_func("/image/png", test_png_keeps_every_code);
    g_test_add_func("/image/exposure", test_exposure);
    g_test_add_func("/image/jpeg", test_jpeg_is_close);
    g_test_add_func("/image/encoding", test_encoding);
    g_test_add_func("/image/png-kinds", test_png_kinds);
    g_test_add_func("/image/write-refuses", test_write_refuses);
    g_test_add_func("/image/full-disk", test_full_disk_keeps_old_file);
    g_test_add_func("/image/hdr-by-hand", test_hdr_by_hand);
    g_test_add_func("/image/pfm-by-hand", test_pfm_by_hand);
    g_test_add_func("/image/references", test_references_are_read);
    g_test_add_func("/image/read-refuses", test_read_refuses);
    int result = g_test_run();
    g_rmdir(folder);
    g_free(folder);
    return result;
}
