/*
 * motion: pictures of what moves are the mean of pictures of it standing at many times,
 * by every algorithm; photons that have times of their own light what is seen at theirs.
 */
#include "rooms.h"

#define VIEW                                                                             \
    "LookAt 0 -6 1.5 0 0 0.6 0 0 1\nCamera \"perspective\" \"float fov\" 40\n"           \
    "WorldBegin\n"
#define LAMP                                                                             \
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [12 12 12]\n"                 \
    "Translate 1 -1 4\nReverseOrientation\nShape \"disk\" \"float radius\" 0.5\n"        \
    "AttributeEnd\n"
#define FLOOR                                                                            \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.5 0.3]\n"                           \
    "Shape \"disk\" \"float radius\" 6\n"

/* The scene with `thing` moved all of the way in the shutter's time, or standing at a
 * share of it. */
static view *scene_with(const char *thing, double at)
{
    const double way[3] = {1.6, 0.3, 0.4};
    g_autofree char *moved =
        at < 0 ? g_strdup_printf("ActiveTransform EndTime\nTranslate %g %g %g\n"
                                 "Rotate 90 0 1 0\nActiveTransform All\n",
                                 way[0], way[1], way[2])
               : g_strdup_printf("Translate %.9g %.9g %.9g\nRotate %.9g 0 1 0\n",
                                 at * way[0], at * way[1], at * way[2], at * 90);
    g_autofree char *text = g_strdup_printf(
        SIZE(20) VIEW LAMP FLOOR
        "AttributeBegin\nTranslate -0.8 0 0.8\n%sShape \"disk\" \"float radius\" 0.01\n"
        "%sAttributeEnd\n",
        moved, thing);
    return view_of(text);
}

/* Mean over blocks of 4 x 4 pixels of what is not seen by way of glass, where small
 * bright images of the lamp would be noise. */
static void add_layer(const image *img, const char *name, double *sums, double weight)
{
    int channel = image_channel(img, name);
    g_assert_cmpint(channel, >=, 0);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 20; x++)
            sums[5 * (y / 4) + x / 4] +=
                weight * (double)img->pixels[(20 * y + x) * img->n_channels + channel] /
                16;
}

static void render_blocks(const view *v, const char *words, double *sums, double weight)
{
    g_autoptr(image) img = render_with(v, words);
    add_layer(img, "direct.G", sums, weight);
    add_layer(img, "indirect.G", sums, weight);
    add_layer(img, "caustic.G", sums, weight);
}

/* By the mean over times, which is the midpoint rule's. */
static void still_blocks(const char *thing, const char *words, double *sums)
{
    enum { TIMES = 16 };
    for (int i = 0; i < TIMES; i++) {
        g_autoptr(view) v = scene_with(thing, (i + 0.5) / TIMES);
        g_autofree char *seeded = g_strdup_printf("%s seed=%d", words, i);
        render_blocks(v, seeded, sums, 1.0 / TIMES);
    }
}

static void assert_close(const double *a, const double *b, double relative)
{
    double mean = 0;
    for (int i = 0; i < 25; i++)
        mean += b[i] / 25;
    for (int i = 0; i < 25; i++)
        g_assert_cmpfloat(fabs(a[i] - b[i]), <, relative * (b[i] + 0.3 * mean));
}

static const char wall[] =
    "Material \"diffuse\" \"rgb reflectance\" [0.2 0.6 0.8]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-0.5 0 -0.5 0.5 0 -0.5 -0.5 0 0.5 0.5 0 0.5]\n";
static const char glass[] =
    "Material \"dielectric\"\nShape \"sphere\" \"float radius\" 0.45\n";

/* A matt board that flies and turns: paths and all photon algorithms agree with standing
 * boards seen by paths. */
static void test_board(void)
{
    double still[25] = {0};
    still_blocks(wall, "integrator=path passes=1 spp=40", still);
    static const char *const ways[] = {
        "integrator=path passes=8 spp=64",
        "integrator=photonmap passes=12 spp=16 photons=50000 final_gather=false",
        "integrator=vcm passes=12 spp=24 photons=10000",
        "integrator=vcm vcm_strategies=bpt passes=12 spp=24 photons=10000",
    };
    g_autoptr(view) moving = scene_with(wall, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        double found[25] = {0};
        render_blocks(moving, ways[i], found, 1);
        assert_close(found, still, 0.08);
    }
}

/* Light from the board onto the floor by gather rays, whose look-ups of irradiance are of
 * their time, as by standing boards with the photons of a slice each. */
static void test_final_gather(void)
{
    enum { TIMES = 8 };
#define GATHER "integrator=photonmap passes=4 spp=8 final_gather=on gather_rays=8 "
    double still[25] = {0}, found[25] = {0}, sum = 0, sum_still = 0;
    for (int i = 0; i < TIMES; i++) {
        g_autoptr(view) v = scene_with(wall, (i + 0.5) / TIMES);
        g_autoptr(image) img = render_with(v, GATHER "photons=10000");
        add_layer(img, "indirect.G", still, 1.0 / TIMES);
    }
    g_autoptr(view) moving = scene_with(wall, -1);
    g_autoptr(image) img = render_with(moving, GATHER "photons=80000");
    add_layer(img, "indirect.G", found, 1);
    for (int i = 0; i < 25; i++) {
        sum += found[i];
        sum_still += still[i];
    }
    g_test_message("indirect light %g, of standing boards %g", sum, sum_still);
    g_assert_cmpfloat(fabs(sum / sum_still - 1), <, 0.05);
    assert_close(found, still, 0.2);
}

/* A glass ball on its way: photons see the caustic it drags along as paths do. */
static void test_glass_ball(void)
{
    double still[25] = {0};
    still_blocks(glass, "integrator=path passes=1 spp=150", still);
    static const char *const ways[] = {
        "integrator=photonmap passes=12 spp=16 photons=50000 final_gather=false",
        "integrator=auto passes=12 spp=24 photons=30000",
        "integrator=vcm passes=12 spp=24 photons=10000",
    };
    g_autoptr(view) moving = scene_with(glass, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        double found[25] = {0};
        render_blocks(moving, ways[i], found, 1);
        assert_close(found, still, 0.06);
    }
}

/* The same with the camera on the way: what stands still is then what moves. */
static void test_camera_moves(void)
{
    double still[25] = {0}, found[25] = {0};
    static const char head[] =
        SIZE(20) "ActiveTransform EndTime\nTranslate 0.8 0 0\n"
                 "Rotate 20 0 1 0\nActiveTransform All\n" VIEW LAMP FLOOR
                 "Translate 0 0 0.6\n";
    g_autofree char *text = g_strconcat(head, wall, NULL);
    g_autoptr(view) moving = view_of(text);
    render_blocks(moving, "integrator=vcm passes=12 spp=32 photons=5000", found, 1);
    for (int i = 0; i < 16; i++) {
        double at = (i + 0.5) / 16;
        /* pbrt interpolates the camera's own place, the inverse of what is written. */
        transform shift = transform_translate(0.8, 0, 0),
                  turn = transform_rotate(20, 0, 1, 0);
        transform end = transform_multiply(&shift, &turn), look;
        const double eye[3] = {0, -6, 1.5}, to[3] = {0, 0, 0.6}, up[3] = {0, 0, 1};
        g_assert_true(transform_look_at(eye, to, up, &look));
        transform a = transform_inverse(&look), b = transform_multiply(&end, &look);
        b = transform_inverse(&b);
        motion path = motion_make(&a, &b, 0, 1);
        transform here = motion_at(&path, at);
        g_autofree char *plain =
            g_strconcat(SIZE(20) VIEW LAMP FLOOR "Translate 0 0 0.6\n", wall, NULL);
        g_autoptr(view) v = view_of(plain);
        motion stand = motion_still(&here);
        v->camera.path = stand;
        v->camera.to_world = here;
        g_autofree char *words =
            g_strdup_printf("integrator=path passes=1 spp=32 seed=%d", i);
        render_blocks(v, words, still, 1.0 / 16);
    }
    assert_close(found, still, 0.12);
}

/* Bit for bit the same on any number of threads. */
static void test_threads(void)
{
    g_autoptr(view) v = scene_with(glass, -1);
    static const char *const ways[] = {"integrator=auto passes=2 spp=2 photons=5000 ",
                                       "integrator=vcm passes=2 spp=2 photons=5000 "};
    for (size_t i = 0; i < 2; i++) {
        g_autofree char *one = g_strconcat(ways[i], "threads=1", NULL);
        g_autofree char *three = g_strconcat(ways[i], "threads=3", NULL);
        g_autoptr(image) a = render_with(v, one);
        g_autoptr(image) b = render_with(v, three);
        size_t size =
            (size_t)a->width * (size_t)a->height * (size_t)a->n_channels * sizeof(float);
        g_assert_cmpmem(a->pixels, size, b->pixels, size);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/motion/board", test_board);
    g_test_add_func("/motion/final-gather", test_final_gather);
    g_test_add_func("/motion/glass", test_glass_ball);
    g_test_add_func("/motion/camera", test_camera_moves);
    g_test_add_func("/motion/threads", test_threads);
    return g_test_run();
}
