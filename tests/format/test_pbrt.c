/*
 * pbrt: what the text says is what the scene holds: transforms against closed matrices,
 * attributes by their scope, parameters in every spelling, integrators as settings.
 */
#include "scene_text.h"

#include <math.h>
#include <zlib.h>

#define CAMERA "Camera \"perspective\"\n"
#define LIGHT "LightSource \"point\"\n"
#define PROBE                                                                            \
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  0 0 1]\n"                 \
    "  \"integer indices\" [0 1 2  0 2 3]\n"

static const shape *shape_at(const scene *s, guint i)
{
    g_assert_cmpuint(i, <, s->shapes->len);
    return s->shapes->pdata[i];
}

/** The columns of the transform that the last shape, the probe, stands in. */
static void probe_columns(const scene *s, float out[4][3])
{
    const shape *probe = shape_at(s, s->shapes->len - 1);
    const mesh *m = probe->kind->triangles(probe->self);
    g_assert_cmpuint(m->n_vertices, ==, 4);
    memcpy(out, m->positions, 12 * sizeof(float));
    for (int axis = 1; axis < 4; axis++)
        for (int i = 0; i < 3; i++)
            out[axis][i] -= out[0][i];
}

/** Directives before and after WorldBegin give origin and axes x, y, z of the probe. */
static void transform_is(const char *before, const char *after, const float want[4][3])
{
    g_autofree char *text =
        g_strconcat(before, CAMERA "WorldBegin\n" LIGHT, after, PROBE, NULL);
    g_autoptr(scene) s = scene_of(text);
    float found[4][3];
    probe_columns(s, found);
    for (int axis = 0; axis < 4; axis++)
        for (int i = 0; i < 3; i++)
            if (fabsf(found[axis][i] - want[axis][i]) > 1e-5f)
                g_error("%s%s: column %d, row %d: expected %g, found %g", before, after,
                        axis, i, (double)want[axis][i], (double)found[axis][i]);
}

static void test_each_transform(void)
{
    static const float unit[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    transform_is("", "", unit);
    transform_is("Translate 1 2 3\n", "", unit);
    transform_is("", "Scale 2 2 2 Identity\n", unit);
    transform_is("", "Translate 1 2 3\n",
                 (const float[4][3]){{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("", "Scale 2 -3 4\n",
                 (const float[4][3]){{0, 0, 0}, {2, 0, 0}, {0, -3, 0}, {0, 0, 4}});
    transform_is("", "Rotate 90 0 0 1\n",
                 (const float[4][3]){{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}});
    transform_is("", "Rotate 120 1 1 1\n",
                 (const float[4][3]){{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}});
    transform_is("", "LookAt 1 2 3  1 2 10  0 5 0\n",
                 (const float[4][3]){{-1, -2, -3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("", "LookAt 0 0 0  4 0 0  0 1 0\n",
                 (const float[4][3]){{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}});
    transform_is("", "Transform [0 2 0 0  -3 0 0 0  0 0 4 0  5 6 7 1]\n",
                 (const float[4][3]){{5, 6, 7}, {0, 2, 0}, {-3, 0, 0}, {0, 0, 4}});
}

static void test_transforms_compose(void)
{
    transform_is("", "Translate 1 2 3 Scale 2 2 2\n",
                 (const float[4][3]){{1, 2, 3}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}});
    transform_is("", "Scale 2 2 2 Translate 1 2 3\n",
                 (const float[4][3]){{2, 4, 6}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}});
    transform_is("",
                 "Translate 1 0 0 ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1]\n",
                 (const float[4][3]){{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}});
    transform_is("", "Scale 2 2 2 Transform [1 0 0 0 0 1 0 0 0 0 1 0 8 8 8 1]\n",
                 (const float[4][3]){{8, 8, 8}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("",
                 "Translate 3 0 0 CoordinateSystem \"here\" Identity "
                 "CoordSysTransform \"here\"\n",
                 (const float[4][3]){{3, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("Translate 1 2 3\n", "CoordSysTransform \"camera\"\n",
                 (const float[4][3]){{-1, -2, -3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("", "Scale 2 2 2 CoordSysTransform \"world\"\n",
                 (const float[4][3]){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    transform_is("TransformTimes 0 1\n",
                 "AttributeBegin Scale 9 9 9 ActiveTransform EndTime AttributeEnd "
                 "TransformBegin Translate 5 5 5 TransformEnd Translate 1 1 1\n",
                 (const float[4][3]){{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
}

static void test_camera_stands_at_its_directive(void)
{
    g_autoptr(view) v = view_of("Scale -1 1 1\nLookAt 1 2 3  1 2 10  0 1 0\n" CAMERA
                                "Film \"rgb\" \"integer xresolution\" 30 "
                                "\"integer yresolution\" 20\n"
                                "Translate 9 9 9\nWorldBegin\n" LIGHT);
    vec3 eye = transform_point(&v->camera.to_world, vec3_make(0, 0, 0));
    vec3 right = transform_vector(&v->camera.to_world, vec3_make(1, 0, 0));
    g_assert_true(length3(eye - vec3_make(1, 2, 3)) < 1e-5f);
    g_assert_true(length3(right - vec3_make(-1, 0, 0)) < 1e-5f);
    g_assert_cmpint(v->camera.width, ==, 30);
    g_assert_cmpint(v->film.height, ==, 20);
}

static const char *material_kind_of(const scene *s, guint i)
{
    int index = shape_at(s, i)->material;
    return index == NO_INDEX ? ""
                             : ((const material *)s->materials->pdata[index])->kind->name;
}

static void test_materials_follow_attributes(void)
{
    g_autoptr(scene) s = scene_of(
        CAMERA "WorldBegin\n" LIGHT PROBE
               "MakeNamedMaterial \"metal\" \"string type\" \"conductor\"\n"
               "MakeNamedMaterial \"air\" \"string type\" \"interface\"\n"
               "AttributeBegin\n  NamedMaterial \"metal\"\n" PROBE
               "  AttributeBegin Material \"dielectric\"\n" PROBE "  AttributeEnd\n" PROBE
               "  NamedMaterial \"air\"\n" PROBE "AttributeEnd\n" PROBE
               "Material \"\"\n" PROBE "Material \"none\"\n" PROBE);
    static const char *const want[] = {"diffuse", "conductor", "dielectric", "conductor",
                                       "",        "diffuse",   "",           ""};
    g_assert_cmpuint(s->shapes->len, ==, G_N_ELEMENTS(want));
    for (guint i = 0; i < s->shapes->len; i++)
        g_assert_cmpstr(material_kind_of(s, i), ==, want[i]);
    g_assert_cmpint(shape_at(s, 0)->material, ==, shape_at(s, 5)->material);
    g_assert_cmpint(shape_at(s, 1)->material, ==, shape_at(s, 3)->material);
}

static void test_area_lights_follow_attributes(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin\n"
                        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
                        "Shape \"sphere\"\nMaterial \"interface\" Shape \"disk\"\n"
                        "AttributeEnd\nShape \"sphere\"\n");
    g_assert_cmpuint(s->lights->len, ==, 2);
    g_assert_cmpint(shape_at(s, 0)->light, ==, 0);
    g_assert_cmpint(shape_at(s, 1)->light, ==, 1);
    g_assert_cmpint(shape_at(s, 1)->material, ==, NO_INDEX);
    g_assert_cmpint(shape_at(s, 2)->light, ==, NO_INDEX);
}

/** The first shape's normal as seen from +z. */
static float normal_z(const char *before)
{
    g_autofree char *text =
        g_strconcat(CAMERA "WorldBegin\n" LIGHT, before, "Shape \"disk\"\n", NULL);
    g_autoptr(scene) s = scene_of(text);
    ray r = {.origin = vec3_make(0.2f, 0.1f, 5),
             .direction = vec3_make(0, 0, -1),
             .t_max = INFINITY};
    surface_hit hit;
    g_assert_true(scene_intersect(s, &r, &hit));
    return hit.n_geom[2];
}

static void test_reverse_orientation_toggles(void)
{
    g_assert_cmpfloat(normal_z("") * normal_z("ReverseOrientation\n"), <, 0.0f);
    g_assert_cmpfloat(normal_z("") * normal_z("ReverseOrientation ReverseOrientation\n"),
                      >, 0.0f);
    g_assert_cmpfloat(normal_z("") *
                          normal_z("AttributeBegin ReverseOrientation AttributeEnd\n"),
                      >, 0.0f);
}

static float sphere_radius(const scene *s, guint i)
{
    const shape *sphere = shape_at(s, i);
    box3 b = sphere->kind->bounds(sphere->self);
    return (b.high[0] - b.low[0]) / 2.0f;
}

static void test_attribute_gives_defaults(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin\n" LIGHT "Attribute \"shape\" \"float radius\" 3\n"
                        "Shape \"sphere\"\nShape \"sphere\" \"float radius\" 2\n"
                        "AttributeBegin\n Attribute \"shape\" \"float radius\" [5]\n"
                        " Shape \"sphere\"\nAttributeEnd\nShape \"sphere\"\n" PROBE
                        "Attribute \"material\" \"bool remaproughness\" false\n"
                        "Material \"conductor\" Material \"diffuse\"\n");
    static const float want[] = {3, 2, 5, 3};
    for (guint i = 0; i < 4; i++)
        g_assert_true(fabsf(sphere_radius(s, i) - want[i]) < 1e-4f);
}

static void test_values_in_every_spelling(void)
{
    static const char *const spellings[] = {
        "\"float radius\" 2",       "\"float radius\" [2]",    "\"float radius\"[ 2.0 ]",
        "\"float radius\" +2",      "\"float radius\" 200e-2", "\"float radius\" 0.2E1",
        "\"float  radius\"\n\t2\r", "\" float radius \" .2e1", "\"float radius\"#2\n2"};
    for (size_t i = 0; i < G_N_ELEMENTS(spellings); i++) {
        g_autofree char *text = g_strconcat(
            CAMERA "WorldBegin\n" LIGHT "Shape \"sphere\" ", spellings[i], "\n", NULL);
        g_autoptr(scene) s = scene_of(text);
        g_assert_true(fabsf(sphere_radius(s, 0) - 2.0f) < 1e-4f);
    }
}

static void test_spectra_in_every_spelling(void)
{
    scene_folder f = folder_new(
        CAMERA "WorldBegin\nColorSpace \"rec2020\"\n"
               "LightSource \"point\" \"spectrum I\" \"stdillum-D65\"\n"
               "LightSource \"point\" \"blackbody I\" 3000\n"
               "LightSource \"point\" \"rgb I\" [1 2 3]\n"
               "Material \"diffuse\" \"spectrum reflectance\" [400 .1 700 .9]\n"
               "Material \"diffuse\" \"spectrum reflectance\" \"a.spd\"\n"
               "Material \"conductor\" \"spectrum eta\" [\"metal-Au-eta\"]\n"
               "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n"
               "Material \"dielectric\" \"float eta\" 1.3\n");
    folder_write(&f, "a.spd", "# nm value\n400 0.1\n700 0.2 # end\n", -1);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(s->lights->len, ==, 3);
    g_assert_cmpuint(s->materials->len, ==, 5);
    folder_remove(&f);
}

static void test_include_and_import(void)
{
    scene_folder f =
        folder_new(CAMERA "WorldBegin\n" LIGHT "Include \"a.pbrt\"\n"
                          "Include \"a.pbrt\"\n" PROBE "Import \"a.pbrt\"\n" PROBE);
    folder_write(&f, "a.pbrt", "Translate 1 0 0\nShape \"sphere\"", -1);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(s->shapes->len, ==, 5);
    float columns[4][3];
    probe_columns(s, columns);
    g_assert_true(fabsf(columns[0][0] - 2.0f) < 1e-6f);
    folder_remove(&f);
}

static void test_gzip_is_read(void)
{
    scene_folder f =
        folder_new(CAMERA "WorldBegin\n" LIGHT "Shape \"plymesh\" \"string filename\" "
                          "\"mesh.ply.gz\"\n");
    folder_write(&f, "mesh.ply.gz", "", 0);
    gzFile file = gzopen(f.files->pdata[1], "wb");
    gzputs(file,
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
           "property float y\nproperty float z\nelement face 1\nproperty list uchar "
           "int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n");
    gzclose(file);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    g_assert_no_error(error);
    g_assert_true(fabsf(shape_at(s, 0)->area - 0.5f) < 1e-6f);
    folder_remove(&f);
}

/* ---- Integrators as settings ---- */

static settings settings_of(const char *options)
{
    g_autofree char *text = g_strconcat(CAMERA "Film \"rgb\" \"integer xresolution\" 30 "
                                               "\"integer yresolution\" 20\n",
                                        options, "WorldBegin\n" LIGHT, NULL);
    g_autoptr(scene) s = scene_of(text);
    return s->settings;
}

static void test_photonmap_takes_settings(void)
{
    settings s =
        settings_of("Sampler \"halton\" \"integer pixelsamples\" 9 \"integer seed\" 7\n"
                    "Integrator \"photonmap\" \"integer passes\" 3 \"float radius\" 0.1\n"
                    "  \"bool final_gather\" true \"string photon_map\" \"kdtree\"\n"
                    "  \"float photons\" 1e6 \"integer CAUSTIC_NEARBY_PHOTONS\" 60\n");
    g_assert_cmpint(s.passes, ==, 3);
    g_assert_cmpint(s.spp, ==, 9);
    g_assert_cmpint(s.seed, ==, 7);
    g_assert_true(fabs(s.radius - 0.1) < 1e-15);
    g_assert_true(s.final_gather);
    g_assert_cmpint(s.photon_map, ==, MAP_KDTREE);
    g_assert_cmpint(s.photons, ==, 1000000);
    g_assert_cmpint(s.class_nearest[2], ==, 60);
    s = settings_of("Integrator \"photonmap\" \"integer spp\" 2\n"
                    "Sampler \"sobol\" \"integer pixelsamples\" 9\n");
    g_assert_cmpint(s.spp, ==, 2);
    s = settings_of("Integrator \"auto\" \"integer max_backward_bounces\" 3\n"
                    "  \"integer max_forward_bounces\" -1\n");
    g_assert_cmpint(s.max_backward_bounces, ==, 3);
    g_assert_cmpint(s.max_forward_bounces, ==, -1);
    s = settings_of("Integrator \"vcm\" \"integer max_forward_bounces\" 0\n"
                    "  \"string max_backward_bounces\" \"unlimited\"\n");
    g_assert_cmpint(s.max_backward_bounces, ==, -1);
    g_assert_cmpint(s.max_forward_bounces, ==, 0);
}

static void test_sppm_becomes_photonmap(void)
{
    settings s = settings_of("Sampler \"halton\" \"integer pixelsamples\" 50\n"
                             "Integrator \"sppm\" \"integer maxdepth\" 8\n"
                             "  \"float radius\" 0.25 \"integer seed\" 4\n");
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_PHOTONMAP);
    g_assert_cmpint(s.passes, ==, 50);
    g_assert_cmpint(s.spp, ==, 1);
    g_assert_cmpint(s.photons, ==, 600);
    g_assert_cmpint(s.max_backward_bounces, ==, 8);
    g_assert_cmpint(s.max_forward_bounces, ==, 7);
    g_assert_true(fabs(s.radius - 0.25) < 1e-15);
    g_assert_cmpint(s.seed, ==, 4);
    s = settings_of("Integrator \"sppm\" \"integer photonsperiteration\" 1234\n");
    g_assert_cmpint(s.photons, ==, 1234);
    g_assert_cmpint(s.max_backward_bounces, ==, 5);
}

static void test_paths_become_auto_or_vcm(void)
{
    static const struct {
        const char *name;
        int integrator, strategies;
    } kinds[] = {
        {"path", INTEGRATOR_AUTO, VCM_ALL},
        {"volpath", INTEGRATOR_AUTO, VCM_ALL},
        {"simplepath", INTEGRATOR_AUTO, VCM_ALL},
        {"simplevolpath", INTEGRATOR_AUTO, VCM_ALL},
        {"randomwalk", INTEGRATOR_AUTO, VCM_ALL},
        {"bdpt", INTEGRATOR_VCM, VCM_BPT},
        {"lightpath", INTEGRATOR_VCM, VCM_LIGHT},
        {"mlt", INTEGRATOR_VCM, VCM_ALL},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        g_autofree char *text =
            g_strdup_printf("Integrator \"%s\" \"integer maxdepth\" 65\n"
                            "Sampler \"sobol\" \"integer pixelsamples\" 64\n",
                            kinds[i].name);
        settings s = settings_of(text);
        g_assert_cmpint(s.integrator, ==, kinds[i].integrator);
        g_assert_cmpint(s.vcm_strategies, ==, kinds[i].strategies);
        g_assert_cmpint(s.passes, ==, 16);
        g_assert_cmpint(s.spp, ==, 4);
        g_assert_cmpint(s.max_backward_bounces, ==, 65);
        g_assert_cmpint(s.max_forward_bounces, ==, 64);
    }
    settings s = settings_of("Integrator \"path\" \"bool regularize\" true\n"
                             "Sampler \"stratified\" \"integer xsamples\" 3 \"integer "
                             "ysamples\" 1 \"bool jitter\" true\n");
    g_assert_cmpint(s.passes, ==, 1);
    g_assert_cmpint(s.spp, ==, 3);
}

static void test_own_integrators_keep_their_names(void)
{
    settings s = settings_of("Integrator \"vcm\" \"string vcm_strategies\" \"bpm\"\n");
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_VCM);
    g_assert_cmpint(s.vcm_strategies, ==, VCM_BPM);
    s = settings_of("Integrator \"auto\" \"integer caustic_photons\" 5000\n");
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_AUTO);
    g_assert_cmpint(s.class_photons[2], ==, 5000);
}

/* Whatever is registered can be said, by pbrt-v3's files too. */
static void test_registered_integrators_are_known(void)
{
    const char *const *words = settings_find("integrator")->words;
    static const char *const films[] = {"rgb", "image"}; /* of v4, of v3 */
    for (size_t f = 0; f < G_N_ELEMENTS(films); f++) {
        for (int k = 0; k < N_INTEGRATORS; k++) {
            g_autofree char *text =
                g_strdup_printf(CAMERA "Film \"%s\" Integrator \"%s\" WorldBegin\n" LIGHT,
                                films[f], words[k]);
            g_autoptr(scene) s = scene_of(text);
            int want = k == INTEGRATOR_PATH ? INTEGRATOR_AUTO : k; /* pbrt's own word */
            g_assert_cmpint(s->settings.integrator, ==, want);
        }
    }
}

static void test_no_integrator_is_the_default(void)
{
    settings s = settings_of("Option \"integer seed\" 11 \"bool wavefront\" true\n"
                             "Accelerator \"bvh\" \"integer maxnodeprims\" 4\n");
    settings d = settings_default();
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_AUTO);
    g_assert_cmpint(s.passes, ==, d.passes);
    g_assert_cmpint(s.spp, ==, d.spp);
    g_assert_cmpint(s.seed, ==, 11);
}

static void keep_note(log_level level, const char *text, void *data)
{
    g_assert_cmpint(level, ==, LOG_NOTE);
    g_string_append_printf(data, "%s\n", text);
}

/* As pbrt reads it: the last counts, whatever its type, and so does what is given itself
 * before what Attribute gives. */
static void test_last_of_repeated_counts(void)
{
    g_autoptr(GString) notes = g_string_new(NULL);
    log_sink sink = {keep_note, notes};
    scene_folder f =
        folder_new(CAMERA "WorldBegin\n" LIGHT
                          "Shape \"sphere\" \"float radius\" 1 \"float radius\" [3]\n"
                          "Attribute \"shape\" \"float radius\" 4 \"float radius\" 5\n"
                          "Shape \"sphere\" \"string radius\" \"x\" \"float radius\" 2\n"
                          "Shape \"sphere\"\n");
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, &sink, &error);
    g_assert_no_error(error);
    static const float want[] = {3, 2, 5};
    for (guint i = 0; i < 3; i++)
        g_assert_true(fabsf(sphere_radius(s, i) - want[i]) < 1e-4f);
    g_autofree char *text =
        g_strdup_printf("%s:4:33: parameter 'radius' is given again: the last counts\n"
                        "%s:5:36: parameter 'radius' is given again: the last counts\n"
                        "%s:6:36: parameter 'radius' is given again: the last counts\n",
                        f.main, f.main, f.main);
    g_assert_cmpstr(notes->str, ==, text);
    folder_remove(&f);
}

static void test_notes_say_what_was_chosen(void)
{
    g_autoptr(GString) notes = g_string_new(NULL);
    log_sink sink = {keep_note, notes};
    scene_folder f = folder_new(CAMERA "Integrator \"path\" \"integer maxdepth\" 3\n"
                                       "WorldBegin\n" LIGHT);
    g_autoptr(scene) s = format_load(f.main, 1, &sink, NULL);
    g_assert_nonnull(s);
    g_autofree char *want = g_strdup_printf(
        "%s:2:12: integrator 'path' becomes auto with 16 passes of 4 "
        "samples a pixel and maxdepth 3; paths alone: --integrator path\n",
        f.main);
    g_assert_cmpstr(notes->str, ==, want);
    folder_remove(&f);
}

/* ---- Scenes of others ---- */

static void test_published_scenes_load_unchanged(void)
{
    static const struct {
        const char *name;
        guint n_shapes, n_lights, n_media;
    } scenes[] = {{"bitterli/cornell-box/scene-v4.pbrt", 8, 1, 0},
                  {"bitterli/coffee/scene-v4.pbrt", 23, 3, 0},
                  {"bitterli/veach-mis/scene-v4.pbrt", 9, 3, 0},
                  {"bitterli/volumetric-caustic/scene-v4.pbrt", 8, 1, 1},
                  {"spectral/cornell-glass.pbrt", 8, 1, 0},
                  {"spectral/ring.pbrt", 3, 1, 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(scenes); i++) {
        g_autofree char *path =
            g_build_filename(SOURCE_ROOT, "../shared/refs", scenes[i].name, NULL);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no reference scenes beside the source");
            return;
        }
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = format_load(path, 1, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpuint(s->shapes->len, ==, scenes[i].n_shapes);
        g_assert_cmpuint(s->lights->len, ==, scenes[i].n_lights);
        g_assert_cmpuint(s->media->len, ==, scenes[i].n_media);
    }
}

static void test_own_scenes_load(void)
{
    static const struct {
        const char *name;
        integrator_choice integrator;
    } own[] = {{"cornell-box", INTEGRATOR_PHOTONMAP},
               {"cobblers-globe", INTEGRATOR_PHOTONMAP},
               {"glass-ball", INTEGRATOR_AUTO},
               {"ring", INTEGRATOR_AUTO}};
    for (size_t i = 0; i < G_N_ELEMENTS(own); i++) {
        g_autofree char *path = g_strdup_printf("%s/scenes/%s/%s.pbrt", SOURCE_ROOT,
                                                own[i].name, own[i].name);
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = format_load(path, 1, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpint(s->settings.integrator, ==, own[i].integrator);
    }
}

/* As pbrt-v4 has them, a name and a value, and as parameters. */
static void test_options(void)
{
    static const char *const texts[] = {
        "Option \"disable-pixel-jitter\" true\nOption \"seed\" 5\n",
        "Option \"bool disablepixeljitter\" true \"integer seed\" 5\n",
        "Option \"disablePixelJitter\" true Option \"disablewavelengthjitter\" false\n"
        "Option \"rendercoordsys\" \"world\" Option \"displacementedgescale\" 1.5\n"
        "Option \"seed\" 5\n"};
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++) {
        g_autofree char *text = g_strconcat(
            texts[i],
            "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\nShape "
            "\"sphere\"\n",
            NULL);
        g_autoptr(scene) s = scene_of(text);
        g_assert_true(s->switches.fixed_pixels);
        g_assert_false(s->switches.fixed_wavelengths);
        g_assert_cmpint(s->settings.seed, ==, 5);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt/options", test_options);
    g_test_add_func("/pbrt/each-transform", test_each_transform);
    g_test_add_func("/pbrt/transforms-compose", test_transforms_compose);
    g_test_add_func("/pbrt/camera", test_camera_stands_at_its_directive);
    g_test_add_func("/pbrt/materials", test_materials_follow_attributes);
    g_test_add_func("/pbrt/area-lights", test_area_lights_follow_attributes);
    g_test_add_func("/pbrt/reverse-orientation", test_reverse_orientation_toggles);
    g_test_add_func("/pbrt/attribute", test_attribute_gives_defaults);
    g_test_add_func("/pbrt/values", test_values_in_every_spelling);
    g_test_add_func("/pbrt/spectra", test_spectra_in_every_spelling);
    g_test_add_func("/pbrt/include-and-import", test_include_and_import);
    g_test_add_func("/pbrt/gzip", test_gzip_is_read);
    g_test_add_func("/pbrt/photonmap", test_photonmap_takes_settings);
    g_test_add_func("/pbrt/sppm", test_sppm_becomes_photonmap);
    g_test_add_func("/pbrt/path", test_paths_become_auto_or_vcm);
    g_test_add_func("/pbrt/own-integrators", test_own_integrators_keep_their_names);
    g_test_add_func("/pbrt/registered-integrators",
                    test_registered_integrators_are_known);
    g_test_add_func("/pbrt/no-integrator", test_no_integrator_is_the_default);
    g_test_add_func("/pbrt/repeated", test_last_of_repeated_counts);
    g_test_add_func("/pbrt/notes", test_notes_say_what_was_chosen);
    g_test_add_func("/pbrt/published-scenes", test_published_scenes_load_unchanged);
    g_test_add_func("/pbrt/own-scenes", test_own_scenes_load);
    return g_test_run();
}
