/*
 * The pass loop: when it stops, what it tells, and that neither changes a bit of what it
 * renders; the error it claims against the error it makes.
 */
#include "render/stop.h"
#include "rooms.h"

/* ---- Rules ---- */

static settings with_rules(int64_t passes, double time, double noise)
{
    settings how = settings_default();
    how.passes = passes;
    how.time = time;
    how.noise = noise;
    return how;
}

static void test_rules(void)
{
    const settings five = with_rules(5, 0, 0), none = with_rules(0, 0, 0),
                   second = with_rules(0, 1.0, 0), still = with_rules(0, 0, 0.1),
                   all = with_rules(100, 1.0, 0.1);
    const struct {
        const settings *how;
        stop_state now;
        render_stop expected;
    } cases[] = {
        {&five, {4, 1e9, 1, 0, 0, 0}, RENDER_GOES_ON},
        {&five, {5, 0, 0, INFINITY, 0, 0}, RENDER_PASSES_DONE},
        {&none, {15, 0, 0, INFINITY, 0, 0}, RENDER_GOES_ON},
        {&none, {16, 0, 0, INFINITY, 0, 0}, RENDER_PASSES_DONE},
        {&second,
         {0, 7, 0, INFINITY, 0, 0},
         RENDER_GOES_ON}, /* one pass is always rendered */
        {&second, {1, 7, 7, INFINITY, 0, 0}, RENDER_TIME_UP},
        {&second, {1000, 0.99, 0.001, INFINITY, 0, 0}, RENDER_GOES_ON},
        {&second, {1000, 1.0, 0.001, INFINITY, 0, 0}, RENDER_TIME_UP},
        {&second, {2, 0.6, 0.3, INFINITY, 0, 0}, RENDER_GOES_ON},
        /* One that would take too long ends early, if some of it will be done. */
        {&second, {1, 0.6, 0.6, INFINITY, 0, 0.3}, RENDER_GOES_ON},
        {&second, {1, 0.95, 0.6, INFINITY, 0, 0}, RENDER_GOES_ON},
        {&second, {1, 0.995, 0.6, INFINITY, 0, 0}, RENDER_TIME_UP},
        {&second, {1, 0.6, 0.6, INFINITY, 0, 0.5}, RENDER_TIME_UP},
        {&still, {3, 1e9, 1, 0.01, 0, 0}, RENDER_GOES_ON}, /* too few to know */
        {&still, {4, 0, 1, 0.1, 0, 0}, RENDER_NOISE_REACHED},
        {&still, {1e6, 0, 1, 0.11, 0, 0}, RENDER_GOES_ON},
        {&all, {50, 0.5, 0.01, 0.2, 0, 0}, RENDER_GOES_ON},
        {&all, {50, 0.5, 0.01, 0.05, 0, 0}, RENDER_NOISE_REACHED},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_test_message("case %zu", i);
        g_assert_cmpint(stop_decide(cases[i].how, &cases[i].now), ==, cases[i].expected);
    }
}

/* Cells of a pass: the first shows the whole picture soon; where time is short there are
   few at once, and none any more when it is over. */
static void test_cells(void)
{
    const settings four = with_rules(4, 0, 0), second = with_rules(0, 1.0, 0);
    const stop_state early = {1, 0.1, 0.2, INFINITY, 0, 0},
                     late = {1, 0.9, 0.2, INFINITY, 0, 0},
                     over = {1, 1.1, 0.2, INFINITY, 0, 0};
    const struct {
        const settings *how;
        const stop_state *now;
        stop_part part;
        int least, most;
    } cases[] = {
        {&four, &over, {0, 64, 0, 0.1, false}, 64, 64},
        {&four, &over, {0, 64, 1, 0, true}, 1, 1},
        {&four, &over, {4, 64, 1, 0.1, true}, 12, 12},
        {&four, &over, {16, 40, 1, 0.1, true}, 24, 24},
        {&four, &over, {40, 40, 1, 0.1, true}, 0, 0},
        {&second, &early, {0, 64, 0, 0.001, false}, 64, 64},
        {&second, &early, {0, 64, 0, 0.1, false}, 1, 8},
        {&second, &late, {0, 64, 0, 0.02, false}, 1, 4},
        {&second, &late, {60, 64, 0, 0.02, false}, 1, 4},
        {&second, &late, {9, 64, 0, 0.2, false}, 0, 0},
        {&second, &over, {9, 64, 0, 0.001, false}, 0, 0},
        {&second, &over, {0, 64, 1, 0.1, true}, 1, 1},
        {&second, &over, {1, 64, 1, 0.1, true}, 0, 0},
        {&second, &over, {16, 64, 32, 0.1, true}, 16, 16},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        int n = stop_next_cells(cases[i].how, cases[i].now, &cases[i].part);
        g_test_message("case %zu: %d", i, n);
        g_assert_cmpint(n, >=, cases[i].least);
        g_assert_cmpint(n, <=, cases[i].most);
    }
}

static void test_fraction(void)
{
    const settings four = with_rules(4, 0, 0), all = with_rules(100, 10, 0.1);
    const stop_state middle = {2.5, 0, 0, INFINITY, 0, 0}, by_time = {1, 8, 1, 1.0, 0, 0},
                     by_noise = {1, 1, 1, 0.2, 0, 0}, late = {1, 99, 1, INFINITY, 0, 0};
    g_assert_cmpfloat_with_epsilon(stop_fraction(&four, &middle), 0.625, 1e-12);
    g_assert_cmpfloat_with_epsilon(stop_fraction(&all, &by_time), 0.8, 1e-12);
    g_assert_cmpfloat_with_epsilon(stop_fraction(&all, &by_noise), 0.25, 1e-12);
    g_assert_cmpfloat_with_epsilon(stop_fraction(&all, &late), 1.0, 1e-12);
}

/* Ends between the pass that was too early and the one that was too late. */
static void test_time_is_kept(void)
{
    g_autoptr(view) v = view_of(ROOM);
    g_autoptr(render) r = render_of(v, "integrator=path spp=1 time=0.4");
    double start = (double)g_get_monotonic_time() * 1e-6;
    g_assert_true(render_run(r, NULL, NULL, NULL));
    double took = (double)g_get_monotonic_time() * 1e-6 - start;
    const render_statistics st = render_get_statistics(r);
    g_test_message("%" G_GINT64_FORMAT " passes in %g s", st.passes, took);
    g_assert_cmpint(st.stopped_by, ==, RENDER_TIME_UP);
    g_assert_cmpint(st.passes, >, 16);
    g_assert_cmpfloat(took, >, 0.4 * 0.8);
    g_assert_cmpfloat(st.time_total, <=, took);
    /* A busy machine may keep the last pass waiting. */
    g_assert_cmpfloat(took, <, 0.4 * 1.2 + 0.5);
}

static void test_noise_is_reached(void)
{
    g_autoptr(view) v = view_of(ROOM);
    g_autoptr(render) r = render_of(v, "integrator=path spp=4 noise=0.05");
    g_assert_true(render_run(r, NULL, NULL, NULL));
    const render_statistics st = render_get_statistics(r);
    g_test_message("%" G_GINT64_FORMAT " passes to %g", st.passes, st.noise);
    g_assert_cmpint(st.stopped_by, ==, RENDER_NOISE_REACHED);
    g_assert_cmpfloat(st.noise, <=, 0.05);
    g_assert_cmpfloat(st.noise, >, 0.03);
}

/* Short renders, so that little evens out, that are nearly all gathering. */
static void test_no_part_takes_longer_than_the_whole(void)
{
    g_autoptr(view) v = view_of(ROOM);
    for (int i = 0; i < 30; i++) {
        g_autoptr(render) r = render_of(
            v, "photons=3000 radius=1 spp=1 passes=1 direct_illumination=off threads=1");
        g_assert_true(render_run(r, NULL, NULL, NULL));
        const render_statistics st = render_get_statistics(r);
        double parts = st.time_prepare + st.time_trace + st.time_build + st.time_camera;
        g_test_message("gather %g of camera %g", st.time_gather, st.time_camera);
        g_assert_cmpfloat(st.time_gather, >, 0.0);
        g_assert_cmpfloat(st.time_gather, <=, st.time_camera);
        g_assert_cmpfloat(parts, <=, st.time_total + 1e-9);
    }
}

/* ---- The same bits ---- */

typedef struct interruption {
    int64_t passes;  /* stop when so many are done ... */
    double fraction; /* ... and at least this share of all */
} interruption;

static bool interrupt(double fraction, const render_statistics *st, void *data)
{
    const interruption *when = data;
    return st->passes < when->passes || fraction < when->fraction;
}

/* Renders until the interruption comes. */
static void run_until(render *r, interruption when)
{
    g_autoptr(GError) error = NULL;
    g_assert_false(render_run(r, interrupt, &when, &error));
    g_assert_error(error, error_quark(), ERROR_CANCELLED);
    g_assert_cmpint(render_get_statistics(r).stopped_by, ==, RENDER_CANCELLED);
}

/* After n of at most 12 passes: one image, whatever ended the render and whether it was
   taken up again. */
static void test_stopping_changes_nothing(void)
{
    const char *ways[] = {"integrator=path spp=2",
                          "photons=3000 spp=1 final_gather=on gather_rays=4",
                          "integrator=auto photons=2000 spp=1"};
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS GLASS_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *plain = g_strconcat(ways[i], " passes=6", NULL);
        g_autofree char *noisy =
            g_strconcat(ways[i], " passes=6 noise=1 threads=3", NULL);
        g_autoptr(render) straight = render_of(v, plain), broken = render_of(v, plain),
                          by_noise = render_of(v, noisy);
        g_assert_true(render_run(straight, NULL, NULL, NULL));
        g_assert_true(render_run(by_noise, NULL, NULL, NULL));
        run_until(broken, (interruption){4, 0.0});
        g_assert_cmpint(render_get_statistics(by_noise).stopped_by, ==,
                        RENDER_NOISE_REACHED);
        g_autoptr(image) four = image_of(broken), also_four = image_of(by_noise);
        assert_same_bits(four, also_four);
        g_assert_true(render_run(broken, NULL, NULL, NULL));
        g_autoptr(image) six = image_of(straight), also_six = image_of(broken);
        assert_same_bits(six, also_six);
    }
}

/* A pass given up halfway leaves no trace in the picture. */
static void test_half_a_pass_is_no_pass(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(96) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    const char *how = "integrator=path passes=2 spp=64 threads=2";
    g_autoptr(render) straight = render_of(v, how), broken = render_of(v, how);
    run_until(straight, (interruption){1, 0.0});
    run_until(broken, (interruption){1, 0.0});
    run_until(broken, (interruption){1, 0.51});
    g_assert_cmpint(render_get_statistics(broken).passes, ==, 1);
    g_autoptr(image) one = image_of(straight), also_one = image_of(broken);
    assert_same_bits(one, also_one);
    g_assert_true(render_run(straight, NULL, NULL, NULL));
    g_assert_true(render_run(broken, NULL, NULL, NULL));
    g_autoptr(image) two = image_of(straight), also_two = image_of(broken);
    assert_same_bits(two, also_two);
}

/* ---- Progress ---- */

typedef struct listener {
    const render *render;
    int calls, calls_before_first, images;
    double last;
} listener;

static bool listen(double fraction, const render_statistics *st, void *data)
{
    listener *l = data;
    l->calls++;
    l->calls_before_first += st->passes == 0;
    g_assert_cmpfloat(fraction, >=, l->last - 1e-9);
    g_assert_cmpfloat(fraction, <=, 1.0);
    l->last = fraction;
    if (st->passes > l->images) {
        g_autoptr(image) img = image_of(l->render);
        g_assert_cmpfloat(mean_of(img, ""), >, 0.1);
        l->images++;
    }
    return true;
}

static void test_progress_while_photons_fly(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(4) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    g_autoptr(render) r = render_of(v, "passes=2 spp=1 photons=1000000 radius=0.1");
    listener l = {.render = r};
    g_assert_true(render_run(r, listen, &l, NULL));
    g_assert_cmpint(l.images, ==, 2);
    g_assert_cmpint(l.calls_before_first, >=, 1);
    g_assert_cmpfloat_with_epsilon(l.last, 1.0, 1e-12);
}

static gpointer cancel_soon(gpointer data)
{
    g_usleep(100000);
    render_cancel(data);
    return NULL;
}

/* Seconds from a cancel out of the blue to the end of the render. */
static double time_to_cancel(const view *v, const char *words)
{
    g_autoptr(render) r = render_of(v, words);
    g_autoptr(GError) error = NULL;
    GThread *thread = g_thread_new("cancel", cancel_soon, r);
    double start = (double)g_get_monotonic_time() * 1e-6;
    g_assert_false(render_run(r, NULL, NULL, &error));
    double took = (double)g_get_monotonic_time() * 1e-6 - start - 0.1;
    g_assert_error(error, error_quark(), ERROR_CANCELLED);
    g_thread_join(thread);
    g_test_message("%s: %g s", words, took);
    return took;
}

/* 0.2 s on a machine that has nothing else to do. */
static void test_cancel_is_quick(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(256) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS GLASS_BALL);
    const char *const ways[] = {
        "integrator=path spp=65536",
        "photons=1000000000",
        "photons=20000 final_gather=on gather_rays=1000 precompute_radiance=off spp=64",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++)
        g_assert_cmpfloat(time_to_cancel(v, ways[i]), <, 2.0);
}

/* ---- The error it claims ---- */

/* film_noise's measure, of an image against a reference. */
static double relative_error(const image *img, const image *reference)
{
    static const double y[3] = {0.2126, 0.7152, 0.0722};
    size_t n = pixels_of(img);
    g_autofree double *truth = g_new0(double, n), *off = g_new0(double, n);
    double mean = 0, capped = 0, sum = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t c = 0; c < 3; c++) {
            truth[i] += y[c] * at(reference, i, c);
            off[i] += y[c] * (at(img, i, c) - at(reference, i, c));
        }
        mean += truth[i] / (double)n;
    }
    for (size_t i = 0; i < n; i++)
        capped += fmin(truth[i], mean) / (double)n;
    for (size_t i = 0; i < n; i++)
        sum += off[i] * off[i] / (truth[i] * truth[i] + 0.01 * capped * capped);
    return sqrt(sum / (double)n);
}

typedef struct noise_case {
    const char *name, *world, *how, *reference;
} noise_case;

/* Fixed radii: the noise is that of the light, without what the radius blurs. */
static const noise_case noise_cases[] = {
    {"path", ROOM_LAMP("") ROOM_WALLS, "integrator=path passes=16 spp=1",
     "integrator=path passes=256 spp=4"},
    {"photonmap", ROOM_LAMP("") ROOM_WALLS,
     "passes=16 spp=1 photons=3000 radius=0.2 alpha=1",
     "passes=256 spp=1 photons=3000 radius=0.2 alpha=1"},
    {"caustic", ROOM_LAMP("") ROOM_WALLS GLASS_BALL,
     "integrator=auto passes=16 spp=1 caustic_photons=2000 radius=0.1 alpha=1",
     "integrator=auto passes=256 spp=1 caustic_photons=2000 radius=0.1 alpha=1"},
    {"rare", ROOM_LAMP("") ROOM_WALLS GLASS_BALL, "integrator=path passes=16 spp=1",
     "integrator=path passes=1024 spp=4"},
};

static void test_noise_is_honest(gconstpointer data)
{
    enum { SEEDS = 4 };
    const noise_case *c = data;
    g_autofree char *text =
        g_strconcat(ROOM_CAMERA SIZE(12) "WorldBegin\n", c->world, NULL);
    g_autoptr(view) v = view_of(text);
    g_autofree char *long_run = g_strconcat(c->reference, " seed=99", NULL);
    g_autoptr(image) reference = render_with(v, long_run);
    double claimed2 = 0, made2 = 0;
    for (int seed = 0; seed < SEEDS; seed++) {
        g_autofree char *words = g_strdup_printf("%s seed=%d", c->how, seed);
        g_autoptr(render) r = render_of(v, words);
        g_assert_true(render_run(r, NULL, NULL, NULL));
        g_autoptr(image) img = image_of(r);
        double claimed = render_get_statistics(r).noise;
        double made = relative_error(img, reference);
        g_test_message("%s: claimed %g, made %g", c->name, claimed, made);
        claimed2 += claimed * claimed;
        made2 += made * made;
    }
    double ratio = sqrt(claimed2 / made2);
    g_test_message("%s: %g", c->name, ratio);
    g_assert_cmpfloat(ratio, >, 1 / 1.5);
    g_assert_cmpfloat(ratio, <, 1.5);
}

/* Over many seeds the squares of the errors are, on the mean over pixels, what variance.Y
   says. Both are taken relative to the brightness: at the lamp's edge, where the samples
   of a pixel fill it evenly, the scatter of passes overstates the error. */
static void test_variance_layer(void)
{
    enum { SEEDS = 40, PIXELS = 64 };
    double sum[PIXELS] = {0}, sum2[PIXELS] = {0}, layer[PIXELS] = {0};
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(8) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    for (int seed = 0; seed < SEEDS; seed++) {
        g_autofree char *words =
            g_strdup_printf("passes=8 spp=1 photons=2000 radius=0.2 seed=%d", seed);
        g_autoptr(image) img = render_with(v, words);
        size_t variance = channel_of(img, "variance.Y");
        for (size_t i = 0; i < PIXELS; i++) {
            double y = luminance_at(img, i);
            sum[i] += y;
            sum2[i] += y * y;
            layer[i] += at(img, i, variance);
        }
    }
    double claimed = 0, found = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double mean = sum[i] / SEEDS;
        found += (sum2[i] - sum[i] * mean) / (SEEDS - 1) / (mean * mean);
        claimed += layer[i] / SEEDS / (mean * mean);
    }
    g_test_message("claimed %g, found %g", claimed, found);
    g_assert_cmpfloat(claimed / found, >, 0.75);
    g_assert_cmpfloat(claimed / found, <, 1.33);
}

static void test_one_pass_claims_nothing(void)
{
    g_autoptr(view) v = view_of(ROOM);
    g_autoptr(render) r = render_of(v, "integrator=path passes=1 spp=1");
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_autoptr(image) img = image_of(r);
    g_assert_cmpint(image_channel(img, "variance.Y"), ==, -1);
    g_assert_true(isinf(render_get_statistics(r).noise));
}

/* ---- What the camera does not see ---- */

#define HIDDEN_BALL(kind)                                                                \
    "AttributeBegin Attribute \"shape\" \"bool camera_visible\" false\n" kind            \
    "Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n"

/* Largest ratio of a channel of two images, over pixels. */
static double largest_ratio(const image *a, const image *b, const char *channel)
{
    double largest = 0;
    size_t in_a = channel_of(a, channel), in_b = channel_of(b, channel);
    for (size_t i = 0; i < pixels_of(a); i++)
        largest = fmax(largest, at(a, i, in_a) / at(b, i, in_b));
    return largest;
}

/* A ball that is not seen leaves depth and albedo as they are without it, but takes light
   away beneath it. */
static void test_hidden_casts_shadow(void)
{
    g_autoptr(view) with = view_of(ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP(
        "") HIDDEN_BALL("Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n") ROOM_WALLS);
    g_autoptr(view) without =
        view_of(ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    const char *const ways[] = {"integrator=path passes=4 spp=16",
                                "passes=4 spp=4 photons=20000 radius=0.2"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) a = render_with(with, ways[i]);
        g_autoptr(image) b = render_with(without, ways[i]);
        const char *const geometry[] = {"depth.Z", "albedo.R", "albedo.B"};
        for (size_t k = 0; k < G_N_ELEMENTS(geometry); k++) {
            g_assert_cmpfloat(largest_ratio(a, b, geometry[k]), <, 1.0001);
            g_assert_cmpfloat(largest_ratio(b, a, geometry[k]), <, 1.0001);
        }
        g_test_message("%s: direct light %g of %g", ways[i], mean_of(a, "direct"),
                       mean_of(b, "direct"));
        g_assert_cmpfloat(largest_ratio(b, a, "direct.G"), >, 3.0);
    }
}

/* A hidden lens: no depth, no highlight, but its caustic. */
static void test_hidden_casts_caustic(void)
{
    g_autoptr(view) v = view_of(ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP("")
                                    HIDDEN_BALL("Material \"dielectric\"\n") ROOM_WALLS);
    const char *const ways[] = {"integrator=auto passes=4 spp=4 photons=20000",
                                "passes=4 spp=4 photons=20000"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) img = render_with(v, ways[i]);
        g_test_message("%s: caustic %g", ways[i], mean_of(img, "caustic"));
        g_assert_cmpfloat(mean_of(img, "specular"), <=, 0.0);
        g_assert_cmpfloat(mean_of(img, "caustic"), >, 0.01);
    }
}

/* A mirror shows it, and a lamp that is not seen lights as ever. */
static void test_hidden_is_seen_in_mirrors(void)
{
    static const char mirror[] =
        "AttributeBegin Material \"conductor\" Shape \"trianglemesh\" \"point3 P\" [-1 "
        "1.9 0 1 1.9 0 1 1.9 1.9 -1 1.9 1.9] \"integer indices\" [0 1 2 0 2 3] "
        "AttributeEnd\n";
    g_autofree char *shown_text = g_strconcat(ROOM_CAMERA SIZE(16) "WorldBegin\n",
                                              ROOM_LAMP(""), mirror, ROOM_WALLS, NULL);
    g_autofree char *hidden_text = g_strconcat(
        ROOM_CAMERA SIZE(16) "WorldBegin\n",
        "Attribute \"shape\" \"bool camera_visible\" false\n", ROOM_LAMP(""),
        "Attribute \"shape\" \"bool camera_visible\" true\n", mirror, ROOM_WALLS, NULL);
    g_autoptr(view) shown = view_of(shown_text), hidden = view_of(hidden_text);
    g_autoptr(image) a = render_with(shown, "integrator=path passes=2 spp=16");
    g_autoptr(image) b = render_with(hidden, "integrator=path passes=2 spp=16");
    g_assert_cmpfloat(mean_of(a, "emission"), >, 0.05);
    g_assert_cmpfloat(mean_of(b, "emission"), <=, 0.0);
    g_assert_cmpfloat(mean_of(b, "specular"), >, 0.99 * mean_of(a, "specular"));
    g_assert_cmpfloat(fabs(mean_of(b, "direct") / mean_of(a, "direct") - 1.0), <, 0.05);
}

/* ---- Light groups ---- */

#define GROUPED_LIGHTS                                                                   \
    ROOM_LAMP("\"string group\" \"key\"")                                                \
    "LightSource \"point\" \"rgb I\" [0.5 1 2] \"point3 from\" [1.5 -1 1.2] \"string "   \
    "group\" \"fill\"\n"                                                                 \
    "LightSource \"infinite\" \"rgb L\" [1 1 1] \"string group\" \"sky\"\n"              \
    "LightSource \"spot\" \"rgb I\" [9 1 1] \"point3 from\" [-1 -3 1] \"point3 to\" [0 " \
    "0 0]\n"

/* A room without a ceiling, so that the sky looks in. */
#define OPEN_ROOM                                                                        \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                           \
    "Shape \"trianglemesh\" \"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0 -2 -4 2 2 -4 2 "   \
    "2 2 2 -2 2 2] \"integer indices\" [0 1 2 0 2 3 0 5 1 0 4 5 3 2 6 3 6 7 0 3 7 0 7 "  \
    "4 "                                                                                 \
    "1 5 6 1 6 2]\n"

static const char *const group_layers[] = {"light.key", "light.fill", "light.sky",
                                           "light.default"};

static const char *const grouped_ways[] = {
    "integrator=path passes=2 spp=4",
    "integrator=auto passes=2 spp=2 photons=5000",
    "integrator=vcm passes=2 spp=2 photons=5000",
    "passes=2 spp=2 photons=5000",
    "passes=2 spp=2 photons=5000 direct_illumination=off radius=0.3",
    "passes=1 spp=2 photons=5000 indirect_nearest=50 caustic_nearest=20 "
    "photon_map=kdtree",
    "passes=1 spp=1 photons=5000 final_gather=on gather_rays=8",
    "passes=1 spp=1 photons=5000 final_gather=on gather_rays=8 precompute_radiance=off",
};

/* Pixel by pixel and channel by channel the groups sum to the picture. */
static void test_groups_sum_to_the_beauty(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(12) "PixelFilter \"gaussian\"\n"
                                     "WorldBegin\n" GROUPED_LIGHTS OPEN_ROOM GLASS_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(grouped_ways); i++) {
        g_autoptr(image) img = render_with(v, grouped_ways[i]);
        double worst = 0;
        for (int c = 0; c < 3; c++) {
            size_t channel[4];
            for (int k = 0; k < 4; k++) {
                g_autofree char *name =
                    g_strdup_printf("%s.%c", group_layers[k], "RGB"[c]);
                channel[k] = channel_of(img, name);
            }
            for (size_t p = 0; p < pixels_of(img); p++) {
                double sum = 0, beauty = at(img, p, (size_t)c);
                for (int k = 0; k < 4; k++)
                    sum += at(img, p, channel[k]);
                worst = fmax(worst, fabs(sum - beauty) / (fabs(beauty) + 0.01));
            }
        }
        g_test_message("%s: off by %g", grouped_ways[i], worst);
        for (int k = 0; k < 4; k++)
            g_assert_cmpfloat(mean_of(img, group_layers[k]), >, 0.001);
        g_assert_cmpfloat(worst, <, 1e-4);
    }
}

/* A group is what its lamps give alone. */
static void test_group_is_its_light_alone(void)
{
    g_autoptr(view) all =
        view_of(ROOM_CAMERA SIZE(12) "WorldBegin\n" GROUPED_LIGHTS OPEN_ROOM GLASS_BALL);
    g_autoptr(view) key = view_of(ROOM_CAMERA SIZE(12) "WorldBegin\n" ROOM_LAMP(
        "\"string group\" \"key\"") OPEN_ROOM GLASS_BALL);
    const char *const ways[] = {
        "integrator=path passes=4 spp=64", "passes=8 spp=4 photons=40000",
        "passes=4 spp=4 photons=40000 final_gather=on gather_rays=8"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) a = render_with(all, ways[i]);
        g_autoptr(image) b = render_with(key, ways[i]);
        g_test_message("%s: %g, alone %g", ways[i], mean_of(a, "light.key"),
                       mean_of(b, ""));
        g_assert_cmpint(image_channel(b, "light.default.R"), ==, -1);
        g_assert_cmpfloat(fabs(mean_of(a, "light.key") / mean_of(b, "") - 1), <, 0.04);
    }
}

/* Groups change nothing in the picture but rounding, and threads change not even that. */
static void test_groups_change_nothing(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(12) "WorldBegin\n" GROUPED_LIGHTS OPEN_ROOM GLASS_BALL);
    g_autoptr(view) plain =
        view_of(ROOM_CAMERA SIZE(12) "WorldBegin\n" ROOM_LAMP("") OPEN_ROOM GLASS_BALL);
    g_autoptr(view) named = view_of(ROOM_CAMERA SIZE(12) "WorldBegin\n" ROOM_LAMP(
        "\"string group\" \"a\"") OPEN_ROOM GLASS_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(grouped_ways); i++) {
        g_autofree char *one = g_strconcat(grouped_ways[i], " threads=1", NULL);
        g_autofree char *three = g_strconcat(grouped_ways[i], " threads=3", NULL);
        g_autoptr(image) a = render_with(v, one), b = render_with(v, three);
        assert_same_bits(a, b);
        g_autoptr(image) without = render_with(plain, one),
                         with = render_with(named, one);
        g_assert_cmpint(image_channel(without, "light.default.R"), ==, -1);
        for (size_t p = 0; p < pixels_of(with); p++)
            for (size_t c = 0; c < 3; c++)
                g_assert_cmpfloat(fabs(at(with, p, c) - at(without, p, c)), <=,
                                  1e-4 * (0.01 + at(with, p, c)));
    }
}

/* The whole picture can be seen, coarsely, long before the first pass is done. */
typedef struct glance {
    const render *render;
    size_t
        size; /* of the smallest squares of one colour when all was seen first; 0: not */
} glance;

static bool look_for_whole(double fraction, const render_statistics *st, void *data)
{
    glance *g = data;
    g_autoptr(image) img = image_of(g->render);
    size_t n = pixels_of(img), black = 0, same = 0;
    (void)fraction;
    g_assert_cmpuint(st->passes, ==, 0);
    for (size_t i = 0; i < n; i++) {
        black += !(at(img, i, 0) > 0);
        same += i % 2 == 1 && !(fabs(at(img, i, 0) - at(img, i - 1, 0)) > 0);
    }
    g->size = black > 0 ? 0 : same == n / 2 ? 2 : 1;
    return g->size == 0;
}

static void test_picture_is_seen_soon(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(64) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    g_autoptr(render) r = render_of(v, "integrator=path passes=1 spp=1024");
    glance g = {.render = r};
    g_assert_false(render_run(r, look_for_whole, &g, NULL));
    g_assert_cmpuint(g.size, ==, 2);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/render/stop/rules", test_rules);
    g_test_add_func("/render/stop/cells", test_cells);
    g_test_add_func("/render/stop/fraction", test_fraction);
    g_test_add_func("/render/parts-of-time", test_no_part_takes_longer_than_the_whole);
    g_test_add_func("/render/stop/time", test_time_is_kept);
    g_test_add_func("/render/stop/noise", test_noise_is_reached);
    g_test_add_func("/render/bits/stopping", test_stopping_changes_nothing);
    g_test_add_func("/render/bits/half-a-pass", test_half_a_pass_is_no_pass);
    g_test_add_func("/render/progress/photons", test_progress_while_photons_fly);
    g_test_add_func("/render/progress/soon", test_picture_is_seen_soon);
    g_test_add_func("/render/progress/cancel", test_cancel_is_quick);
    for (size_t i = 0; i < G_N_ELEMENTS(noise_cases); i++) {
        g_autofree char *path = g_strconcat("/render/noise/", noise_cases[i].name, NULL);
        g_test_add_data_func(path, &noise_cases[i], test_noise_is_honest);
    }
    g_test_add_func("/render/noise/variance", test_variance_layer);
    g_test_add_func("/render/noise/one-pass", test_one_pass_claims_nothing);
    g_test_add_func("/render/hidden/shadow", test_hidden_casts_shadow);
    g_test_add_func("/render/hidden/caustic", test_hidden_casts_caustic);
    g_test_add_func("/render/hidden/mirror", test_hidden_is_seen_in_mirrors);
    g_test_add_func("/render/groups/sum", test_groups_sum_to_the_beauty);
    g_test_add_func("/render/groups/alone", test_group_is_its_light_alone);
    g_test_add_func("/render/groups/nothing-else", test_groups_change_nothing);
    return g_test_run();
}
