/*
 * Pictures of other renderers: the Cornell box of Bitterli's collection (Tungsten, RGB)
 * and two scenes rendered spectrally with progressive photon mapping. They are not part
 * of the project; where they are absent the tests are skipped.
 */
#include "image/compare.h"
#include "render/render.h"
#include "scene_text.h"

#define REFERENCES SOURCE_ROOT "/../shared/refs/"

static image *render_at(const char *path, int size, const char *const *changes)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(path, 2, NULL, &error);
    g_assert_no_error(error);
    scene_resize(s, size, size);
    settings how = s->settings;
    for (size_t i = 0; changes[i]; i += 2)
        g_assert_true(settings_set(&how, changes[i], changes[i + 1], NULL));
    g_autoptr(render) r = render_new(s, &how, &error);
    g_assert_true(r && render_run(r, NULL, NULL, &error));
    return render_image(r, &error);
}

static double mean_of(const image *img, const char *channel)
{
    size_t n = (size_t)img->width * (size_t)img->height;
    int c = image_channel(img, channel);
    double sum = 0;
    g_assert_cmpint(c, >=, 0);
    for (size_t i = 0; i < n; i++)
        sum += (double)img->pixels[i * (size_t)img->n_channels + (size_t)c];
    return sum / (double)n;
}

/* Rec. 709 luminance. */
static double luminance(const image *img)
{
    return 0.2126 * mean_of(img, "R") + 0.7152 * mean_of(img, "G") +
           0.0722 * mean_of(img, "B");
}

static void check(const char *scene_name, const char *reference, int size,
                  double tolerance)
{
    const char *const changes[] = {"integrator", "photonmap", "passes", "8",
                                   "spp",        "8",         "radius", "0",
                                   "photons",    "100000",    NULL};
    g_autofree char *scene_path = g_strconcat(REFERENCES, scene_name, NULL);
    g_autofree char *reference_path = g_strconcat(REFERENCES, reference, NULL);
    if (!g_file_test(scene_path, G_FILE_TEST_EXISTS)) {
        g_test_skip("the reference pictures are not here");
        return;
    }
    g_autoptr(image) expected = image_read(reference_path, NULL, NULL);
    g_assert_nonnull(expected);
    g_autoptr(image) found = render_at(scene_path, size, changes);
    double a = luminance(found), b = luminance(expected);
    g_test_message("%s: mean luminance %g, reference %g (%+.2f %%)", scene_name, a, b,
                   100 * (a / b - 1));
    g_assert_cmpfloat(fabs(a / b - 1), <, tolerance);
}

static void test_cornell_box(void)
{
    check("bitterli/cornell-box/scene-v4.pbrt", "bitterli/cornell-box/TungstenRender.exr",
          96, 0.01);
}

static void test_ring(void)
{
    check("spectral/ring.pbrt", "spectral/ring.exr", 96, 0.01);
}

static void test_cornell_glass(void)
{
    check("spectral/cornell-glass.pbrt", "spectral/cornell-glass.exr", 96, 0.01);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/reference/cornell-box", test_cornell_box);
    g_test_add_func("/reference/ring", test_ring);
    g_test_add_func("/reference/cornell-glass", test_cornell_glass);
    return g_test_run();
}
