/*
 * glTF materials: our material of the same name, and what else a glTF material says that
 * belongs to the surface: light that it sends out, and cut-outs.
 */
#include "format/gltf/gltf.h"

#include "format/given.h"

#include <math.h>
#include <string.h>

/* Fraunhofer's lines F, d and C, µm, which Abbe's number is measured at. */
#define LINE_F 0.4861327
#define LINE_D 0.5875618
#define LINE_C 0.6562725

#define GLOSSY "KHR_materials_pbrSpecularGlossiness"

/* ---- Parts ---- */

/* KHR_materials_pbrSpecularGlossiness, from before metalness: reflectance straight on is
 * given, which is 0.04 times our specular colour at the index of 1.5. */
static void give_glossy(gltf *g, params *p, const json_value *of, bool colored)
{
    const gltf_channel base = {.vertex_color = colored};
    const gltf_channel rough = {.channel = "A", .invert = true};
    double color[4] = {1.0, 1.0, 1.0, 1.0}, specular[3] = {1.0, 1.0, 1.0};
    json_value color_map = json_member(of, "diffuseTexture");
    json_value map = json_member(of, "specularGlossinessTexture");
    double gloss = CLAMP(json_real(of, "glossinessFactor", 1.0), 0.0, 1.0);
    json_numbers(of, "diffuseFactor", color, 4);
    json_numbers(of, "specularFactor", specular, 3);
    for (int i = 0; i < 3; i++) {
        color[i] = CLAMP(color[i], 0.0, 1.0);
        specular[i] = CLAMP(specular[i], 0.0, 1.0) / 0.04;
    }
    gltf_give_textured(g, p, "basecolor", &color_map, &base, color);
    gltf_give_textured(g, p, "specularcolor", &map, &(gltf_channel){0}, specular);
    gltf_give_textured(g, p, "roughness", &map, &rough, &gloss);
    give_float(p, "metallic", 0.0);
}

static void give_base(gltf *g, params *p, const json_value *m, bool colored)
{
    const gltf_channel base = {.vertex_color = colored};
    double color[4] = {1.0, 1.0, 1.0, 1.0}, x;
    json_value pbr = json_member(m, "pbrMetallicRoughness");
    json_value color_map = json_member(&pbr, "baseColorTexture");
    json_value rough_map = json_member(&pbr, "metallicRoughnessTexture");
    json_numbers(&pbr, "baseColorFactor", color, 4);
    for (int i = 0; i < 3; i++)
        color[i] = CLAMP(color[i], 0.0, 1.0);
    gltf_give_textured(g, p, "basecolor", &color_map, &base, color);
    x = CLAMP(json_real(&pbr, "metallicFactor", 1.0), 0.0, 1.0);
    gltf_give_textured(g, p, "metallic", &rough_map, &(gltf_channel){.channel = "B"}, &x);
    x = CLAMP(json_real(&pbr, "roughnessFactor", 1.0), 0.0, 1.0);
    gltf_give_textured(g, p, "roughness", &rough_map, &(gltf_channel){.channel = "G"},
                       &x);
}

/* A factor in 0..1 with its map, if there is something to say. */
static void give_share(gltf *g, params *p, const char *name, const json_value *of,
                       const char *key, double fallback, const char *channel)
{
    g_autofree char *factor_key = g_strdup_printf("%sFactor", key);
    g_autofree char *map_key = g_strdup_printf("%sTexture", key);
    json_value map = json_member(of, map_key);
    double x = CLAMP(json_real(of, factor_key, fallback), 0.0, 1.0);
    gltf_give_textured(g, p, name, &map, &(gltf_channel){.channel = channel}, &x);
}

static void give_specular(gltf *g, params *p, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_specular", &extensions);
    double color[3] = {1.0, 1.0, 1.0};
    if (!json_exists(&e))
        return;
    json_value map = json_member(&e, "specularColorTexture");
    json_numbers(&e, "specularColorFactor", color, 3);
    give_share(g, p, "specular", &e, "specular", 1.0, "A");
    gltf_give_textured(g, p, "specularcolor", &map, &(gltf_channel){0}, color);
}

/* The texture has the direction in red and green, -1..1 as 0..1, the strength in blue. */
static void give_anisotropy(gltf *g, params *p, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_anisotropy", &extensions);
    const double one = 1.0;
    double strength = CLAMP(json_real(&e, "anisotropyStrength", 0.0), 0.0, 1.0);
    if (!json_exists(&e))
        return;
    json_value map = json_member(&e, "anisotropyTexture");
    gltf_give_textured(g, p, "anisotropy", &map, &(gltf_channel){.channel = "B"},
                       &strength);
    give_float(p, "anisotropyrotation", json_real(&e, "anisotropyRotation", 0.0));
    if (!json_exists(&map))
        return;
    gltf_give_textured(g, p, "anisotropyu", &map, &(gltf_channel){.channel = "R"}, &one);
    gltf_give_textured(g, p, "anisotropyv", &map, &(gltf_channel){.channel = "G"}, &one);
}

static void give_leaf(gltf *g, params *p, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_diffuse_transmission", &extensions);
    double color[3] = {1.0, 1.0, 1.0};
    if (!json_exists(&e))
        return;
    json_value map = json_member(&e, "diffuseTransmissionColorTexture");
    json_numbers(&e, "diffuseTransmissionColorFactor", color, 3);
    for (int i = 0; i < 3; i++)
        color[i] = CLAMP(color[i], 0.0, 1.0);
    give_share(g, p, "diffusetransmission", &e, "diffuseTransmission", 0.0, "A");
    gltf_give_textured(g, p, "diffusetransmissioncolor", &map, &(gltf_channel){0}, color);
}

static void give_coat(gltf *g, params *p, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_clearcoat", &extensions);
    if (!json_exists(&e))
        return;
    json_value normals = json_member(&e, "clearcoatNormalTexture");
    if (json_exists(&normals))
        gltf_note(g, LOG_WARNING,
                  "a clear coat has the surface's own normals: its "
                  "clearcoatNormalTexture is left out");
    give_share(g, p, "clearcoat", &e, "clearcoat", 0.0, "R");
    give_share(g, p, "clearcoatroughness", &e, "clearcoatRoughness", 0.0, "G");
}

/* Cauchy's n = a + b/λ² through the index at line d with Abbe's number V, every 10 nm. */
static void give_dispersive_eta(params *p, double ior, double abbe)
{
    enum { FIRST = 360, STEP = 10, N = 48 };
    float pairs[2 * N];
    double b = (ior - 1.0) / abbe / (1.0 / (LINE_F * LINE_F) - 1.0 / (LINE_C * LINE_C));
    for (int i = 0; i < N; i++) {
        double um = 1e-3 * (FIRST + STEP * i);
        pairs[2 * i] = (float)(FIRST + STEP * i);
        pairs[2 * i + 1] = (float)(ior + b * (1.0 / (um * um) - 1.0 / (LINE_D * LINE_D)));
    }
    params_add_numbers(p, p->place, PARAM_SPECTRUM, "eta", pairs, 2 * N, NULL);
}

/* An index of 0 stands for infinity, which mirrors all: the largest that makes sense. */
static void give_index(params *p, const json_value *m, bool solid)
{
    json_value of_ior, of_dispersion;
    json_value e = gltf_extension(m, "KHR_materials_ior", &of_ior);
    json_value d = gltf_extension(m, "KHR_materials_dispersion", &of_dispersion);
    double ior = json_real(&e, "ior", 1.5);
    double dispersion = json_real(&d, "dispersion", 0.0);
    if (ior > 0.0 && ior < 1.0)
        json_fail(&e, "expected an \"ior\" of 0 or at least 1, found %g", ior);
    if (!(ior >= 1.0))
        ior = 1000.0;
    if (solid && dispersion > 0.0)
        give_dispersive_eta(p, ior, 20.0 / dispersion);
    else
        give_float(p, "eta", ior);
}

static bool has_volume(const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_volume", &extensions);
    return json_real(&e, "thicknessFactor", 0.0) > 0.0;
}

static void give_volume(params *p, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_volume", &extensions);
    double color[3] = {1.0, 1.0, 1.0};
    double distance = json_real(&e, "attenuationDistance", 0.0);
    if (!json_numbers(&e, "attenuationColor", color, 3) || !(distance > 0.0))
        return;
    for (int i = 0; i < 3; i++)
        color[i] = CLAMP(color[i], 0.0, 1.0);
    give_triple(p, PARAM_RGB, "attenuationcolor", color[0], color[1], color[2]);
    give_float(p, "attenuationdistance", distance);
}

static bool give_transmission(gltf *g, params *p, const json_value *m, bool solid)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_transmission", &extensions);
    solid = json_exists(&e) && (solid || has_volume(m));
    if (!json_exists(&e))
        return false;
    give_share(g, p, "transmission", &e, "transmission", 0.0, "R");
    give_bool(p, "thin", !solid);
    if (solid)
        give_volume(p, m);
    return solid;
}

/* ---- What shines ---- */

/* Whether a material is unlit: it shows its base colour whatever falls on it, and is
 * black else. Other things see that light, as they see that of what glows. */
static bool is_unlit(const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_unlit", &extensions);
    return json_exists(&e);
}

static params *read_unlit(gltf *g, const json_value *m, bool colored)
{
    const gltf_channel base = {.vertex_color = colored};
    json_value pbr = json_member(m, "pbrMetallicRoughness");
    json_value map = json_member(&pbr, "baseColorTexture");
    double color[4] = {1.0, 1.0, 1.0, 1.0};
    json_numbers(&pbr, "baseColorFactor", color, 4);
    if (!(color[0] + color[1] + color[2] > 0.0))
        return NULL;
    params *p = gltf_params(g);
    gltf_give_textured(g, p, "L", &map, &base, color);
    return p;
}

static void give_black(params *p)
{
    give_triple(p, PARAM_RGB, "basecolor", 0.0, 0.0, 0.0);
    give_float(p, "metallic", 0.0);
    give_float(p, "specular", 0.0);
}

static params *read_emission(gltf *g, const json_value *m)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_emissive_strength", &extensions);
    json_value map = json_member(m, "emissiveTexture");
    double color[3] = {0.0, 0.0, 0.0};
    double strength = json_real(&e, "emissiveStrength", 1.0);
    json_numbers(m, "emissiveFactor", color, 3);
    if (!(color[0] + color[1] + color[2] > 0.0) || !(strength > 0.0))
        return NULL;
    g->shines |= strength * MAX(color[0], MAX(color[1], color[2])) > 1.0;
    params *p = gltf_params(g);
    gltf_give_textured(g, p, "L", &map, &(gltf_channel){0}, color);
    give_float(p, "scale", strength);
    return p;
}

static params *read_shine(gltf *g, const json_value *m, bool colored)
{
    return is_unlit(m) ? read_unlit(g, m, colored) : read_emission(g, m);
}

/* ---- Cut-outs ---- */

/* The alpha channel of the base colour, which for MASK is cut at a value. */
static params *read_alpha(gltf *g, const json_value *m, bool colored)
{
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND", NULL};
    const char *mode = json_text(m, "alphaMode");
    json_value extensions, pbr = json_member(m, "pbrMetallicRoughness");
    json_value glossy = gltf_extension(m, GLOSSY, &extensions);
    bool is_glossy = json_exists(&glossy);
    json_value map = is_glossy ? json_member(&glossy, "diffuseTexture")
                               : json_member(&pbr, "baseColorTexture");
    double color[4] = {1.0, 1.0, 1.0, 1.0}, cut = json_real(m, "alphaCutoff", 0.5);
    json_numbers(is_glossy ? &glossy : &pbr,
                 is_glossy ? "diffuseFactor" : "baseColorFactor", color, 4);
    double alpha = CLAMP(color[3], 0.0, 1.0);
    if (mode && !g_strv_contains(modes, mode))
        json_fail(m, "expected \"alphaMode\" OPAQUE, MASK or BLEND, found %s", mode);
    if (!mode || strcmp(mode, "OPAQUE") == 0)
        return NULL;
    bool masked = strcmp(mode, "MASK") == 0;
    params *p = gltf_params(g);
    const gltf_channel how = {
        .channel = "A", .vertex_color = colored, .is_cut = masked, .cut = cut};
    if (masked && !json_exists(&map) && !colored)
        alpha = alpha < cut ? 0.0 : 1.0;
    gltf_give_textured(g, p, "alpha", &map, &how, &alpha);
    return p;
}

/* ---- All of it ---- */

static void note_occlusion(gltf *g, const json_value *m)
{
    json_value occlusion = json_member(m, "occlusionTexture");
    if (json_exists(&occlusion))
        gltf_note(g, LOG_NOTE,
                  "occlusion maps are not needed: light itself finds what is hidden");
}

static params *material_params(gltf *g, const json_value *m, bool colored, bool solid)
{
    params *p = gltf_params(g);
    if (is_unlit(m)) {
        give_black(p);
        return p;
    }
    json_value normals = json_member(m, "normalTexture");
    json_value extensions;
    json_value glossy = gltf_extension(m, GLOSSY, &extensions);
    if (json_exists(&glossy)) {
        give_glossy(g, p, &glossy, colored);
    } else {
        give_base(g, p, m, colored);
        give_specular(g, p, m);
    }
    give_anisotropy(g, p, m);
    give_leaf(g, p, m);
    give_coat(g, p, m);
    solid = give_transmission(g, p, m, solid);
    give_index(p, m, solid);
    gltf_give_normals(g, p, &normals);
    return p;
}

/* Element of "materials", absent for the default material. */
static json_value material_value(gltf *g, json_value *array, gint64 index)
{
    *array = json_member(&g->root, "materials");
    if (index < 0)
        return (json_value){.reader = &g->json, .parent = array};
    return json_element(array, (guint)index);
}

static gltf_material_info *info_of(gltf *g, gint64 index)
{
    return &g->materials[index < 0 ? g->n_materials : (guint)index];
}

static void read_info(gltf *g, const json_value *m, gltf_material_info *info)
{
    json_value extensions;
    json_value e = gltf_extension(m, "KHR_materials_transmission", &extensions);
    info->is_read = true;
    info->transmits = json_exists(&e) && !has_volume(m) && !is_unlit(m);
    info->alpha = read_alpha(g, m, info->colored);
    note_occlusion(g, m);
    info->area_light = read_shine(g, m, info->colored);
    /* What is unlit is a picture, and black behind it would be none; a closed body of it
     * may be a environment, seen from within. */
    if (!info->area_light || !(is_unlit(m) || json_flag(m, "doubleSided", false)))
        return;
    if (!is_unlit(m))
        info->both_sides = read_shine(g, m, info->colored);
    if (!gltf_failed(g))
        give_bool(info->both_sides ? info->both_sides : info->area_light, "twosided",
                  true);
}

static void make(gltf *g, const json_value *m, gltf_material_info *info, bool solid)
{
    GError *error = NULL;
    const char *name = json_text(m, "name");
    g_autofree char *unique =
        name ? g_strdup_printf("%s%s", name, solid ? " (solid)" : "") : NULL;
    if (unique && builder_find_material(g->builder, unique) != NO_INDEX)
        g_clear_pointer(&unique, g_free);
    g_autoptr(params) p = material_params(g, m, info->colored, solid);
    if (gltf_failed(g))
        return;
    int made = builder_add_material(g->builder, unique, "gltf", p, &error);
    if (made == NO_INDEX)
        gltf_take_error(g, m, error);
    *(solid ? &info->solid_index : &info->index) = made;
}

const gltf_material_info *gltf_material(gltf *g, gint64 index)
{
    json_value array, m = material_value(g, &array, index);
    if (gltf_failed(g))
        return NULL;
    gltf_material_info *info = info_of(g, index);
    if (!info->is_read)
        read_info(g, &m, info);
    return gltf_failed(g) ? NULL : info;
}

int gltf_material_index(gltf *g, gint64 index, bool solid)
{
    json_value array, m = material_value(g, &array, index);
    if (gltf_failed(g))
        return NO_INDEX;
    gltf_material_info *info = info_of(g, index);
    int *made = solid ? &info->solid_index : &info->index;
    if (*made == NO_INDEX)
        make(g, &m, info, solid);
    return *made;
}
