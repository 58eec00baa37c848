/*
 * Every setting means what its row says: each has an oracle here, or names the test that
 * holds it to one. (That it acts on those integrators that its row names, and on no
 * other, is what test_knobs.c sees.)
 */
#include "rooms.h"

#include "transport/transport.h"

/* ---- How often light scatters ---- */

/* The furnace cut after d scatterings: sums of powers of a half. */
static void test_bounces(void)
{
    g_autoptr(view) v = view_of(FURNACE);
    for (int d = 0; d < 4; d++) {
        g_autofree char *backward =
            g_strdup_printf("integrator=path passes=4 spp=32 max_backward_bounces=%d", d);
        g_autofree char *forward =
            g_strdup_printf("integrator=photonmap passes=4 spp=4 photons=20000 radius=.3 "
                            "max_forward_bounces=%d",
                            d);
        g_autoptr(image) cut = render_with(v, backward);
        g_autoptr(image) by_photons = render_with(v, forward);
        double a = mean_of(cut, ""), b = mean_of(by_photons, "");
        double expected = 2.0 - exp2(-d), of_photons = 2.0 - exp2(-d - 1);
        g_test_message("%d: %g of %g, %g of %g", d, a, expected, b, of_photons);
        g_assert_cmpfloat(fabs(a / expected - 1.0), <, 0.01);
        g_assert_cmpfloat(fabs(b / of_photons - 1.0), <, 0.01);
    }
}

/* ---- What is counted ---- */

static render_statistics counted(const view *v, const char *words)
{
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    return render_get_statistics(r);
}

/* Where there is nothing but sky, a sample is one ray. */
static void test_samples(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(8) "WorldBegin LightSource \"infinite\"\n");
    render_statistics a = counted(v, "integrator=path passes=3 spp=5");
    g_assert_cmpint(a.passes, ==, 3);
    g_assert_cmpuint(a.camera_rays, ==, 8 * 8 * 3 * 5);
}

/* The first pass has fewer samples and photons, in proportion, and no other has. */
static void test_first_pass(void)
{
    g_autoptr(view) sky =
        view_of(ROOM_CAMERA SIZE(8) "WorldBegin LightSource \"infinite\"\n");
    g_autoptr(view) v = view_of(FURNACE);
    render_statistics a = counted(sky, "integrator=path passes=3 spp=5 first_spp=2");
    render_statistics same = counted(sky, "integrator=path passes=3 spp=5 first_spp=9");
    render_statistics b = counted(v, "integrator=photonmap passes=3 spp=4 first_spp=1 "
                                     "indirect_photons=1000 radius=.1");
    g_assert_cmpuint(a.camera_rays, ==, 8 * 8 * (2 + 5 + 5));
    g_assert_cmpuint(same.camera_rays, ==, 8 * 8 * 3 * 5);
    g_assert_cmpuint(b.emitted[PHOTON_INDIRECT], ==, 250 + 1000 + 1000);
}

/* Of a part of a pass so many of the pixels are rendered, and the picture is whole. */
static void test_part(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(8) "WorldBegin LightSource \"infinite\"\n");
    static const double passes[] = {0.015625, 0.25, 0.5, 1.0, 2.75};
    for (size_t i = 0; i < G_N_ELEMENTS(passes); i++) {
        g_autofree char *words =
            g_strdup_printf("integrator=path passes=%g spp=3", passes[i]);
        g_autoptr(render) r = render_of(v, words);
        g_assert_true(render_run(r, NULL, NULL, NULL));
        render_statistics n = render_get_statistics(r);
        g_autoptr(image) img = image_of(r);
        double mean = mean_of(img, "");
        g_test_message("%g passes: %g", passes[i], mean);
        g_assert_cmpuint(n.camera_rays, ==, (uint64_t)(8 * 8 * 3 * passes[i]));
        g_assert_cmpfloat(n.part, ==, passes[i] - floor(passes[i]));
        g_assert_cmpfloat(fabs(mean - 1.0), <, 0.05);
    }
}

/* Rays of a gather: so many more with the number. */
static void test_gather_rays(void)
{
    g_autoptr(view) v = view_of(FURNACE);
    double rays[3];
    for (int i = 0; i < 3; i++) {
        g_autofree char *words = g_strdup_printf("integrator=photonmap passes=1 spp=1 "
                                                 "photons=2000 radius=.3 final_gather=on "
                                                 "precompute_radiance=on gather_rays=%d",
                                                 16 << i);
        rays[i] = (double)counted(v, words).camera_rays;
    }
    double each = (rays[1] - rays[0]) / (8 * 8 * 16.0);
    g_test_message("%g rays each", each);
    g_assert_cmpfloat(fabs(each - 1.0), <, 0.01);
    g_assert_cmpfloat(fabs((rays[2] - rays[1]) / (rays[1] - rays[0]) - 2.0), <, 0.01);
}

static void test_photons(void)
{
    g_autoptr(view) v = view_of(ROOM GLASS_BALL);
    const uint64_t *n;
    render_statistics shared =
        counted(v, "passes=1 spp=1 photons=3000 radius=.1 direct_illumination=off");
    n = shared.emitted;
    g_assert_cmpuint(n[0] + n[1] + n[2], ==, 3000);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(n[c], >, 500);
    render_statistics own = counted(v, "passes=2 spp=1 radius=.1 direct_photons=100 "
                                       "indirect_photons=200 caustic_photons=300 "
                                       "direct_illumination=off");
    for (uint64_t c = 0; c < N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(own.emitted[c], ==, 2 * 100 * (c + 1));
    render_statistics sampled =
        counted(v, "passes=1 spp=1 photons=100 radius=.1 direct_photons=100");
    g_assert_cmpuint(sampled.emitted[PHOTON_DIRECT], ==, 0);
    g_assert_cmpuint(sampled.shadow_rays, >, 16 * 16 / 2);
    g_assert_cmpuint(own.shadow_rays, ==, 0);
}

/* r²(i+1) = r²(i) (i + α)/(i + 1), from pass 1 on (Knaus & Zwicker 2011). */
static void test_radius_shrinks(void)
{
    g_autoptr(view) v = view_of(ROOM);
    for (double alpha = .25; alpha <= 1.0; alpha *= 2.0) {
        g_autofree char *words = g_strdup_printf(
            "passes=5 spp=1 photons=100 radius=.5 indirect_photons=50 alpha=%g", alpha);
        double r2 = .25;
        for (int i = 1; i < 5; i++)
            r2 *= (i - 1.0 + alpha) / i;
        double found = counted(v, words).radius[PHOTON_INDIRECT];
        g_assert_cmpfloat(fabs(found / sqrt(r2) - 1.0), <, 1e-6);
    }
}

/* ---- Photons' ways ---- */

/* A box whose walls reflect what the pass' wavelengths say: of N photons of a light that
   is the same at all of them, so many bounce once. */
#define PAINTED_BOX                                                                      \
    "Camera \"perspective\"\n" SIZE(                                                     \
        2) "WorldBegin Material \"diffuse\" \"spectrum "                                 \
           "reflectance\" [300 .9 550 .9 551 .1 900 .1] Shape \"sphere\" LightSource "   \
           "\"point\" \"spectrum I\" [300 1 900 1]\n"

static void test_roulette(void)
{
    enum { N = 20000 };
    g_autoptr(view) v = view_of(PAINTED_BOX);
    for (int most = 0; most < 2; most++) {
        g_autofree char *words = g_strdup_printf("passes=1 spp=1 indirect_photons=%d "
                                                 "max_forward_bounces=1 radius=.1 "
                                                 "roulette=%s",
                                                 N, most ? "max" : "mean");
        settings how = settings_with(v->scene, words);
        wavelengths w = scene_wavelengths(v->scene, &how, 0);
        double sum = 0.0, largest = 0.0;
        for (int i = 0; i < N_WAVELENGTHS; i++) {
            double rho = w.lambda[i] < 550.5f ? .9 : .1;
            sum += rho / N_WAVELENGTHS;
            largest = MAX(largest, rho);
        }
        double p = most ? largest : sum, sigma = sqrt(p * (1.0 - p) / N);
        double found = (double)counted(v, words).stored[PHOTON_INDIRECT] / N;
        g_test_message("%s: %g bounce, expected %g", words, found, p);
        g_assert_cmpfloat(fabs(found - p), <, 5.0 * sigma + 0.005);
    }
}

/* A clear ball on the way of a few photons: all that meet it are caustic on the walls.
   Aimed at it by area all do, and guided most. */
#define CLEAR_BALL                                                                       \
    ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_WALLS                                       \
                         "LightSource \"point\" \"point3 from\" [0 0 1.8] Material "     \
                         "\"dielectric\" \"float eta\" 1 Translate 0 0 .5 Shape "        \
                         "\"sphere\" \"float radius\" .2\n"

static void test_caustic_emission(void)
{
    const double sine = .2 / 1.3, met = .5 * (1.0 - sqrt(1.0 - sine * sine));
    static const char *const ways[] = {"uniform", "specular-area", "guided"};
    const double least[] = {met * .9, .999, .5}, most[] = {met * 1.1, 1.0, 1.0};
    g_autoptr(view) v = view_of(CLEAR_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *words = g_strdup_printf(
            "passes=1 spp=1 caustic_photons=40000 indirect_photons=10 radius=.1 "
            "max_forward_bounces=2 caustic_emission=%s",
            ways[i]);
        render_statistics n = counted(v, words);
        double found =
            (double)n.stored[PHOTON_CAUSTIC] / (double)n.emitted[PHOTON_CAUSTIC];
        g_test_message("%s: %g of photons land, %g meet the ball", ways[i], found, met);
        g_assert_cmpfloat(found, >=, least[i]);
        g_assert_cmpfloat(found, <=, most[i]);
    }
}

/* Few photons of a bare lamp meet a cup, and fewer are scattered on inside it. */
#define CUP                                                                              \
    ROOM_CAMERA SIZE(16) "WorldBegin LightSource \"point\" \"point3 from\" [0 0 2] "     \
                         "Shape \"sphere\" \"float radius\" .3 \"float zmax\" .1\n"

static void test_emission(void)
{
    g_autoptr(view) v = view_of(CUP);
    static const char *const ways[] = {"uniform", "guided"};
    render_statistics n[2];
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *words = g_strdup_printf(
            "integrator=photonmap passes=1 planned_passes=400 spp=1 radius=.1 "
            "direct_illumination=false direct_photons=20000 indirect_photons=20000 "
            "direct_emission=%s indirect_emission=%s",
            ways[i], ways[i]);
        n[i] = counted(v, words);
    }
    for (int c = PHOTON_DIRECT; c <= PHOTON_INDIRECT; c++) {
        double few = (double)n[0].stored[c], many = (double)n[1].stored[c];
        g_test_message("class %d: %g of 20000 land, guided %g", c, few, many);
        g_assert_cmpfloat(few, >, 0);
        g_assert_cmpfloat(many, >, 30 * few);
    }
}

/* A pane before the sky: what Fresnel's formula lets through at 0°, or all. */
static void test_multiple_samples(void)
{
    const double r = .04, through = (1.0 - r) / (1.0 + r);
    g_autoptr(view) v = view_of("Camera \"orthographic\" " SIZE(
        4) "WorldBegin Material \"diffuse\" \"rgb "
           "reflectance\" [0 0 0] AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" "
           "[1 1 "
           "1] Translate 0 0 5 Rotate 180 0 1 0 Shape \"disk\" \"float radius\" 9 "
           "AttributeEnd "
           "Material \"dielectric\" \"float eta\" 1.5 Translate 0 0 2 Shape "
           "\"trianglemesh\" \"point3 P\" [-3 -3 0 3 -3 0 3 3 0 -3 3 0 -3 -3 1 3 -3 1 3 "
           "3 1 "
           "-3 3 1] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 "
           "2 "
           "3 7 2 7 6 3 0 4 3 4 7]\n");
    g_autoptr(image) split = render_with(v, "integrator=path passes=4 spp=256");
    g_autoptr(image) whole =
        render_with(v, "integrator=path passes=16 spp=1 multiple_samples=off");
    g_test_message("%g of %g; %g", mean_of(split, ""), through, mean_of(whole, ""));
    g_assert_cmpfloat(fabs(mean_of(split, "") - through), <, 0.01);
    g_assert_cmpfloat(fabs(mean_of(whole, "") - 1.0), <, 2e-3);
}

/* ---- Whole renders ---- */

/* Photons stay: what is but their light, on a wall, hardly changes from one seed of the
   camera to another, where other photons change it. */
static void test_camera_seed(void)
{
    g_autoptr(view) v = view_of(ROOM);
    static const char how[] = "direct_illumination=off passes=1 spp=64 photons=300";
    g_autofree char *eye = g_strconcat(how, " camera_seed=8", NULL);
    g_autofree char *all = g_strconcat(how, " seed=8", NULL);
    g_autoptr(image) a = render_with(v, how), b = render_with(v, eye);
    g_autoptr(image) c = render_with(v, all);
    double of_eye = 0.0, of_all = 0.0;
    for (size_t i = 0; i < pixels_of(a); i++) {
        of_eye += pow(luminance_at(a, i) - luminance_at(b, i), 2.0);
        of_all += pow(luminance_at(a, i) - luminance_at(c, i), 2.0);
    }
    g_test_message("%g, %g", of_eye, of_all);
    g_assert_cmpfloat(of_eye, >, 0.0);
    g_assert_cmpfloat(of_eye, <, 0.1 * of_all);
}

static void test_seed(void)
{
    g_autoptr(view) v = view_of(ROOM);
    g_autoptr(image) a = render_with(v, "integrator=path passes=1 spp=16 seed=7");
    g_autoptr(image) b = render_with(v, "integrator=path passes=1 spp=16 seed=7");
    g_autoptr(image) c = render_with(v, "integrator=path passes=1 spp=16 seed=8");
    assert_same_bits(a, b);
    size_t n_same = 0;
    for (size_t i = 0; i < pixels_of(a); i++)
        n_same += memcmp(&a->pixels[i * (size_t)a->n_channels],
                         &c->pixels[i * (size_t)a->n_channels], 3 * sizeof(float)) == 0;
    g_assert_cmpuint(n_same, <, pixels_of(a) / 4); /* the lamp is the same */
    g_assert_cmpfloat(fabs(mean_of(a, "") / mean_of(c, "") - 1.0), <, 0.1);
}

/* Paths do not find what a point throws through glass. */
static void test_integrator(void)
{
    g_autoptr(view) v =
        view_of(ROOM_CAMERA SIZE(16) "WorldBegin LightSource \"point\" "
                                     "\"point3 from\" [1 0 1.7]\n" ROOM_WALLS GLASS_BALL);
    static const char *const names[] = {"auto", "photonmap", "path", "vcm"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *words =
            g_strdup_printf("integrator=%s passes=1 spp=4 photons=2000", names[i]);
        settings how = settings_with(v->scene, words);
        g_assert_cmpstr(transport_find(how.integrator)->name, ==, names[i]);
        render_statistics n = counted(v, words);
        g_assert_true((n.photon_rays > 0) == (strcmp(names[i], "path") != 0));
        g_assert_true((n.stored[PHOTON_INDIRECT] > 0) == (i % 2 == 1));
        g_assert_true((n.stored[PHOTON_CAUSTIC] > 0) == (i < 2));
    }
}

/* ---- All of them ---- */

#define PROFILES                                                                         \
    "/knob-pictures/profile/direct /knob-pictures/profile/indirect "                     \
    "/knob-pictures/profile/caustic"

static const struct {
    const char *name;
    const char *proofs; /* a test here or elsewhere, each */
} meanings[] = {
    {"integrator", "/knob-meanings/integrator"},
    {"passes", "/knob-meanings/samples /knob-meanings/part"},
    {"time", "/render/stop/time"},
    {"noise", "/render/stop/noise"},
    {"planned_passes", "/pace/plans /pace/together"},
    {"spp", "/knob-meanings/samples"},
    {"first_spp", "/knob-meanings/first-pass"},
    {"max_backward_bounces", "/knob-meanings/bounces"},
    {"max_forward_bounces", "/knob-meanings/bounces"},
    {"final_gather", "/transport/furnace/final-gather"},
    {"gather_rays", "/knob-meanings/gather-rays"},
    {"precompute_radiance", "/transport/irradiance-cache"},
    {"direct_illumination", "/knob-meanings/photons"},
    {"shadow_rays", "/transport/shadow-rays"},
    {"photons", "/knob-meanings/photons"},
    {"direct_photons", "/knob-meanings/photons"},
    {"indirect_photons", "/knob-meanings/photons"},
    {"caustic_photons", "/knob-meanings/photons"},
    {"photons_per_light", "/presets/by-light"},
    {"one_map", "/presets/one-map"},
    {"photon_lobes", "/presets/lobes"},
    {"photon_survivors", "/presets/survivors"},
    {"direct_nearest", "/knob-pictures/profile/direct"},
    {"indirect_nearest", "/knob-pictures/profile/indirect"},
    {"caustic_nearest", "/knob-pictures/profile/caustic"},
    {"radius", PROFILES},
    {"one_radius", "/presets/one-radius"},
    {"direct_kernel", "/knob-pictures/profile/direct"},
    {"indirect_kernel", "/knob-pictures/profile/indirect"},
    {"caustic_kernel", "/knob-pictures/profile/caustic"},
    {"direct_cone_k", "/knob-pictures/profile/direct"},
    {"indirect_cone_k", "/knob-pictures/profile/indirect"},
    {"caustic_cone_k", "/knob-pictures/profile/caustic"},
    {"photon_map", "/transport/maps"},
    {"flatten", "/estimate/flatten"},
    {"edges", "/knob-pictures/edges"},
    {"bright_spots", "/spots/density /spots/layers"},
    {"gather_indirect", "/gather/pays/room /gather/converges"},
    {"time_slices", "/knob-pictures/time-slices"},
    {"roulette", "/knob-meanings/roulette"},
    {"direct_emission", "/knob-meanings/emission"},
    {"indirect_emission", "/knob-meanings/emission"},
    {"caustic_emission", "/knob-meanings/caustic-emission"},
    {"multiple_samples", "/knob-meanings/multiple-samples"},
    {"vcm_strategies", "/vcm/strategies"},
    {"alpha", "/knob-meanings/alpha"},
    {"denoise", "/film-denoise/raw-stays /film-denoise/less-noise"},
    {"denoise_windows", "/film-denoise/windows /pace/windows"},
    {"seed", "/knob-meanings/seed"},
    {"camera_seed", "/knob-meanings/camera-seed"},
    {"threads", "/base/parallel/once /transport/threads"},
};

static const struct {
    const char *path;
    GTestFunc run;
} own[] = {
    {"/knob-meanings/bounces", test_bounces},
    {"/knob-meanings/samples", test_samples},
    {"/knob-meanings/part", test_part},
    {"/knob-meanings/first-pass", test_first_pass},
    {"/knob-meanings/gather-rays", test_gather_rays},
    {"/knob-meanings/photons", test_photons},
    {"/knob-meanings/alpha", test_radius_shrinks},
    {"/knob-meanings/roulette", test_roulette},
    {"/knob-meanings/emission", test_emission},
    {"/knob-meanings/caustic-emission", test_caustic_emission},
    {"/knob-meanings/multiple-samples", test_multiple_samples},
    {"/knob-meanings/seed", test_seed},
    {"/knob-meanings/camera-seed", test_camera_seed},
    {"/knob-meanings/integrator", test_integrator},
};

static bool is_own(const char *path)
{
    for (size_t i = 0; i < G_N_ELEMENTS(own); i++)
        if (strcmp(own[i].path, path) == 0)
            return true;
    return false;
}

/* True if tests/ROOM/test_NAME.c has the test /NAME/... */
static bool is_elsewhere(const char *path)
{
    bool found = false;
    g_auto(GStrv) parts = g_strsplit(path + 1, "/", 2);
    g_autofree char *file =
        g_strdup_printf("test_%s.c", g_strdelimit(parts[0], "-", '_'));
    g_autofree char *quoted = g_strdup_printf("\"%s\"", path);
    g_autoptr(GDir) rooms = g_dir_open(SOURCE_ROOT "/tests", 0, NULL);
    for (const char *room; (room = g_dir_read_name(rooms)) && !found;) {
        g_autofree char *name = g_build_filename(SOURCE_ROOT "/tests", room, file, NULL);
        g_autofree char *text = NULL;
        if (g_file_get_contents(name, &text, NULL, NULL))
            found = strstr(text, quoted) != NULL;
    }
    return found;
}

static const char *proofs_of(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(meanings); i++)
        if (strcmp(meanings[i].name, name) == 0)
            return meanings[i].proofs;
    return "";
}

static void test_none_is_without(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    g_assert_cmpuint(n, ==, G_N_ELEMENTS(meanings));
    for (size_t i = 0; i < n; i++) {
        g_auto(GStrv) proofs = g_strsplit(proofs_of(rows[i].name), " ", -1);
        if (!proofs[0])
            g_error("nothing proves what %s means", rows[i].name);
        for (char **path = proofs; *path; path++)
            if (!is_own(*path) && !is_elsewhere(*path))
                g_error("%s: there is no test %s", rows[i].name, *path);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/knob-meanings/all", test_none_is_without);
    for (size_t i = 0; i < G_N_ELEMENTS(own); i++)
        g_test_add_func(own[i].path, own[i].run);
    return g_test_run();
}
