/*
 * Whole renders against what must hold: furnaces, path tracing, symmetry of threads and
 * scale.
 */
#include "image/compare.h"
#include "render/render.h"
#include "scene_text.h"

#define SIZE(n)                                                                          \
    "Film \"rgb\" \"integer xresolution\" " #n " \"integer yresolution\" " #n            \
    "\nPixelFilter \"box\"\n"

/* Settings as "name=value" words. */
static settings settings_with(const scene *s, const char *words)
{
    settings how = s->settings;
    g_auto(GStrv) list = g_strsplit(words, " ", -1);
    for (char **word = list; *word; word++) {
        g_auto(GStrv) pair = g_strsplit(*word, "=", 2);
        g_autoptr(GError) error = NULL;
        settings_set(&how, pair[0], pair[1], &error);
        g_assert_no_error(error);
    }
    return how;
}

static image *render_with(const scene *s, const char *words)
{
    g_autoptr(GError) error = NULL;
    settings how = settings_with(s, words);
    g_autoptr(render) r = render_new(s, &how, &error);
    g_assert_no_error(error);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(render_get_statistics(r).n_not_finite, ==, 0);
    image *img = render_image(r, &error);
    g_assert_no_error(error);
    return img;
}

/* Mean over pixels of the channel sum R+G+B over three, of the layer ("" for the beauty).
 */
static double mean_of(const image *img, const char *layer)
{
    double sum = 0;
    size_t n = (size_t)img->width * (size_t)img->height;
    for (const char *c = "RGB"; *c; c++) {
        g_autofree char *name = g_strdup_printf("%s%s%c", layer, *layer ? "." : "", *c);
        int channel = image_channel(img, name);
        g_assert_cmpint(channel, >=, 0);
        for (size_t i = 0; i < n; i++)
            sum += (double)img->pixels[i * (size_t)img->n_channels + (size_t)channel];
    }
    return sum / (3.0 * (double)n);
}

/* ---- Furnace ---- */

/* A closed box that shines Le = 1 and reflects 0.5 everywhere: radiance is 2 in every
   place and direction. The camera stands in the middle and sees the middle of a wall. */
#define FURNACE                                                                          \
    "Camera \"perspective\" \"float fov\" 40\n" SIZE(                                    \
        8) "WorldBegin\n"                                                                \
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                    \
           "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n"      \
           "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 " \
           "1 1 -1 1 1 1 1 "                                                             \
           "-1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 " \
           "7 0 3 7 0 7 4 1 "                                                            \
           "5 6 1 6 2]\n"

static void check_furnace(const char *words)
{
    g_autoptr(scene) s = scene_of(FURNACE);
    g_autoptr(image) img = render_with(s, words);
    double found = mean_of(img, "");
    g_test_message("%s: radiance %g", words, found);
    g_assert_cmpfloat(fabs(found / 2.0 - 1.0), <, 0.01);
}

static void test_furnace_by_the_map(void)
{
    check_furnace("passes=4 spp=4 photons=200000 radius=0.1 direct_illumination=off");
    check_furnace("passes=4 spp=4 photons=200000 indirect_nearest=200");
}

static void test_furnace_by_final_gather(void)
{
    check_furnace(
        "passes=2 spp=2 photons=100000 radius=0.1 final_gather=on gather_rays=64 "
        "precompute_radiance=off");
    check_furnace(
        "passes=2 spp=2 photons=100000 radius=0.1 final_gather=on gather_rays=64");
}

static void test_furnace_by_path(void)
{
    check_furnace("integrator=path passes=8 spp=16 max_backward_bounces=-1");
}

/* ---- Photon mapping against path tracing ---- */

/* A room with one small and one large lamp and, by turns, something in it. */
#define ROOM                                                                             \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55\n" SIZE(  \
        16) "WorldBegin\n"                                                               \
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] Material "     \
            "\"diffuse\" \"rgb "                                                         \
            "reflectance\" [0 0 0] Shape \"trianglemesh\" \"point3 P\" [-0.7 -0.7 1.98 " \
            "-0.7 0.7 1.98 "                                                             \
            "0.7 0.7 1.98 0.7 -0.7 1.98] \"integer indices\" [0 1 2 0 2 3] "             \
            "AttributeEnd\n"                                                             \
            "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                   \
            "Shape \"trianglemesh\" \"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0 -2 -4 2 "  \
            "2 -4 2 2 2 2 -2 "                                                           \
            "2 2] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 7 " \
            "0 3 7 0 7 4 1 5 6 "                                                         \
            "1 6 2]\n"

typedef struct furnishing {
    const char *name, *text;
    double tolerance; /* of means; the noise of so few samples is half of it */
} furnishing;

static const furnishing furnishings[] = {
    {"empty", "", 0.008},
    {"mirror",
     "Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
     "\"metal-Ag-k\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"glass",
     "Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" "
     "0.5\n",
     0.01},
    {"dispersive",
     "Material \"dielectric\" \"spectrum eta\" \"glass-N-SF11\" Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.012},
    {"rough-metal",
     "Material \"conductor\" \"float roughness\" 0.15 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"very-rough-metal",
     "Material \"conductor\" \"float roughness\" 0.5 \"bool "
     "remaproughness\" false Translate 0 0 0.6 Shape \"sphere\" \"float "
     "radius\" 0.5\n",
     0.02},
    {"rough-glass",
     "Material \"dielectric\" \"float roughness\" 0.4 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"plastic",
     "Material \"coateddiffuse\" \"rgb reflectance\" [0.2 0.4 0.8] Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"point-light",
     "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5] Material "
     "\"conductor\" \"float roughness\" 0.1 Translate 0 0 0.6 Shape \"sphere\" "
     "\"float radius\" 0.5\n",
     0.02},
};

/* All but the lamps as the camera sees them, whose edges make noise of their own. */
static double reflected(const image *img)
{
    return mean_of(img, "") - mean_of(img, "emission");
}

static void test_photon_mapping_agrees_with_path_tracing(gconstpointer data)
{
    const furnishing *f = data;
    g_autofree char *text = g_strconcat(ROOM, f->text, NULL);
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(image) path =
        render_with(s, "integrator=path passes=8 spp=128 max_backward_bounces=-1 seed=1");
    const char *const ways[] = {
        "passes=4 spp=16 photons=100000 radius=0.05",
        "integrator=auto passes=8 spp=64 photons=10000 max_backward_bounces=-1",
        "passes=4 spp=4 photons=150000 radius=0.05 direct_illumination=off",
        "passes=4 spp=8 photons=100000 radius=0.05 final_gather=on gather_rays=8 "
        "precompute_radiance=off",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) photons = render_with(s, ways[i]);
        double a = reflected(photons), b = reflected(path);
        g_test_message("%s: %s: %g, path %g (%+.2f %%)", f->name, ways[i], a, b,
                       100 * (a / b - 1));
        g_assert_cmpfloat(fabs(a / b - 1.0), <, f->tolerance);
    }
}

/* The layers hold the same light, whichever way it was found. */
static void test_layers_agree_with_path_tracing(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(image) path =
        render_with(s, "integrator=path passes=8 spp=64 max_backward_bounces=-1");
    g_autoptr(image) photons = render_with(s, "passes=8 spp=8 photons=60000");
    const char *const names[] = {"direct",   "indirect", "caustic",
                                 "specular", "emission", "albedo"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        double a = mean_of(photons, names[i]), b = mean_of(path, names[i]);
        g_test_message("%s: photons %g, path %g", names[i], a, b);
        g_assert_cmpfloat(fabs(a - b), <, 0.012 * mean_of(path, "") + 0.02 * b);
    }
}

/* ---- Invariance ---- */

static void test_same_bits_on_any_number_of_threads(void)
{
    const char *const ways[] = {
        "passes=2 spp=2 photons=30000", "passes=2 spp=1 photons=30000 photon_map=kdtree",
        "passes=1 spp=1 photons=20000 final_gather=on gather_rays=8",
        "passes=1 spp=1 photons=20000 indirect_nearest=50",
        "integrator=path passes=2 spp=4"};
    g_autofree char *text = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(scene) s = scene_of(text);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *one = g_strconcat(ways[i], " threads=1", NULL);
        g_autofree char *two = g_strconcat(ways[i], " threads=2", NULL);
        g_autoptr(image) a = render_with(s, one);
        g_autoptr(image) b = render_with(s, two);
        size_t n = (size_t)a->width * (size_t)a->height * (size_t)a->n_channels;
        g_assert_cmpmem(a->pixels, n * sizeof(float), b->pixels, n * sizeof(float));
    }
}

static void test_maps_render_the_same(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[1].text, NULL);
    g_autoptr(scene) s = scene_of(text);
    const char *const ways[] = {"passes=1 spp=1 photons=5000",
                                "passes=1 spp=1 photons=5000 indirect_nearest=30 "
                                "caustic_nearest=20"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *list = g_strconcat(ways[i], " photon_map=list", NULL);
        g_autoptr(image) expected = render_with(s, list);
        for (int k = 0; k < 2; k++) {
            g_autofree char *other =
                g_strconcat(ways[i], k ? " photon_map=grid" : " photon_map=kdtree", NULL);
            g_autoptr(image) found = render_with(s, other);
            image_difference d;
            g_assert_true(image_compare(found, expected, &d, NULL));
            g_assert_cmpfloat(d.rmse, <, 1e-4 * d.mean_b);
        }
    }
}

/* The same scene in metres and in millimetres. Radiance does not change with scale. */
static void test_scale_changes_nothing(void)
{
    g_autofree char *metres = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(scene) s = scene_of(metres);
    GString *scaled = g_string_new(ROOM);
    g_string_replace(scaled, "LookAt 0 -3.4 1.2  0 0 0.9", "LookAt 0 -3400 1200  0 0 900",
                     1);
    g_string_replace(scaled, "WorldBegin\n", "WorldBegin\nScale 1000 1000 1000\n", 1);
    g_string_append(scaled, furnishings[2].text);
    g_autoptr(scene) big = scene_of(scaled->str);
    g_string_free(scaled, TRUE);
    const char *how = "passes=2 spp=4 photons=50000";
    g_autoptr(image) a = render_with(s, how);
    g_autoptr(image) b = render_with(big, how);
    image_difference d;
    g_assert_true(image_compare(b, a, &d, NULL));
    g_test_message("scaled: mean %g and %g, relMSE %g", d.mean_a, d.mean_b, d.relmse);
    /* Rounding sends some photons elsewhere: the images agree far below their own noise.
     */
    g_assert_cmpfloat(fabs(d.mean_a / d.mean_b - 1.0), <, 2e-3);
    g_assert_cmpfloat(d.relmse, <, 1e-3);
}

/* ---- Settings act ---- */

static void test_shadow_rays_off_lights_through(void)
{
    const char *text =
        "LookAt 3 0 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20\n" SIZE(
            8) "WorldBegin LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 "
               "0 3]\n"
               "Shape \"disk\" \"float radius\" 5\n"
               "Translate 0 0 2.9 Shape \"disk\" \"float radius\" 0.5\n";
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(image) dark =
        render_with(s, "passes=1 spp=1 photons=100 max_forward_bounces=0");
    g_autoptr(image) lit = render_with(
        s, "passes=1 spp=1 photons=100 max_forward_bounces=0 shadow_rays=off");
    g_assert_cmpfloat(mean_of(lit, "direct"), >, mean_of(dark, "direct"));
}

static void test_cancel_keeps_what_there_is(void)
{
    g_autoptr(scene) s = scene_of(ROOM);
    settings how = settings_with(s, "passes=4 spp=1 photons=1000");
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_new(s, &how, &error);
    render_cancel(r);
    g_assert_false(render_run(r, NULL, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_CANCELLED);
    g_autoptr(image) img = render_image(r, NULL);
    g_assert_nonnull(img);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/transport/furnace/map", test_furnace_by_the_map);
    g_test_add_func("/transport/furnace/final-gather", test_furnace_by_final_gather);
    g_test_add_func("/transport/furnace/path", test_furnace_by_path);
    for (size_t i = 0; i < G_N_ELEMENTS(furnishings); i++) {
        g_autofree char *name =
            g_strdup_printf("/transport/agree/%s", furnishings[i].name);
        g_test_add_data_func(name, &furnishings[i],
                             test_photon_mapping_agrees_with_path_tracing);
    }
    g_test_add_func("/transport/layers", test_layers_agree_with_path_tracing);
    g_test_add_func("/transport/threads", test_same_bits_on_any_number_of_threads);
    g_test_add_func("/transport/maps", test_maps_render_the_same);
    g_test_add_func("/transport/scale", test_scale_changes_nothing);
    g_test_add_func("/transport/shadow-rays", test_shadow_rays_off_lights_through);
    g_test_add_func("/transport/cancel", test_cancel_keeps_what_there_is);
    return g_test_run();
}
