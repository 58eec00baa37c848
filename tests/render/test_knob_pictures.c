/*
 * Settings of the estimate, by what pictures they make: kernels and their radii are seen
 * as they are where all light comes down at one place; floors that move or end are lit as
 * closed forms say.
 */
#include "rooms.h"

/* ---- A spike of light on a floor ---- */

/* All light of a tiny lamp comes down at one place, so that a picture of the floor from
   above is the kernel itself: L(d) = ρ/π Φ κ(d). A sheet below the lamp decides what
   class of photons it is: none, clear glass, or paper that lets all light through. */
#define FROM_ABOVE                                                                       \
    "LookAt 0 0 5  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" "         \
    "[-.5 .5 -.5 .5]\n" SIZE(16) "WorldBegin\n"
#define FLOOR                                                                            \
    "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"trianglemesh\" "        \
    "\"point3 P\" [-3 -3 0 3 -3 0 3 3 0 -3 3 0] \"integer indices\" [0 1 2 0 2 3]\n"
#define SPIKE                                                                            \
    "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 0 "     \
    ".002 "                                                                              \
    "Rotate 180 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [79577.47 79577.47 "         \
    "79577.47] Shape \"disk\" \"float radius\" .002 AttributeEnd\n"
#define SHEET(material)                                                                  \
    "Material " material " Translate 0 0 .001 Shape \"disk\" \"float radius\" .03\n"
/* π L times the area of the lamp. */
#define FLUX (G_PI * G_PI * 79577.47 * .002 * .002)
#define REFLECTED (.5 / G_PI)

static const struct {
    const char *name, *text, *also;
} classes[N_PHOTON_CLASSES] = {
    {"direct", FROM_ABOVE FLOOR SPIKE, "direct_illumination=off "},
    {"indirect",
     FROM_ABOVE FLOOR SPIKE SHEET("\"diffusetransmission\" \"rgb reflectance\" [0 0 0] "
                                  "\"rgb transmittance\" [1 1 1]"),
     ""},
    {"caustic", FROM_ABOVE FLOOR SPIKE SHEET("\"dielectric\" \"float eta\" 1"), ""},
};

/* The place under a point of the film. */
static vec3 floor_at(const view *v, float x, float y)
{
    ray r = camera_ray(&v->camera, (vec2){x, y}, (vec2){.5f, .5f}, 0.0f);
    return r.origin - r.direction * (r.origin[2] / r.direction[2]);
}

typedef struct profile {
    const char *kernel;
    double cone_k, radius, nearest;
} profile;

/* κ by its definition, but for a factor. */
static double shape_of(const profile *f, double d)
{
    double t = d / f->radius, beta = 1.953;
    if (t > 1.0)
        return 0.0;
    if (strcmp(f->kernel, "cone") == 0)
        return 1.0 - t / f->cone_k;
    if (strcmp(f->kernel, "gaussian") == 0)
        return 1.0 - (1.0 - exp(-beta * t * t / 2.0)) / (1.0 - exp(-beta));
    return strcmp(f->kernel, "constant") == 0 ? 1.0 : 1.0 - t * t;
}

static double integral_of(const profile *f)
{
    enum { STEPS = 2000 };
    double sum = 0.0, step = f->radius / STEPS;
    for (int i = 0; i < STEPS; i++)
        sum += shape_of(f, (i + 0.5) * step) * 2.0 * G_PI * (i + 0.5) * step * step;
    return sum;
}

enum { SPIKE_PHOTONS = 500 };

/* What an estimate at distance d from all photons gives; by the k nearest all of them are
   as far away as the k-th, which only tells how far. */
static double expected_at(const profile *f, double integral, double d)
{
    double near = (f->nearest - 1.0) / SPIKE_PHOTONS / (G_PI * d * d);
    return REFLECTED * FLUX * (f->nearest > 0.0 ? near : shape_of(f, d) / integral);
}

/* Below the lamp nothing is seen of the floor. */
#define HIDDEN .1

/* The root of the mean square difference over that of the picture. */
static double difference(const view *v, const image *img, const char *layer,
                         const profile *f)
{
    g_autofree char *name = g_strconcat(layer, ".G", NULL);
    size_t channel = channel_of(img, name);
    double integral = integral_of(f), sum = 0.0, sum2 = 0.0;
    for (size_t i = 0; i < pixels_of(img); i++) {
        enum { SUB = 8 };
        double expected = 0.0, least = HUGE_VAL;
        for (int k = 0; k < SUB * SUB; k++) {
            float x = (float)(i % (size_t)img->width) + ((float)(k % SUB) + .5f) / SUB;
            float y = (float)(i / (size_t)img->width) + ((float)(k / SUB) + .5f) / SUB;
            double d = (double)length3(floor_at(v, x, y));
            least = MIN(least, d);
            expected += expected_at(f, integral, d) / (SUB * SUB);
        }
        if (least < HIDDEN)
            continue;
        double error = at(img, i, channel) - expected;
        sum += error * error;
        sum2 += expected * expected;
    }
    return sqrt(sum / sum2);
}

/* Pixels that the rim of a kernel crosses have noise of their own, 3 % in all. */
static void check_profile(photon_class c, const profile *f)
{
    const char *name = classes[c].name;
    g_autoptr(view) v = view_of(classes[c].text);
    g_autofree char *words = g_strdup_printf(
        "integrator=photonmap passes=1 spp=16 photons=100 edges=off alpha=1 "
        "caustic_emission=uniform "
        "%s%s_photons=%d radius=%g %s_kernel=%s %s_cone_k=%g %s_nearest=%g",
        classes[c].also, name, SPIKE_PHOTONS, f->radius, name, f->kernel, name, f->cone_k,
        name, f->nearest);
    g_autoptr(image) img = render_with(v, words);
    double found = difference(v, img, name, f);
    g_test_message("%s: %.4f", words, found);
    g_assert_cmpfloat(found, <, 0.05);
}

static void test_profile(gconstpointer data)
{
    static const profile profiles[] = {
        {"constant", 1.0, .3, 0},     {"cone", 1.0, .3, 0},
        {"cone", 1.7, .3, 0},         {"gaussian", 1.0, .3, 0},
        {"epanechnikov", 1.0, .3, 0}, {"epanechnikov", 1.0, .4, 0},
        {"constant", 1.0, 2, 201},    {"constant", 1.0, 2, 301},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(profiles); i++)
        check_profile((photon_class)GPOINTER_TO_INT(data), &profiles[i]);
}

/* ---- Time ---- */

/* A floor on its way beneath the spike: in each of n slices photons and what is seen are
   apart by the difference of two times in it, which has a variance of 1/6 of its length's
   square; the constant kernel adds r²/4, and a column of pixels a 12th of its square. */
static void test_time_slices(void)
{
    const double way = .3, radius = .1, column = 1.0 / 16;
    g_autoptr(view) v =
        view_of(FROM_ABOVE SPIKE "ActiveTransform EndTime Translate .3 0 0 "
                                 "ActiveTransform All " FLOOR);
    for (int n = 1; n <= 4; n *= 2) {
        g_autofree char *words = g_strdup_printf(
            "integrator=photonmap passes=2 spp=64 photons=100 edges=off alpha=1 "
            "radius=%g "
            "direct_illumination=off direct_photons=4000 direct_kernel=constant "
            "time_slices=%d",
            radius, n);
        g_autoptr(image) img = render_with(v, words);
        double sum = 0.0, moment = 0.0;
        for (size_t i = 0; i < pixels_of(img); i++) {
            double x = (double)floor_at(v, (float)(i % 16) + .5f, 8.0f)[0];
            double value = at(img, i, channel_of(img, "direct.G"));
            sum += value;
            moment += value * x * x;
        }
        double slice = way / n, expected = slice * slice / 6.0 + radius * radius / 4.0 +
                                           column * column / 12.0;
        g_test_message("%d slices: %g, expected %g", n, moment / sum, expected);
        g_assert_cmpfloat(fabs(moment / sum / expected - 1.0), <, 0.04);
    }
}

/* ---- Edges ---- */

/* A floor that ends at x = -.3, evenly lit: within the radius of its end a part of the
   disc has no photons. */
#define ENDING_FLOOR                                                                     \
    "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"trianglemesh\" "        \
    "\"point3 P\" [-.3 -1 0 1 -1 0 1 1 0 -.3 1 0] \"integer indices\" [0 1 2 0 2 3]\n"   \
    "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n"

/* Mean of the picture between two columns. */
static double columns(const image *img, size_t begin, size_t end)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels_of(img); i++) {
        size_t x = i % (size_t)img->width;
        sum += x >= begin && x < end ? at(img, i, channel_of(img, "G")) : 0.0;
    }
    return sum / (double)(end - begin) / img->height;
}

static void test_edges(void)
{
    enum { STEPS = 1000 };
    const double radius = .1;
    double lit = 0.0;
    for (int i = 0; i < STEPS; i++) { /* of the disc, from the edge to a radius away */
        double h = (i + .5) / STEPS;
        lit += (1.0 - (acos(h) - h * sqrt(1.0 - h * h)) / G_PI) / STEPS;
    }
    /* A square picture has 20 columns of 5 cm: the floor begins with the fifth. */
    g_autoptr(view) v = view_of(FROM_ABOVE ENDING_FLOOR);
    view_resize(v, 20, 20);
    for (int on = 0; on < 2; on++) {
        g_autofree char *words = g_strdup_printf(
            "integrator=photonmap passes=4 spp=16 photons=100 direct_illumination=off "
            "alpha=1 "
            "direct_photons=40000 direct_kernel=constant radius=%g edges=%s",
            radius, on ? "on" : "off");
        g_autoptr(image) img = render_with(v, words);
        double left = columns(img, 4, 6), right = columns(img, 14, 16);
        bool mirrored = columns(img, 0, 4) > 0.0; /* x to the left */
        double inner = columns(img, 8, 12);
        double found = (mirrored ? right : left) / inner, expected = on ? 1.0 : lit;
        g_test_message("edges %d: %g, expected %g", on, found, expected);
        g_assert_cmpfloat(fabs(found / expected - 1.0), <, 0.04);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_data_func("/knob-pictures/profile/direct", GINT_TO_POINTER(PHOTON_DIRECT),
                         test_profile);
    g_test_add_data_func("/knob-pictures/profile/indirect",
                         GINT_TO_POINTER(PHOTON_INDIRECT), test_profile);
    g_test_add_data_func("/knob-pictures/profile/caustic",
                         GINT_TO_POINTER(PHOTON_CAUSTIC), test_profile);
    g_test_add_func("/knob-pictures/time-slices", test_time_slices);
    g_test_add_func("/knob-pictures/edges", test_edges);
    return g_test_run();
}
