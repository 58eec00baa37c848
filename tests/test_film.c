/*
 * film: what the film directive says acts on the picture: brightness that is cut off,
 * white balance, the space of normals; and what the cameras that came last see, by every
 * algorithm.
 */
#include "rooms.h"

#include "color/balance.h"

static scene *wall(const char *film_text, const char *camera_text)
{
    g_autofree char *text = g_strdup_printf(
        "Film %s \"integer xresolution\" 12 \"integer yresolution\" 12\n"
        "PixelFilter \"box\"\nLookAt 0 0 4 0 0 0 0 1 0\nCamera %s\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0 0 1] \"rgb I\" [3 3 3]\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
        "AttributeBegin\nRotate 40 0 1 0\nShape \"disk\" \"float radius\" 9\n"
        "AttributeEnd\n",
        film_text, camera_text);
    return scene_of(text);
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
    g_autoptr(scene) free = wall("\"rgb\"", "\"perspective\"");
    g_autoptr(scene) cut =
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
    g_autoptr(scene) plain = wall("\"rgb\"", "\"perspective\"");
    g_autoptr(scene) cold =
        wall("\"rgb\" \"float whitebalance\" 4000", "\"perspective\"");
    g_autoptr(image) a = render_with(plain, "integrator=path passes=1 spp=1");
    g_autoptr(image) b = render_with(cold, "integrator=path passes=1 spp=1");
    float before = value(a, "B", 6, 6) / value(a, "R", 6, 6);
    float after = value(b, "B", 6, 6) / value(b, "R", 6, 6);
    g_assert_cmpfloat(after, >, 1.3f * before);
}

static void test_gbuffer(void)
{
    g_autoptr(scene) world =
        wall("\"gbuffer\" \"string coordinatesystem\" \"world\"", "\"perspective\"");
    g_autoptr(scene) own = wall("\"gbuffer\"", "\"perspective\"");
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

/* All algorithms see the same through the other cameras. */
static void test_cameras_agree(void)
{
    static const char *const cameras[] = {"\"orthographic\"", "\"spherical\"",
                                          "\"spherical\" \"string mapping\" "
                                          "\"equirectangular\""};
    static const char *const ways[] = {
        "integrator=vcm passes=6 spp=16 photons=20000",
        "integrator=vcm vcm_strategies=bpt passes=6 spp=16 photons=20000",
        "integrator=photonmap passes=2 spp=16 photons=20000",
        "integrator=vcm vcm_strategies=light passes=8 spp=16 photons=60000"};
    for (size_t c = 0; c < G_N_ELEMENTS(cameras); c++) {
        g_autoptr(scene) s = wall("\"rgb\"", cameras[c]);
        g_autoptr(image) path = render_with(s, "integrator=path passes=2 spp=32");
        for (size_t i = 0; i < (c == 0 ? 3 : 4); i++) {
            g_autoptr(image) other = render_with(s, ways[i]);
            double a = mean_of(path, ""), b = mean_of(other, "");
            g_assert_cmpfloat(a, >, 0.0);
            g_assert_cmpfloat(fabs(b - a), <, 0.03 * a);
        }
    }
    g_autoptr(scene) s = wall("\"rgb\"", cameras[0]);
    settings how = settings_with(s, "integrator=vcm vcm_strategies=light");
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_new(s, &how, &error);
    g_assert_false(render_run(r, NULL, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "orthographic"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/film/largest", test_largest_component);
    g_test_add_func("/film/balance", test_white_balance);
    g_test_add_func("/film/gbuffer", test_gbuffer);
    g_test_add_func("/film/cameras", test_cameras_agree);
    return g_test_run();
}
