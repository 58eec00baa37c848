/*
 * gltf_material: what a surface scatters and shines by each word of a glTF material,
 * against values in closed form.
 */
#include "gltf_text.h"
#include "math/sampler.h"

#include <math.h>

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
        /* Nothing but the base, as Blender writes what has no specular part. */
        {"{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.1,"
         "\"baseColorFactor\":[0.5,0.5,0.5,1]},\"extensions\":{\"KHR_materials_"
         "specular\":{"
         "\"specularColorFactor\":[0,0,0]}}}",
         LOBE_DIFFUSE | LOBE_REFLECTION, 0.5f},
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

/* What glows is no lamp, unless it is brighter than paper or the file has a camera, and
 * then only if it sends out a hundredth of what a sky would: the tetrahedron's faces do,
 * of 2.4 m² in a sphere of 0.87 m, and a small one of 59 cm² does not. */
static void test_glow(void)
{
#define STRONG(strength)                                                                 \
    ",\"extensions\":{\"KHR_materials_emissive_strength\":{"                             \
    "\"emissiveStrength\":" strength "}}"
    static const struct {
        const char *more;
        bool has_camera, is_small, is_lit;
    } cases[] = {
        {"", false, false, false},
        {"", true, false, true},
        {STRONG("1"), false, false, false},
        {STRONG("5"), false, false, true},
        {"", true, true, false},
        {STRONG("5"), false, true, false},
        {STRONG("5"), true, true, false},
        {STRONG("5000"), false, true, true},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        notes kept = {g_string_new(NULL)};
        g_autofree char *text = g_strdup_printf(
            "\"materials\":[{\"emissiveFactor\":[1,1,1]%s},{}],%s\"meshes\":[{"
            "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":"
            "0}]"
            "},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,"
            "\"material\":1}]}],\"nodes\":[{\"mesh\":0,\"scale\":[%s]},{\"mesh\":1%s}],",
            cases[i].more,
            cases[i].has_camera
                ? "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}],"
                : "",
            cases[i].is_small ? "0.05,0.05,0.05" : "1,1,1",
            cases[i].has_camera ? ",\"camera\":0" : "");
        g_autoptr(scene) s = load(text, &kept);
        g_test_message("%zu", i);
        g_assert_cmpuint(s->lights->len, ==, cases[i].is_lit ? 1 : 2);
        g_assert_true((strstr(kept.text->str, "only what glows a little") == NULL) ==
                      cases[i].is_lit);
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

/* What glows shines from both sides if the file says so, unless it is a closed body; what
   is unlit is seen from both. */
static void test_double_sided(void)
{
    static const struct {
        const char *more;
        bool closed;
        float back;
    } cases[] = {{"", false, 0.0f},
                 {",\"doubleSided\":true", false, 1.0f},
                 {",\"doubleSided\":true", true, 0.0f},
                 {UNLIT ",\"doubleSided\":true", true, 1.0f},
                 {UNLIT, false, 1.0f}};
    wavelengths w = wavelengths_at(0.5f);
    surface_hit hit = {.n_geom = {0, 0, 1}, .n = {0, 0, 1}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = g_strdup_printf(
            "\"materials\":[{\"emissiveFactor\":[1,1,1]%s}],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},%"
            "s\"material\":"
            "0}]}]," NODES,
            cases[i].more, cases[i].closed ? "\"indices\":2," : "\"mode\":5,");
        g_autoptr(scene) s = load(text, NULL);
        const light *l = scene_light(s, 0);
        spectrum front = l->kind->radiance(l->self, &hit, vec3_make(0, 0, 1), &w);
        spectrum back = l->kind->radiance(l->self, &hit, vec3_make(0, 0, -1), &w);
        g_assert_cmpfloat(
            fabsf(spectrum_mean(back) / spectrum_mean(front) - cases[i].back), <, 1e-5f);
    }
}

/* A face that is not double-sided is no hole where it is seen from behind, nor black: it
   is there, and scatters there what it does in front. */
static void test_single_sided(void)
{
    static const char *const indices[] = {"\"mode\":5,", "\"indices\":2,"};
    for (size_t i = 0; i < G_N_ELEMENTS(indices); i++)
        for (int k = 0; k < 2; k++) {
            g_autofree char *text = g_strdup_printf(
                "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
                "\"baseColorFactor\":[0.5,0.5,0.5,1]},\"doubleSided\":%s}],\"meshes\":[{"
                "\"primitives\":[{\"attributes\":{\"POSITION\":0},%s\"material\":0}]}]"
                "," NODES,
                k ? "true" : "false", indices[i]);
            g_autoptr(scene) s = load(text, NULL);
            double albedo[2];
            for (int side = 0; side < 2; side++) {
                const wavelengths w = wavelengths_at(0.5f);
                const bsdf_options plain = {0};
                vec3 toward = normalize3(vec3_make(-1, -1, -1)) * (side ? 1.0f : -1.0f);
                ray r = {.origin = vec3_make(0.33f, 0.33f, 0.33f) - 0.1f * toward,
                         .direction = toward,
                         .t_max = INFINITY};
                surface_hit hit;
                bsdf b;
                g_assert_true(scene_intersect(s, &r, &hit));
                g_assert_cmpfloat(fabsf(hit.t - 0.1f), <, 0.02f);
                material_bsdf(s->materials->pdata[hit.material], &hit, &w,
                              ALL_WAVELENGTHS, &plain, &b);
                albedo[side] = (double)spectrum_mean(
                    bsdf_albedo(&b, vec3_make(0, 0, side ? -1 : 1), LOBE_ALL));
            }
            g_assert_cmpfloat(albedo[0], >, 0.3);
            g_assert_cmpfloat(fabs(albedo[0] - albedo[1]), <, 0.01);
        }
}

/* An unlit surface shines with its base colour, and returns no light. */
static void test_unlit(void)
{
    g_autoptr(scene) s = NULL, glows = NULL;
    const material *m =
        material_of("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1]},"
                    "\"emissiveFactor\":[1,0,0]" UNLIT "}",
                    NULL, &s);
    material_of("{\"emissiveFactor\":[1,1,1]}", NULL, &glows);
    bsdf b = bsdf_of(m);
    vec3 slanted = normalize3(vec3_make(1, 0, 1));
    g_assert_true(spectrum_is_black(bsdf_albedo(&b, slanted, LOBE_ALL)));
    surface_hit hit = {.n_geom = {0, 0, 1}, .n = {0, 0, 1}};
    wavelengths w = wavelengths_at(0.5f);
    const light *l = scene_light(s, 0), *one = scene_light(glows, 0);
    spectrum half = l->kind->radiance(l->self, &hit, slanted, &w);
    spectrum whole = one->kind->radiance(one->self, &hit, slanted, &w);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        g_assert_cmpfloat(fabsf(half[i] / whole[i] - 0.5f), <, 0.01f);
}

/* Facets of roughness 0.4 and strength 0.5: alpha is 0.16 + 0.84 / 4 along the direction,
   0.16 across it; the value straight on is F0 / (4 π alpha alpha'). */
static void test_anisotropy(void)
{
    static const struct {
        const char *more;
        float along; /* its angle from the tangent */
    } cases[] = {{"", 0.0f}, {",\"anisotropyRotation\":0.5", 0.5f}};
    const float wide = 0.16f + 0.84f * 0.25f, narrow = 0.16f, lean = 0.2f;
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = g_strdup_printf(
            "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.4},\"extensions\":{"
            "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.5%s}}}",
            cases[i].more);
        g_autoptr(scene) s = NULL;
        bsdf b = bsdf_of(material_of(text, NULL, &s));
        for (int across = 0; across < 2; across++) {
            float phi = cases[i].along + (float)across * 0.5f * PI_F;
            float alpha = across ? narrow : wide;
            vec3 wi =
                vec3_make(sinf(lean) * cosf(phi), sinf(lean) * sinf(phi), cosf(lean));
            float half = 0.5f * lean;
            float q = square(sinf(half) / alpha) + square(cosf(half));
            float d = INV_PI_F / (wide * narrow * q * q);
            float stretched = sqrtf(square(wi[2]) + square(alpha * sinf(lean)));
            float expected = d / (2.0f * (stretched + wi[2]));
            spectrum f =
                bsdf_eval(&b, vec3_make(0, 0, 1), wi, LOBE_ALL, TRANSPORT_RADIANCE);
            g_assert_cmpfloat(fabsf(spectrum_mean(f) / expected - 1.0f), <, 1e-3f);
        }
    }
}

/* A leaf: what the facets leave goes through by a quarter, in another colour. */
static void test_diffuse_transmission(void)
{
    g_autoptr(scene) s = NULL;
    bsdf b = bsdf_of(material_of(
        "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[0.8,0.8,"
        "0.8,1]},\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0},"
        "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.25,"
        "\"diffuseTransmissionColorFactor\":[0.4,0.4,0.4]}}}",
        NULL, &s));
    vec3 up = vec3_make(0, 0, 1), down = vec3_make(0, 0, -1);
    float back = spectrum_mean(bsdf_eval(&b, up, up, LOBE_ALL, TRANSPORT_RADIANCE));
    float on = spectrum_mean(bsdf_eval(&b, up, down, LOBE_ALL, TRANSPORT_RADIANCE));
    g_assert_cmpfloat(fabsf(back * PI_F - 0.75f * 0.8f), <, 2e-3f);
    g_assert_cmpfloat(fabsf(on * PI_F - 0.25f * 0.4f), <, 1e-3f);
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

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/gltf-material/materials", test_materials);
    g_test_add_func("/gltf-material/solid-glass", test_solid_glass);
    g_test_add_func("/gltf-material/thin-glass", test_thin_glass);
    g_test_add_func("/gltf-material/glow", test_glow);
    g_test_add_func("/gltf-material/emission", test_emission);
    g_test_add_func("/gltf-material/textured-emission", test_textured_emission);
    g_test_add_func("/gltf-material/double-sided", test_double_sided);
    g_test_add_func("/gltf-material/single-sided", test_single_sided);
    g_test_add_func("/gltf-material/unlit", test_unlit);
    g_test_add_func("/gltf-material/anisotropy", test_anisotropy);
    g_test_add_func("/gltf-material/diffuse-transmission", test_diffuse_transmission);
    g_test_add_func("/gltf-material/alpha", test_alpha);
    return g_test_run();
}
