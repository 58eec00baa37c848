/*
 * material: parameters mean what pbrt-v4 says, every one acts, and what is wrong or not
 * known is refused at its place.
 */
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"
#include "material/material.h"
#include "scene/builder.h"

#include <string.h>

static const source_place here = {"m.pbrt", 4, 9};
static const bsdf_options plain = {0}, deterministic = {.deterministic = true};
static const surface_hit flat = {.n = {0, 0, 1, 0},
                                 .n_geom = {0, 0, 1, 0},
                                 .dpdu = {1, 0, 0, 0},
                                 .uv = {0.25f, 0.75f}};

static params *list(void)
{
    return params_new((source_place){"m.pbrt", 2, 1}, "/", color_space_srgb());
}

static void add_float(params *p, const char *name, float value)
{
    g_assert_true(params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL));
}

static void add_rgb(params *p, const char *name, float r, float g, float b)
{
    float rgb[3] = {r, g, b};
    g_assert_true(params_add_numbers(p, here, PARAM_RGB, name, rgb, 3, NULL));
}

static void add_string(params *p, param_type type, const char *name, const char *text)
{
    g_assert_true(params_add_strings(p, here, type, name, &text, 1, NULL));
}

static void add_bool(params *p, const char *name, int value)
{
    g_assert_true(params_add_integers(p, here, PARAM_BOOL, name, &value, 1, NULL));
}

static material *make(const char *kind, params *p)
{
    GError *error = NULL;
    material *m = material_new(NULL, kind, p, &error);
    g_assert_no_error(error);
    params_free(p);
    return m;
}

static bsdf at(const material *m, const bsdf_options *options)
{
    wavelengths w = wavelengths_at(0.5f);
    bsdf b;
    material_bsdf(m, &flat, &w, ALL_WAVELENGTHS, options, &b);
    return b;
}

static void refuse(const char *kind, params *p, const char *message)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(material_new(NULL, kind, p, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_cmpstr(error->message, ==, message);
    params_free(p);
}

static void test_diffuse(void)
{
    material *m = make("diffuse", list());
    bsdf b = at(m, &plain);
    g_assert_cmpuint(b.lobes, ==, LOBE_DIFFUSE | LOBE_REFLECTION);
    g_assert_true(b.lambertian);
    g_assert_cmpfloat(b.rho[3], ==, 0.5f);
    g_assert_false(material_casts_caustics(m));
    material_free(m);

    params *p = list();
    add_rgb(p, "reflectance", 0.8f, 0.1f, 0.1f);
    m = make("diffuse", p);
    b = at(m, &plain);
    g_assert_cmpfloat(b.rho[7], >, 0.6f);
    g_assert_cmpfloat(b.rho[2], <, 0.2f);
    material_free(m);
}

static ggx roughness_of(params *p, const char *kind)
{
    material *m = make(kind, p);
    bsdf b = at(m, &plain);
    vec3 wo = normalize3(vec3_make(0.3f, 0.1f, 1.0f));
    bsdf_sample s;
    g_assert_true(bsdf_sample_direction(&b, wo, 0.5f, (vec2){0.3f, 0.4f}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &s));
    /* D at the normal gives alpha_x alpha_y, tilted along x alpha_x alone. */
    vec3 up = vec3_make(0, 0, 1), tilted = normalize3(vec3_make(0.1f, 0, 1));
    vec3 mirror = tilted * (2.0f * tilted[2]) - up;
    float top = bsdf_pdf(&b, up, up, LOBE_ALL, TRANSPORT_RADIANCE);
    float slope = bsdf_pdf(&b, up, mirror, LOBE_ALL, TRANSPORT_RADIANCE) / top;
    float xy = INV_PI_F / (4.0f * top), q = 1.0f / sqrtf(slope);
    float x = 0.1f * tilted[2] / sqrtf(q - square(tilted[2]));
    material_free(m);
    return (ggx){x, xy / x};
}

static void test_roughness(void)
{
    params *p = list();
    add_float(p, "roughness", 0.25f);
    ggx g = roughness_of(p, "conductor");
    g_assert_cmpfloat(fabsf(g.alpha_x - 0.5f) + fabsf(g.alpha_y - 0.5f), <, 1e-3f);
    p = list();
    add_float(p, "roughness", 0.25f);
    add_bool(p, "remaproughness", 0);
    g = roughness_of(p, "conductor");
    g_assert_cmpfloat(fabsf(g.alpha_x - 0.25f) + fabsf(g.alpha_y - 0.25f), <, 1e-3f);
    p = list();
    add_float(p, "roughness", 0.25f);
    add_float(p, "vroughness", 0.09f);
    g = roughness_of(p, "conductor");
    g_assert_cmpfloat(fabsf(g.alpha_x - 0.5f) + fabsf(g.alpha_y - 0.3f), <, 1e-3f);
}

static unsigned class_of(const char *kind, float roughness)
{
    params *p = list();
    add_float(p, "roughness", roughness);
    material *m = make(kind, p);
    bsdf b = at(m, &plain);
    g_assert_cmpint(material_casts_caustics(m), ==,
                    (b.lobes & (LOBE_SPECULAR | LOBE_GLOSSY)) != 0);
    material_free(m);
    return b.lobes & ~(unsigned)LOBE_ANY_SIDE;
}

static void test_classes(void)
{
    static const char *const names[] = {"conductor", "dielectric"};
    for (int i = 0; i < 2; i++) {
        g_assert_cmpuint(class_of(names[i], 0.0f), ==, LOBE_SPECULAR);
        g_assert_cmpuint(class_of(names[i], 0.99e-6f), ==, LOBE_SPECULAR);
        g_assert_cmpuint(class_of(names[i], 0.01f), ==, LOBE_GLOSSY);
        g_assert_cmpuint(class_of(names[i], 0.089f), ==, LOBE_GLOSSY);
    }
    g_assert_cmpuint(class_of("conductor", 0.091f), ==, LOBE_DIFFUSE);
    g_assert_cmpuint(class_of("dielectric", 0.091f), ==, LOBE_GLOSSY);
    g_assert_cmpuint(class_of("dielectric", 1.0f), ==, LOBE_GLOSSY);
}

static float normal_reflectance(params *p, int wavelength)
{
    material *m = make("conductor", p);
    bsdf b = at(m, &plain);
    float r = bsdf_albedo(&b, vec3_make(0, 0, 1), LOBE_ALL)[wavelength];
    material_free(m);
    return r;
}

static void test_conductor(void)
{
    /* Copper is red. */
    g_assert_cmpfloat(normal_reflectance(list(), 6), >, 0.9f);
    g_assert_cmpfloat(normal_reflectance(list(), 2), <, 0.65f);
    params *p = list();
    float half[4] = {300.0f, 0.5f, 900.0f, 0.5f};
    g_assert_true(
        params_add_numbers(p, here, PARAM_SPECTRUM, "reflectance", half, 4, NULL));
    g_assert_cmpfloat(fabsf(normal_reflectance(p, 1) - 0.5f), <, 1e-5f);
    /* An rgb index is no albedo: it may exceed one. */
    p = list();
    add_rgb(p, "eta", 1.66f, 0.88f, 0.52f);
    add_rgb(p, "k", 9.2f, 6.3f, 4.8f);
    g_assert_cmpfloat(normal_reflectance(p, 1), >, 0.85f);
}

static void test_dispersion_by_eta(void)
{
    params *p = list();
    add_float(p, "eta", 1.7f);
    material *m = make("dielectric", p);
    bsdf b = at(m, &plain);
    bsdf_sample s;
    vec3 wo = normalize3(vec3_make(1, 0, 1));
    g_assert_true(bsdf_sample_direction(&b, wo, 0.9f, (vec2){0.5f, 0.5f}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &s));
    g_assert_cmpint(s.wavelength, ==, ALL_WAVELENGTHS);
    g_assert_cmpfloat(fabsf(s.eta - 1.7f), <, 1e-6f);
    material_free(m);
    p = list();
    add_string(p, PARAM_SPECTRUM_NAME, "eta", "glass-N-SF11");
    m = make("dielectric", p);
    b = at(m, &plain);
    g_assert_true(bsdf_sample_direction(&b, wo, 0.99f, (vec2){0.5f, 0.5f}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &s));
    g_assert_cmpint(s.wavelength, ==, 7);
    g_assert_cmpfloat(fabsf(s.eta - 1.775f), <, 0.01f);
    material_free(m);
}

static void test_deterministic(void)
{
    params *p = list();
    add_float(p, "roughness", 0.5f);
    material *m = make("conductor", p);
    bsdf b = at(m, &deterministic);
    g_assert_cmpuint(b.lobes, ==, LOBE_SPECULAR | LOBE_REFLECTION);
    material_free(m);
    for (int i = 0; i < 2; i++) {
        m = make(i ? "dielectric" : "thindielectric", list());
        b = at(m, &deterministic);
        bsdf_sample s;
        g_assert_true(bsdf_sample_direction(&b, vec3_make(0.8f, 0, 0.6f), 0.0f, (vec2){0},
                                            LOBE_ALL, TRANSPORT_IMPORTANCE, &s));
        g_assert_cmpuint(s.lobe, ==, LOBE_SPECULAR | LOBE_TRANSMISSION);
        g_assert_cmpfloat(fabsf(s.weight[0] - 1.0f), <, 1e-6f);
        material_free(m);
    }
}

static void test_thin_pane_keeps_direction(void)
{
    material *m = make("thindielectric", list());
    bsdf b = at(m, &plain);
    bsdf_sample s;
    vec3 wo = vec3_make(0.0f, -0.6f, 0.8f);
    g_assert_true(bsdf_sample_direction(&b, wo, 0.99f, (vec2){0}, LOBE_ALL,
                                        TRANSPORT_RADIANCE, &s));
    g_assert_cmpfloat(length3(s.wi + wo), <, 1e-6f);
    g_assert_cmpfloat(fabsf(s.weight[0] - 1.0f), <, 1e-5f);
    float r = bsdf_albedo(&b, vec3_make(0, 0, 1), LOBE_SPECULAR | LOBE_REFLECTION)[0];
    g_assert_cmpfloat(fabsf(r - 0.08f / 1.04f), <, 1e-5f);
    material_free(m);
}

static float coated_albedo(params *p)
{
    material *m = make("coateddiffuse", p);
    bsdf b = at(m, &plain);
    float albedo =
        bsdf_albedo(&b, vec3_make(0.6f, 0, 0.8f), LOBE_DIFFUSE | LOBE_ANY_SIDE)[0];
    material_free(m);
    return albedo;
}

static params *white(const char *name, float value)
{
    params *p = list();
    float ones[4] = {300, 1, 900, 1};
    g_assert_true(
        params_add_numbers(p, here, PARAM_SPECTRUM, "reflectance", ones, 4, NULL));
    if (strcmp(name, "maxdepth") == 0)
        g_assert_true(params_add_integers(p, here, PARAM_INTEGER, name,
                                          (int[]){(int)value}, 1, NULL));
    else
        add_float(p, name, value);
    return p;
}

/* Each parameter changes what is seen, in the direction that it should. */
static void test_coated_diffuse(void)
{
    float usual = coated_albedo(white("thickness", 0.01f));
    g_assert_cmpfloat(coated_albedo(white("thickness", 0.1f)), <, usual - 0.05f);
    g_assert_cmpfloat(coated_albedo(white("maxdepth", 1.0f)), <, usual - 0.3f);
    g_assert_cmpfloat(coated_albedo(white("maxdepth", 100.0f)), >, usual + 0.01f);
    g_assert_cmpfloat(coated_albedo(white("eta", 1.1f)), >, usual + 0.01f);
    material *m = make("coateddiffuse", list());
    g_assert_true(material_casts_caustics(m));
    bsdf b = at(m, &plain);
    g_assert_cmpuint(b.lobes, ==, LOBE_SPECULAR | LOBE_DIFFUSE | LOBE_REFLECTION);
    g_assert_false(b.lambertian);
    b = at(m, &deterministic);
    g_assert_true(b.lambertian);
    material_free(m);
    g_assert_cmpuint(class_of("coateddiffuse", 0.04f), ==, LOBE_GLOSSY | LOBE_DIFFUSE);
    params *p = white("thickness", 0.5f);
    float clear = coated_albedo(p);
    p = white("thickness", 0.5f);
    add_rgb(p, "albedo", 0.9f, 0.9f, 0.9f);
    g_assert_cmpfloat(coated_albedo(p), >, clear + 0.1f);
    refuse("coateddiffuse", white("g", 1.5f),
           "m.pbrt:4:9: parameter 'g': expected a number in -1..1, found 1.5");
    refuse("coateddiffuse", white("maxdepth", 0.0f),
           "m.pbrt:4:9: parameter 'maxdepth': expected a number >= 1, found 0");
    refuse("coateddiffuse", white("thickness", -1.0f),
           "m.pbrt:4:9: parameter 'thickness': expected a number >= 0, found -1");
}

static unsigned phong_lobes(float exponent, bool *caustics)
{
    params *p = list();
    add_float(p, "exponent", exponent);
    material *m = make("phong", p);
    bsdf b = at(m, &plain);
    *caustics = material_casts_caustics(m);
    material_free(m);
    return b.lobes;
}

static void test_phong(void)
{
    bool caustics;
    g_assert_cmpuint(phong_lobes(21.0f, &caustics), ==,
                     LOBE_GLOSSY | LOBE_DIFFUSE | LOBE_REFLECTION);
    g_assert_true(caustics);
    g_assert_cmpuint(phong_lobes(20.0f, &caustics), ==, LOBE_DIFFUSE | LOBE_REFLECTION);
    g_assert_false(caustics);
    params *p = list();
    add_float(p, "exponent", -1.0f);
    refuse("phong", p,
           "m.pbrt:4:9: parameter 'exponent': expected a number in 0..1e+06, found -1");
}

static void test_textured_inputs(void)
{
    build_context context;
    build_context_init(&context, NULL, NULL);
    params *p = list();
    add_float(p, "value", 0.25f);
    texture *number = texture_new(&context, "constant", false, p, NULL);
    params_free(p);
    p = list();
    add_rgb(p, "value", 0.3f, 0.3f, 0.3f);
    texture *colour = texture_new(&context, "constant", true, p, NULL);
    params_free(p);
    g_assert_true(number && colour);
    g_hash_table_insert(context.float_textures, g_strdup("n"), number);
    g_hash_table_insert(context.spectrum_textures, g_strdup("c"), colour);

    p = list();
    add_string(p, PARAM_TEXTURE, "reflectance", "c");
    material *m = material_new(&context, "diffuse", p, NULL);
    g_assert_nonnull(m);
    g_assert_cmpfloat(fabsf(at(m, &plain).rho[4] - 0.3f), <, 2e-3f);
    material_free(m);
    params_free(p);

    p = list();
    add_string(p, PARAM_TEXTURE, "roughness", "n");
    m = material_new(&context, "dielectric", p, NULL);
    g_assert_nonnull(m);
    g_assert_true(material_casts_caustics(m));
    g_assert_cmpuint(at(m, &plain).lobes, ==, LOBE_GLOSSY | LOBE_ANY_SIDE);
    material_free(m);
    params_free(p);

    p = list();
    add_string(p, PARAM_TEXTURE, "reflectance", "n");
    g_autoptr(GError) error = NULL;
    g_assert_null(material_new(&context, "diffuse", p, &error));
    g_assert_cmpstr(error->message, ==,
                    "m.pbrt:4:9: parameter 'reflectance': expected a spectrum texture, "
                    "but 'n' is of the other type");
    params_free(p);
    texture_free(number);
    texture_free(colour);
    build_context_clear(&context);
}

/* Each part is met as often as "amount" says, always the same one at a point, with its
 * own normals; and its lobes are known. */
static void test_mix(void)
{
    scene_builder *s = scene_builder_new(NULL);
    GError *error = NULL;
    params *matt = list(), *metal = list();
    builder_add_material(s, "matt", "diffuse", matt, &error);
    builder_add_material(s, "metal", "conductor", metal, &error);
    g_assert_no_error(error);
    for (int k = 0; k < 5; k++) {
        const float amount = (float[]){0, 0.1f, 0.5f, 0.9f, 1}[k];
        const char *const names[] = {"matt", "metal"};
        params *p = list();
        params_add_strings(p, here, PARAM_STRING, "materials", names, 2, NULL);
        add_float(p, "amount", amount);
        material *m = material_new(&s->build, "mix", p, &error);
        g_assert_no_error(error);
        g_assert_true(material_casts_caustics(m));
        int n_metal = 0;
        enum { N = 20000 };
        const wavelengths w = wavelengths_at(0.5f);
        for (int i = 0; i < N; i++) {
            surface_hit hit = flat;
            hit.p = vec3_make(1e-3f * (float)(i % 200), 1e-3f * (float)(i / 200), 2);
            bsdf b, again;
            material_bsdf(m, &hit, &w, ALL_WAVELENGTHS, &plain, &b);
            material_bsdf(m, &hit, &w, 3, &plain, &again);
            g_assert_cmpuint(b.lobes, ==, again.lobes);
            n_metal += (b.lobes & LOBE_SPECULAR) != 0;
        }
        double expected = (double)amount * N, slack = 6 * sqrt(N * 0.25);
        g_assert_cmpfloat(fabs(n_metal - expected), <=, k % 4 ? slack : 0);
        material_free(m);
        params_free(p);
    }
    const char *const bad[] = {"matt", "nothing"};
    params *p = list();
    params_add_strings(p, here, PARAM_STRING, "materials", bad, 2, NULL);
    g_assert_null(material_new(&s->build, "mix", p, &error));
    g_assert_nonnull(strstr(error->message, "'nothing'"));
    g_clear_error(&error);
    params_free(p);
    params_free(matt);
    params_free(metal);
    scene_builder_free(s);
    refuse("mix", list(), "m.pbrt:2:1: a mix needs \"string materials\" with two names");
}

static void test_diffuse_transmission(void)
{
    material *m = make("diffusetransmission", list());
    bsdf b = at(m, &plain);
    g_assert_cmpuint(b.lobes, ==, LOBE_DIFFUSE | LOBE_ANY_SIDE);
    vec3 up = vec3_make(0, 0, 1);
    g_assert_cmpfloat(
        fabsf(bsdf_albedo(&b, up, LOBE_DIFFUSE | LOBE_REFLECTION)[2] - 0.25f), <, 1e-6f);
    g_assert_cmpfloat(
        fabsf(bsdf_albedo(&b, up, LOBE_DIFFUSE | LOBE_TRANSMISSION)[2] - 0.25f), <,
        1e-6f);
    material_free(m);
    params *p = list();
    add_rgb(p, "reflectance", 0.1f, 0.1f, 0.1f);
    add_rgb(p, "transmittance", 0.3f, 0.3f, 0.3f);
    add_float(p, "scale", 2);
    m = make("diffusetransmission", p);
    b = at(m, &plain);
    spectrum f = bsdf_eval(&b, up, up, LOBE_ALL, TRANSPORT_RADIANCE) * PI_F;
    spectrum g = bsdf_eval(&b, up, -up, LOBE_ALL, TRANSPORT_RADIANCE) * PI_F;
    g_assert_cmpfloat(fabsf(f[4] - 0.2f), <, 1e-3f);
    g_assert_cmpfloat(fabsf(g[4] - 0.6f), <, 1e-3f);
    material_free(m);
    p = list();
    add_float(p, "scale", 9);
    m = make("diffusetransmission", p);
    b = at(m, &plain);
    g_assert_cmpfloat(fabsf(bsdf_albedo(&b, up, LOBE_ALL)[1] - 1), <, 1e-5f);
    material_free(m);
    p = list();
    add_float(p, "scale", -1);
    refuse("diffusetransmission", p,
           "m.pbrt:4:9: parameter 'scale': expected a number >= 0, found -1");
}

/* Two smooth layers: the geometric series of reflections, written out. */
static void test_smooth_lacquer(void)
{
    params *p = list();
    add_float(p, "thickness", 0.1f);
    material *m = make("coatedconductor", p);
    bsdf b = at(m, &plain);
    g_assert_cmpuint(b.lobes & ~(unsigned)LOBE_DIFFUSE, ==,
                     LOBE_SPECULAR | LOBE_REFLECTION);
    const wavelengths w = wavelengths_at(0.5f);
    g_autoptr(curve) eta = curve_named("metal-Cu-eta");
    g_autoptr(curve) k = curve_named("metal-Cu-k");
    spectrum ce = curve_eval(eta, &w) / 1.5f, ck = curve_eval(k, &w) / 1.5f;
    for (int i = 0; i < 4; i++) {
        float cosine = (float[]){1, 0.8f, 0.5f, 0.2f}[i];
        float inside = sqrtf(1 - (1 - cosine * cosine) / 2.25f);
        float f = fresnel_dielectric(cosine, 1.5f), a = expf(-0.1f / inside);
        spectrum r = fresnel_conductor(inside, ce, ck), expected = spectrum_fill(f);
        spectrum going = spectrum_fill((1 - f) * a);
        for (int round = 0; round < 40; round++) {
            going *= r * a;
            expected += going * (1 - f);
            going *= f * a;
        }
        vec3 wo = vec3_make(sqrtf(1 - cosine * cosine), 0, cosine);
        bsdf_sample s;
        g_assert_true(bsdf_sample_direction(&b, wo, 0.3f, (vec2){0.5f, 0.5f}, LOBE_ALL,
                                            TRANSPORT_RADIANCE, &s));
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
            g_assert_cmpfloat(fabsf(s.weight[wavelength] / expected[wavelength] - 1), <,
                              1e-3f);
        g_assert_cmpfloat(length3(s.wi - vec3_make(-wo[0], 0, wo[2])), <, 1e-5f);
    }
    material_free(m);
}

/* A number that tells bsdfs apart: what two directions see, and the lobes. */
static float look_of(params *p)
{
    material *m = make("coatedconductor", p);
    bsdf b = at(m, &plain);
    vec3 wo = normalize3(vec3_make(0.3f, 0.2f, 1)),
         wi = normalize3(vec3_make(-0.1f, 0.3f, 1));
    spectrum f = bsdf_eval(&b, wo, wi, LOBE_ALL, TRANSPORT_RADIANCE);
    f += bsdf_albedo(&b, wo, LOBE_ALL);
    material_free(m);
    return spectrum_mean(f) + 0.3f * f[6];
}

static params *satin(void)
{
    params *p = list();
    add_float(p, "interface.roughness", 0.02f);
    add_float(p, "conductor.roughness", 0.1f);
    return p;
}

static void test_lacquer_parameters_act(void)
{
    static const char *const numbers[] = {"interface.uroughness", "interface.vroughness",
                                          "interface.eta",        "thickness",
                                          "conductor.uroughness", "conductor.vroughness"};
    float plain_look = look_of(satin());
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        params *p = satin();
        add_float(p, numbers[i], i == 2 ? 1.8f : 0.4f);
        float look = look_of(p);
        g_test_message("%s: %g to %g", numbers[i], (double)plain_look, (double)look);
        g_assert_cmpfloat(fabsf(look - plain_look), >, 1e-3f);
    }
    static const char *const spectra[] = {"conductor.eta", "conductor.k", "reflectance"};
    for (size_t i = 0; i < G_N_ELEMENTS(spectra); i++) {
        params *p = satin();
        add_rgb(p, spectra[i], 0.3f, 0.6f, 0.2f);
        g_assert_cmpfloat(fabsf(look_of(p) - plain_look), >, 1e-3f);
    }
    params *p = satin();
    add_bool(p, "remaproughness", 0);
    g_assert_cmpfloat(fabsf(look_of(p) - plain_look), >, 1e-3f);
    p = satin();
    add_rgb(p, "albedo", 0.5f, 0.5f, 0.5f);
    g_assert_cmpfloat(fabsf(look_of(p) - plain_look), >, 1e-3f);
    p = list();
    add_rgb(p, "reflectance", 1, 1, 1);
    add_rgb(p, "conductor.k", 1, 1, 1);
    refuse("coatedconductor", p,
           "m.pbrt:4:9: a conductor has either 'reflectance' or 'conductor.eta' and "
           "'conductor.k'");
    p = list();
    add_float(p, "roughness", 0.1f);
    refuse("coatedconductor", p,
           "m.pbrt:4:9: unknown parameter 'roughness' of material 'coatedconductor'");
    static const char *const unknown[] = {"hair", "subsurface", "measured"};
    for (int i = 0; i < 3; i++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(params) q = list();
        g_assert_null(material_new(NULL, unknown[i], q, &error));
        g_assert_true(g_str_has_prefix(error->message, "m.pbrt:2:1: "));
        g_assert_nonnull(strstr(error->message, unknown[i]));
    }
}

static void test_refusals(void)
{
    params *p = list();
    add_float(p, "shine", 1.0f);
    refuse("diffuse", p, "m.pbrt:4:9: unknown parameter 'shine' of material 'diffuse'");
    p = list();
    add_string(p, PARAM_TEXTURE, "displacement", "bumps");
    refuse("diffuse", p,
           "m.pbrt:4:9: parameter 'displacement': there is no float texture 'bumps'");
    p = list();
    add_string(p, PARAM_TEXTURE, "reflectance", "nowhere");
    refuse("diffuse", p,
           "m.pbrt:4:9: parameter 'reflectance': there is no spectrum texture 'nowhere'");
    p = list();
    add_rgb(p, "reflectance", 1, 1, 1);
    add_rgb(p, "k", 1, 1, 1);
    refuse("conductor", p,
           "m.pbrt:4:9: a conductor has either 'reflectance' or 'eta' and 'k'");
    p = list();
    add_float(p, "roughness", -0.1f);
    refuse("conductor", p,
           "m.pbrt:4:9: parameter 'roughness': expected a number >= 0, found -0.1");
    p = list();
    add_float(p, "eta", 0.0f);
    refuse("dielectric", p,
           "m.pbrt:4:9: parameter 'eta': expected an index of refraction > 0, found 0 at "
           "380 nm");
    p = list();
    add_float(p, "roughness", 0.1f);
    add_float(p, "uroughness", 0.1f);
    add_float(p, "vroughness", 0.1f);
    refuse("dielectric", p,
           "m.pbrt:4:9: parameter 'roughness' has no effect beside 'uroughness' and "
           "'vroughness'");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/material/diffuse", test_diffuse);
    g_test_add_func("/material/roughness", test_roughness);
    g_test_add_func("/material/classes", test_classes);
    g_test_add_func("/material/conductor", test_conductor);
    g_test_add_func("/material/dispersion-by-eta", test_dispersion_by_eta);
    g_test_add_func("/material/deterministic", test_deterministic);
    g_test_add_func("/material/thin-pane", test_thin_pane_keeps_direction);
    g_test_add_func("/material/coated-diffuse", test_coated_diffuse);
    g_test_add_func("/material/phong", test_phong);
    g_test_add_func("/material/textured-inputs", test_textured_inputs);
    g_test_add_func("/material/lacquer/smooth", test_smooth_lacquer);
    g_test_add_func("/material/lacquer/parameters", test_lacquer_parameters_act);
    g_test_add_func("/material/mix", test_mix);
    g_test_add_func("/material/diffuse-transmission", test_diffuse_transmission);
    g_test_add_func("/material/refusals", test_refusals);
    return g_test_run();
}
