/*
 * Materials and textures of pbrt-v3 in pbrt-v4's words.
 */
#include "format/pbrt/pbrt_v3_words.h"

#include <math.h>

/* ---- Materials ---- */

/* TrowbridgeReitzDistribution::RoughnessToAlpha of v3. */
static double alpha_of(double roughness)
{
    double x = log(fmax(roughness, 1e-3));
    return 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x +
           0.000640711 * x * x * x * x;
}

/* Numbers become alphas by v3's formula; v4's is another. 0 stays smooth where v3 keeps
 * it so (glass). */
static void translate_roughness(const translation *t, double fallback)
{
    static const char *const names[] = {"roughness", "uroughness", "vroughness"};
    const param *remap = find(t, "remaproughness");
    bool remaps =
        !remap || remap->type != PARAM_BOOL || remap->n != 1 || remap->integers[0];
    bool textured = false;
    if (!find(t, "roughness") && !(find(t, "uroughness") && find(t, "vroughness")))
        give_float(t->p, "roughness", fallback);
    if (find(t, "roughness") && find(t, "uroughness") && find(t, "vroughness"))
        drop(t, "roughness");
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        textured |= find(t, names[i]) && !is_number(find(t, names[i]));
    if (!remaps)
        return;
    if (textured) {
        note(t, NULL, "a roughness map is remapped as pbrt-v4 does it");
        return;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        double roughness = number(t, names[i], -1.0);
        if (roughness > 0.0 || (roughness >= 0.0 && fallback > 0.0))
            set_number(t, names[i], alpha_of(roughness));
    }
    drop(t, "remaproughness");
    give_bool(t->p, "remaproughness", false);
}

static void to_matte(const translation *t)
{
    const param *sigma = find(t, "sigma");
    set_kind(t, "diffuse");
    if (sigma && !(is_number(sigma) && !(sigma->numbers[0] > 0.0f)))
        note(t, sigma, "'sigma' (Oren-Nayar) is left out, as pbrt-v4 does");
    drop(t, "sigma");
    rename_to(t, "Kd", "reflectance");
}

static void to_plastic(const translation *t)
{
    set_kind(t, "coateddiffuse");
    default_rgb(t, "Kd", 0.25);
    rename_to(t, "Kd", "reflectance");
    drop_noted(t, "Ks", "the coat reflects by Fresnel's law instead of 'Ks'");
    translate_roughness(t, 0.1);
}

static void to_substrate(const translation *t)
{
    set_kind(t, "coateddiffuse");
    default_rgb(t, "Kd", 0.5);
    rename_to(t, "Kd", "reflectance");
    drop_noted(t, "Ks", "the coat reflects by Fresnel's law instead of 'Ks'");
    translate_roughness(t, 0.1);
}

static void to_uber(const translation *t)
{
    drop_noted(t, "Kr", "'Kr' of uber is left out, as pbrt-v4 does");
    drop_noted(t, "Kt", "'Kt' of uber is left out, as pbrt-v4 does");
    drop_noted(t, "opacity", "'opacity' of uber is left out; shapes have 'alpha'");
    rename_to(t, "index", "eta");
    to_plastic(t);
}

static void to_glass(const translation *t)
{
    set_kind(t, "dielectric");
    rename_to(t, "index", "eta");
    drop_noted(t, "Kr", "glass reflects by Fresnel's law alone: 'Kr' is left out");
    clamp_rgb(t, "Kt");
    rename_to(t, "Kt", "tint");
    translate_roughness(t, 0.0);
}

static void to_mirror(const translation *t)
{
    set_kind(t, "conductor");
    default_rgb(t, "Kr", 0.9);
    clamp_rgb(t, "Kr");
    rename_to(t, "Kr", "reflectance");
}

static void to_metal(const translation *t)
{
    set_kind(t, "conductor");
    translate_roughness(t, 0.01);
}

static double mean_of(const double a[3], const double b[3])
{
    return (a[0] + a[1] + a[2] + b[0] + b[1] + b[2]) / 6.0;
}

static void to_translucent(const translation *t)
{
    double reflect[3] = {0.5, 0.5, 0.5}, transmit[3] = {0.5, 0.5, 0.5};
    const param *r = find(t, "reflect"), *s = find(t, "transmit");
    for (int i = 0; i < 3; i++) {
        reflect[i] = is_rgb(r) ? (double)r->numbers[i] : 0.5;
        transmit[i] = is_rgb(s) ? (double)s->numbers[i] : 0.5;
    }
    set_kind(t, "diffusetransmission");
    default_rgb(t, "Kd", 0.25);
    const param *kd = find(t, "Kd");
    if (is_rgb(kd)) {
        params_add_numbers(t->p, kd->place, PARAM_RGB, "transmittance", kd->numbers, 3,
                           NULL);
    } else if (kd->type == PARAM_TEXTURE && kd->n == 1) {
        give_text(t->p, PARAM_TEXTURE, "transmittance", kd->strings[0]);
        give_float(t->p, "scale", mean_of(reflect, transmit));
    }
    rename_to(t, "Kd", "reflectance");
    scale_rgb(t, "reflectance", reflect);
    scale_rgb(t, "transmittance", transmit);
    drop(t, "reflect");
    drop(t, "transmit");
    drop(t, "Ks");
    drop(t, "roughness");
    drop(t, "remaproughness");
    note(t, NULL, "translucent keeps its diffuse part alone, as pbrt-v4 does");
}

static const char *text_of(const translation *t, const char *name)
{
    const param *q = find(t, name);
    return q && q->type == PARAM_STRING && q->n == 1 ? q->strings[0] : "";
}

/* v3's amount is the first material's, v4's the second's. */
static void to_mix(const translation *t)
{
    const char *a = text_of(t, "namedmaterial1"), *b = text_of(t, "namedmaterial2");
    param *amount = find(t, "amount");
    bool turned = amount && amount->type == PARAM_TEXTURE; /* instead of the amount */
    const char *both[] = {turned ? b : a, turned ? a : b};
    params_add_strings(t->p, t->p->place, PARAM_STRING, "materials", both, 2, NULL);
    drop(t, "namedmaterial1");
    drop(t, "namedmaterial2");
    double share = 0.5;
    if (is_rgb(amount))
        share = ((double)amount->numbers[0] + (double)amount->numbers[1] +
                 (double)amount->numbers[2]) /
                3.0;
    else if (is_number(amount))
        share = (double)amount->numbers[0];
    if (amount && !is_rgb(amount) && !is_number(amount))
        return;
    drop(t, "amount");
    give_float(t->p, "amount", 1.0 - share);
}

/* Says what is lost, unless it is nothing. */
static void drop_lost(const translation *t, const char *name)
{
    const param *q = find(t, name);
    float sum = 0.0f;
    for (size_t i = 0; q && q->numbers && i < q->n; i++)
        sum += fabsf(q->numbers[i]);
    if (q && (sum > 0.0f || !q->numbers)) {
        g_autofree char *text = g_strdup_printf("'%s' of disney is left out", name);
        note(t, q, text);
    }
    drop(t, name);
}

static void default_number(const translation *t, const char *name, double value)
{
    if (!find(t, name))
        give_float(t->p, name, value);
}

/* Base, metal, coat and glass are those of the gltf material, whose facets are the same.
 * A Disney coat is a quarter of one, with alpha from 0.1 to 0.001 by its gloss. */
static void to_disney(const translation *t)
{
    static const char *const lost[] = {"sheen", "speculartint", "flatness", "difftrans",
                                       "scatterdistance"};
    double coat = number(t, "clearcoat", 0.0), gloss = number(t, "clearcoatgloss", 1.0);
    set_kind(t, "gltf");
    default_rgb(t, "color", 0.5);
    clamp_rgb(t, "color");
    rename_to(t, "color", "basecolor");
    default_number(t, "metallic", 0.0);
    default_number(t, "roughness", 0.5);
    rename_to(t, "anisotropic", "anisotropy");
    if (find(t, "spectrans") && !find(t, "thin"))
        give_bool(t->p, "thin", false);
    rename_to(t, "spectrans", "transmission");
    if (coat > 0.0) {
        set_number(t, "clearcoat", CLAMP(0.25 * coat, 0.0, 1.0));
        give_float(t->p, "clearcoatroughness",
                   sqrt(0.1 + (0.001 - 0.1) * CLAMP(gloss, 0.0, 1.0)));
    }
    drop(t, "clearcoatgloss");
    drop(t, "sheentint");
    for (size_t i = 0; i < G_N_ELEMENTS(lost); i++)
        drop_lost(t, lost[i]);
    note(t, NULL, "disney becomes the gltf material");
}

typedef struct v3_kind {
    const char *name;
    void (*translate)(const translation *t);
} v3_kind;

static const v3_kind materials[] = {
    {"matte", to_matte},
    {"plastic", to_plastic},
    {"substrate", to_substrate},
    {"uber", to_uber},
    {"glass", to_glass},
    {"mirror", to_mirror},
    {"metal", to_metal},
    {"translucent", to_translucent},
    {"mix", to_mix},
    {"disney", to_disney},
};

void pbrt_v3_material(const translation *t)
{
    rename_to(t, "bumpmap", "displacement");
    for (size_t i = 0; i < G_N_ELEMENTS(materials); i++)
        if (strcmp(*t->kind, materials[i].name) == 0) {
            materials[i].translate(t);
            clamp_rgb(t, "reflectance");
            return;
        }
}

/* ---- Textures ---- */

static double mean_of_rgb(const param *q)
{
    return ((double)q->numbers[0] + (double)q->numbers[1] + (double)q->numbers[2]) / 3.0;
}

/* v3 multiplies two colours, v4 a colour by a number. */
static void translate_scale(const translation *t)
{
    param *a = find(t, "tex1"), *b = find(t, "tex2");
    if (is_rgb(a) && is_rgb(b)) {
        for (int i = 0; i < 3; i++)
            a->numbers[i] *= b->numbers[i];
        drop(t, "tex2");
    } else if (is_rgb(a) || is_rgb(b)) {
        bool second = is_rgb(b);
        double mean = mean_of_rgb(second ? b : a);
        note(t, NULL, "a texture is scaled by the mean of the colour's components");
        drop(t, second ? "tex2" : "tex1");
        give_float(t->p, "scale", mean);
        rename_to(t, second ? "tex1" : "tex2", "tex");
    }
    rename_to(t, "tex1", "tex");
    rename_to(t, "tex2", "scale");
}

/* u is red and v is green. */
static void translate_uv(const translation *t)
{
    set_kind(t, "bilerp");
    give_triple(t->p, PARAM_RGB, "v00", 0.0, 0.0, 0.0);
    give_triple(t->p, PARAM_RGB, "v01", 0.0, 1.0, 0.0);
    give_triple(t->p, PARAM_RGB, "v10", 1.0, 0.0, 0.0);
    give_triple(t->p, PARAM_RGB, "v11", 1.0, 1.0, 0.0);
    note(t, NULL, "texture uv becomes bilerp, which does not repeat");
}

static bool has_text(const translation *t, const char *name)
{
    return *text_of(t, name) != '\0';
}

static void drop_unknown_mapping(const translation *t)
{
    static const char *const known[] = {"uv", "spherical", "cylindrical", "planar", NULL};
    if (has_text(t, "mapping") && !g_strv_contains(known, text_of(t, "mapping")))
        drop_noted(t, "mapping", "a mapping that is unknown is 'uv'");
}

/* pbrt-v3's for a picture that can not be read. */
static void to_white(const translation *t)
{
    note(t, NULL, "a picture without a name is white");
    set_kind(t, "constant");
    g_ptr_array_set_size(t->p->list, 0);
}

void pbrt_v3_texture(const translation *t)
{
    const param *gamma = find(t, "gamma"), *trilinear = find(t, "trilinear");
    if (strcmp(*t->kind, "scale") == 0)
        translate_scale(t);
    if (strcmp(*t->kind, "uv") == 0)
        translate_uv(t);
    drop(t, "aamode");
    drop_unknown_mapping(t);
    if (strcmp(*t->kind, "imagemap") != 0)
        return;
    if (!has_text(t, "filename")) {
        to_white(t);
        return;
    }
    if (gamma && gamma->type == PARAM_BOOL && gamma->n == 1)
        give_text(t->p, PARAM_STRING, "encoding", gamma->integers[0] ? "sRGB" : "linear");
    if (trilinear && trilinear->type == PARAM_BOOL && trilinear->n == 1 &&
        trilinear->integers[0])
        give_text(t->p, PARAM_STRING, "filter", "trilinear");
    drop(t, "gamma");
    drop(t, "trilinear");
    drop(t, "maxanisotropy");
}
