/*
 * Scenes without light, or with lights that send none, are read with a warning, and every
 * integrator ends on them with a black picture.
 */
#include "rooms.h"

static const char *const lamps[] = {
    "",
    "LightSource \"point\" \"rgb I\" [0 0 0]\n",
    "LightSource \"infinite\" \"rgb L\" [0 0 0]\n",
    "LightSource \"infinite\" \"rgb L\" [0 0 0] LightSource \"distant\" \"rgb L\" [0 0 "
    "0] AreaLightSource \"diffuse\" \"rgb L\" [0 0 0]\n",
};

static view *dark_room(const char *lamp, const log_sink *log)
{
    g_autofree char *text = g_strconcat(ROOM_CAMERA SIZE(8) "WorldBegin\n" ROOM_WALLS,
                                        lamp, GLASS_BALL, NULL);
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    view *v = load_view(f.main, log, &error);
    g_assert_no_error(error);
    folder_remove(&f);
    return v;
}

static void test_picture_is_black(void)
{
    static const char *const ways[] = {
        "integrator=photonmap passes=1 photons=500",
        "integrator=photonmap passes=1 photons=500 final_gather=true",
        "integrator=photonmap passes=1 photons=500 radius=0.1 photon_map=kdtree",
        "integrator=sppm passes=2 photons=500",
        "integrator=path passes=2",
        "integrator=auto passes=2",
        "integrator=vcm passes=2",
        "integrator=vcm passes=2 vcm_strategies=light",
        "integrator=vcm passes=2 vcm_strategies=bpm",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(lamps); i++) {
        g_autoptr(view) v = dark_room(lamps[i], NULL);
        for (size_t k = 0; k < G_N_ELEMENTS(ways); k++) {
            g_autoptr(image) img = render_with(v, ways[k]);
            g_assert_false(fabs(mean_of(img, "")) > 0.0);
        }
    }
}

/* Nothing but a camera: an empty picture. */
static void test_nothing_is_black(void)
{
    g_autoptr(view) v = view_of(ROOM_CAMERA SIZE(8) "WorldBegin\n");
    g_autoptr(image) img = render_with(v, "integrator=auto passes=1");
    g_assert_false(fabs(mean_of(img, "")) > 0.0);
}

static void keep_warning(log_level level, const char *text, void *data)
{
    if (level == LOG_WARNING)
        g_string_append_printf(data, "%s\n", strchr(text, ':'));
}

static void test_warning(void)
{
    static const char *const lamps_and_words[][2] = {
        {"", ": the scene has no light: its picture is black\n"},
        {"LightSource \"point\" \"rgb I\" [0 0 0]\n",
         ": the scene has no light but what is black: its picture is black\n"},
        {"LightSource \"point\"\n", ""},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(lamps_and_words); i++) {
        g_autoptr(GString) text = g_string_new(NULL);
        const log_sink sink = {keep_warning, text};
        view_free(dark_room(lamps_and_words[i][0], &sink));
        g_assert_cmpstr(text->str, ==, lamps_and_words[i][1]);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/darkness/picture", test_picture_is_black);
    g_test_add_func("/darkness/nothing", test_nothing_is_black);
    g_test_add_func("/darkness/warning", test_warning);
    return g_test_run();
}
