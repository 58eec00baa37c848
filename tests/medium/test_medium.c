/*
 * medium: light that passes a slab of coloured glass, by Fresnel's series and
 * Beer-Lambert's law, for camera paths and for photons, in every transport; solids in
 * solids, the eye and the lamp in solids; and what is read, and refused.
 */
#include "rooms.h"

#include "bsdf/fresnel.h"
#include "medium/medium.h"
#include "photon/trace/trace.h"

/* A slab 0.5 thick and wide enough to have no edges, before a lamp that fills the view.
   The camera looks straight through it. */
#define SLAB(material)                                                                   \
    "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 2\n" SIZE(         \
        4) "WorldBegin\n"                                                                \
           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material "      \
           "\"diffuse\" \"rgb reflectance\" [0 0 0] ReverseOrientation Translate 0 0 2 " \
           "Shape \"disk\" \"float radius\" 9 AttributeEnd\n"                            \
           "Material " material                                                          \
           "Shape \"trianglemesh\" \"point3 P\" [-90 -90 0 90 -90 0 90 90 0 -90 90 0 "   \
           "-90 -90 .5 90 -90 .5 90 90 .5 -90 90 .5] \"integer indices\" [0 2 1 0 3 2 "  \
           "4 5 6 4 6 7]\n"

/* T = (1-R)² τ / (1 - R² τ²), straight through. */
static double slab_transmittance(double eta, double tau)
{
    double r = (double)fresnel_dielectric(1.0f, (float)eta);
    return (1.0 - r) * (1.0 - r) * tau / (1.0 - r * r * tau * tau);
}

static double seen_through(const char *text, const char *how)
{
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) img = render_with(v, how);
    return mean_of(img, "");
}

static void check_slab(const char *text, double tau, const char *how)
{
    double open = seen_through(SLAB("\"interface\"\n"), how);
    double seen = seen_through(text, how) / open, expected = slab_transmittance(1.5, tau);
    g_test_message("%s: %.4f of %.4f, expected %.4f", how, seen, open, expected);
    g_assert_cmpfloat(fabs(seen / expected - 1.0), <, 0.01);
}

#define GREY "\"dielectric\" \"spectrum absorption\" [300 3 900 3]\n"
#define COLOR                                                                            \
    "\"dielectric\" \"rgb attenuationcolor\" [.25 .25 .25] \"float "                     \
    "attenuationdistance\" "                                                             \
    "0.25\n"

static void test_camera_paths(void)
{
    static const char *const transports[] = {"photonmap", "path", "vcm"};
    for (size_t i = 0; i < G_N_ELEMENTS(transports); i++) {
        g_autofree char *how =
            g_strdup_printf("integrator=%s spp=500 passes=1 photons=1000", transports[i]);
        check_slab(SLAB(GREY), exp(-1.5), how);
        check_slab(SLAB(COLOR), 0.25 * 0.25, how);
        check_slab(SLAB("\"dielectric\"\n"), 1.0, how);
    }
}

/* W that all photons of the task bring. */
static double flux_of(const trace_task *task)
{
    trace_result result;
    g_assert_true(photon_trace(task, false, &result, NULL));
    double flux = 0.0;
    for (size_t i = 0; i < result.photons.n; i++)
        flux += (double)spectrum_mean(result.photons.flux[i]);
    trace_result_clear(&result);
    return flux;
}

/* A floor behind the slab, lit by a beam: what arrives is the slab's transmittance. */
static void test_photons(void)
{
    g_autoptr(scene) s =
        scene_of("LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\"\n" SIZE(
            4) "WorldBegin\n"
               "LightSource \"distant\" \"point3 from\" [0 0 0] \"point3 to\" [0 0 1]\n"
               "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
               "AttributeBegin Translate 0 0 2 Shape \"disk\" \"float radius\" 1 "
               "AttributeEnd\n"
               "Material " GREY "Shape \"trianglemesh\" \"point3 P\" [-2 -2 0 2 -2 0 2 2 "
               "0 -2 2 0 -2 -2 .5 2 -2 "
               ".5 2 2 .5 -2 2 .5] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7]\n");
    settings how = s->settings;
    g_autoptr(caustic_casters) casters = caustic_casters_new(s, NULL);
    trace_task task = {.scene = s,
                       .how = &how,
                       .w = wavelengths_at(0.5f),
                       .photon_class = PHOTON_CAUSTIC,
                       .casters = casters,
                       .n_photons = 100000};
    const light *l = scene_light(s, 0);
    light_sample to;
    g_assert_true(l->kind->sample(l->self, &task.w, vec3_make(0, 0, 2), 0.5f,
                                  (vec2){0.5f, 0.5f}, &to));
    double sky = (double)spectrum_mean(to.radiance) * G_PI;
    double seen = flux_of(&task) / sky;
    double expected = slab_transmittance(1.5, exp(-1.5));
    g_test_message("photons: %.4f, expected %.4f", seen, expected);
    /* 17000 photons of about one weight: a deviation of 0.8 %. */
    g_assert_cmpfloat(fabs(seen / expected - 1.0), <, 0.045);
}

/* ---- Solids in solids: all of index 1, so that light goes straight through ---- */

#define SOLID(half, near, far, absorption)                                               \
    "Material \"dielectric\" \"float eta\" 1 \"spectrum absorption\" [300 " absorption   \
    " 900 " absorption "] Shape \"trianglemesh\" \"point3 P\" [-" half " -" half         \
    " " near " " half " -" half " " near " " half " " half " " near " -" half " " half   \
    " " near " -" half " -" half " " far " " half " -" half " " far " " half " " half    \
    " " far " -" half " " half " " far                                                   \
    "] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 "                          \
    "4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7]\n"
#define FROM(z)                                                                          \
    "LookAt 0 0 " z "  0 0 9  0 1 0 Camera \"perspective\" \"float fov\" 2\n" SIZE(      \
        4) "WorldBegin\n"                                                                \
           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material "      \
           "\"diffuse\" \"rgb reflectance\" [0 0 0] ReverseOrientation Translate 0 0 2 " \
           "Shape \"disk\" \"float radius\" 9 AttributeEnd\n"

typedef struct nest {
    const char *what, *eye, *text;
    double depth; /* Σ absorption × length between the eye at -3 and the lamp at 2 */
} nest;

static const nest nests[] = {
    {"one within another", FROM("-3"),
     SOLID("60", "0", "1", "1") SOLID("50", ".3", ".5", "4"), 0.8 + 0.8},
    {"the inner one first", FROM("-3"),
     SOLID("50", ".3", ".5", "4") SOLID("60", "0", "1", "1"), 0.8 + 0.8},
    {"clear within coloured", FROM("-3"),
     SOLID("60", "0", "1", "1") SOLID("50", ".3", ".5", "0"), 0.8},
    {"three deep", FROM("-3"),
     SOLID("60", "0", "1", "1") SOLID("50", ".2", ".8", ".5")
         SOLID("40", ".4", ".5", "3"),
     0.4 + 0.25 + 0.3},
    {"the smaller reaches into the larger", FROM("-3"),
     SOLID("60", "0", ".5", "1") SOLID("50", ".4", ".9", "2"), 0.4 + 1.0},
    {"the same, seen from the other side", FROM("-3"),
     SOLID("50", "0", ".5", "2") SOLID("60", ".4", ".9", "1"), 1.0 + 0.4},
    {"the eye within", FROM(".25"), SOLID("60", "0", "1", "1"), 0.75},
    {"the eye within two", FROM(".25"),
     SOLID("60", "0", "1", "1") SOLID("50", ".2", ".5", "2"), 0.5 + 0.5},
    {"the lamp within", FROM("-3"), SOLID("60", "1", "3", "1"), 1.0},
    {"both within", FROM("1.5"), SOLID("60", "1", "3", "1"), 0.5},
};

/* Roulette ends some paths: of 1600 a deviation of 1.5 %. */
static void test_nests(void)
{
    static const char *const transports[] = {"photonmap", "path", "vcm", "auto"};
    for (size_t i = 0; i < G_N_ELEMENTS(nests); i++)
        for (size_t k = 0; k < G_N_ELEMENTS(transports); k++) {
            const nest *n = &nests[i];
            g_autofree char *how = g_strdup_printf(
                "integrator=%s spp=100 passes=1 photons=500", transports[k]);
            g_autofree char *text = g_strconcat(n->eye, n->text, NULL);
            double seen = seen_through(text, how) / seen_through(n->eye, how);
            g_test_message("%s, %s: %.4f, expected %.4f", n->what, transports[k], seen,
                           exp(-n->depth));
            g_assert_cmpfloat(fabs(seen / exp(-n->depth) - 1.0), <, 0.09);
        }
}

/* A lamp within, whose narrow beam leaves to a floor; and one whose beam comes from
   without and ends on a floor within. */
static double beam_through(const char *from, const char *bodies, const char *floor)
{
    g_autofree char *text = g_strdup_printf(
        "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\"\n" SIZE(
            4) "WorldBegin\n"
               "LightSource \"spot\" \"point3 from\" [0 0 %s] \"point3 to\" [0 0 9] "
               "\"float coneangle\" 2 \"float conedeltaangle\" 1\n"
               "AttributeBegin Material \"diffuse\" Translate 0 0 %s Shape \"disk\" "
               "\"float radius\" 4 AttributeEnd\n%s",
        from, floor, bodies);
    g_autoptr(scene) s = scene_of(text);
    settings how = s->settings;
    how.class_emission[PHOTON_CAUSTIC] = EMISSION_UNIFORM;
    g_autoptr(caustic_casters) casters = caustic_casters_new(s, NULL);
    trace_task task = {.scene = s,
                       .how = &how,
                       .w = wavelengths_at(0.5f),
                       .photon_class = PHOTON_CAUSTIC,
                       .casters = casters,
                       .n_photons = 2000};
    const light *l = scene_light(s, 0);
    return flux_of(&task) / (double)spectrum_mean(l->kind->power(l->self, &task.w));
}

static void test_photons_in_nests(void)
{
    static const struct {
        const char *from, *bodies, *floor;
        double depth;
    } cases[] = {
        {"-3", SOLID("60", "0", "1", "1") SOLID("50", ".3", ".5", "4"), "2", 1.6},
        {"-3", SOLID("60", "0", ".5", "1") SOLID("50", ".4", ".9", "2"), "2", 1.4},
        {"-3", SOLID("50", "0", ".5", "2") SOLID("60", ".4", ".9", "1"), "2", 1.4},
        {".25", SOLID("60", "0", "1", "1"), "2", 0.75},
        {".25", SOLID("60", "0", "1", "1") SOLID("50", ".2", ".5", "2"), "2", 1.0},
        {"-3", SOLID("60", "0", "4", "1"), "2", 2.0},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        double left = beam_through(cases[i].from, cases[i].bodies, cases[i].floor);
        g_test_message("%zu: %.4f, expected %.4f", i, left, exp(-cases[i].depth));
        g_assert_cmpfloat(fabs(left / exp(-cases[i].depth) - 1.0), <, 0.003);
    }
}

/* ---- Light from beyond ---- */

/* W that direct photons bring to all surfaces. */
static double direct_flux(const char *text)
{
    g_autoptr(scene) s = scene_of(text);
    settings how = s->settings;
    trace_task task = {.scene = s,
                       .how = &how,
                       .w = wavelengths_at(0.5f),
                       .photon_class = PHOTON_DIRECT,
                       .n_photons = 500000};
    return flux_of(&task);
}

/* The camera is in water, as far as that goes; the sun stands above. */
#define WATER(sigma_a)                                                                   \
    "MakeNamedMedium \"water\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" "    \
    "[300 " sigma_a " 900 " sigma_a "] \"spectrum sigma_s\" [300 0 900 0]\n"             \
    "MediumInterface \"\" \"water\"\n"
#define SUN                                                                              \
    "WorldBegin LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n"
#define WALL "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "

/* A tank 2 m deep, between walls that water is said to be behind, too. */
#define TANK(sigma_a)                                                                    \
    WATER(sigma_a)                                                                       \
    "LookAt 0 -1 1  0 0 1  0 0 1 Camera \"perspective\"\n" SUN                           \
    "MediumInterface \"water\" \"\" Material \"interface\"\n" WALL                       \
    "[-2 -2 2 2 -2 2 2 2 2 -2 2 2]\n"                                                    \
    "MediumInterface \"water\" \"water\" Material \"diffuse\"\n" WALL                    \
    "[-2 -2 0 2 -2 0 2 2 0 -2 2 0]\n" WALL "[-2 -2 0 2 -2 0 2 -2 2 -2 -2 2]\n" WALL      \
    "[-2 2 0 2 2 0 2 2 2 -2 2 2]\n" WALL "[-2 -2 0 -2 2 0 -2 2 2 -2 -2 2]\n" WALL        \
    "[2 -2 0 2 2 0 2 2 2 2 -2 2]\n"

/* A stone; what holds the camera has a radius of 1 m, and water that nothing bounds ends
   at twice that. */
#define SEA(sigma_a)                                                                     \
    WATER(sigma_a)                                                                       \
    "LookAt 0 0 1  0 0 0  0 1 0 Camera \"perspective\"\n" SUN                            \
    "MediumInterface \"water\" \"water\" Shape \"disk\" \"float radius\" .01\n"

/* Where light from beyond comes in is what the boundary that it meets says is outside,
   not what lies behind walls that the camera cannot see through; and it comes through all
   of a medium that has no bounds. */
static void test_beyond(void)
{
    static const char *const waters[][2] = {{TANK(".5"), TANK("0")},
                                            {SEA(".5"), SEA("0")}};
    for (size_t i = 0; i < G_N_ELEMENTS(waters); i++) {
        double left = direct_flux(waters[i][0]) / direct_flux(waters[i][1]);
        g_test_message("%.4f, expected %.4f", left, exp(-1.0));
        g_assert_cmpfloat(fabs(left / exp(-1.0) - 1.0), <, 0.01);
    }
}

/* A stone below the middle of a sky's portal, which is .5 m above; from .49 m on there is
   water. */
#define HATCH(sigma_a, more)                                                             \
    WATER(sigma_a)                                                                       \
    "LookAt 0 0 1  0 0 0  0 1 0 Camera \"perspective\" WorldBegin\n"                     \
    "LightSource \"infinite\" \"point3 portal\" [-.01 -.01 .5 -.01 .01 .5 .01 .01 .5 "   \
    ".01 -.01 .5] \"rgb L\" [1 1 1]\n"                                                   \
    "Material \"interface\" Shape \"disk\" \"float height\" .49 \"float radius\" .1\n"   \
    "MediumInterface \"\" \"\" Material \"diffuse\" Shape \"disk\" \"float radius\" "    \
    ".01\n" more
#define PLATE(height) "Shape \"disk\" \"float radius\" .1 \"float height\" " height

/* What lies before a portal only takes light away: a plate gets none and leaves none,
   water leaves what Beer and Lambert say. */
static void test_before_portal(void)
{
    g_autoptr(scene) s = scene_of(HATCH(".5", ""));
    double clear = direct_flux(HATCH("0", ""));
    double water = (double)(s->center[2] + s->media_radius) - 0.49;
    double left = direct_flux(HATCH(".5", "")) / clear, expected = exp(-0.5 * water);
    g_test_message("%.4f, expected %.4f", left, expected);
    g_assert_cmpfloat(fabs(left / expected - 1.0), <, 0.02);
    g_assert_cmpfloat(direct_flux(HATCH("0", PLATE(".6"))), ==, 0.0);
    g_assert_cmpfloat(direct_flux(HATCH("0", PLATE(".3"))), >, clear);
}

/* ---- What is refused ---- */

static void refuse(const char *glass, const char *message)
{
    g_autofree char *text = g_strdup_printf(SLAB("%s\n"), glass);
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(f.main, 1, NULL, &error));
    g_assert_nonnull(strstr(error->message, message));
    folder_remove(&f);
}

static void test_refused(void)
{
    refuse("\"dielectric\" \"rgb attenuationcolor\" [1 1 1]", "needs an 'attenuationd");
    refuse("\"dielectric\" \"float attenuationdistance\" 1", "needs an 'attenuationc");
    refuse("\"dielectric\" \"rgb attenuationcolor\" [1 1 1] \"float "
           "attenuationdistance\" 0",
           "expected a length > 0, found 0");
    refuse("\"dielectric\" \"spectrum absorption\" [300 -1 900 1]",
           "expected numbers >= 0");
    refuse("\"thindielectric\" \"spectrum absorption\" [300 1 900 1]",
           "unknown parameter 'absorption'");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/medium/camera-paths", test_camera_paths);
    g_test_add_func("/medium/photons", test_photons);
    g_test_add_func("/medium/nests", test_nests);
    g_test_add_func("/medium/photons-in-nests", test_photons_in_nests);
    g_test_add_func("/medium/beyond", test_beyond);
    g_test_add_func("/medium/before-portal", test_before_portal);
    g_test_add_func("/medium/refused", test_refused);
    return g_test_run();
}
