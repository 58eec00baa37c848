/*
 * gltf: the reader against small files made here, whose content is known: where things
 * stand, what they are made of, what is noted, and what is refused with the way to it;
 * and damaged files, which may be refused but must do no harm.
 */
#include "gltf_text.h"
#include "math/sampler.h"

#include <math.h>

#define BLENDER ",\"generator\":\"Khronos glTF Blender I/O v3.4.50\""

/* ---- What is read ---- */

static void test_shapes(void)
{
    static const char *const nodes[] = {
        NODES,
        "\"nodes\":[{\"children\":[1],\"translation\":[0,0,10]},{\"mesh\":0,\"scale\":[2,"
        "2,2],\"rotation\":[0,0,0.70710678,0.70710678]}],\"scenes\":[{\"nodes\":[0]}],",
        "\"nodes\":[{\"children\":[1]},{\"mesh\":0,\"matrix\":[1,0,0,0, 0,2,0,0, "
        "0,0,3,0, "
        "4,5,6,1]}],",
    };
    static const float high[][3] = {{1, 1, 1}, {0, 2, 12}, {5, 7, 9}};
    static const float low[][3] = {{0, 0, 0}, {-2, 0, 10}, {4, 5, 6}};
    for (size_t i = 0; i < G_N_ELEMENTS(nodes); i++)
        for (int quantized = 0; quantized < 2; quantized++) {
            g_autofree char *text = g_strdup_printf(
                "\"materials\":[{}],%s%s", quantized ? MESH("1") : MESH("0"), nodes[i]);
            g_autoptr(scene) s = load(text, NULL);
            g_assert_cmpuint(s->shapes->len, ==, 1);
            assert_at(s->bounds.high, high[i][0], high[i][1], high[i][2]);
            assert_at(s->bounds.low, low[i][0], low[i][1], low[i][2]);
        }
    g_autoptr(scene) sparse = load("\"materials\":[{}]," MESH("3") NODES, NULL);
    assert_at(sparse->bounds.high, 1, 1, 5);
}

/* The same document in each way to keep its numbers. */
static void test_containers(void)
{
    static const char middle[] = HEAD "\"materials\":[{}]," MESH("0") NODES;
    g_autofree char *json = g_strdup_printf(
        "%s\"buffers\":[{\"byteLength\":%zu}]," VIEWS "}", middle, sizeof tetrahedron);
    while (strlen(json) % 4) {
        char *longer = g_strconcat(json, " ", NULL);
        g_free(json);
        json = longer;
    }
    uint32_t words[] = {0x46546C67, 2, 0, (uint32_t)strlen(json), 0x4E4F534A};
    uint32_t chunk[] = {sizeof tetrahedron, 0x004E4942};
    words[2] =
        (uint32_t)(sizeof words + strlen(json) + sizeof chunk + sizeof tetrahedron);
    g_autoptr(GByteArray) glb = g_byte_array_new();
    g_byte_array_append(glb, (const guint8 *)words, sizeof words);
    g_byte_array_append(glb, (const guint8 *)json, (guint)strlen(json));
    g_byte_array_append(glb, (const guint8 *)chunk, sizeof chunk);
    g_byte_array_append(glb, (const guint8 *)&tetrahedron, sizeof tetrahedron);
    g_autofree char *beside = g_strdup_printf(
        "%s\"buffers\":[{\"byteLength\":%zu,\"uri\":\"body%%2Ebin\"}]," VIEWS "}", middle,
        sizeof tetrahedron);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) a =
        load_bytes("a.glb", (const char *)glb->data, (gssize)glb->len, NULL, &error);
    g_assert_no_error(error);
    g_autoptr(scene) b = load_bytes("b.gltf", beside, -1, NULL, &error);
    g_assert_no_error(error);
    /* By its content, whatever its name. */
    g_autoptr(scene) c =
        load_bytes("c.txt", (const char *)glb->data, (gssize)glb->len, NULL, &error);
    g_assert_no_error(error);
    assert_at(a->bounds.high, 1, 1, 1);
    assert_at(b->bounds.high, 1, 1, 1);
    assert_at(c->bounds.high, 1, 1, 1);
}

/* Lamps of 683 cd and 1366 lx; a camera that looks along its -z with y up. */
static void test_lights_and_camera(void)
{
    g_autoptr(view) v = load_shown(
        "\"materials\":[{}]," MESH(
            "0") "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
                 "\"point\","
                 "\"intensity\":683},{\"type\":\"directional\",\"intensity\":1366},{"
                 "\"type\":"
                 "\"spot\",\"intensity\":683,\"spot\":{\"outerConeAngle\":0.5}}]}},"
                 "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.6,"
                 "\"aspectRatio\":2}}],"
                 "\"nodes\":[{\"mesh\":0},{\"extensions\":{\"KHR_lights_punctual\":{"
                 "\"light\":0}},"
                 "\"translation\":[0,0,2]},{\"extensions\":{\"KHR_lights_punctual\":{"
                 "\"light\":1}}"
                 "},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}},"
                 "\"translation\":[0,0,2]"
                 "},{\"camera\":0,\"translation\":[3,0,9],\"scale\":[2,2,2]}],",
        NULL);
    wavelengths w = wavelengths_at(0.5f);
    light_sample to[3];
    for (int i = 0; i < 3; i++) {
        const light *l = scene_light(v->scene, i);
        g_assert_true(l->kind->sample(l->self, &w, vec3_make(0, 0, 0), 0.5f,
                                      (vec2){0.5f, 0.5f}, &to[i]));
        assert_at(to[i].wi, 0, 0, 1);
    }
    float point = spectrum_mean(to[0].radiance), sun = spectrum_mean(to[1].radiance);
    float spot = spectrum_mean(to[2].radiance);
    g_assert_cmpfloat(fabsf(sun / point - 8.0f), <, 1e-3f); /* 2 over 1/2² */
    g_assert_cmpfloat(fabsf(spot / point - 1.0f), <, 1e-3f);

    vec2 raster;
    g_assert_cmpint(v->film.width, ==, 2 * v->film.height);
    g_assert_true(camera_project(&v->camera, vec3_make(3, 0, 0), &raster));
    g_assert_cmpfloat(fabsf(raster.x - 0.5f * (float)v->film.width), <, 0.01f);
    g_assert_true(camera_project(&v->camera, vec3_make(4, 9 * tanf(0.3f), 0), &raster));
    g_assert_cmpfloat(raster.x, >, 0.5f * (float)v->film.width);
    g_assert_cmpfloat(fabsf(raster.y), <, 0.1f);
}

/* The luminance that a sun of so many lux brings to a place that it shines on. */
static double lux_of(const char *asset, const char *lights)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *buffers = buffer_uri();
    g_autofree char *text = g_strdup_printf(
        "{\"asset\":{\"version\":\"2.0\"%s},\"materials\":[{}]," MESH(
            "0") "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[%s]}},\"nodes\":[{"
                 "\"mesh\":0},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
                 "%s" VIEWS "}",
        asset, lights, buffers);
    g_autoptr(scene) s = load_bytes("a.gltf", text, -1, NULL, &error);
    g_assert_no_error(error);
    double sum = 0.0;
    for (int i = 0; i < 32; i++) {
        wavelengths w = wavelengths_at(((float)i + 0.5f) / 32.0f);
        const light *l = scene_light(s, 0);
        light_sample to;
        float xyz[3];
        g_assert_true(l->kind->sample(l->self, &w, vec3_make(0, 0, -1), 0.5f,
                                      (vec2){0.5f, 0.5f}, &to));
        spectrum_to_xyz(&w, to.radiance, xyz);
        sum += (double)xyz[1] / 32.0;
    }
    return sum;
}

/* A lux is a lux, and a candela at a metre is one too; what Blender made of watts is
   watts again, unless it left them as they were. */
static void test_units(void)
{
#define SUN(lux) "{\"type\":\"directional\",\"intensity\":" lux "}"
#define BULB(candela) "{\"type\":\"point\",\"intensity\":" candela "}"
    static const struct {
        const char *asset, *lights;
        double lux;
    } cases[] = {
        {"", SUN("2.5"), 2.5},
        {"", SUN("100000"), 100000.0},
        {"", BULB("80"), 80.0},
        {BLENDER, SUN("2.5"), 2.5},
        {BLENDER, SUN("1707.5"), 2.5},
        {BLENDER, BULB("80"), 80.0}, /* 1000 W, left as it was, over 4 pi */
        {BLENDER, BULB("54351.4"), 79.58},
        {BLENDER, BULB("80") "," SUN("1707.5"), 80.0 / 683.0},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        double found = lux_of(cases[i].asset, cases[i].lights);
        g_test_message("%s %s: %g", cases[i].asset, cases[i].lights, found);
        g_assert_cmpfloat(fabs(found / cases[i].lux - 1.0), <, 0.01);
    }
}

/* A spot lamp's light at an angle off its axis, as a share of that along it. */
static double spot_share(const char *asset, const char *cone, double angle)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *buffers = buffer_uri();
    g_autofree char *text = g_strdup_printf(
        "{\"asset\":{\"version\":\"2.0\"%s},\"materials\":[{}]," MESH(
            "0") "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
                 "\"spot\",\"spot\":{%s}}]}},\"nodes\":[{\"mesh\":0},{\"extensions\":{"
                 "\"KHR_lights_punctual\":{\"light\":0}}}],%s" VIEWS "}",
        asset, cone, buffers);
    g_autoptr(scene) s = load_bytes("a.gltf", text, -1, NULL, &error);
    g_assert_no_error(error);
    const light *l = scene_light(s, 0);
    wavelengths w = wavelengths_at(0.5f);
    double found[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        light_sample to;
        vec3 p = vec3_make((float)sin(i * angle), 0.0f, (float)-cos(i * angle));
        if (l->kind->sample(l->self, &w, p, 0.5f, (vec2){0.5f, 0.5f}, &to))
            found[i] = (double)spectrum_mean(to.radiance);
    }
    return found[1] / found[0];
}

/* Blender's lamp of 70 degrees across and a blend of a half is at full strength where
 * 1 - cos is half of that at the edge, and fades by smoothstep in it from there on. */
static void test_spot_edges(void)
{
#define SOFT "\"innerConeAngle\":0.305432619,\"outerConeAngle\":0.610865238"
#define SHARP "\"innerConeAngle\":0.5,\"outerConeAngle\":0.5"
    const double edge = 1.0 - cos(0.610865238), tiny = 1e-4;
    for (double share = 0.49; share < 1.0; share += 0.125) {
        double x = CLAMP((1.0 - share) / 0.5, 0.0, 1.0);
        double want = x * x * (3.0 - 2.0 * x);
        double found = spot_share(BLENDER, SOFT, acos(1.0 - share * edge));
        g_assert_cmpfloat(fabs(found - want), <, tiny);
    }
    g_assert_cmpfloat(spot_share("", SOFT, 0.30), >, 1.0 - tiny);
    g_assert_cmpfloat(spot_share("", SOFT, 0.35), <, 0.99);
    for (int i = 0; i < 2; i++) {
        const char *from = i ? BLENDER : "";
        g_assert_cmpfloat(spot_share(from, SHARP, 0.499), >, 1.0 - tiny);
        g_assert_cmpfloat(spot_share(from, SHARP, 0.501), <, tiny);
    }
}

static void test_defaults(void)
{
    notes kept = {g_string_new(NULL)};
    g_autoptr(view) v = load_shown("\"materials\":[{}]," MESH("0") NODES, &kept);
    g_assert_nonnull(
        strstr(kept.text->str, "no light in it; a soft environment is added"));
    g_assert_nonnull(strstr(kept.text->str, "no camera in it; one that frames it"));
    for (int k = 0; k < 4; k++) {
        vec2 raster;
        const float *p = tetrahedron.positions + 3 * k;
        g_assert_true(camera_project(&v->camera, vec3_make(p[0], p[1], p[2]), &raster));
        g_assert_cmpfloat(raster.x, >, 0.0f);
        g_assert_cmpfloat(raster.x, <, (float)v->film.width);
        g_assert_cmpfloat(raster.y, >, 0.0f);
        g_assert_cmpfloat(raster.y, <, (float)v->film.height);
    }
    /* The sky is brighter above than below. */
    wavelengths w = wavelengths_at(0.5f);
    spectrum up = sky_at(v->scene, vec3_make(0, 1, 0), &w);
    spectrum down = sky_at(v->scene, vec3_make(0, -1, 0), &w);
    g_assert_cmpfloat(spectrum_mean(up), >, 1.5f * spectrum_mean(down));
    g_string_free(kept.text, TRUE);
}

/* What a file requires, and what only looks otherwise without: shown, and said. What its
 * data cannot be read without, and what nobody knows, is refused by name. */
static void test_required(void)
{
    static const struct {
        const char *name;
        bool is_shown, is_noted;
    } cases[] = {
        {"KHR_materials_iridescence", true, true},
        {"KHR_materials_sheen", true, true},
        {"KHR_materials_volume_scatter", true, true},
        {"KHR_materials_variants", true, true},
        {"KHR_animation_pointer", true, true},
        {"KHR_interactivity", true, true},
        {"KHR_xmp_json_ld", true, true},
        {"KHR_materials_specular", true, false},
        {"KHR_materials_anisotropy", true, false},
        {"KHR_materials_dispersion", true, false},
        {"KHR_texture_transform", true, false},
        {"KHR_node_visibility", true, false},
        {"KHR_draco_mesh_compression", false, false},
        {"KHR_meshopt_compression", false, false},
        {"EXT_texture_webp", false, false},
        {"XYZ_not_known", false, false},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        notes kept = {g_string_new(NULL)};
        g_autoptr(GError) error = NULL;
        g_autofree char *middle =
            g_strdup_printf("\"extensionsUsed\":[\"%s\"],\"extensionsRequired\":[\"%s\"],"
                            "\"materials\":[{}]," MESH("0") NODES,
                            cases[i].name, cases[i].name);
        g_autofree char *text = document(middle);
        g_autoptr(scene) s = load_bytes("a.gltf", text, -1, &kept, &error);
        g_test_message("%s", cases[i].name);
        g_assert_true((s != NULL) == cases[i].is_shown);
        const char *said = s ? kept.text->str : error->message;
        bool is_named = strstr(said, cases[i].name) != NULL;
        g_assert_true(is_named == (cases[i].is_noted || !cases[i].is_shown));
        g_string_free(kept.text, TRUE);
    }
}

/* A node that is not to be seen, and what hangs on it. */
static void test_hidden(void)
{
#define HIDDEN ",\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}"
    g_autoptr(scene) s = load(
        "\"materials\":[{}]," MESH("0") "\"nodes\":[{\"mesh\":0},{\"children\":[2,3]"
                                        "},{\"mesh\":0" HIDDEN
                                        "},{\"children\":[4]" HIDDEN "},{\"mesh\":0}],",
        NULL);
    g_assert_cmpuint(s->shapes->len + s->instances->len, ==, 2); /* an object, once */
}

/* Who packs a mesh and does not require that it is unpacked says the same plainly. */
static void test_packed_beside(void)
{
    static const char middle[] =
        "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"materials\":[{}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,"
        "\"material\":0,\"extensions\":{\"KHR_draco_mesh_compression\":{"
        "\"bufferView\":1,\"attributes\":{\"POSITION\":0}}}}]}]," NODES;
    g_autoptr(scene) packed = load(middle, NULL);
    g_autoptr(scene) plain = load("\"materials\":[{}]," MESH("0") NODES, NULL);
    g_assert_cmpuint(packed->shapes->len, >, 0);
    g_assert_cmpuint(packed->shapes->len, ==, plain->shapes->len);
    g_assert_cmpfloat(packed->radius, ==, plain->radius);
}

/* ---- What is refused ---- */

static void test_refused(void)
{
    static const struct {
        const char *middle, *message;
    } cases[] = {
        {"\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
         "extensionsRequired[0]: the file requires the extension "
         "KHR_draco_mesh_compression, which is not supported"},
        {"\"extensionsRequired\":[7],", "extensionsRequired[0]: expected a string"},
        {"\"nodes\":[{\"children\":[0]}],\"scenes\":[{\"nodes\":[0]}],",
         "nodes[0]: the node is met twice"},
        {"\"nodes\":[{\"mesh\":4}],", "\"mesh\" 4: there are only 0 meshes"},
        {"\"nodes\":[{\"children\":[\"x\"]}],",
         "nodes[0].children[0]: expected a whole number in 0..0"},
        {"\"nodes\":[{\"translation\":[1,2]}],",
         "nodes[0].translation: expected 3 numbers, found 2"},
        {"\"materials\":[{}],\"meshes\":[{\"primitives\":[{\"attributes\":{}}]}]," NODES,
         "meshes[0].primitives[0].attributes: expected a POSITION, found none"},
        {"\"materials\":[{}]," MESH("9") NODES,
         "accessors: expected more than 9 elements, found 4"},
        {"\"materials\":[{}]," MESH("2") NODES,
         "accessors[2]: expected 3 components, found 1"},
        {"\"materials\":[{\"extensions\":{\"KHR_materials_ior\":{\"ior\":0.5}}}]," MESH(
             "0") NODES,
         "expected an \"ior\" of 0 or at least 1, found 0.5"},
        {"\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}"
         "]," MESH("0") NODES,
         "\"index\" 0: there are only 0 textures"},
        {"\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":\"x\"}}]," MESH(
             "0") NODES,
         "materials[0].pbrMetallicRoughness.metallicFactor: expected a number"},
        {"", "expected something with a surface, found nothing"},
        {"\"scenes\":[{\"nodes\":[0]}],\"scene\":3,",
         "scenes: expected more than 3 elements, found 1"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = document(cases[i].middle);
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = load_bytes("a.gltf", text, -1, NULL, &error);
        g_assert_null(s);
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        if (!strstr(error->message, cases[i].message))
            g_error("%s\n  does not say: %s", error->message, cases[i].message);
    }
}

static void test_not_json(void)
{
    g_autofree char *deep = g_strnfill(100000, '[');
    static const char *const texts[] = {
        "",        "{", "{\"asset\":{}}", "[1,2]", "{\"asset\":{\"version\":\"1.0\"}}",
        "\xff\xfe"};
    g_autoptr(GError) error = NULL;
    g_assert_null(load_bytes("a.gltf", deep, -1, NULL, &error));
    g_assert_nonnull(strstr(error->message, "a.gltf:1:1: expected at most 200 brackets"));
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++) {
        g_clear_error(&error);
        g_assert_null(load_bytes("a.gltf", texts[i], -1, NULL, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    }
    g_clear_error(&error);
    g_assert_null(load_bytes("a.gltf", "{\n  \"asset\": }", -1, NULL, &error));
    g_assert_nonnull(strstr(error->message, "a.gltf:2:"));
}

/* Digits replaced at random: every offset, count and index comes to be wrong. */
static void test_damaged(void)
{
    g_autofree char *whole = document("\"materials\":[" GLASS("") "]," MESH("3") NODES);
    size_t size = strlen(whole), refused = 0;
    for (uint64_t i = 0; i < 150; i++) {
        sampler random = sampler_make(31, i);
        g_autofree char *text = g_strdup(whole);
        for (int k = 0; k < 3; k++) {
            size_t at = (size_t)(sampler_1d(&random) * (float)size);
            if (g_ascii_isdigit(text[at]))
                text[at] = "0123456789-.e"[(int)(sampler_1d(&random) * 13.0f)];
        }
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = load_bytes("a.gltf", text, -1, NULL, &error);
        g_assert_true((s == NULL) == (error != NULL));
        refused += s == NULL;
    }
    g_assert_cmpuint(refused, >, 5);
}

/* The files that show what the extensions mean. */
static void test_shared(void)
{
    static const char *const names[] = {"AttenuationTest", "EmissiveStrengthTest",
                                        "GlassHurricaneCandleHolder",
                                        "LightsPunctualLamp"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *path = g_strdup_printf(
            SOURCE_ROOT "/../shared/data/gltf/%s/glTF/%s.gltf", names[i], names[i]);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no shared files");
            return;
        }
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = format_load(path, 1, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpuint(s->shapes->len, >, 1);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/gltf/shapes", test_shapes);
    g_test_add_func("/gltf/containers", test_containers);
    g_test_add_func("/gltf/lights-and-camera", test_lights_and_camera);
    g_test_add_func("/gltf/units", test_units);
    g_test_add_func("/gltf/spot-edges", test_spot_edges);
    g_test_add_func("/gltf/defaults", test_defaults);
    g_test_add_func("/gltf/required", test_required);
    g_test_add_func("/gltf/hidden", test_hidden);
    g_test_add_func("/gltf/packed-beside", test_packed_beside);
    g_test_add_func("/gltf/refused", test_refused);
    g_test_add_func("/gltf/not-json", test_not_json);
    g_test_add_func("/gltf/damaged", test_damaged);
    g_test_add_func("/gltf/shared", test_shared);
    return g_test_run();
}
