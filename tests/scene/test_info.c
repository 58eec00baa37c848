/*
 * info: what is warned of, and what is not.
 */
#include "api/describe/describe.h"
#include "json_check.h"
#include "nephroid/nephroid.h"
#include "scene_text.h"

#define HEAD                                                                             \
    "LookAt 0 -9 2  0 0 0  0 0 1 Camera \"perspective\" WorldBegin\n"                    \
    "LightSource \"point\" \"point3 from\" [0 0 0]\n"
#define CORNERS "\"point3 P\" [1 1 1 2 1 1 1 2 1 1 1 2] "
#define BODY                                                                             \
    "Shape \"trianglemesh\" " CORNERS "\"integer indices\" [0 2 1 0 1 3 0 3 2 1 2 3]\n"
#define INWARD                                                                           \
    "Shape \"trianglemesh\" " CORNERS "\"integer indices\" [0 1 2 0 3 1 0 2 3 1 3 2]\n"
#define OPEN "Shape \"trianglemesh\" " CORNERS "\"integer indices\" [0 2 1 0 1 3 0 3 2]\n"
#define GLASS "Material \"dielectric\" "
#define SOLID "Material \"gltf\" \"float transmission\" 1 \"bool thin\" false "
#define MATT "Material \"diffuse\" "

static void check_warnings(const char *text, const char *expected)
{
    g_autoptr(view) v = view_of(text);
    g_autoptr(GPtrArray) warnings = describe_warnings(v);
    const char *found = warnings->len ? warnings->pdata[0] : NULL;
    g_test_message("%s: %s", text, found ? found : "nothing");
    g_assert_cmpuint(warnings->len, ==, expected != NULL);
    if (expected)
        g_assert_nonnull(strstr(found, expected));
}

static void check(const char *world, const char *expected)
{
    g_autofree char *text = g_strconcat(HEAD, world, NULL);
    check_warnings(text, expected);
}

static void test_glass(void)
{
    check(GLASS BODY, NULL);
    check(GLASS "Scale -1 1 1 " BODY, NULL);
    check(GLASS OPEN, "of solid glass ('dielectric') is open");
    check(SOLID OPEN, "is open");
    check(MATT OPEN, NULL);
    check("Material \"thindielectric\" " OPEN, NULL);
    check(GLASS INWARD, "is inside out");
    check(GLASS "ReverseOrientation " BODY, "is inside out");
    check(GLASS "ReverseOrientation " INWARD, NULL);
}

#define BOX                                                                              \
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0 -1 -1 1 1 -1 1 1 " \
    "1 "                                                                                 \
    "1 -1 1 1] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 "  \
    "3 7 "                                                                               \
    "2 7 6 3 0 4 3 4 7]\n"
#define TABLE(z) MATT "Shape \"disk\" \"float radius\" 4 \"float height\" " #z "\n"

/* Glass on a table, above it and a little in it. */
static void test_touching(void)
{
    const char *const text = "have surfaces in one place";
    check(TABLE(0) GLASS BOX, text);
    check(TABLE(1) GLASS BOX, text);
    check(GLASS BOX TABLE(0), text);
    check(GLASS "Scale 0.03 0.03 0.03 Translate 0.3 0.1 7 " BOX TABLE(0), text);
    check(TABLE(-0.001) GLASS BOX, NULL);
    check(TABLE(0.001) GLASS BOX, NULL);
    check(TABLE(0) MATT BOX, NULL);
    check(TABLE(0) "Material \"thindielectric\" " BOX, NULL);
    check(TABLE(-1) GLASS "Shape \"sphere\" \"float radius\" 1\n", NULL);
}

static void test_lamps(void)
{
    check(MATT "Shape \"sphere\" \"float radius\" 0.5\n", "light 0 (point) is shut into");
    check(GLASS "Shape \"sphere\" \"float radius\" 0.5\n", NULL);
    check(MATT "Shape \"sphere\" \"float radius\" 50\n", NULL); /* a room */
    check(MATT "Shape \"sphere\" \"float radius\" 0.5 \"float phimax\" 200\n", NULL);
    check(MATT "Shape \"disk\" \"float height\" -1\n", NULL);
}

static void test_size(void)
{
    check(MATT "Shape \"disk\" \"float radius\" 90000\n",
          "m wide; lengths are in metres");
}

/* A sky through a window behind the scene, its corners in either order. */
static void test_portal(void)
{
    float white[2 * 2 * 3];
    for (size_t i = 0; i < G_N_ELEMENTS(white); i++)
        white[i] = 1.0f;
    GByteArray *sky = g_byte_array_new();
    g_byte_array_append(sky, (const guint8 *)"PF 2 2 -1\n", 10);
    g_byte_array_append(sky, (const guint8 *)white, sizeof white);
    const char *const corners[] = {"-1 5 -1  1 5 -1  1 5 1  -1 5 1",
                                   "-1 5 -1  -1 5 1  1 5 1  1 5 -1"};
    for (guint i = 0; i < 2; i++) {
        g_autofree char *text = g_strdup_printf(
            HEAD MATT "Shape \"sphere\" \"float phimax\" 200\n"
                      "LightSource \"infinite\" \"string filename\" \"sky.pfm\" "
                      "\"point3 portal\" [%s]\n",
            corners[i]);
        scene_folder f = folder_new(text);
        folder_write(&f, "sky.pfm", (const char *)sky->data, (gssize)sky->len);
        g_autoptr(GError) error = NULL;
        g_autoptr(view) v = load_view(f.main, NULL, &error);
        g_assert_no_error(error);
        g_autoptr(GPtrArray) warnings = describe_warnings(v);
        g_assert_cmpuint(warnings->len, ==, i);
        if (i > 0)
            g_assert_nonnull(strstr(warnings->pdata[0], "light 1 (infinite) reaches"));
        folder_remove(&f);
    }
    g_byte_array_unref(sky);
}

static void test_json(void)
{
    scene_folder f = folder_new(HEAD GLASS OPEN);
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) s = neph_scene_load(f.main, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    g_autofree char *json = neph_scene_describe(s, true);
    g_assert_true(json_is_valid(json));
    g_assert_nonnull(strstr(json, "\"warnings\": [\n"));
    g_assert_nonnull(strstr(json, "is open"));
    g_assert_nonnull(strstr(json, "\"unit\": \"m\""));
    g_autofree char *text = neph_scene_describe(s, false);
    g_assert_nonnull(strstr(text, "\nwarning          shape 0"));
    g_assert_nonnull(strstr(text, "caustics from  unnamed"));
    folder_remove(&f);
}

/* ---- Watts ---- */

static double power_told(const char *lamps)
{
    g_autofree char *all = g_strconcat("WorldBegin\n", lamps, NULL);
    scene_folder f = folder_new(all);
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) s = neph_scene_load(f.main, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    g_autofree char *json = neph_scene_describe(s, true);
    folder_remove(&f);
    return json_find_number(json, "power");
}

/* Lamps have the watts that the file gives them, whatever their spectra; those that it
   gives in other ways have what follows by geometry. */
static void test_watts(void)
{
    static const struct {
        const char *lamps;
        double watts;
    } cases[] = {
        {"LightSource \"point\" \"float power\" 1 LightSource \"point\" \"float power\" "
         "3\n",
         4},
        {"LightSource \"point\" \"float power\" 1 \"rgb I\" [1 0 0] LightSource "
         "\"point\" "
         "\"float power\" 3 \"blackbody I\" 2400\n",
         0.2126 + 3},
        {"LightSource \"point\" \"float power\" 4 \"spectrum I\" [588 0 589 1 590 0]\n",
         4},
        {"LightSource \"point\"\n", 4 * G_PI},
        {"LightSource \"spot\" \"float power\" 7 \"float coneangle\" 20\n", 7},
        /* What meets the sphere around the scene's box: R² = 3 around a ball's. */
        {"LightSource \"distant\" \"float illuminance\" 2 Shape \"sphere\"\n",
         2 * G_PI * 3},
        {"LightSource \"infinite\" \"float illuminance\" 2 Shape \"sphere\"\n",
         2 * 4 * G_PI * 3},
        {"AreaLightSource \"diffuse\" \"float power\" 5 Shape \"sphere\"\n", 5},
        {"AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Shape \"disk\"\n",
         3 * G_PI * G_PI},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        double found = power_told(cases[i].lamps);
        g_test_message("%s%g W, expected %g", cases[i].lamps, found, cases[i].watts);
        g_assert_cmpfloat(fabs(found / cases[i].watts - 1), <, 2e-3);
    }
}

/* And these are the watts of the photons that they send: all of them land in a ball. */
static void test_watts_of_photons(void)
{
    scene_folder f = folder_new(
        "Integrator \"photonmap\" \"bool direct_illumination\" false \"integer "
        "direct_photons\" 2000\nWorldBegin LightSource \"point\" \"float power\" 1 "
        "LightSource \"point\" \"float power\" 3 Material \"diffuse\" Shape "
        "\"sphere\"\n");
    double sum = 0;
    enum { SEEDS = 16 };
    g_autoptr(NephScene) s = neph_scene_load(f.main, 1, NULL, NULL, NULL);
    for (int seed = 0; seed < SEEDS; seed++) { /* each draws wavelengths of its own */
        g_autoptr(NephSettings) how = neph_scene_settings(s);
        g_autofree char *text = g_strdup_printf("%d", seed);
        g_assert_true(neph_settings_set(how, "seed", text, NULL));
        g_autoptr(NephPhotons) photons = neph_photons_trace(s, how, NULL);
        NephPhoton p;
        for (size_t i = 0; neph_photons_get(photons, i, &p); i++)
            if (p.photon_class == NEPH_PHOTON_DIRECT)
                sum += (0.2126 * (double)p.rgb[0] + 0.7152 * (double)p.rgb[1] +
                        0.0722 * (double)p.rgb[2]) /
                       SEEDS;
    }
    folder_remove(&f);
    g_test_message("%g W of photons", sum);
    g_assert_cmpfloat(fabs(sum / 4 - 1), <, 0.03);
}

static void test_instances(void)
{
    scene_folder f =
        folder_new(HEAD "ObjectBegin \"o\" " MATT "Shape \"sphere\" ObjectEnd "
                        "ObjectInstance \"o\" Translate 3 0 0 "
                        "ObjectInstance \"o\" ");
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) s = neph_scene_load(f.main, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    g_autofree char *text = neph_scene_describe(s, false);
    g_assert_nonnull(strstr(text, "instances      2 of 1 objects\n"));
    g_autofree char *json = neph_scene_describe(s, true);
    g_assert_nonnull(strstr(json, "\"instances\": 2"));
    folder_remove(&f);
}

#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" "
#define IN_FOG                                                                           \
    FOG "MediumInterface \"\" \"fog\" LookAt 0 -9 2  0 0 0  0 0 1 Camera "               \
        "\"perspective\" WorldBegin\n"

/* How many of each kind, and where the camera is. */
static void test_media(void)
{
    scene_folder f =
        folder_new(IN_FOG "LightSource \"point\"\n"
                          "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" "
                          "\"spectrum sigma_s\" [300 0 900 0]\n");
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) s = neph_scene_load(f.main, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    g_autofree char *text = neph_scene_describe(s, false);
    g_assert_nonnull(strstr(text, "\nmedia            2\n  homogeneous    2, 1 scatt"));
    g_assert_nonnull(strstr(text, "\n  in medium      fog\n"));
    g_autofree char *json = neph_scene_describe(s, true);
    g_assert_true(json_is_valid(json));
    g_assert_nonnull(strstr(json, "\"medium\": \"fog\""));
    g_assert_cmpfloat(json_find_number(json, "scattering"), ==, 1.0);
    folder_remove(&f);
}

static void check_fog(const char *lamp, const char *world, bool warned)
{
    g_autofree char *text = g_strconcat(IN_FOG, lamp, world, NULL);
    check_warnings(text, warned ? "through medium 'fog'" : NULL);
}

/* Light from beyond all meets fog that ends, but not fog that does not. */
static void test_fog_without_bounds(void)
{
    const char *const dome = "MediumInterface \"fog\" \"\" Material \"interface\" Shape "
                             "\"sphere\" \"float radius\" 30\n";
    const char *const ball = MATT "Shape \"sphere\"\n";
    check_fog("LightSource \"infinite\"\n", ball, true);
    check_fog("LightSource \"distant\"\n", ball, true);
    check_fog("LightSource \"infinite\"\n", dome, false);
    check_fog("LightSource \"point\" \"point3 from\" [0 0 5]\n", ball, false);
}

static void check_lamp(const char *before, const char *between, const char *text)
{
    g_autofree char *all = g_strconcat(
        FOG, before, "LookAt 0 -9 2  0 0 0  0 0 1 Camera \"perspective\" WorldBegin\n",
        between, "LightSource \"point\"\n", NULL);
    check_warnings(all, text);
}

/* The way from the camera to a lamp leads through interfaces that fit. */
static void test_lamp_in_medium(void)
{
#define AROUND "Material \"interface\" Shape \"sphere\" \"float radius\" 3\n"
    check_lamp("", "MediumInterface \"fog\" \"\"" AROUND "MediumInterface \"fog\"\n",
               NULL);
    check_lamp("MediumInterface \"fog\"", "", NULL);
    check_lamp("", "MediumInterface \"fog\" \"\"" AROUND,
               "in medium 'none', but the way to it from the camera ends in 'fog'");
    check_lamp("MediumInterface \"fog\"", "MediumInterface \"\"\n",
               "in medium 'none', but the way to it from the camera ends in 'fog'");
    check_lamp("", "MediumInterface \"fog\"" AROUND,
               "in medium 'fog', but the way to it from the camera ends in 'none'");
}

/* A wall within fog has fog on the side that is seen. */
static void test_wall_in_medium(void)
{
    const char *const wall = MATT "Shape \"disk\" \"float radius\" 20\n";
    g_autofree char *right = g_strconcat(IN_FOG, wall, NULL);
    g_autofree char *both =
        g_strconcat(IN_FOG, "MediumInterface \"fog\" \"fog\"", wall, NULL);
    g_autofree char *wrong = g_strconcat(IN_FOG, "ReverseOrientation\n", wall, NULL);
    check_warnings(right, NULL);
    check_warnings(both, NULL);
    check_warnings(wrong, "seen from the camera through medium 'fog', but its "
                          "MediumInterface has 'none' on that side");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/info/touching", test_touching);
    g_test_add_func("/info/glass", test_glass);
    g_test_add_func("/info/lamps", test_lamps);
    g_test_add_func("/info/size", test_size);
    g_test_add_func("/info/instances", test_instances);
    g_test_add_func("/info/portal", test_portal);
    g_test_add_func("/info/json", test_json);
    g_test_add_func("/info/watts", test_watts);
    g_test_add_func("/info/watts-of-photons", test_watts_of_photons);
    g_test_add_func("/info/media", test_media);
    g_test_add_func("/info/fog-without-bounds", test_fog_without_bounds);
    g_test_add_func("/info/lamp-in-medium", test_lamp_in_medium);
    g_test_add_func("/info/wall-in-medium", test_wall_in_medium);
    return g_test_run();
}
