/*
 * gltf: the reader against small files made here, whose content is known: where things
 * stand, what they are made of, what is noted, and what is refused with the way to it;
 * and damaged files, which may be refused but must do no harm.
 */
#include "format/format.h"
#include "math/sampler.h"
#include "scene/bsdf_models.h"
#include "scene_text.h"

#include <math.h>

/* ---- Files ---- */

/* A tetrahedron with its corners at the origin and 1 along each axis: positions, a copy
   of them as normalised bytes, indices; then two sparse values. */
typedef struct body {
    float positions[12];
    uint8_t bytes[16]; /* 3 a vertex, 4 apart */
    uint16_t indices[12];
    uint16_t sparse_index, padding;
    float sparse_value[3];
} body;

static const body tetrahedron = {
    .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
    .bytes = {0, 0, 0, 9, 255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9},
    .indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3},
    .sparse_index = 3,
    .sparse_value = {0, 0, 5},
};

#define VIEWS                                                                            \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"                                 \
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16,\"byteStride\":4},"               \
    "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":24},"                                \
    "{\"buffer\":0,\"byteOffset\":88,\"byteLength\":2},"                                 \
    "{\"buffer\":0,\"byteOffset\":92,\"byteLength\":12}],"                               \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"      \
    "\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,\"normalized\":true,\"count\":4" \
    ",\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5123,\"count\":12,\"type\"" \
    ":\"SCALAR\"},{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"        \
    "\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":"  \
    "5123},\"values\":{\"bufferView\":4}}}]"

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"
#define MESH(position)                                                                   \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":" position               \
    "},\"indices\":2,\"material\":0}]}],"
#define NODES "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],"

static char *buffer_uri(void)
{
    g_autofree char *code =
        g_base64_encode((const guchar *)&tetrahedron, sizeof tetrahedron);
    return g_strdup_printf("\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/"
                           "octet-stream;base64,%s\"}],",
                           sizeof tetrahedron, code);
}

/* The middle of a file, completed by buffers and views. */
static char *document(const char *middle)
{
    g_autofree char *buffers = buffer_uri();
    return g_strdup_printf(HEAD "%s%s" VIEWS "}", middle, buffers);
}

typedef struct notes {
    GString *text;
} notes;

static void keep_note(log_level level, const char *text, void *data)
{
    (void)level;
    g_string_append_printf(((notes *)data)->text, "%s\n", text);
}

static bool thin_glass; /* for the next load */

/* Loads a file of these bytes; NULL with its error. */
static scene *load_bytes(const char *name, const char *bytes, gssize size, notes *kept,
                         GError **error)
{
    scene_folder f = folder_new("");
    folder_write(&f, name, bytes, size);
    folder_write(&f, "body.bin", (const char *)&tetrahedron, sizeof tetrahedron);
    g_autofree char *path = g_build_filename(f.path, name, NULL);
    const log_sink sink = {keep_note, kept};
    const load_options how = {
        .threads = 1, .thin_glass = thin_glass, .log = kept ? &sink : NULL};
    scene *s = format_load_with(path, &how, error);
    if (s && kept)
        s->log = (log_sink){0};
    folder_remove(&f);
    return s;
}

static scene *load(const char *middle, notes *kept)
{
    g_autofree char *text = document(middle);
    g_autoptr(GError) error = NULL;
    scene *s = load_bytes("a.gltf", text, -1, kept, &error);
    g_assert_no_error(error);
    return s;
}

static void assert_at(vec3 p, float x, float y, float z)
{
    vec3 off = abs3(p - vec3_make(x, y, z));
    if (!(max_component3(off) < 2e-5f))
        g_error("(%g, %g, %g) is not (%g, %g, %g)", (double)p[0], (double)p[1],
                (double)p[2], (double)x, (double)y, (double)z);
}

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

/* Blender's lamps of 1 W/sr and 1 W/m²; a camera that looks along its -z with y up. */
static void test_lights_and_camera(void)
{
    g_autoptr(scene) s = load(
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
        const light *l = scene_light(s, i);
        g_assert_true(l->kind->sample(l->self, &w, vec3_make(0, 0, 0), 0.5f,
                                      (vec2){0.5f, 0.5f}, &to[i]));
        assert_at(to[i].wi, 0, 0, 1);
    }
    float point = spectrum_mean(to[0].radiance), sun = spectrum_mean(to[1].radiance);
    float spot = spectrum_mean(to[2].radiance);
    g_assert_cmpfloat(fabsf(sun / point - 8.0f), <, 1e-3f); /* 2 over 1/2² */
    g_assert_cmpfloat(fabsf(spot / point - 1.0f), <, 1e-3f);

    vec2 raster;
    g_assert_cmpint(s->film.width, ==, 2 * s->film.height);
    g_assert_true(camera_project(&s->camera, vec3_make(3, 0, 0), &raster));
    g_assert_cmpfloat(fabsf(raster.x - 0.5f * (float)s->film.width), <, 0.01f);
    g_assert_true(camera_project(&s->camera, vec3_make(4, 9 * tanf(0.3f), 0), &raster));
    g_assert_cmpfloat(raster.x, >, 0.5f * (float)s->film.width);
    g_assert_cmpfloat(fabsf(raster.y), <, 0.1f);
}

static const material *material_of(const char *json, notes *kept, scene **owner)
{
    g_autofree char *text = g_strdup_printf("\"materials\":[%s]," MESH("0") NODES, json);
    *owner = load(text, kept);
    const shape *on = (*owner)->shapes->pdata[0];
    return (*owner)->materials->pdata[on->material];
}

static bsdf bsdf_of(const material *m)
{
    static const bsdf_options plain = {0};
    wavelengths w = wavelengths_at(0.5f);
    surface_hit hit = {
        .n = {0, 0, 1}, .n_geom = {0, 0, 1}, .dpdu = {1, 0, 0}, .dpdv = {0, 1, 0}};
    bsdf b;
    material_bsdf(m, &hit, &w, ALL_LANES, &plain, &b);
    return b;
}

/* What materials scatter, straight on. */
static void test_materials(void)
{
    static const struct {
        const char *json;
        unsigned lobes;
        float albedo; /* straight on; -1: not asked */
    } cases[] = {
        /* glTF's default: rough white metal. */
        {"{}", LOBE_DIFFUSE | LOBE_REFLECTION, -1},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[0.6,0.6,0.6,1]}}",
         LOBE_SPECULAR | LOBE_REFLECTION, 0.6f},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[0.5,0.5,0.5,1]}}",
         LOBE_SPECULAR | LOBE_DIFFUSE | LOBE_REFLECTION, 0.04f + 0.96f * 0.5f},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0.5,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[0.5,0.5,0.5,1]}}",
         LOBE_SPECULAR | LOBE_DIFFUSE | LOBE_REFLECTION,
         0.5f * 0.5f + 0.5f * (0.04f + 0.96f * 0.5f)},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[0,0,0,1]},\"extensions\":{\"KHR_materials_ior\":{\"ior\":"
         "2}"
         "}}",
         LOBE_SPECULAR | LOBE_REFLECTION, 1.0f / 9.0f},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[0,0,0,1]},\"extensions\":{\"KHR_materials_specular\":{"
         "\"specularFactor\":0.5}}}",
         LOBE_SPECULAR | LOBE_REFLECTION, 0.02f},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.4,"
         "\"baseColorFactor\":[0,0,0,1]},\"extensions\":{\"KHR_materials_clearcoat\":{"
         "\"clearcoatFactor\":1}}}",
         LOBE_SPECULAR | LOBE_GLOSSY | LOBE_REFLECTION, -1},
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0,"
         "\"baseColorFactor\":[1,1,1,1]},\"extensions\":{\"KHR_materials_transmission\":{"
         "\"transmissionFactor\":1}}}",
         LOBE_SPECULAR | LOBE_REFLECTION | LOBE_TRANSMISSION, 1.0f},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(scene) s = NULL;
        bsdf b = bsdf_of(material_of(cases[i].json, NULL, &s));
        g_test_message("%s", cases[i].json);
        g_assert_cmpuint(b.lobes, ==, cases[i].lobes);
        float albedo = spectrum_mean(bsdf_albedo(&b, vec3_make(0, 0, 1), LOBE_ALL));
        if (cases[i].albedo >= 0.0f)
            g_assert_cmpfloat(fabsf(albedo - cases[i].albedo), <, 2e-3f);
    }
}

#define GLASS(more)                                                                      \
    "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0,\"metallicFactor\":0},"            \
    "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}" more     \
    "}}"

/* The tetrahedron is closed: solid, with or without a volume. */
static void test_solid_glass(void)
{
    notes kept = {g_string_new(NULL)};
    g_autoptr(scene) s = NULL;
    bsdf b = bsdf_of(material_of(GLASS(""), &kept, &s));
    bsdf_sample out;
    vec3 slanted = normalize3(vec3_make(1, 0, 1));
    g_assert_true(bsdf_sample_direction(&b, slanted, 0.9f, (vec2){0.5f, 0.5f}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &out));
    g_assert_cmpfloat(fabsf(out.wi[0] + slanted[0] / 1.5f), <, 1e-4f);
    g_assert_nonnull(strstr(kept.text->str, "1 closed mesh lets light pass"));

    g_autoptr(scene) colored = NULL;
    const material *m =
        material_of(GLASS(",\"KHR_materials_volume\":{\"thicknessFactor\":1,"
                          "\"attenuationDistance\":0.5,\"attenuationColor\":[0.25,0.25,"
                          "0.25]}"),
                    NULL, &colored);
    wavelengths w = wavelengths_at(0.5f);
    spectrum left = medium_transmittance(material_interior(m), 1.0f, &w);
    g_assert_cmpfloat(fabsf(left[3] - 0.0625f), <, 1e-4f);

    g_autoptr(scene) prism = NULL;
    m = material_of(GLASS(",\"KHR_materials_volume\":{\"thicknessFactor\":1},"
                          "\"KHR_materials_dispersion\":{\"dispersion\":0.4},"
                          "\"KHR_materials_ior\":{\"ior\":1.7}"),
                    NULL, &prism);
    b = bsdf_of(m);
    spectrum eta;
    memcpy(&eta, b.data, sizeof eta);
    g_assert_cmpfloat(spectrum_max(eta), >, 1.71f);
    g_assert_cmpfloat(-spectrum_max(-eta), <, 1.7f);
    g_string_free(kept.text, TRUE);
}

/* By the standard, if it is asked for: light passes without being bent. */
static void test_thin_glass(void)
{
    g_autoptr(scene) s = NULL;
    notes kept = {g_string_new(NULL)};
    thin_glass = true;
    bsdf b = bsdf_of(material_of(GLASS(""), &kept, &s));
    thin_glass = false;
    bsdf_sample out;
    vec3 slanted = normalize3(vec3_make(1, 0, 1));
    g_assert_true(bsdf_sample_direction(&b, slanted, 0.9f, (vec2){0.5f, 0.5f}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &out));
    g_assert_cmpfloat(max_component3(abs3(out.wi + slanted)), <, 1e-4f);
    g_assert_null(strstr(kept.text->str, "solid"));
    g_string_free(kept.text, TRUE);
}

static void test_defaults(void)
{
    notes kept = {g_string_new(NULL)};
    g_autoptr(scene) s = load("\"materials\":[{}]," MESH("0") NODES, &kept);
    g_assert_nonnull(strstr(kept.text->str, "no light in it; a soft sky is added"));
    g_assert_nonnull(strstr(kept.text->str, "no camera in it; one that frames it"));
    for (int k = 0; k < 4; k++) {
        vec2 raster;
        const float *p = tetrahedron.positions + 3 * k;
        g_assert_true(camera_project(&s->camera, vec3_make(p[0], p[1], p[2]), &raster));
        g_assert_cmpfloat(raster.x, >, 0.0f);
        g_assert_cmpfloat(raster.x, <, (float)s->film.width);
        g_assert_cmpfloat(raster.y, >, 0.0f);
        g_assert_cmpfloat(raster.y, <, (float)s->film.height);
    }
    /* The sky is brighter above than below. */
    wavelengths w = wavelengths_at(0.5f);
    spectrum up = scene_environment(s, vec3_make(0, 1, 0), &w);
    spectrum down = scene_environment(s, vec3_make(0, -1, 0), &w);
    g_assert_cmpfloat(spectrum_mean(up), >, 1.5f * spectrum_mean(down));
    g_string_free(kept.text, TRUE);
}

/* What glows is no lamp, unless its strength is given or the file has a camera. */
static void test_glow(void)
{
    static const char *const cameras[] = {
        "", "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}],"};
    for (int i = 0; i < 2; i++) {
        notes kept = {g_string_new(NULL)};
        g_autofree char *text =
            g_strdup_printf("\"materials\":[{\"emissiveFactor\":[1,1,1]}],%s" MESH(
                                "0") "\"nodes\":[{\"mesh\":0%s}],",
                            cameras[i], i ? ",\"camera\":0" : "");
        g_autoptr(scene) s = load(text, &kept);
        g_assert_cmpuint(s->lights->len, ==, i ? 1 : 2);
        g_assert_true((strstr(kept.text->str, "only what glows a little") != NULL) ==
                      (i == 0));
        g_string_free(kept.text, TRUE);
    }
}

static void test_emission(void)
{
    g_autoptr(scene) s = NULL;
    material_of("{\"emissiveFactor\":[1,1,1],\"extensions\":{\"KHR_materials_emissive_"
                "strength\":{\"emissiveStrength\":3}}}",
                NULL, &s);
    g_assert_cmpuint(s->lights->len, ==, 1);
    const light *l = scene_light(s, 0);
    const shape *on = s->shapes->pdata[0];
    surface_hit hit = {.n_geom = {0, 0, 1}, .n = {0, 0, 1}};
    wavelengths w = wavelengths_at(0.5f);
    spectrum three = l->kind->radiance(l->self, &hit, vec3_make(0, 0, 1), &w);
    g_autoptr(scene) one = NULL;
    material_of("{\"emissiveFactor\":[1,1,1]}", NULL, &one);
    l = scene_light(one, 0);
    spectrum single = l->kind->radiance(l->self, &hit, vec3_make(0, 0, 1), &w);
    g_assert_cmpfloat(fabsf(three[2] / single[2] - 3.0f), <, 1e-3f);
    g_assert_cmpfloat(fabsf(on->area - (1.5f + 0.5f * sqrtf(3.0f))), <, 1e-5f);
}

/* A lamp whose picture is black on its left and 1 on its right half: half the power, sent
   from the right half by every way that light is made. */
static void test_textured_emission(void)
{
    static const float texels[] = {0, 0, 0, 1, 1, 1};
    scene_folder f = folder_new(
        "Camera \"perspective\" WorldBegin\n"
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\" "
        "\"string filter\" \"point\" \"string wrap\" \"clamp\"\n"
        "AttributeBegin AreaLightSource \"diffuse\" \"texture L\" \"t\" \"float scale\" "
        "3\n"
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer "
        "indices\" "
        "[0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1] AttributeEnd\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"float scale\" 3\n"
        "Shape \"trianglemesh\" \"point3 P\" [0 0 5 1 0 5 1 1 5 0 1 5] \"integer "
        "indices\" "
        "[0 1 2 0 2 3]\n");
    g_autofree char *pfm = g_malloc(64);
    int head = g_snprintf(pfm, 64, "PF\n2 1\n-1.0\n");
    memcpy(pfm + head, texels, sizeof texels);
    folder_write(&f, "t.pfm", pfm, head + (gssize)sizeof texels);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    g_assert_no_error(error);
    folder_remove(&f);
    wavelengths w = wavelengths_at(0.5f);
    const light *half = scene_light(s, 0), *whole = scene_light(s, 1);
    float power = spectrum_mean(half->kind->power(half->self, &w)), emitted = 0.0f;
    float full = spectrum_mean(whole->kind->power(whole->self, &w)), direct = 0.0f;
    enum { N = 40000 }; /* a deviation of 0.0025 */
    for (int i = 0; i < N; i++) {
        sampler random = sampler_make(9, (uint64_t)i);
        vec2 u = sampler_2d(&random);
        float v = sampler_1d(&random);
        light_emission e;
        light_sample to;
        if (half->kind->emit(half->self, &w, v, u, u, &e)) {
            g_assert_true(e.ray.origin[0] > 0.4999f || spectrum_is_black(e.flux));
            emitted += spectrum_mean(e.flux) / N;
        }
        if (half->kind->sample(half->self, &w, vec3_make(0.5f, 0.5f, 9), v, u, &to))
            direct += spectrum_mean(to.radiance) / to.pdf / N;
    }
    g_assert_cmpfloat(fabsf(power / full - 0.5f), <, 0.02f);
    g_assert_cmpfloat(fabsf(emitted / full - 0.5f), <, 0.015f);
    surface_hit hit = {.n = {0, 0, 1}, .n_geom = {0, 0, 1}, .uv = {0.75f, 0.5f}};
    float lit =
        spectrum_mean(half->kind->radiance(half->self, &hit, vec3_make(0, 0, 1), &w));
    g_assert_cmpfloat(fabsf(lit * PI_F / full - 1.0f), <, 1e-3f);
    g_assert_cmpfloat(fabsf(direct / (lit * 0.5f / 81.0f) - 1.0f), <, 0.03f);
    hit.uv.x = 0.25f;
    g_assert_true(spectrum_is_black(
        half->kind->radiance(half->self, &hit, vec3_make(0, 0, 1), &w)));
}

/* Opacity by mode: a mask cuts, a blend lets a share through. */
static void test_alpha(void)
{
    static const struct {
        const char *json;
        float opacity;
    } cases[] = {
        {"{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.4]}}", 1.0f},
        {"{\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,"
         "0."
         "4]}}",
         0.4f},
        {"{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3,\"pbrMetallicRoughness\":{"
         "\"baseColorFactor\":[1,1,1,0.4]}}",
         1.0f},
    };
    surface_hit hit = {.n = {0, 0, 1}, .n_geom = {0, 0, 1}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(scene) s = NULL;
        material_of(cases[i].json, NULL, &s);
        float opacity = shape_opacity(s->shapes->pdata[0], &hit);
        g_assert_cmpfloat(fabsf(opacity - cases[i].opacity), <, 1e-6f);
    }
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
    g_test_add_func("/gltf/materials", test_materials);
    g_test_add_func("/gltf/solid-glass", test_solid_glass);
    g_test_add_func("/gltf/thin-glass", test_thin_glass);
    g_test_add_func("/gltf/defaults", test_defaults);
    g_test_add_func("/gltf/glow", test_glow);
    g_test_add_func("/gltf/emission", test_emission);
    g_test_add_func("/gltf/textured-emission", test_textured_emission);
    g_test_add_func("/gltf/alpha", test_alpha);
    g_test_add_func("/gltf/refused", test_refused);
    g_test_add_func("/gltf/not-json", test_not_json);
    g_test_add_func("/gltf/damaged", test_damaged);
    g_test_add_func("/gltf/shared", test_shared);
    return g_test_run();
}
