/*
 * gltf-maps: what textures and meshes are looked up by. Every map by its own set of
 * coordinates and its own KHR_texture_transform, colours of vertices, and meshes that
 * several nodes show, against the same scene with all of it done by hand.
 */
#include "bsdf/bsdf.h"
#include "format/format.h"
#include "math/sampler.h"
#include "scene_text.h"

#include <math.h>

#define SQRT_HALF 0.70710678f

/* A quad in z = 0 over 0..1; its second coordinates are turned by 90° and half as large:
   (u2, v2) = (v, u) / 2 in glTF's sense. One colour a vertex. */
typedef struct quad {
    float positions[12];
    float uvs[8], uvs2[8];
    float colors[16];
    uint16_t indices[6], padding[2];
    float moves[6];
} quad;

static const quad data = {
    .positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
    .uvs = {0, 1, 1, 1, 1, 0, 0, 0},
    .uvs2 = {0.5f, 0, 0.5f, 0.5f, 0, 0.5f, 0, 0},
    .colors = {1, 1, 1, 1, .5f, .5f, .5f, 1, .5f, .5f, .5f, .5f, 1, 1, 1, .5f},
    .indices = {0, 1, 2, 0, 2, 3},
    .moves = {0, 0, 0, 0, 0, 2},
};

#define VIEW(offset, length)                                                             \
    "{\"buffer\":0,\"byteOffset\":" #offset ",\"byteLength\":" #length "}"
#define FLOATS(view, count, type)                                                        \
    "{\"bufferView\":" #view ",\"componentType\":5126,\"count\":" #count                 \
    ",\"type\":\"" type "\"}"
#define ACCESSORS                                                                                                                                       \
    "\"bufferViews\":[" VIEW(0, 48) "," VIEW(48, 32) "," VIEW(80, 32) "," VIEW(112, 64) "," VIEW(176, 12) "," VIEW(192, 24) "],\"accessors\":[" FLOATS( \
        0, 4,                                                                                                                                           \
        "VEC3") "," FLOATS(1, 4,                                                                                                                        \
                           "VEC2") "," FLOATS(2, 4,                                                                                                     \
                                              "VEC2") "," FLOATS(3, 4,                                                                                  \
                                                                 "VEC4") ",{"                                                                           \
                                                                         "\"bufferView"                                                                 \
                                                                         "\":4,"                                                                        \
                                                                         "\"componentTy"                                                                \
                                                                         "pe\":5123,"                                                                   \
                                                                         "\"count\":6,"                                                                 \
                                                                         "\"type\":"                                                                    \
                                                                         "\"SCALAR\"}"                                                                  \
                                                                         "," FLOATS(                                                                    \
                                                                             5, 2,                                                                      \
                                                                             "VE"                                                                       \
                                                                             "C"                                                                        \
                                                                             "3") "]"
#define PRIMITIVE(more)                                                                  \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":"  \
    "2" more "},\"indices\":4,\"material\":0}]}"
#define TEXTURES                                                                         \
    "\"images\":[{\"uri\":\"t.pfm\"}],\"textures\":[{\"source\":0,\"sampler\":0}],"      \
    "\"samplers\":[{\"magFilter\":9728}],"

/* Four texels, upper row first: the file is of glTF's (s, t). */
static void write_picture(scene_folder *f, const float texels[12])
{
    g_autofree char *pfm = g_malloc(128);
    int head = g_snprintf(pfm, 64, "PF\n2 2\n-1.0\n");
    memcpy(pfm + head, texels + 6, 6 * sizeof *texels); /* PFM has its lowest row first */
    memcpy(pfm + head + 6 * sizeof *texels, texels, 6 * sizeof *texels);
    folder_write(f, "t.pfm", pfm, head + 48);
}

static view *load_shown(const char *middle, const float texels[12])
{
    g_autofree char *code = g_base64_encode((const guchar *)&data, sizeof data);
    g_autofree char *text =
        g_strdup_printf("{\"asset\":{\"version\":\"2.0\"},%s" TEXTURES
                        "\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/"
                        "octet-stream;base64,%s\"}]," ACCESSORS "}",
                        middle, sizeof data, code);
    scene_folder f = folder_new("");
    static const float white[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    write_picture(&f, texels ? texels : white);
    folder_write(&f, "a.gltf", text, -1);
    g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
    g_autoptr(GError) error = NULL;
    view *v = load_view(path, NULL, &error);
    g_assert_no_error(error);
    folder_remove(&f);
    return v;
}

static scene *load(const char *middle, const float texels[12])
{
    view *v = load_shown(middle, texels);
    scene *s = g_steal_pointer(&v->owned); /* with which the view would free these */
    filter_clear(&v->filter);
    g_free(v->film.filename);
    view_free(v);
    return s;
}

static bool hit_from(const scene *s, float x, float y, float z, surface_hit *hit)
{
    const ray r = {
        .origin = {x, y, z}, .direction = {0, 0, -1}, .t_max = INFINITY, .time = 0.5f};
    return scene_intersect(s, &r, hit);
}

static bsdf bsdf_at(const scene *s, const surface_hit *hit, const wavelengths *w)
{
    bsdf b;
    const bsdf_options options = {0};
    g_assert_true(scene_bsdf(s, hit, w, ALL_WAVELENGTHS, &options, &b));
    return b;
}

/* What comes back of white light, straight up: grows with the base colour. */
static float brightness(const scene *s, float x, float y)
{
    const wavelengths w = wavelengths_at(0.5f);
    surface_hit hit;
    g_assert_true(hit_from(s, x, y, 5.0f, &hit));
    bsdf b = bsdf_at(s, &hit, &w);
    const vec3 up = vec3_make(0.3f, 0, 0.953939f);
    return spectrum_mean(bsdf_eval(&b, up, up, LOBE_GATHERED, TRANSPORT_RADIANCE));
}

#define MATTE(base)                                                                      \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0," base "}}],"
#define NODE "\"nodes\":[{\"mesh\":0}],"

/* White is the upper left texel (t downwards). Where that lies on the quad tells which
   coordinates were used, and how. */
static void test_coordinates(void)
{
    static const float corner[12] = {1, 1, 1};
    static const struct {
        const char *info;
        float white[2], black[2];
    } cases[] = {
        {"", {0.25f, 0.75f}, {0.75f, 0.75f}},
        /* (u2, v2) = (1 - v, u) / 2, so that all the quad is in the first texel ... */
        {",\"texCoord\":1", {0.9f, 0.1f}, {-1, 0}},
        /* ... and a quarter of it, once that is twice as large. */
        {",\"texCoord\":1,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,2]}}",
         {0.25f, 0.75f},
         {0.25f, 0.25f}},
        {",\"extensions\":{\"KHR_texture_transform\":{\"texCoord\":1,\"scale\":[2,2]}}",
         {0.25f, 0.75f},
         {0.75f, 0.75f}},
        {",\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0]}}",
         {0.75f, 0.75f},
         {0.25f, 0.75f}},
        /* Turned by 90°: (s, t) = (t, -s). */
        {",\"extensions\":{\"KHR_texture_transform\":{\"rotation\":1.5707963}}",
         {0.75f, 0.75f},
         {0.25f, 0.75f}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = g_strdup_printf(
            MATTE("\"baseColorTexture\":{\"index\":0%s}") "\"meshes\":[" PRIMITIVE(
                "") "]," NODE,
            cases[i].info);
        g_autoptr(scene) s = load(text, corner);
        g_test_message("%s", cases[i].info);
        g_assert_cmpfloat(brightness(s, cases[i].white[0], cases[i].white[1]), >, 0.2f);
        if (cases[i].black[0] >= 0.0f)
            g_assert_cmpfloat(brightness(s, cases[i].black[0], cases[i].black[1]), <,
                              0.1f);
    }
}

/* A normal map that leans along its own +u by 45°: on the quad along x; along the second
   coordinates' u, which goes down y; turned and mirrored as the map is. */
static void test_normal_maps(void)
{
    static const struct {
        const char *info;
        float x, y;
    } cases[] = {
        {"", 1, 0},
        {",\"texCoord\":1", 0, -1},
        /* s = -u: where s grows is to the left. */
        {",\"extensions\":{\"KHR_texture_transform\":{\"scale\":[-1,1]}}", -1, 0},
        /* s = t', t = -s': s grows with glTF's v, which is down. */
        {",\"extensions\":{\"KHR_texture_transform\":{\"rotation\":1.5707963}}", 0, -1},
    };
    float texels[12];
    for (int i = 0; i < 4; i++) {
        texels[3 * i] = 0.5f + 0.5f * SQRT_HALF;
        texels[3 * i + 1] = 0.5f;
        texels[3 * i + 2] = 0.5f + 0.5f * SQRT_HALF;
    }
    const wavelengths w = wavelengths_at(0.5f);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = g_strdup_printf(
            "\"materials\":[{\"normalTexture\":{\"index\":0%s}}],\"meshes\":[" PRIMITIVE(
                "") "]," NODE,
            cases[i].info);
        g_autoptr(scene) s = load(text, texels);
        surface_hit hit;
        g_assert_true(hit_from(s, 0.3f, 0.6f, 5.0f, &hit));
        bsdf b = bsdf_at(s, &hit, &w);
        vec3 expected = SQRT_HALF * vec3_make(cases[i].x, cases[i].y, 1.0f);
        g_test_message("%s: (%g, %g, %g)", cases[i].info, (double)b.shading.n[0],
                       (double)b.shading.n[1], (double)b.shading.n[2]);
        g_assert_cmpfloat(max_component3(abs3(b.shading.n - expected)), <, 1e-4f);
    }
}

/* Grey at the vertices is 1, 0.5, 0.5, 1 and opacity 1, 1, 0.5, 0.5. */
static void test_vertex_colors(void)
{
    g_autoptr(scene) s =
        load("\"materials\":[{\"alphaMode\":\"BLEND\",\"extensions\":{\"KHR_materials_"
             "specular\":{\"specularFactor\":0}},\"pbrMetallicRoughness\":{"
             "\"metallicFactor\":0}}],\"meshes\":[" PRIMITIVE(",\"COLOR_0\":3") "]," NODE,
             NULL);
    const wavelengths w = wavelengths_at(0.5f);
    for (float x = 0.1f; x < 1.0f; x += 0.2f) {
        surface_hit hit;
        const ray r = {.origin = {x, 0.3f, 5.0f},
                       .direction = {0, 0, -1},
                       .t_max = INFINITY,
                       .time = 0.5f};
        g_assert_true(scene_intersect_solid(s, &r, &hit));
        bsdf b = bsdf_at(s, &hit, &w);
        spectrum seen = bsdf_albedo(&b, vec3_make(0, 0, 1), LOBE_ALL);
        float grey = 1.0f - 0.5f * x, opacity = 1.0f - 0.5f * 0.3f;
        const shape *on = s->shapes->pdata[0];
        g_assert_cmpfloat(fabsf(shape_opacity(on, &hit) - opacity), <, 1e-5f);
        g_assert_cmpfloat(fabsf(spectrum_mean(seen) - grey), <, 0.01f);
    }
}

/* Reflectance straight on and glossiness, as constants and as an image, of which alpha is
   1: the same surface. */
static void test_glossiness(void)
{
    static const float blue[12] = {0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f,
                                   0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
    static const char *const maps[] = {
        "\"specularFactor\":[0.2,0.2,0.2]",
        "\"specularFactor\":[0.8,0.8,0.8],\"specularGlossinessTexture\":{\"index\":0}"};
    const wavelengths w = wavelengths_at(0.5f);
    const vec3 up = vec3_make(0, 0, 1);
    for (size_t i = 0; i < G_N_ELEMENTS(maps); i++) {
        g_autofree char *text = g_strdup_printf(
            "\"materials\":[{\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
            "\"diffuseFactor\":[0,0,0,1],\"glossinessFactor\":0.5,%s}}}],\"meshes\":"
            "[" PRIMITIVE("") "]," NODE,
            maps[i]);
        g_autoptr(scene) s = load(text, blue);
        surface_hit hit;
        g_assert_true(hit_from(s, 0.4f, 0.4f, 5.0f, &hit));
        bsdf b = bsdf_at(s, &hit, &w);
        /* D = 1 / (π α²) straight on, f = F D / 4. */
        float alpha = 0.25f, expected = 0.2f / (4.0f * PI_F * alpha * alpha);
        float seen = spectrum_mean(bsdf_eval(&b, up, up, LOBE_ALL, TRANSPORT_RADIANCE));
        g_test_message("%s: %g, expected %g", maps[i], (double)seen, (double)expected);
        g_assert_cmpfloat(fabsf(seen / expected - 1.0f), <, 0.02f);
    }
}

/* ---- Instances ---- */

/* Turned, mirrored and moved. */
#define PLACES(first, second, third)                                                     \
    "\"nodes\":[{\"mesh\":" first                                                        \
    ",\"scale\":[2,2,2],\"rotation\":[0,0.5,0,0.8660254]},{\"mesh\":" second             \
    ",\"scale\":[-1,1,1],\"translation\":[0,3,0]},{\"mesh\":" third                      \
    ",\"translation\":[3,3,1]}],"

/* One mesh shown three times against three meshes shown once each. */
static void test_instances(void)
{
    g_autoptr(view) shared_view =
        load_shown(MATTE("\"roughnessFactor\":1") "\"meshes\":[" PRIMITIVE(
                       "") "]," PLACES("0", "0", "0"),
                   NULL);
    g_autoptr(view) copied_view =
        load_shown(MATTE("\"roughnessFactor\":1") "\"meshes\":[" PRIMITIVE(
                       "") "," PRIMITIVE("") "," PRIMITIVE("") "]," PLACES("0", "1", "2"),
                   NULL);
    const scene *shared = shared_view->scene, *copied = copied_view->scene;
    g_assert_cmpuint(shared->shapes->len, ==, 1);
    g_assert_cmpuint(shared->instances->len, ==, 3);
    g_assert_cmpuint(copied->shapes->len, ==, 3);
    g_assert_cmpuint(copied->instances->len, ==, 0);
    /* The view that is added frames the same. */
    for (int i = 0; i < 16; i++)
        g_assert_cmpfloat(fabs(shared_view->camera.to_world.m[i / 4][i % 4] -
                               copied_view->camera.to_world.m[i / 4][i % 4]),
                          <, 1e-4);
    int met = 0;
    for (int i = 0; i < 400; i++) {
        sampler random = sampler_make(4, (uint64_t)i);
        vec2 u = sampler_2d(&random);
        surface_hit a, b;
        float x = 6.0f * u.x - 1.5f, y = 6.0f * u.y - 0.5f;
        bool hit = hit_from(copied, x, y, 9.0f, &b);
        g_assert_true(hit_from(shared, x, y, 9.0f, &a) == hit);
        if (!hit)
            continue;
        met++;
        g_assert_cmpfloat(max_component3(abs3(a.p - b.p)), <, 1e-4f);
        g_assert_cmpfloat(max_component3(abs3(a.n_geom - b.n_geom)), <, 1e-4f);
        g_assert_cmpfloat(max_component3(abs3(a.n - b.n)), <, 1e-4f);
        g_assert_cmpfloat(max_component3(abs3(a.dpdu - b.dpdu)), <, 1e-4f);
        g_assert_cmpfloat(fabsf(a.uv.x - b.uv.x), <, 1e-4f);
    }
    g_assert_cmpint(met, >, 40);
}

/* Each place of a lamp is a lamp. */
static void test_lamps_are_copied(void)
{
    g_autoptr(scene) s =
        load("\"materials\":[{\"emissiveFactor\":[1,1,1]}],\"meshes\":[" PRIMITIVE(
                 "") "]," PLACES("0", "0", "0"),
             NULL);
    g_assert_cmpuint(s->lights->len, ==, 4); /* and a sky */
    g_assert_cmpuint(s->instances->len, ==, 0);
    g_assert_cmpuint(s->shapes->len, ==, 3);
}

/* Two copies by EXT_mesh_gpu_instancing, the second 2 higher. */
static void test_gpu_instancing(void)
{
    g_autoptr(scene) s = load(
        MATTE("\"roughnessFactor\":1") "\"meshes\":[" PRIMITIVE(
            "") "],\"nodes\":[{\"mesh\":0,\"scale\":[1,1,2],\"extensions\":{\"EXT_mesh_"
                "gpu_instancing\":{\"attributes\":{\"TRANSLATION\":5}}}}],",
        NULL);
    surface_hit hit;
    g_assert_cmpuint(s->instances->len, ==, 2);
    g_assert_true(hit_from(s, 0.5f, 0.4f, 9.0f, &hit));
    g_assert_cmpfloat(fabsf(hit.p[2] - 4.0f), <, 1e-5f);
    g_assert_true(hit_from(s, 0.5f, 0.4f, 3.0f, &hit));
    g_assert_cmpfloat(fabsf(hit.p[2]), <, 1e-5f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/gltf-maps/coordinates", test_coordinates);
    g_test_add_func("/gltf-maps/normal-maps", test_normal_maps);
    g_test_add_func("/gltf-maps/vertex-colors", test_vertex_colors);
    g_test_add_func("/gltf-maps/glossiness", test_glossiness);
    g_test_add_func("/gltf-maps/instances", test_instances);
    g_test_add_func("/gltf-maps/lamps", test_lamps_are_copied);
    g_test_add_func("/gltf-maps/gpu-instancing", test_gpu_instancing);
    return g_test_run();
}
