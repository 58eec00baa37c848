/*
 * film: what the film directive says acts on the picture: brightness that is cut off,
 * white balance, the space of normals; and what the cameras that came last see, by every
 * algorithm.
 */
#include "rooms.h"

#include "color/balance.h"
#include "render/film/film.h"

static view *wall(const char *film_text, const char *camera_text)
{
    g_autofree char *text = g_strdup_printf(
        "Film %s \"integer xresolution\" 12 \"integer yresolution\" 12\n"
        "PixelFilter \"box\"\nLookAt 0 0 4 0 0 0 0 1 0\nCamera %s\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0 0 1] \"rgb I\" [3 3 3]\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
        "AttributeBegin\nRotate 40 0 1 0\nShape \"disk\" \"float radius\" 9\n"
        "AttributeEnd\n",
        film_text, camera_text);
    return view_of(text);
}

static float value(const image *img, const char *channel, int x, int y)
{
    int c = image_channel(img, channel);
    g_assert_cmpint(c, >=, 0);
    return img->pixels[(12 * y + x) * img->n_channels + c];
}

/* No sample is brighter than allowed, and what is darker stays as it is. */
static void test_largest_component(void)
{
    static const char *const ways[] = {"integrator=path passes=2 spp=4",
                                       "integrator=vcm passes=2 spp=4 photons=2000"};
    g_autoptr(view) free = wall("\"rgb\"", "\"perspective\"");
    g_autoptr(view) cut =
        wall("\"rgb\" \"float maxcomponentvalue\" 0.3", "\"perspective\"");
    g_autoptr(image) a = render_with(free, ways[0]);
    g_autoptr(image) b = render_with(cut, ways[0]);
    bool any = false;
    for (int i = 0; i < 144; i++) {
        float before = value(a, "G", i % 12, i / 12),
              after = value(b, "G", i % 12, i / 12);
        if (before < 0.15f)
            g_assert_cmpfloat(fabsf(after - before), <, 1e-6f);
        any |= before > 0.5f;
        g_assert_cmpfloat(after, <, 0.4f);
    }
    g_assert_true(any);
}

/* What is grey in daylight of 4500 K is grey after balancing for it. */
static void test_white_balance(void)
{
    double m[9], daylight65[9];
    color_balance(4500, color_space_srgb(), m);
    color_balance(6504, color_space_srgb(), daylight65);
    const double t = 1e3 / 4500,
                 x = ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063,
                 y = (-3 * x + 2.87) * x - 0.275;
    const double white[3] = {x / y, 1, (1 - x - y) / y}, d65[3] = {0.95047, 1, 1.08883};
    for (int i = 0; i < 3; i++) {
        double to =
            m[3 * i] * white[0] + m[3 * i + 1] * white[1] + m[3 * i + 2] * white[2];
        g_assert_cmpfloat(fabs(to - d65[i]), <, 2e-3);
        for (int k = 0; k < 3; k++)
            g_assert_cmpfloat(fabs(daylight65[3 * i + k] - (i == k)), <, 3e-3);
    }
    g_autoptr(view) plain = wall("\"rgb\"", "\"perspective\"");
    g_autoptr(view) cold = wall("\"rgb\" \"float whitebalance\" 4000", "\"perspective\"");
    g_autoptr(image) a = render_with(plain, "integrator=path passes=1 spp=1");
    g_autoptr(image) b = render_with(cold, "integrator=path passes=1 spp=1");
    float before = value(a, "B", 6, 6) / value(a, "R", 6, 6);
    float after = value(b, "B", 6, 6) / value(b, "R", 6, 6);
    g_assert_cmpfloat(after, >, 1.3f * before);
}

static void test_gbuffer(void)
{
    g_autoptr(view) world =
        wall("\"gbuffer\" \"string coordinatesystem\" \"world\"", "\"perspective\"");
    g_autoptr(view) own = wall("\"gbuffer\"", "\"perspective\"");
    g_autoptr(image) a = render_with(world, "integrator=path passes=1 spp=1");
    g_autoptr(image) b = render_with(own, "integrator=path passes=1 spp=1");
    const float n[3] = {sinf(40 * PI_F / 180), 0, cosf(40 * PI_F / 180)};
    static const char *const names[3] = {"normal.X", "normal.Y", "normal.Z"};
    for (int i = 0; i < 3; i++) {
        /* The camera looks along -z, its right is -x. */
        float turned = i == 1 ? n[1] : -n[i];
        g_assert_cmpfloat(fabsf(value(a, names[i], 6, 6) - n[i]), <, 1e-4f);
        g_assert_cmpfloat(fabsf(value(b, names[i], 6, 6) - turned), <, 1e-4f);
    }
}

/* Colour, u, v and places of the tilted wall are those of its plane, by all algorithms.
 */
static void check_places(const image *img, bool in_camera)
{
    const vec3 n = vec3_make(sinf(40 * PI_F / 180), 0, cosf(40 * PI_F / 180));
    for (int i = 0; i < 144; i++) {
        int x = i % 12, y = i / 12;
        if (!(value(img, "depth.Z", x, y) > 0)) { /* beyond the rim */
            g_assert_cmpfloat(fabsf(value(img, "Albedo.G", x, y)), <, 1e-6f);
            continue;
        }
        vec3 p = vec3_make(value(img, "P.X", x, y), value(img, "P.Y", x, y),
                           value(img, "P.Z", x, y));
        if (in_camera) /* the camera looks along -z, its right is -x */
            p = vec3_make(-p[0], p[1], 4 - p[2]);
        g_assert_cmpfloat(fabsf(dot3(p, n)), <, 1e-4f);
        /* Seen through this pixel: the shorter side of the screen is 90 degrees wide. */
        float u = -p[0] / (4 - p[2]), v = -p[1] / (4 - p[2]);
        g_assert_cmpfloat(fabsf((u + 1) * 6 - (float)x - 0.5f), <, 0.51f);
        g_assert_cmpfloat(fabsf((v + 1) * 6 - (float)y - 0.5f), <, 0.51f);
        float along = p[0] * cosf(40 * PI_F / 180) - p[2] * sinf(40 * PI_F / 180);
        float phi = atan2f(p[1], along) / (2 * PI_F);
        g_assert_cmpfloat(fabsf(value(img, "u", x, y) - (phi < 0 ? phi + 1 : phi)), <,
                          1e-3f);
        g_assert_cmpfloat(fabsf(value(img, "v", x, y) - 1 + length3(p) / 9), <, 1e-3f);
        g_assert_cmpfloat(fabsf(value(img, "N.X", x, y) - (in_camera ? -n[0] : n[0])), <,
                          1e-4f);
        g_assert_cmpfloat(fabsf(value(img, "Albedo.G", x, y) - 0.5f), <, 0.02f);
    }
}

static void test_gbuffer_places(void)
{
    static const char *const ways[] = {"integrator=path passes=1 spp=1",
                                       "integrator=vcm passes=1 spp=1 photons=100",
                                       "integrator=photonmap passes=1 spp=1 photons=100"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(view) v = i ? wall("\"gbuffer\"", "\"perspective\"")
                              : wall("\"gbuffer\" \"string coordinatesystem\" \"world\"",
                                     "\"perspective\"");
        g_autoptr(image) img = render_with(v, ways[i]);
        check_places(img, i > 0);
    }
    g_autoptr(view) plain = wall("\"rgb\"", "\"perspective\"");
    g_autoptr(image) img = render_with(plain, ways[0]);
    g_assert_cmpint(image_channel(img, "P.X"), ==, -1);
}

/* dzdx and dzdy are what neighbours differ by; the variance between samples is that of
 * their mean times their number; N and Ns differ where normals are bent. */
static void test_gbuffer_noise(void)
{
    g_autoptr(view) v =
        view_of("Film \"gbuffer\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"
                "PixelFilter \"box\"\nLookAt 0 0 4 0 0 0 0 1 0\n"
                "Camera \"perspective\" \"float fov\" 40\nWorldBegin\n"
                "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\n"
                "Translate 0 3 4\nShape \"sphere\"\nAttributeEnd\n"
                "Rotate 30 1 0 0\nRotate 30 0 1 0\nShape \"trianglemesh\"\n"
                "\"point3 P\" [-5 -5 0  5 -5 0  -5 5 0  5 5 0]\n"
                "\"normal N\" [0 0.6 0.8  0 0.6 0.8  0 0.6 0.8  0 0.6 0.8]\n"
                "\"integer indices\" [0 1 2 2 1 3]\n");
    g_autoptr(image) img = render_with(v, "integrator=path passes=64 spp=2");
    double of_mean = 0, of_samples = 0;
    for (int i = 0; i < 100; i++) {
        int x = i % 10, y = i / 10;
        float dx = value(img, "P.Z", x + 1, y) - value(img, "P.Z", x, y);
        float dy = value(img, "P.Z", x, y + 1) - value(img, "P.Z", x, y);
        g_assert_cmpfloat(fabsf(value(img, "dzdx", x, y) / fabsf(dx) - 1), <, 0.15f);
        g_assert_cmpfloat(fabsf(value(img, "dzdy", x, y) / fabsf(dy) - 1), <, 0.15f);
        float cosine = value(img, "N.X", x, y) * value(img, "Ns.X", x, y) +
                       value(img, "N.Y", x, y) * value(img, "Ns.Y", x, y) +
                       value(img, "N.Z", x, y) * value(img, "Ns.Z", x, y);
        g_assert_cmpfloat(fabsf(cosine - 0.8f), <, 1e-3f);
        float variance = value(img, "Variance.G", x, y);
        float relative = value(img, "RelativeVariance.G", x, y);
        g_assert_cmpfloat(fabsf(relative * value(img, "G", x, y) / variance - 1), <,
                          1e-3f);
        of_mean += (double)value(img, "variance.Y", x, y) / 100;
        of_samples += (double)variance / 100;
    }
    g_assert_cmpfloat(of_samples, >, 0.0);
    g_assert_cmpfloat(fabs(of_samples / (128 * of_mean) - 1), <, 0.3);
}

/* Only an EXR file can hold the layers. */
static void test_gbuffer_file(void)
{
    scene_folder f =
        folder_new("Film \"gbuffer\" \"string filename\" \"a.png\"\nWorldBegin\n");
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(f.main, 1, NULL, &error));
    g_assert_nonnull(strstr(error->message, "1:16: film \"gbuffer\": only an .exr"));
    folder_remove(&f);
}

/* All algorithms see the same through the other cameras. */
static void test_cameras_agree(void)
{
    static const char *const cameras[] = {
        "\"orthographic\"", "\"spherical\"",
        "\"spherical\" \"string mapping\" \"equirectangular\""};
    static const char *const ways[] = {
        "integrator=vcm passes=6 spp=16 photons=20000",
        "integrator=vcm vcm_strategies=bpt passes=6 spp=16 photons=20000",
        "integrator=photonmap passes=2 spp=16 photons=20000",
        "integrator=vcm vcm_strategies=light passes=8 spp=16 photons=60000"};
    for (size_t c = 0; c < G_N_ELEMENTS(cameras); c++) {
        g_autoptr(view) v = wall("\"rgb\"", cameras[c]);
        g_autoptr(image) path = render_with(v, "integrator=path passes=2 spp=32");
        for (size_t i = 0; i < (c == 0 ? 3 : 4); i++) {
            g_autoptr(image) other = render_with(v, ways[i]);
            double a = mean_of(path, ""), b = mean_of(other, "");
            g_assert_cmpfloat(a, >, 0.0);
            g_assert_cmpfloat(fabs(b - a), <, 0.03 * a);
        }
    }
    g_autoptr(view) v = wall("\"rgb\"", cameras[0]);
    settings how = settings_with(v->scene, "integrator=vcm vcm_strategies=light");
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_new(v, &how, &error);
    g_assert_false(render_run(r, NULL, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "orthographic"));
}

/* ---- Half a pass ---- */

/* A wall, and before a part of it a lamp that is much brighter than white; each of them
   fills whole pixels. */
#define LAMP_BEFORE_WALL                                                                 \
    "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"               \
    "PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n"                  \
    "LookAt 0 0 4 0 0 0 0 1 0\nCamera \"orthographic\" \"float screenwindow\" "          \
    "[-6 6 -6 6]\nWorldBegin\nLightSource \"point\" \"point3 from\" [2 1 3] \"rgb I\" "  \
    "[9 9 9]\nShape \"disk\" \"float radius\" 20\n"                                      \
    "AreaLightSource \"diffuse\" \"rgb L\" [99 99 99] Shape \"trianglemesh\" "           \
    "\"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-1 -3 1 4 -3 1 4 4 1 -1 4 1]\n"

/* Mean over those pixels on the sides of one that the lamp fills, or that it does not. */
static float mean_beside(const image *img, int x, int y, bool lit)
{
    static const int to[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    float sum = 0.0f, n = 0.0f;
    for (int k = 0; k < 4; k++) {
        int u = x + to[k][0], v = y + to[k][1];
        bool within = u >= 0 && u < 12 && v >= 0 && v < 12;
        if (!within || (value(img, "emission.G", u, v) > 0.0f) != lit)
            continue;
        sum += value(img, "G", u, v);
        n += 1.0f;
    }
    return sum / n;
}

/* Of half a pass every other pixel is there; the rest are as those beside them, and lamps
   have their outlines. */
static void test_half_a_pass(void)
{
    static const char how[] = "integrator=path denoise=off spp=1 planned_passes=1 ";
    g_autoptr(view) v = view_of(LAMP_BEFORE_WALL);
    g_autofree char *half_of = g_strconcat(how, "passes=.5", NULL);
    g_autofree char *whole = g_strconcat(how, "passes=1", NULL);
    g_autoptr(image) half = render_with(v, half_of);
    g_autoptr(image) all = render_with(v, whole);
    int n_lit = 0;
    for (int i = 0; i < 144; i++) {
        int x = i % 12, y = i / 12;
        bool is_there = (x + y) % 2 == 0, lit = value(all, "emission.G", x, y) > 0.0f;
        float expected = is_there ? value(all, "G", x, y) : mean_beside(all, x, y, lit);
        g_assert_cmpint(value(half, "emission.G", x, y) > 0.0f, ==, lit);
        g_assert_cmpfloat(fabsf(value(half, "G", x, y) - expected), <=, 1e-5f * expected);
        n_lit += lit;
    }
    g_assert_cmpint(n_lit, ==, 5 * 7);
}

/* ---- Splats ---- */

/* Some on the film and some beside it, several of the loop's pieces of them. */
static splat *some_splats(size_t n)
{
    splat *splats = g_aligned_alloc0(n, sizeof *splats, 64);
    for (size_t i = 0; i < n; i++) {
        sampler random = sampler_make(91, i);
        random.dimension = 40;
        vec2 u = sampler_2d(&random);
        splats[i] = (splat){.value = spectrum_fill(sampler_1d(&random)),
                            .raster = {46.0f * u.x - 3.0f, 43.0f * u.y - 3.0f},
                            .layer = (radiance_layer)(i % N_LAYERS)};
    }
    return splats;
}

static void add_splats(film *f, const view *v, splat_list splats, unsigned threads)
{
    const wavelengths w = wavelengths_at(0.25f);
    g_assert_true(film_open(f, v, false, NULL));
    for (int i = 0; i < f->width * f->height; i++) {
        const film_sum sum = {.weight = 1.0 + 0.125 * (i % 3)};
        film_put(f, i % f->width, i / f->width, &sum);
    }
    film_pass pass = film_pass_for(f, &w);
    film_add_splats(f, &pass, &v->filter, splats, threads);
}

/* Each pixel's are added in their order, whoever adds them. */
static void test_splats_on_any_number_of_threads(void)
{
    enum { N = 50000 };
    g_autoptr(view) v = view_of("Film \"rgb\" \"integer xresolution\" 40 \"integer "
                                "yresolution\" 37\nPixelFilter \"gaussian\"\nCamera "
                                "\"perspective\"\nWorldBegin\n");
    splat *splats = some_splats(N);
    const splat_list list = {splats, N};
    film one;
    add_splats(&one, v, list, 1);
    size_t size = (size_t)one.width * (size_t)one.height * sizeof *one.pass;
    for (unsigned threads = 2; threads <= 5; threads += 3) {
        film many;
        add_splats(&many, v, list, threads);
        g_assert_cmpint(memcmp(one.pass, many.pass, size), ==, 0);
        film_clear(&many);
    }
    film_clear(&one);
    g_aligned_free(splats);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/film/largest", test_largest_component);
    g_test_add_func("/film/balance", test_white_balance);
    g_test_add_func("/film/gbuffer", test_gbuffer);
    g_test_add_func("/film/gbuffer/places", test_gbuffer_places);
    g_test_add_func("/film/gbuffer/noise", test_gbuffer_noise);
    g_test_add_func("/film/gbuffer/file", test_gbuffer_file);
    g_test_add_func("/film/cameras", test_cameras_agree);
    g_test_add_func("/film/half-a-pass", test_half_a_pass);
    g_test_add_func("/film/splats", test_splats_on_any_number_of_threads);
    return g_test_run();
}
