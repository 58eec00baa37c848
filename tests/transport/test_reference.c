/*
 * Pictures of other renderers: scenes of Bitterli's collection (Tungsten, RGB) and two
 * scenes rendered spectrally with progressive photon mapping. They are not part of the
 * project; where they are absent the tests are skipped.
 */
#include "render/render.h"
#include "scene_text.h"

#define REFERENCES SOURCE_ROOT "/../shared/refs/"

enum { BLOCKS = 8 };

/* What is compared with what, and how near it must come. */
typedef struct reference {
    const char *scene, *picture;
    int width, height;
    double region[4];      /* x0, x1, y0, y1 in 0..1 */
    double mean_tolerance; /* of the luminance */
    double rms_tolerance;  /* of the luminance of blocks, relative to the mean */
    const char *changes[13];
} reference;

static image *render_of(const reference *r, const char *path)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(path, NULL, &error);
    g_assert_no_error(error);
    view_resize(v, r->width, r->height);
    settings how = v->scene->settings;
    for (size_t i = 0; r->changes[i]; i += 2)
        g_assert_true(settings_set(&how, r->changes[i], r->changes[i + 1], NULL));
    g_autoptr(render) run = render_new(v, &how, &error);
    g_assert_true(run && render_run(run, NULL, NULL, &error));
    return render_image(run, &error);
}

/* Rec. 709 luminance of a pixel. */
static double luminance(const image *img, int x, int y)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    static const char *const names[3] = {"R", "G", "B"};
    size_t at = ((size_t)y * (size_t)img->width + (size_t)x) * (size_t)img->n_channels;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        int c = image_channel(img, names[i]);
        g_assert_cmpint(c, >=, 0);
        sum += weights[i] * (double)img->pixels[at + (size_t)c];
    }
    return sum;
}

static int edge(double share, int size)
{
    return (int)lround(share * size);
}

/* Mean luminance of the blocks of a region. @return of the whole */
static double block_means(const image *img, const double region[4],
                          double blocks[BLOCKS * BLOCKS])
{
    double total = 0.0;
    for (int i = 0; i < BLOCKS * BLOCKS; i++) {
        double wide = (region[1] - region[0]) / BLOCKS, u = region[0] + i % BLOCKS * wide;
        double high = (region[3] - region[2]) / BLOCKS, v = region[2] + i / BLOCKS * high;
        int x0 = edge(u, img->width), x1 = edge(u + wide, img->width);
        int y0 = edge(v, img->height), y1 = edge(v + high, img->height);
        double sum = 0.0;
        for (int y = y0; y < y1; y++) {
            for (int x = x0; x < x1; x++)
                sum += luminance(img, x, y);
        }
        blocks[i] = sum / ((x1 - x0) * (y1 - y0));
        total += blocks[i] / (BLOCKS * BLOCKS);
    }
    return total;
}

static void check(gconstpointer data)
{
    const reference *r = data;
    g_autofree char *scene_path = g_strconcat(REFERENCES, r->scene, NULL);
    g_autofree char *picture_path = g_strconcat(REFERENCES, r->picture, NULL);
    if (!g_file_test(scene_path, G_FILE_TEST_EXISTS)) {
        g_test_skip("the reference pictures are not here");
        return;
    }
    g_autoptr(image) expected = image_read(picture_path, NULL, NULL);
    g_assert_nonnull(expected);
    g_autoptr(image) found = render_of(r, scene_path);
    double f[BLOCKS * BLOCKS], e[BLOCKS * BLOCKS], square = 0.0;
    double mean = block_means(found, r->region, f);
    double expected_mean = block_means(expected, r->region, e);
    for (int i = 0; i < BLOCKS * BLOCKS; i++)
        square += (f[i] - e[i]) * (f[i] - e[i]) / (BLOCKS * BLOCKS);
    double off = mean / expected_mean - 1.0, rms = sqrt(square) / expected_mean;
    g_test_message("%s: mean luminance %g, reference %g (%+.2f %%); blocks differ by "
                   "%.2f %%",
                   r->scene, mean, expected_mean, 100.0 * off, 100.0 * rms);
    g_assert_cmpfloat(fabs(off), <, r->mean_tolerance);
    g_assert_cmpfloat(rms, <, r->rms_tolerance);
}

#define PHOTONS                                                                          \
    {                                                                                    \
        "integrator", "photonmap", "passes", "8", "spp", "8", "radius", "0", "photons",  \
            "100000", NULL                                                               \
    }
#define AS_FOUND                                                                         \
    {                                                                                    \
        "passes", "8", "spp", "8", NULL                                                  \
    }

#define FOUR_BOUNCES                                                                     \
    {                                                                                    \
        "passes", "16", "spp", "8", "max_backward_bounces", "4", NULL                    \
    }

/* Where the references are known to show another scene than the file describes, only the
   rest is compared:
   - veach-mis: the plates reflect 0.3 of what their metal does, with a Beckmann
     distribution (the reflection of a lamp over the lamp, and no light between two
     highlights); so the wall beside them, which is compared, is lit by them less.
   - volumetric-caustic: light is followed for four bounces. What the ball lights by way
   of the fog has more here, since photons' bounces in glass are not counted with those of
     the path that meets them, and the lamp's images in it are pixels of very much light:
     the side without it is compared.
   - coffee: its plastic is a lossless coat and colours are RGB: the orange is another;
     the grey floor and wall differ by what pbrt's thickness absorbs. */
static const reference references[] = {
    {"bitterli/cornell-box/scene-v4.pbrt",
     "bitterli/cornell-box/TungstenRender.exr",
     96,
     96,
     {0, 1, 0, 1},
     0.01,
     0.03,
     PHOTONS},
    {"bitterli/veach-mis/scene-v4.pbrt",
     "bitterli/veach-mis/TungstenRender.exr",
     160,
     90,
     {0, 0.275, 0, 0.35},
     0.1,
     0.1,
     AS_FOUND},
    {"bitterli/coffee/scene-v4.pbrt",
     "bitterli/coffee/TungstenRender.exr",
     96,
     120,
     {0, 0.2, 0, 1},
     0.07,
     0.09,
     AS_FOUND},
    {"bitterli/volumetric-caustic/scene-v4.pbrt",
     "bitterli/volumetric-caustic/TungstenRender.exr",
     96,
     96,
     {0.55, 0.96, 0.25, 0.95},
     0.03,
     0.06,
     FOUR_BOUNCES},
    {"spectral/ring.pbrt",
     "spectral/ring.exr",
     96,
     96,
     {0, 1, 0, 1},
     0.01,
     0.015,
     PHOTONS},
    {"spectral/cornell-glass.pbrt",
     "spectral/cornell-glass.exr",
     96,
     96,
     {0, 1, 0, 1},
     0.01,
     0.015,
     PHOTONS},
};

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(references); i++) {
        g_autofree char *folder = g_path_get_dirname(references[i].picture);
        g_autofree char *name = g_str_has_prefix(references[i].scene, "bitterli/")
                                    ? g_path_get_basename(folder)
                                    : g_path_get_basename(references[i].scene);
        g_autofree char *path = g_strconcat("/reference/", name, NULL);
        g_test_add_data_func(path, &references[i], check);
    }
    return g_test_run();
}
