/*
 * knobs: each setting changes the picture of the integrators that its row says read it,
 * and of no other one.
 */
#include "rooms.h"

#include <string.h>

/* A glass ball that flies through a room with a lamp and a point light, past a block of
   rough metal that stands close to a wall. */
static const char subject[] = ROOM_CAMERA SIZE(8) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS
    "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5]\n"
    "AttributeBegin Material \"conductor\" \"float roughness\" 0.3\n"
    "Translate 1.2 0 0.4 Scale 0.4 0.4 0.4 Shape \"sphere\" AttributeEnd\n"
    "AttributeBegin Translate -0.3 0 0.6 ActiveTransform EndTime Translate 0.2 0 0\n"
    "ActiveTransform All Material \"dielectric\" \"float roughness\" 0.02\n"
    "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n";

#define COMMON "threads=1 passes=2 spp=1 photons=800 radius=0.6 caustic_emission=uniform "
#define CONES "direct_kernel=cone indirect_kernel=cone caustic_kernel=cone "
#define DIRECT_MAP "direct_illumination=false "
#define GATHER "final_gather=true gather_rays=4 "

static const struct {
    const char *name, *value;
    const char *while_; /* what must be set for it to matter */
} trials[] = {
    {"spp", "2", ""},
    {"max_backward_bounces", "1", ""},
    {"max_forward_bounces", "1", ""},
    {"final_gather", "true", ""},
    {"gather_rays", "8", GATHER},
    {"precompute_radiance", "false", GATHER},
    {"direct_illumination", "false", ""},
    {"shadow_rays", "false", ""},
    {"photons", "1600", ""},
    {"direct_photons", "200", DIRECT_MAP},
    {"indirect_photons", "200", ""},
    {"caustic_photons", "1000", ""},
    {"photons_per_light", "true", ""},
    {"one_map", "true", ""},
    {"photon_lobes", "glossy", ""},
    {"photon_survivors", "true", ""},
    {"direct_nearest", "2", DIRECT_MAP},
    {"indirect_nearest", "2", ""},
    {"caustic_nearest", "2", "caustic_photons=4000 "},
    {"radius", "0.2", ""},
    {"one_radius", "true", "radius=0 "},
    {"direct_kernel", "cone", DIRECT_MAP},
    {"indirect_kernel", "cone", ""},
    {"caustic_kernel", "cone", ""},
    {"direct_cone_k", "2", DIRECT_MAP CONES},
    {"indirect_cone_k", "2", CONES},
    {"caustic_cone_k", "2", CONES},
    {"flatten", "0.1", "edges=false "},
    {"edges", "false", ""},
    {"time_slices", "2", ""},
    {"roulette", "max", ""},
    {"caustic_emission", "specular-area", ""},
    {"multiple_samples", "false", ""},
    {"vcm_strategies", "bpt", ""},
    {"alpha", "0.9", ""},
    {"seed", "3", ""},
    {"camera_seed", "3", ""},
    {"first_spp", "1", "spp=2 "},
};

/* What changes when or how fast the same picture is there, or what is beside it; and
   five that act where it pays, see test_spots.c, test_pace.c, test_gather.c and
   test_knob_meanings.c. */
static const char *const others[] = {"integrator",
                                     "passes",
                                     "time",
                                     "noise",
                                     "threads",
                                     "photon_map",
                                     "planned_passes",
                                     "bright_spots",
                                     "gather_indirect",
                                     "denoise",
                                     "denoise_windows",
                                     "direct_emission",
                                     "indirect_emission",
                                     NULL};

static image *picture(const view *v, const char *integrator, const char *with)
{
    g_autofree char *words =
        g_strdup_printf("integrator=%s " COMMON "%s", integrator, with);
    return render_with(v, g_strchomp(words));
}

static bool is_read_by(const char *name, const char *integrator)
{
    g_auto(GStrv) users = g_strsplit(settings_find(name)->users, " ", -1);
    return g_strv_contains((const char *const *)users, "all") ||
           g_strv_contains((const char *const *)users, integrator);
}

static void test_acts(const void *data)
{
    const char *integrator = data;
    unsigned n_wrong = 0;
    g_autoptr(view) v = view_of(subject);
    for (size_t i = 0; i < G_N_ELEMENTS(trials); i++) {
        g_autoptr(image) before = picture(v, integrator, trials[i].while_);
        g_autofree char *with =
            g_strdup_printf("%s%s=%s", trials[i].while_, trials[i].name, trials[i].value);
        g_autoptr(image) after = picture(v, integrator, with);
        bool acts =
            memcmp(before->pixels, after->pixels,
                   pixels_of(before) * (size_t)before->n_channels * sizeof(float)) != 0;
        if (acts == is_read_by(trials[i].name, integrator))
            continue;
        g_test_message("%s %s", trials[i].name, acts ? "acts" : "does nothing");
        n_wrong++;
    }
    g_assert_cmpuint(n_wrong, ==, 0);
}

/* A new setting is tried too. */
static void test_all_are_tried(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        bool tried = g_strv_contains(others, rows[i].name);
        for (size_t k = 0; k < G_N_ELEMENTS(trials); k++)
            tried |= strcmp(trials[k].name, rows[i].name) == 0;
        g_test_message("%s", rows[i].name);
        g_assert_true(tried);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/knobs/all", test_all_are_tried);
    g_test_add_data_func("/knobs/photonmap", "photonmap", test_acts);
    g_test_add_data_func("/knobs/path", "path", test_acts);
    g_test_add_data_func("/knobs/auto", "auto", test_acts);
    g_test_add_data_func("/knobs/vcm", "vcm", test_acts);
    return g_test_run();
}
