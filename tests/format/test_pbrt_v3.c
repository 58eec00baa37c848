/*
 * pbrt-v3: scenes in its words against the same written by hand in pbrt-v4's; both must
 * render alike. And what tells one from the other.
 */
#include "alike.h"
#include "format/pbrt/pbrt_v3.h"

#include <math.h>
#include <string.h>

#define LOOK "LookAt 0 -5 2  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40\n"
#define FILM3 "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 6\n"
#define FILM4                                                                            \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 PixelFilter "      \
    "\"box\"\n"
#define LAMP "LightSource \"point\" \"rgb I\" [20 18 16] \"point from\" [1 -2 4]\n"
#define FLOOR "Shape \"disk\" \"float radius\" 4\n"
#define BALL "Translate 0 0 .8 Shape \"sphere\" \"float radius\" .7\n"

#define WORLD3(text) LOOK FILM3 "WorldBegin\n" LAMP FLOOR text "WorldEnd\n"
#define WORLD4(text) LOOK FILM4 "WorldBegin\n" LAMP FLOOR text

static void test_materials(void)
{
    static const pair pairs[] = {
        {"matte",
         WORLD3("Material \"matte\" \"color Kd\" [.2 .6 .4] \"float sigma\" 0 " BALL),
         WORLD4("Material \"diffuse\" \"rgb reflectance\" [.2 .6 .4] " BALL)},
        {"mirror", WORLD3("Material \"mirror\" " BALL),
         WORLD4("Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] " BALL)},
        /* x = ln 0.1: 1.62142 + 0.819955 x + 0.1734 x² + 0.0171201 x³ + 0.000640711 x⁴ */
        {"plastic", WORLD3("Material \"plastic\" \"rgb Kd\" [.5 .1 .1] " BALL),
         WORLD4("Material \"coateddiffuse\" \"rgb reflectance\" [.5 .1 .1] \"float "
                "roughness\" 0.461745 \"bool remaproughness\" false " BALL)},
        {"substrate",
         WORLD3("Material \"substrate\" \"rgb Kd\" [.5 .1 .1] \"float uroughness\" 0.2 "
                "\"float vroughness\" 0.2 \"bool remaproughness\" \"false\" " BALL),
         WORLD4("Material \"coateddiffuse\" \"rgb reflectance\" [.5 .1 .1] \"float "
                "roughness\" 0.2 \"bool remaproughness\" false " BALL)},
        {"glass",
         WORLD3("Material \"glass\" \"float index\" 1.4 \"rgb Kt\" [.5 .9 .9] " BALL),
         WORLD4(
             "Material \"dielectric\" \"float eta\" 1.4 \"rgb tint\" [.5 .9 .9] " BALL)},
        {"metal",
         WORLD3("Material \"metal\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
                "\"metal-Ag-k\" \"float roughness\" 0.1 " BALL),
         WORLD4("Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
                "\"metal-Ag-k\" \"float roughness\" 0.461745 \"bool remaproughness\" "
                "false " BALL)},
        {"uber",
         WORLD3("Material \"uber\" \"rgb Kd\" [.1 .5 .1] \"float index\" 1.6 \"rgb "
                "Kr\" [0 0 0] " BALL),
         WORLD4("Material \"coateddiffuse\" \"rgb reflectance\" [.1 .5 .1] \"float eta\" "
                "1.6 \"float roughness\" 0.461745 \"bool remaproughness\" false " BALL)},
        {"translucent",
         WORLD3(
             "Material \"translucent\" \"rgb Kd\" [.6 .8 .4] \"rgb reflect\" [.5 .5 .5] "
             "\"rgb transmit\" [.25 .25 .25] " BALL),
         WORLD4("Material \"diffusetransmission\" \"rgb reflectance\" [.3 .4 .2] \"rgb "
                "transmittance\" [.15 .2 .1] " BALL)},
        {"mix",
         WORLD3("MakeNamedMaterial \"a\" \"string type\" \"matte\" MakeNamedMaterial "
                "\"b\" \"string type\" \"mirror\" Material \"mix\" \"string "
                "namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" "
                "[.7 .7 .7] " BALL),
         WORLD4("MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial "
                "\"b\" \"string type\" \"conductor\" \"rgb reflectance\" [.9 .9 .9] "
                "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" "
                ".3 " BALL)},
        {"named",
         WORLD3("MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [.1 .5 .1] "
                "NamedMaterial \"a\" " BALL),
         WORLD4("Material \"diffuse\" \"rgb reflectance\" [.1 .5 .1] " BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

static void test_lights(void)
{
    static const pair pairs[] = {
        {"scale",
         WORLD3(
             "LightSource \"distant\" \"rgb L\" [1 2 3] \"rgb scale\" [2 1 .5] \"point "
             "from\" [0 0 1] \"point to\" [0 0 0]\n"),
         WORLD4("LightSource \"distant\" \"rgb L\" [2 2 1.5] \"point3 from\" [0 0 1] "
                "\"point3 to\" [0 0 0]\n")},
        {"area",
         WORLD3(
             "AreaLightSource \"area\" \"rgb L\" [3 3 2] \"integer nsamples\" 4 " BALL),
         WORLD4("AreaLightSource \"diffuse\" \"rgb L\" [3 3 2] " BALL)},
        {"infinite",
         WORLD3("LightSource \"infinite\" \"rgb L\" [1 1 1] \"rgb scale\" [.5 .5 "
                ".5] \"integer samples\" 4\n"),
         WORLD4("LightSource \"infinite\" \"rgb L\" [.5 .5 .5]\n")},
        /* A flat spectrum of 1 has the luminance 1 in v3. */
        {"spectrum", WORLD3("LightSource \"infinite\" \"spectrum L\" [300 1 900 1]\n"),
         WORLD4("LightSource \"infinite\" \"spectrum L\" [300 1 900 1]\n")},
        {"spectrum-3", WORLD3("LightSource \"infinite\" \"spectrum L\" [300 3 900 3]\n"),
         WORLD4("LightSource \"infinite\" \"spectrum L\" [300 1 900 1] \"float scale\" "
                "3\n")},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

static void test_rest(void)
{
    static const pair pairs[] = {
        {"film-scale",
         LOOK
         "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"float "
         "scale\" 2 \"float maxsampleluminance\" 10\nWorldBegin " LAMP FLOOR "WorldEnd\n",
         LOOK
         "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"float iso\" "
         "200 PixelFilter \"box\" WorldBegin " LAMP FLOOR},
        {"filter",
         LOOK FILM3 "PixelFilter \"gaussian\" \"float xwidth\" 1.5 \"float ywidth\" 1.5 "
                    "\"float alpha\" 2\nWorldBegin " LAMP FLOOR "WorldEnd\n",
         LOOK
         "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 PixelFilter "
         "\"gaussian\" \"float xradius\" 1.5 \"float yradius\" 1.5 \"float sigma\" 0.5 "
         "WorldBegin " LAMP FLOOR},
        {"mesh",
         WORLD3("Material \"matte\" \"rgb Kd\" [.1 .5 .1] Shape \"trianglemesh\" \"point "
                "P\" "
                "[-1 0 0 1 0 0 0 0 2] \"normal N\" [0 -1 0 0 -1 0 0 -1 0] \"float uv\" "
                "[0 0 1 "
                "0 0 1] \"integer indices\" [0 1 2]\n"),
         WORLD4(
             "Material \"diffuse\" \"rgb reflectance\" [.1 .5 .1] Shape \"trianglemesh\" "
             "\"point3 P\" [-1 0 0 1 0 0 0 0 2] \"normal N\" [0 -1 0 0 -1 0 0 -1 0] "
             "\"point2 uv\" [0 0 1 0 0 1] \"integer indices\" [0 1 2]\n")},
        {"scaled",
         WORLD3(
             "Texture \"c\" \"color\" \"checkerboard\" \"float uscale\" 8 \"rgb tex1\" "
             "[.1 .2 .3] \"rgb tex2\" [.8 .9 .8] Texture \"s\" \"color\" \"scale\" "
             "\"texture tex1\" \"c\" \"rgb tex2\" [.5 .5 .5] Material \"matte\" "
             "\"texture Kd\" \"s\" " BALL),
         WORLD4("Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"rgb "
                "tex1\" [.1 .2 .3] \"rgb tex2\" [.8 .9 .8] Texture \"s\" \"spectrum\" "
                "\"scale\" \"texture tex\" \"c\" \"float scale\" .5 Material \"diffuse\" "
                "\"texture reflectance\" \"s\" " BALL)},
        {"texture",
         WORLD3(
             "Texture \"t\" \"color\" \"constant\" \"color value\" [.3 .2 .1] Material "
             "\"matte\" \"texture Kd\" \"t\" " BALL),
         WORLD4("Material \"diffuse\" \"rgb reflectance\" [.3 .2 .1] " BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

static void keep_note(log_level level, const char *text, void *data)
{
    if (level == LOG_NOTE)
        g_string_append_printf(data, "%s\n", strchr(text, ':'));
}

/* The scene of a text that must be right, and what is noted of it. */
static scene *noted_scene(const char *text, GString *notes)
{
    scene_folder f = folder_new(text);
    const log_sink sink = {keep_note, notes};
    g_autoptr(GError) error = NULL;
    scene *s = format_load(f.main, 1, &sink, &error);
    g_assert_no_error(error);
    folder_remove(&f);
    return s;
}

/* Names may be given again, and what is given between AttributeBegin and AttributeEnd
 * ends there; TransformBegin keeps transforms alone. */
static void test_names_given_again(void)
{
#define COLOR3(name, rgb)                                                                \
    "Texture \"" name "\" \"color\" \"constant\" \"color value\" [" rgb "]\n"
#define MATTE3 "Material \"matte\" \"texture Kd\" \"t\"\n"
#define MATTE4(rgb) "Material \"diffuse\" \"rgb reflectance\" [" rgb "]\n"
#define LEFT "Translate -1 0 0 Shape \"sphere\" Translate 1 0 0\n"
#define RIGHT "Translate 1.5 0 0 Shape \"sphere\"\n"
    static const pair pairs[] = {
        {"texture",
         WORLD3(COLOR3("t", ".9 .1 .1") MATTE3 LEFT COLOR3("t", ".1 .1 .9") MATTE3 RIGHT),
         WORLD4(MATTE4(".9 .1 .1") LEFT MATTE4(".1 .1 .9") RIGHT)},
        {"scope",
         WORLD3(COLOR3("t", ".9 .1 .1") "AttributeBegin\n" COLOR3("t", ".1 .1 .9")
                    MATTE3 LEFT "AttributeEnd\n" MATTE3 RIGHT),
         WORLD4(MATTE4(".1 .1 .9") LEFT MATTE4(".9 .1 .1") RIGHT)},
        {"types",
         WORLD3("Texture \"t\" \"float\" \"constant\" \"float value\" 0.2\n" COLOR3(
             "t", ".1 .1 .9") MATTE3 LEFT RIGHT),
         WORLD4(MATTE4(".1 .1 .9") LEFT RIGHT)},
        {"material",
         WORLD3(
             "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [.9 .1 .1]\n"
             "NamedMaterial \"m\" " LEFT
             "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [.1 .1 .9]\n"
             "NamedMaterial \"m\" " RIGHT),
         WORLD4(MATTE4(".9 .1 .1") LEFT MATTE4(".1 .1 .9") RIGHT)},
        {"object",
         WORLD3(MATTE4(".9 .1 .1") "ObjectBegin \"o\" " LEFT "ObjectEnd ObjectInstance "
                                   "\"o\"\nObjectBegin \"o\" " RIGHT
                                   "ObjectEnd ObjectInstance \"o\"\n"),
         WORLD4(MATTE4(".9 .1 .1") LEFT RIGHT)},
        {"transform-begin",
         WORLD3("TransformBegin Scale 2 2 2 Material \"matte\" \"rgb Kd\" [.9 .1 .1] "
                "TransformEnd\n" RIGHT),
         WORLD4(MATTE4(".9 .1 .1") RIGHT)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* Colours where pbrt-v4 wants numbers, and the other way round. */
static void test_types_of_textures(void)
{
#define CHECKS3                                                                          \
    "Texture \"t\" \"color\" \"checkerboard\" \"rgb tex1\" [.2 .4 .6] \"rgb tex2\" [1 "  \
    "1 "                                                                                 \
    "1]\n"
#define TWO(a, b)                                                                        \
    "MakeNamedMaterial \"a\" \"string type\" \"" a                                       \
    "\" MakeNamedMaterial \"b\" \"string "                                               \
    "type\" \"" b "\"\n"
    static const pair pairs[] = {
        {"amount",
         WORLD3(
             CHECKS3 TWO("matte", "mirror") "Material \"mix\" \"string namedmaterial1\" "
                                            "\"a\" \"string namedmaterial2\" \"b\" "
                                            "\"texture amount\" \"t\" " BALL),
         WORLD4(
             "Texture \"n\" \"float\" \"checkerboard\" \"float tex1\" .4 \"float tex2\" "
             "1\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial "
             "\"b\" \"string type\" \"conductor\" \"rgb reflectance\" [.9 .9 .9] "
             "Material \"mix\" \"string materials\" [\"b\" \"a\"] \"texture amount\" "
             "\"n\" " BALL)},
        {"noise",
         WORLD3("Texture \"t\" \"color\" \"wrinkled\" \"integer octaves\" 3 Material "
                "\"matte\" \"texture Kd\" \"t\" " BALL),
         WORLD4(
             "Texture \"n\" \"float\" \"wrinkled\" \"integer octaves\" 3 Texture \"t\" "
             "\"spectrum\" \"mix\" \"rgb tex1\" [0 0 0] \"rgb tex2\" [1 1 1] \"texture "
             "amount\" \"n\" Material \"diffuse\" \"texture reflectance\" \"t\" " BALL)},
        {"grey",
         WORLD3("Texture \"t\" \"float\" \"constant\" \"float value\" 0.3 Material "
                "\"matte\" \"texture Kd\" \"t\" " BALL),
         WORLD4("Material \"diffuse\" \"rgb reflectance\" [.3 .3 .3] " BALL)},
        {"uv",
         WORLD3("Texture \"t\" \"color\" \"uv\" Material \"matte\" \"texture Kd\" "
                "\"t\" " BALL),
         WORLD4(
             "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [0 0 0] \"rgb v01\" [0 "
             "1 0] \"rgb v10\" [1 0 0] \"rgb v11\" [1 1 0] Material \"diffuse\" "
             "\"texture "
             "reflectance\" \"t\" " BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* pbrt-v3 tells of what is not there and goes on. */
static void test_what_is_not_there(void)
{
    static const pair pairs[] = {
        {"material",
         WORLD3("Material \"matte\" \"rgb Kd\" [.9 .1 .1] NamedMaterial "
                "\"gold\" " BALL),
         WORLD4(MATTE4(".9 .1 .1") BALL)},
        {"texture", WORLD3("Material \"matte\" \"texture Kd\" \"gold\" " BALL),
         WORLD4("Material \"diffuse\" " BALL)},
        {"object", WORLD3("ObjectInstance \"gold\" " BALL), WORLD4(BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

static void test_include_among_parameters(void)
{
    scene_folder f = folder_new(
        LOOK FILM3
        "WorldBegin\n" LAMP
        "Shape \"trianglemesh\" Include \"mesh.pbrt\" \"point P\" [0 0 0 1 0 0 0 "
        "1 0]\nShape \"sphere\" Include \"more.pbrt\"\nWorldEnd\n");
    folder_write(&f, "mesh.pbrt", "\"integer indices\" [0 1 2]\n", -1);
    folder_write(&f, "more.pbrt", "Shape \"sphere\" Shape \"disk\"\n", -1);
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(f.main, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(v->scene->shapes->len, ==, 4);
    folder_remove(&f);
}

/* Disney's base, metal and coat are those of the gltf material. */
static void test_disney(void)
{
    static const pair pairs[] = {
        {"base",
         WORLD3("Material \"disney\" \"color color\" [.8 .3 .1] \"float roughness\" "
                ".4 \"float eta\" 1.4 \"float sheen\" 0 " BALL),
         WORLD4("Material \"gltf\" \"rgb basecolor\" [.8 .3 .1] \"float metallic\" 0 "
                "\"float roughness\" .4 \"float eta\" 1.4 " BALL)},
        {"metal",
         WORLD3("Material \"disney\" \"color color\" [.8 .3 .1] \"float metallic\" "
                "1 \"float clearcoat\" 1 \"float clearcoatgloss\" 0 " BALL),
         WORLD4("Material \"gltf\" \"rgb basecolor\" [.8 .3 .1] \"float metallic\" 1 "
                "\"float roughness\" .5 \"float clearcoat\" .25 \"float "
                "clearcoatroughness\" 0.316228 " BALL)},
        {"glass",
         WORLD3("Material \"disney\" \"color color\" [1 1 1] \"float spectrans\" 1 "
                "\"float roughness\" 0 " BALL),
         WORLD4("Material \"gltf\" \"float metallic\" 0 \"float roughness\" 0 \"float "
                "transmission\" 1 \"bool thin\" false " BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* What else pbrt-v3 takes, in pbrt-v4's words. */
static void test_rest_of_v3(void)
{
    static const pair pairs[] = {
        {"leaves",
         WORLD3(COLOR3("t",
                       ".6 .8 .4") "Material \"translucent\" \"texture Kd\" \"t\" " BALL),
         WORLD4("Material \"diffusetransmission\" \"rgb reflectance\" [.6 .8 .4] \"rgb "
                "transmittance\" [.6 .8 .4] \"float scale\" .5 " BALL)},
        {"type",
         WORLD3("Material \"matte\" \"rgb Kd\" [.9 .1 .1] Shape \"sphere\" \"integer "
                "radius\" 3\n"),
         WORLD4(MATTE4(".9 .1 .1") "Shape \"sphere\"\n")},
        {"open", WORLD3("AttributeBegin " MATTE4(".9 .1 .1") BALL),
         WORLD4(MATTE4(".9 .1 .1") BALL)},
        {"heightfield",
         WORLD3(
             MATTE4(".9 .1 .1") "Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 "
                                "\"float Pz\" [0 1 .5 .2 0 .7]\n"),
         WORLD4(MATTE4(
             ".9 .1 .1") "Shape \"trianglemesh\" \"point3 P\" [0 0 0 .5 0 1 1 0 .5 "
                         "0 1 .2 .5 1 0 1 1 .7] \"integer indices\" [0 1 4 0 4 3 1 2 "
                         "5 1 5 4] \"point2 uv\" [0 0 .5 0 1 0 0 1 .5 1 1 1]\n")},
        {"accelerator",
         "Accelerator \"grid\" " LOOK FILM3 "WorldBegin\n" LAMP FLOOR "WorldEnd\n",
         LOOK FILM4 "WorldBegin\n" LAMP FLOOR},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* v3 multiplies the picture of a sky by "L", too. */
static void test_tinted_pictures(void)
{
    const float texels[] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    g_autoptr(GString) pfm = g_string_new("PF\n2 1\n-1.0\n");
    g_string_append_len(pfm, (const char *)texels, sizeof texels);
    static const char *const lights[] = {
        "LightSource \"infinite\" \"string mapname\" \"a.pfm\" \"rgb L\" [2 2 2] \"rgb "
        "scale\" [3 3 3]\n",
        "LightSource \"infinite\" \"string mapname\" \"a.pfm\" \"rgb scale\" [6 6 6]\n"};
    double means[2];
    for (int i = 0; i < 2; i++) {
        g_autofree char *text =
            g_strconcat(LOOK FILM3 "WorldBegin\n", lights[i], FLOOR "WorldEnd\n", NULL);
        scene_folder f = folder_new(text);
        folder_write(&f, "a.pfm", pfm->str, (gssize)pfm->len);
        g_autoptr(GError) error = NULL;
        g_autoptr(view) v = load_view(f.main, NULL, &error);
        g_assert_no_error(error);
        g_autoptr(image) img = render_with(v, ALIKE_HOW);
        means[i] = mean_of(img, "");
        folder_remove(&f);
    }
    g_assert_cmpfloat(means[0], >, 0.1);
    g_assert_cmpfloat(fabs(means[0] - means[1]), <, 1e-4 * means[0]);
}

/* pbrt-v3 warns of parameters that it does not know, and goes on. */
static void test_unknown_parameters(void)
{
    static const char *const texts[][2] = {
        {"Material \"matte\" \"float shine\" 2 " BALL,
         "'shine' of material 'diffuse' is left out"},
        {"Shape \"sphere\" \"float shine\" 2\n",
         "'shine' of shape \"sphere\" is left out"},
        {"LightSource \"point\" \"float shine\" 2\n",
         "'shine' of light \"point\" is left out"},
        {"Texture \"t\" \"float\" \"constant\" \"float shine\" 2\n",
         "'shine' of texture 'constant' is left out"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++) {
        g_autofree char *text = g_strconcat(LOOK FILM3 "WorldBegin\n" LAMP FLOOR,
                                            texts[i][0], "WorldEnd\n", NULL);
        g_autoptr(GString) notes = g_string_new(NULL);
        scene_free(noted_scene(text, notes));
        if (!strstr(notes->str, texts[i][1]))
            g_error("expected %s, found %s", texts[i][1], notes->str);
    }
    g_autoptr(GString) notes = g_string_new(NULL);
    scene_free(noted_scene(
        LOOK "Film \"image\" \"float shine\" 1 Sampler \"halton\" \"float shine\" 1\n"
             "Integrator \"path\" \"float shine\" 1 PixelFilter \"box\" \"float "
             "shine\" 1 Accelerator \"bvh\" \"float shine\" 1\nWorldBegin WorldEnd\n",
        notes));
    static const char *const of[] = {"film", "Sampler", "Integrator", "filter",
                                     "accelerator"};
    for (size_t i = 0; i < G_N_ELEMENTS(of); i++) {
        g_autofree char *part = g_strdup_printf("unknown parameter 'shine' of %s", of[i]);
        if (!strstr(notes->str, part))
            g_error("expected %s, found %s", part, notes->str);
    }
}

/* A texture goes before a value in pbrt-v3, whichever comes last. */
static void test_texture_before_value(void)
{
#define STRIPES                                                                          \
    "Texture \"t\" \"color\" \"checkerboard\" \"rgb tex1\" [.9 .1 .1] \"rgb tex2\" "     \
    "[.1 .1 .9] "
    static const pair pairs[] = {
        {"last",
         WORLD3(STRIPES "Material \"matte\" \"texture Kd\" \"t\" \"rgb Kd\" [.5 "
                        ".5 .5] " BALL),
         WORLD3(STRIPES "Material \"matte\" \"texture Kd\" \"t\" " BALL)},
        {"first",
         WORLD3(STRIPES "Material \"matte\" \"rgb Kd\" [.5 .5 .5] \"texture "
                        "Kd\" \"t\" " BALL),
         WORLD3(STRIPES "Material \"matte\" \"texture Kd\" \"t\" " BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* Film and integrator where nothing is said, or in v3's words. */
static void test_settings(void)
{
    g_autoptr(view) v = view_of(
        LOOK
        "Integrator \"sppm\" \"integer numiterations\" 12 \"integer "
        "photonsperiteration\" 3000 \"float radius\" 0.3 \"integer maxdepth\" 7\n"
        "Sampler \"lowdiscrepancy\" \"integer pixelsamples\" 64 WorldBegin " LAMP FLOOR
        "WorldEnd\n");
    g_assert_cmpint(v->film.width, ==, 640);
    g_assert_cmpint((int)v->scene->settings.passes, ==, 12);
    g_assert_cmpint((int)v->scene->settings.photons, ==, 3000);
}

static void test_recognised(void)
{
    static const char *const old[] = {"# Material\nMaterial \"glass\"",
                                      "Material \"matte\"", "x\nFilm \"image\"",
                                      "# fine\nWorldEnd"};
    static const char *const new[] = {
        "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" NamedMaterial \"glass\"",
        "Material \"diffuse\"", "# WorldEnd\nFilm \"rgb\"", ""};
    for (size_t i = 0; i < G_N_ELEMENTS(old); i++) {
        g_assert_true(pbrt_v3_recognises(old[i], strlen(old[i])));
        g_assert_false(pbrt_v3_recognises(new[i], strlen(new[i])));
    }
    scene_folder f = folder_new(WORLD3("Material \"fourier\"\n" BALL));
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(f.main, 1, NULL, &error));
    g_assert_nonnull(
        strstr(error->message, "material \"fourier\" is not supported; --lenient takes"));
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt-v3/materials", test_materials);
    g_test_add_func("/pbrt-v3/lights", test_lights);
    g_test_add_func("/pbrt-v3/rest", test_rest);
    g_test_add_func("/pbrt-v3/settings", test_settings);
    g_test_add_func("/pbrt-v3/names-given-again", test_names_given_again);
    g_test_add_func("/pbrt-v3/types-of-textures", test_types_of_textures);
    g_test_add_func("/pbrt-v3/what-is-not-there", test_what_is_not_there);
    g_test_add_func("/pbrt-v3/include-among-parameters", test_include_among_parameters);
    g_test_add_func("/pbrt-v3/disney", test_disney);
    g_test_add_func("/pbrt-v3/rest-of-it", test_rest_of_v3);
    g_test_add_func("/pbrt-v3/tinted-pictures", test_tinted_pictures);
    g_test_add_func("/pbrt-v3/unknown-parameters", test_unknown_parameters);
    g_test_add_func("/pbrt-v3/texture-before-value", test_texture_before_value);
    g_test_add_func("/pbrt-v3/recognised", test_recognised);
    return g_test_run();
}
