/*
 * Renders with little time: passes that fit, a picture in any case, and passes that who
 * sets the same by hand gets again, bit for bit.
 */
#include "render/pace.h"
#include "render/render_state.h"
#include "render/stop.h"
#include "rooms.h"

static double seconds(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}

/* ---- Choosing ---- */

static double whole_pass(const settings *how, const settings *asked,
                         const pace_costs *costs, double n_pixels)
{
    double photons = (double)settings_photons(how) / (double)settings_photons(asked);
    return costs->pass + photons * costs->photons +
           costs->sample * n_pixels * (double)how->spp;
}

static void test_plenty(void)
{
    const pace_costs costs = {0.01, 0.1, 1e-6};
    settings how = settings_default();
    settings paced = pace_choose(&how, &costs, 1e5, 100.0);
    g_assert_cmpint(paced.spp, ==, how.spp);
    g_assert_cmpint(paced.photons, ==, how.photons);
    g_assert_cmpfloat(paced.planned_passes, ==, 16.0);
    how.passes = 7; /* who says how many passes there are has them as they are */
    paced = pace_choose(&how, &costs, 1e5, 0.1);
    g_assert_cmpmem(&paced, sizeof paced, &how, sizeof how);
}

/* Either so many passes fit, or one has a sample a pixel, and photons cost no more than
   that; whatever it all costs. */
static void test_short(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(5);
    for (int i = 0; i < 10000; i++) {
        const pace_costs costs = {g_rand_double_range(random, 0.0, 0.02),
                                  pow(10.0, g_rand_double_range(random, -3.0, 1.0)),
                                  pow(10.0, g_rand_double_range(random, -7.0, -4.0))};
        double left = pow(10.0, g_rand_double_range(random, -1.3, 3.0));
        double n_pixels = pow(10.0, g_rand_double_range(random, 2.0, 7.0));
        settings how = settings_default();
        how.spp = g_rand_int_range(random, 1, 64);
        settings paced = pace_choose(&how, &costs, n_pixels, left);
        double least = costs.pass + costs.sample * n_pixels * (double)paced.spp;
        double whole = whole_pass(&paced, &how, &costs, n_pixels);
        g_assert_cmpint(paced.spp, >=, 1);
        g_assert_cmpint(paced.spp, <=, how.spp);
        g_assert_cmpint(settings_photons(&paced), >=, 1000);
        g_assert_cmpfloat(paced.planned_passes, >, 0.0);
        g_assert_cmpfloat(paced.planned_passes, <=,
                          16.0 * (double)how.spp / (double)paced.spp + 1e-9);
        if (settings_photons(&paced) > 1000)
            g_assert_cmpfloat(whole, <=, 1.01 * fmax(2.0 * least, 2.0 * left / 20.0));
        if (paced.spp > 1)
            g_assert_cmpfloat(costs.sample * n_pixels * (double)paced.spp, <=,
                              left / 20.0);
    }
}

static void test_too_late(void)
{
    settings how = settings_default();
    stop_state now = {.elapsed = 1e6, .last_pass = 1};
    g_assert_false(stop_at_once(&how, &now)); /* no limit */
    how.time = 10.0;
    now.elapsed = 10.0;
    g_assert_false(stop_at_once(&how, &now)); /* it may be done in a moment */
    now.elapsed = 10.5;
    g_assert_true(stop_at_once(&how, &now));
    now = (stop_state){.elapsed = 8.0, .after = 3.0};
    g_assert_true(stop_at_once(&how, &now));
    now.passes = 3;
    g_assert_cmpint(stop_decide(&how, &now), ==, RENDER_TIME_UP);
}

/* ---- Ending in time, by a clock that is counted ---- */

/* A render of which only the time is there. */
typedef struct clocked {
    settings how;
    pace_costs costs; /* of what was asked for */
    double photons;   /* of these so many are sent */
    double n_pixels;
    GRand *random;
    stop_state now;
} clocked;

/* What a machine does takes now more, now less. */
static void spend(clocked *c, double seconds)
{
    c->now.elapsed += seconds * g_rand_double_range(c->random, 0.85, 1.15);
}

/* @return whether it is whole */
static bool clocked_pass(clocked *c)
{
    bool is_first = c->now.passes < 1.0;
    double size = is_first && c->how.first_spp > 0
                      ? (double)c->how.first_spp / (double)c->how.spp
                      : 1.0;
    double cell = size * c->costs.sample * c->n_pixels * (double)c->how.spp / FILM_CELLS;
    double start = c->now.elapsed, last_cell = c->now.last_pass - c->now.last_photons;
    stop_part part = {0, FILM_CELLS, is_first, last_cell / FILM_CELLS, is_first};
    spend(c, c->costs.pass + size * c->photons * c->costs.photons);
    double looked = c->now.elapsed, photons = looked - start;
    for (int n; (n = stop_next_cells(&c->how, &c->now, &part)) > 0;) {
        spend(c, n * cell);
        bool too_late = stop_at_once(&c->how, &c->now);
        if (too_late && (!is_first || part.done > 0)) { /* it is given up then */
            c->now.elapsed = fmin(c->now.elapsed, 1.02 * c->how.time + 0.1);
            return false;
        }
        part.done += n;
        part.cell = (c->now.elapsed - looked) / part.done;
    }
    c->now.passes += part.done == FILM_CELLS;
    c->now.last_pass = (c->now.elapsed - start) / size;
    c->now.last_photons = photons / size;
    return part.done == FILM_CELLS;
}

/* Whatever a pass takes, all ends within 5 % and half a second of the time. */
static void test_ends_in_time(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(6);
    double worst = 0.0;
    for (int i = 0; i < 10000; i++) {
        settings asked = settings_default();
        clocked c = {.random = random};
        c.costs = (pace_costs){g_rand_double_range(random, 0.0, 0.02),
                               pow(10.0, g_rand_double_range(random, -2.0, 0.5)),
                               pow(10.0, g_rand_double_range(random, -7.0, -5.0))};
        c.n_pixels = pow(10.0, g_rand_double_range(random, 3.0, 6.3));
        asked.time = pow(10.0, g_rand_double_range(random, 0.3, 2.0));
        asked.spp = g_rand_int_range(random, 1, 16);
        c.how = pace_choose(&asked, &c.costs, c.n_pixels, asked.time);
        c.photons = (double)settings_photons(&c.how) / (double)settings_photons(&asked);
        while (clocked_pass(&c) && stop_decide(&c.how, &c.now) == RENDER_GOES_ON)
            ;
        double off = fabs(c.now.elapsed - asked.time);
        worst = fmax(worst, off / (0.05 * asked.time + 0.5));
        if (worst > 1.0)
            g_test_message("%g s of %g, %g passes, %g s each", c.now.elapsed, asked.time,
                           c.now.passes, c.now.last_pass);
        g_assert_cmpfloat(worst, <=, 1.0);
    }
    g_test_message("at worst %g of what is allowed", worst);
}

/* ---- Rendering ---- */

static view *subject(void)
{
    return view_of(ROOM_CAMERA SIZE(24) "WorldBegin\n" ROOM_LAMP("")
                       ROOM_WALLS GLASS_BALL);
}

/* Holds the third pass up until the time is over; sees that nothing is done too soon. */
typedef struct hold {
    double start, time;
    unsigned n_done;
    bool held;
} hold;

static bool hold_up(double fraction, const render_statistics *st, void *data)
{
    hold *h = data;
    h->n_done += fraction >= 1.0;
    g_assert_true((fraction >= 1.0) == (st->stopped_by != RENDER_GOES_ON));
    while (st->passes == 2 && seconds() < h->start + 1.1 * h->time + 0.3) {
        h->held = true;
        g_usleep(10000);
    }
    return true;
}

/* On a busy machine even the first pass may be too long: then there is more time. */
static render *render_in_time(const view *v, const char *integrator)
{
    for (double time = 0.3; time < 10.0; time *= 3.0) {
        g_autofree char *words = g_strdup_printf(
            "integrator=%s spp=3 photons=5000 threads=1 time=%g", integrator, time);
        render *r = render_of(v, words);
        hold h = {.start = seconds(), .time = time};
        g_assert_true(render_run(r, hold_up, &h, NULL));
        const render_statistics st = render_get_statistics(r);
        g_test_message("%s: %" G_GINT64_FORMAT " passes", words, st.passes);
        g_assert_cmpint(st.stopped_by, ==, RENDER_TIME_UP);
        g_assert_cmpuint(h.n_done, ==, 1);
        g_assert_cmpint(st.passes, <=, 2);
        if (h.held)
            return r;
        render_free(r);
    }
    return NULL;
}

/* A pass given up leaves no trace, and those before it are had again by their settings.
 */
static void test_repeats(const void *data)
{
    const char *integrator = data;
    g_autoptr(view) v = subject();
    g_autoptr(render) r = render_in_time(v, integrator);
    g_assert_nonnull(r);
    g_auto(GStrv) repeat = render_repeat(r);
    g_autofree char *same = g_strjoinv(" ", repeat);
    g_autofree char *words = g_strdup_printf(
        "integrator=%s spp=3 photons=5000 threads=3 %s", integrator, same);
    g_test_message("%s", words);
    g_assert_true(g_strv_contains((const char *const *)repeat, "passes=2"));
    g_autoptr(image) first = image_of(r), again = render_with(v, words);
    assert_same_bits(first, again);
}

/* Too large for the time: a picture there is, on a grid. */
static void test_too_large(void)
{
    g_autoptr(view) v = subject();
    view_resize(v, 1200, 900);
    g_autoptr(render) r = render_of(v, "integrator=photonmap time=0.01");
    g_assert_true(render_run(r, NULL, NULL, NULL));
    const render_statistics st = render_get_statistics(r);
    g_autoptr(image) picture = image_of(r);
    g_assert_cmpint(st.passes, ==, 0);
    g_assert_cmpint(st.stopped_by, ==, RENDER_TIME_UP);
    g_assert_cmpfloat(st.part, >=, 1.0 / FILM_CELLS);
    g_assert_cmpfloat(st.part, <, 1.0);
    g_assert_cmpfloat(mean_of(picture, ""), >, 0.0);
}

static bool stop_at_part(double fraction, const render_statistics *st, void *data)
{
    (void)fraction;
    return fabs(st->part - *(const double *)data) > 1e-9;
}

/* Of a grid that is not whole nothing is seen, so that the picture is the same however
   far each thread was. */
static void test_grids(void)
{
    g_autoptr(view) v = subject();
    view_resize(v, 61, 47);
    for (double part = 1.0 / FILM_CELLS; part < 1.0; part *= 4.0) {
        g_autoptr(image) first = NULL;
        for (int threads = 1; threads <= 3; threads++) {
            g_autofree char *words =
                g_strdup_printf("integrator=path spp=1 threads=%d", threads);
            g_autoptr(render) r = render_of(v, words);
            g_assert_false(render_run(r, stop_at_part, &part, NULL));
            g_assert_cmpfloat(render_get_statistics(r).part, ==, part);
            g_autoptr(image) picture = image_of(r);
            if (first)
                assert_same_bits(first, picture);
            else
                first = g_steal_pointer(&picture);
        }
    }
}

static bool stop_in_grid(double fraction, const render_statistics *st, void *data)
{
    (void)data, (void)st;
    return fraction < 0.3;
}

/* The same where a finer grid was begun. */
static void test_begun_grid(void)
{
    g_autoptr(view) v = subject();
    g_autoptr(render) r = render_of(v, "integrator=path spp=400 passes=1 threads=1");
    g_assert_false(render_run(r, stop_in_grid, NULL, NULL));
    double part = render_get_statistics(r).part;
    g_assert_cmpfloat(part, >, 0.0);
    g_autoptr(render) whole = render_of(v, "integrator=path spp=400 passes=1 threads=2");
    g_assert_false(render_run(whole, stop_at_part, &part, NULL));
    g_autoptr(image) begun = image_of(r), done = image_of(whole);
    assert_same_bits(begun, done);
}

/* Radii and photons are planned for so many passes. */
static void test_plans(void)
{
    g_autoptr(view) v = subject();
    view_resize(v, 200, 200);
    double radius[2];
    for (int i = 0; i < 2; i++) {
        g_autoptr(render) r =
            render_of(v, i ? "passes=1 spp=1 photons=20000 planned_passes=1000"
                           : "passes=1 spp=1 photons=20000 planned_passes=1");
        g_assert_true(render_run(r, NULL, NULL, NULL));
        radius[i] = render_get_statistics(r).radius[PHOTON_INDIRECT];
    }
    /* 12000 photons are wanted in a radius over all passes, but at least 40 in each. */
    g_test_message("%g m, %g m", radius[0], radius[1]);
    g_assert_cmpfloat(radius[1], <, 0.8 * radius[0]);
}

static bool stops_after_three(double fraction, const render_statistics *st, void *data)
{
    (void)fraction;
    (void)data;
    return st->passes < 3;
}

/* @return its passes, three at most; 0 where the time was too short to denoise */
static uint32_t expect_windows(const view *v, const char *words, int windows)
{
    g_autofree char *all = g_strconcat("integrator=path spp=1 denoise=on ", words, NULL);
    g_autoptr(render) r = render_of(v, all);
    render_run(r, stops_after_three, NULL, NULL);
    render_statistics st = render_get_statistics(r);
    uint32_t passes = (uint32_t)st.passes;
    if (passes < 2 || st.left_noisy)
        return 0;
    g_assert_cmpint(render_settings(r).denoise_windows, ==, windows);
    g_auto(GStrv) again = render_repeat(r);
    g_assert_true(g_strv_contains((const char *const *)again, "denoise_windows=coarse") ==
                  (windows == WINDOWS_COARSE));
    return passes;
}

/* Where there is little time noise is taken out in fewer windows, unless told otherwise,
   and who repeats the render does so too. Little is what two passes and that just fit
   into, which is more where each access to memory is watched. */
static void test_windows(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(192) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    int little = 1;
    for (uint32_t passes = 0; passes < 2; little *= 2) {
        g_autofree char *words = g_strdup_printf("time=%d", little);
        g_assert_cmpint(little, <, 100);
        passes = expect_windows(v, words, WINDOWS_COARSE);
    }
    g_autofree char *fine = g_strdup_printf("time=%d denoise_windows=fine", 4 * little);
    g_assert_cmpuint(expect_windows(v, fine, WINDOWS_FINE), >=, 2);
    g_assert_cmpuint(expect_windows(v, "time=3600", WINDOWS_AUTO), >=, 2);
}

/* Where there is time for less than two passes lights are filtered as one, and the plan
   keeps to that though it leaves time for more; whatever the algorithm. */
static void test_together(void)
{
    static const char *const integrators[] = {"path", "auto"};
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(512) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    for (size_t i = 0; i < G_N_ELEMENTS(integrators); i++) {
        bool was_together = false, was_apart = false;
        for (int k = 0; k <= 8; k++) {
            g_autofree char *words =
                g_strdup_printf("denoise=on integrator=%s time=%g", integrators[i],
                                0.25 * pow(2.0, (double)k));
            g_autoptr(render) r = render_of(v, words);
            render_start_clock(r);
            render_time_writing(r);
            g_assert_true(render_prepare(r, NULL));
            const settings *how = &r->plan.how;
            double samples = settings_planned_passes(how) * (double)how->spp;
            g_assert_true(r->film.together == (how->denoise && samples < 2.0));
            was_together = was_together || r->film.together;
            was_apart = was_apart || (how->denoise && !r->film.together);
        }
        g_assert_true(was_together);
        g_assert_true(was_apart);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pace/plenty", test_plenty);
    g_test_add_func("/pace/short", test_short);
    g_test_add_func("/pace/too-late", test_too_late);
    g_test_add_func("/pace/ends-in-time", test_ends_in_time);
    g_test_add_data_func("/pace/repeats/auto", "auto", test_repeats);
    g_test_add_data_func("/pace/repeats/path", "path", test_repeats);
    g_test_add_data_func("/pace/repeats/photonmap", "photonmap", test_repeats);
    g_test_add_data_func("/pace/repeats/vcm", "vcm", test_repeats);
    g_test_add_func("/pace/windows", test_windows);
    g_test_add_func("/pace/together", test_together);
    g_test_add_func("/pace/too-large", test_too_large);
    g_test_add_func("/pace/grids", test_grids);
    g_test_add_func("/pace/begun-grid", test_begun_grid);
    g_test_add_func("/pace/plans", test_plans);
    return g_test_run();
}
