/*
 * lenient: what can not be rendered is refused by name and place, or replaced with a
 * warning where that is asked for.
 */
#include "scene_text.h"

#define HEAD                                                                             \
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"                 \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"

static void keep_warning(log_level level, const char *text, void *data)
{
    if (level == LOG_WARNING)
        g_ptr_array_add(data, g_strdup(strchr(text, ':') + 1));
}

/* Strictly refused with that error; leniently read with that one warning. */
static scene *refused_or_replaced(const char *text, const char *error_text,
                                  const char *warning)
{
    scene_folder f = folder_new(text);
    g_autoptr(GPtrArray) warnings = g_ptr_array_new_with_free_func(g_free);
    const log_sink sink = {keep_warning, warnings};
    load_options how = {.threads = 1, .log = &sink};
    g_autoptr(GError) strict = NULL, error = NULL;
    g_assert_null(format_load_with(f.main, &how, &strict));
    g_assert_error(strict, NEPH_ERROR, ERROR_INPUT);
    if (!strstr(strict->message, error_text))
        g_error("expected %s, found %s", error_text, strict->message);
    how.lenient = true;
    scene *s = format_load_with(f.main, &how, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(warnings->len, ==, 1);
    g_assert_cmpstr(warnings->pdata[0], ==, warning);
    folder_remove(&f);
    return s;
}

static const char *material_of(const scene *s)
{
    const material *m = s->materials->pdata[0];
    return m->kind->name;
}

static void test_materials(void)
{
    g_autoptr(scene) hair = refused_or_replaced(
        HEAD "Material \"hair\" \"float eumelanin\" 1.3 \"float beta_m\" 0.2\n"
             "Shape \"sphere\"\n",
        "scene.pbrt:5:1: material \"hair\" is not supported; --lenient takes \"diffuse\"",
        "5:1: material \"hair\" becomes \"diffuse\", without 'eumelanin', 'beta_m'");
    g_assert_cmpstr(material_of(hair), ==, "diffuse");
    g_autoptr(scene) wax = refused_or_replaced(
        HEAD "MakeNamedMaterial \"wax\" \"string type\" \"subsurface\" "
             "\"rgb reflectance\" [0.9 0.8 0.2] \"float roughness\" 0.2 "
             "\"rgb mfp\" [1 1 1]\nNamedMaterial \"wax\"\nShape \"sphere\"\n",
        "scene.pbrt:5:1: material \"subsurface\" is not supported",
        "5:1: material \"subsurface\" becomes \"coateddiffuse\", without 'mfp'");
    g_assert_cmpstr(material_of(wax), ==, "coateddiffuse");
    g_autoptr(scene) measured = refused_or_replaced(
        HEAD "Material \"measured\" \"string filename\" \"cloth.bsdf\"\n"
             "Shape \"sphere\"\n",
        "scene.pbrt:5:1: material \"measured\" is not supported",
        "5:1: material \"measured\" becomes \"diffuse\", without 'filename'");
    g_assert_cmpstr(material_of(measured), ==, "diffuse");
}

/* The name stays one that can be used: of no medium. */
static void test_media(void)
{
    static const char *const kinds[] = {"cloud", "nanovdb", "uniformgrid", "rgbgrid"};
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        g_autofree char *text = g_strdup_printf(
            HEAD "MakeNamedMedium \"fog\" \"string type\" \"%s\" \"float density\" 3\n"
                 "MakeNamedMedium \"air\" \"string type\" \"homogeneous\"\n"
                 "MediumInterface \"fog\" \"air\"\nShape \"sphere\"\n",
            kinds[i]);
        g_autofree char *refused = g_strdup_printf(
            "scene.pbrt:5:1: medium \"%s\" is not supported, \"homogeneous\" is; "
            "--lenient takes empty space",
            kinds[i]);
        g_autofree char *replaced =
            g_strdup_printf("5:1: medium \"fog\" (%s) becomes empty space", kinds[i]);
        g_autoptr(scene) s = refused_or_replaced(text, refused, replaced);
        const shape *ball = s->shapes->pdata[0];
        g_assert_cmpuint(s->media->len, ==, 1);
        g_assert_cmpuint(ball->media.inside, ==, 0);
        g_assert_cmpuint(ball->media.outside, ==, 1);
    }
}

/* Mistakes stay mistakes. */
static void test_wrong_media(void)
{
    static const char *const wrong[] = {
        "MediumInterface \"fog\"\n",
        "MakeNamedMedium \"fog\" \"string type\" \"haze\"\n",
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" 2\n",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(wrong); i++) {
        g_autofree char *text = g_strconcat(HEAD, wrong[i], NULL);
        scene_folder f = folder_new(text);
        const load_options how = {.threads = 1, .lenient = true};
        g_autoptr(GError) error = NULL;
        g_assert_null(format_load_with(f.main, &how, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        folder_remove(&f);
    }
}

static void test_textures(void)
{
    static const char *const types[] = {"spectrum", "float"};
    for (int i = 0; i < 2; i++) {
        g_autofree char *text = g_strdup_printf(
            HEAD "Texture \"t\" \"%s\" \"ptex\" \"string filename\" \"a.ptx\"\n"
                 "Material \"diffuse\" %s\nShape \"sphere\"\n",
            types[i],
            i ? "\"texture displacement\" \"t\"" : "\"texture reflectance\" \"t\"");
        g_autoptr(scene) s = refused_or_replaced(
            text, "scene.pbrt:5:1: texture \"ptex\" is not supported; --lenient takes",
            "5:1: texture \"ptex\" becomes a constant of 0.5");
        g_assert_nonnull(s);
    }
}

static void test_shapes(void)
{
    static const char *const kinds[] = {"cone", "hyperboloid", "paraboloid"};
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        g_autofree char *text =
            g_strdup_printf(HEAD "Shape \"%s\" \"float radius\" 2\n", kinds[i]);
        g_autofree char *refused = g_strdup_printf(
            "scene.pbrt:5:1: shape \"%s\" is not supported; --lenient leaves it out",
            kinds[i]);
        g_autofree char *said =
            g_strdup_printf("5:1: shape \"%s\" is left out", kinds[i]);
        g_autoptr(scene) s = refused_or_replaced(text, refused, said);
        g_assert_cmpuint(s->shapes->len, ==, 0);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/lenient/materials", test_materials);
    g_test_add_func("/lenient/textures", test_textures);
    g_test_add_func("/lenient/shapes", test_shapes);
    g_test_add_func("/lenient/media", test_media);
    g_test_add_func("/lenient/wrong-media", test_wrong_media);
    return g_test_run();
}
