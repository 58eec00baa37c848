/*
 * From pbrt-v3 to pbrt-v4, directive by directive, as far as the two mean the same; the
 * formulas are those of Pharr, Jakob & Humphreys, "Physically Based Rendering", third
 * edition, and of pbrt-v4's own upgrade.
 *
 * Colours of lights need care: v3 takes spectra as they are, v4 divides them by their
 * luminance, which is undone in "scale".
 */
#include "format/pbrt_v3.h"

#include "format/given.h"

#include <math.h>
#include <string.h>

/* ∫ ȳ dλ, which v3 divides luminances by. */
#define CIE_Y_INTEGRAL 106.856895

/* ---- Recognising ---- */

static const char *const v3_words[] = {
    "Film \"image\"",
    "Material \"matte\"",
    "Material \"plastic\"",
    "Material \"glass\"",
    "Material \"mirror\"",
    "Material \"metal\"",
    "Material \"substrate\"",
    "Material \"uber\"",
    "Material \"translucent\"",
    "Material \"disney\"",
    "\"string type\" \"matte\"",
    "\"string type\" \"plastic\"",
    "\"string type\" \"glass\"",
    "\"string type\" \"mirror\"",
    "\"string type\" \"metal\"",
    "\"string type\" \"substrate\"",
    "\"string type\" \"uber\"",
    "\"string type\" \"translucent\"",
    "\"string type\" [ \"matte\"",
    "\"string type\" [ \"plastic\"",
    "\"string type\" [ \"uber\"",
    "\"string type\" [ \"substrate\"",
    "\"color\" \"imagemap\"",
    "WorldEnd",
};

/* A comment's words say nothing. */
static bool in_comment(const char *text, const char *at)
{
    while (at > text && at[-1] != '\n')
        if (*--at == '#')
            return true;
    return false;
}

static bool find_word(const char *text, size_t size, const char *word)
{
    size_t length = strlen(word);
    const char *end = text + size;
    for (const char *at = text; (size_t)(end - at) >= length; at++) {
        at = memchr(at, word[0], (size_t)(end - at) - length + 1);
        if (!at)
            return false;
        if (memcmp(at, word, length) == 0 && !in_comment(text, at))
            return true;
    }
    return false;
}

bool pbrt_v3_recognises(const char *text, size_t size)
{
    for (size_t i = 0; i < G_N_ELEMENTS(v3_words); i++)
        if (find_word(text, size, v3_words[i]))
            return true;
    return false;
}

/* ---- Parameters ---- */

/* A directive being translated. */
typedef struct translation {
    char **kind;
    params *p;
    const log_sink *log;
} translation;

static void note(const translation *t, const param *q, const char *text)
{
    source_place at = q ? q->place : t->p->place;
    log_message(t->log, LOG_NOTE, "%s:%d:%d: pbrt-v3: %s", at.file, at.line, at.column,
                text);
}

static param *find(const translation *t, const char *name)
{
    for (guint i = 0; i < t->p->list->len; i++) {
        param *q = t->p->list->pdata[i];
        if (strcmp(q->name, name) == 0)
            return q;
    }
    return NULL;
}

static void drop(const translation *t, const char *name)
{
    param *q = find(t, name);
    if (q)
        g_ptr_array_remove(t->p->list, q);
}

/* Gone without a trace, or with a word about what it meant. */
static void drop_noted(const translation *t, const char *name, const char *text)
{
    if (find(t, name))
        note(t, find(t, name), text);
    drop(t, name);
}

static void rename_to(const translation *t, const char *name, const char *other)
{
    param *q = find(t, name);
    if (q && !find(t, other))
        q->name = g_intern_string(other);
}

static void set_kind(const translation *t, const char *kind)
{
    g_free(*t->kind);
    *t->kind = g_strdup(kind);
}

static bool is_number(const param *q)
{
    return q && q->type == PARAM_FLOAT && q->n == 1;
}

static bool is_rgb(const param *q)
{
    return q && q->type == PARAM_RGB && q->n == 3;
}

static double number(const translation *t, const char *name, double fallback)
{
    const param *q = find(t, name);
    return is_number(q) ? (double)q->numbers[0] : fallback;
}

static void set_number(const translation *t, const char *name, double value)
{
    param *q = find(t, name);
    if (is_number(q))
        q->numbers[0] = (float)value;
    else if (!q)
        give_float(t->p, name, value);
}

/* "rgb name" with a value where nothing is given. */
static void default_rgb(const translation *t, const char *name, double value)
{
    if (!find(t, name))
        give_triple(t->p, PARAM_RGB, name, value, value, value);
}

static void scale_rgb(const translation *t, const char *name, const double factor[3])
{
    param *q = find(t, name);
    if (is_rgb(q))
        for (int i = 0; i < 3; i++)
            q->numbers[i] = (float)((double)q->numbers[i] * factor[i]);
}

/* Cut to what an albedo may be. */
static void clamp_rgb(const translation *t, const char *name)
{
    param *q = find(t, name);
    for (int i = 0; is_rgb(q) && i < 3; i++)
        q->numbers[i] = CLAMP(q->numbers[i], 0.0f, 1.0f);
}

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
    bool remaps = !remap || remap->n != 1 || remap->integers[0], textured = false;
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
    if (is_rgb(kd))
        params_add_numbers(t->p, kd->place, PARAM_RGB, "transmittance", kd->numbers, 3,
                           NULL);
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

/* v3's amount is the first material's, v4's the second's. */
static void to_mix(const translation *t)
{
    const param *a = find(t, "namedmaterial1"), *b = find(t, "namedmaterial2");
    param *amount = find(t, "amount");
    if (a && b && a->type == PARAM_STRING && b->type == PARAM_STRING && a->n == 1 &&
        b->n == 1) {
        const char *both[] = {a->strings[0], b->strings[0]};
        params_add_strings(t->p, a->place, PARAM_STRING, "materials", both, 2, NULL);
        drop(t, "namedmaterial1");
        drop(t, "namedmaterial2");
    }
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
};

static void translate_material(const translation *t)
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

static void translate_texture(const translation *t)
{
    const param *gamma = find(t, "gamma"), *trilinear = find(t, "trilinear");
    if (strcmp(*t->kind, "scale") == 0)
        translate_scale(t);
    drop(t, "aamode");
    if (strcmp(*t->kind, "imagemap") != 0)
        return;
    if (gamma && gamma->type == PARAM_BOOL && gamma->n == 1)
        give_text(t->p, PARAM_STRING, "encoding", gamma->integers[0] ? "sRGB" : "linear");
    if (trilinear && trilinear->type == PARAM_BOOL && trilinear->n == 1 &&
        trilinear->integers[0])
        give_text(t->p, PARAM_STRING, "filter", "trilinear");
    drop(t, "gamma");
    drop(t, "trilinear");
    drop(t, "maxanisotropy");
}

/* ---- Lights ---- */

/* v4 makes the spectrum's luminance 1; v3 leaves it as it is. */
static double lost_scale(const translation *t, const char *name)
{
    param *q = find(t, name);
    double scale = 1.0;
    if (q && q->type == PARAM_BLACKBODY && q->n == 2) {
        scale = (double)q->numbers[1];
        q->n = 1;
    }
    g_autoptr(curve) c = NULL;
    if (q && q->type != PARAM_RGB && params_curve(t->p, name, CURVE_EMISSION, &c, NULL) &&
        c)
        scale *= (double)curve_photometric(c) / CIE_Y_INTEGRAL;
    return scale;
}

static void translate_emission(const translation *t, const char *name)
{
    double scale = lost_scale(t, name);
    const param *by = find(t, "scale");
    if (is_rgb(by)) {
        double factor[3];
        for (int i = 0; i < 3; i++)
            factor[i] = (double)by->numbers[i];
        if (is_rgb(find(t, name))) {
            scale_rgb(t, name, factor);
        } else {
            scale *= (factor[0] + factor[1] + factor[2]) / 3.0;
            if (!find(t, name) && !find(t, "filename"))
                give_triple(t->p, PARAM_RGB, name, 1.0, 1.0, 1.0);
        }
        drop(t, "scale");
    } else if (is_number(by)) {
        scale *= (double)by->numbers[0];
    }
    if (fabs(scale - 1.0) > 1e-9)
        set_number(t, "scale", scale);
    drop(t, "nsamples");
    drop(t, "samples");
}

static void translate_light(const translation *t)
{
    bool parallel = strcmp(*t->kind, "distant") == 0 || strcmp(*t->kind, "infinite") == 0;
    if (strcmp(*t->kind, "exinfinite") == 0)
        set_kind(t, "infinite");
    rename_to(t, "mapname", "filename");
    if (find(t, "filename")) /* it shows the picture's own colours */
        drop_noted(t, "L", "'L' beside a picture is left out");
    translate_emission(t, parallel ? "L" : "I");
}

static void translate_area_light(const translation *t)
{
    if (strcmp(*t->kind, "area") == 0)
        set_kind(t, "diffuse");
    translate_emission(t, "L");
}

/* ---- Shapes ---- */

static void translate_shape(const translation *t)
{
    param *uv = find(t, "uv");
    if (!uv)
        uv = find(t, "st");
    if (uv && (uv->type == PARAM_FLOAT || uv->type == PARAM_POINT2)) {
        uv->name = g_intern_string("uv");
        uv->type = PARAM_POINT2;
    }
    if (strcmp(*t->kind, "loopsubdiv") == 0)
        rename_to(t, "nlevels", "levels");
    drop(t, "discarddegenerateUVs");
    drop_noted(t, "shadowalpha",
               "'shadowalpha' is left out: shadows are cut out by 'alpha'");
}

/* ---- What stands before the world ---- */

static void translate_film(const translation *t)
{
    double scale = number(t, "scale", 1.0);
    if (strcmp(*t->kind, "image") == 0)
        set_kind(t, "rgb");
    if (!find(t, "xresolution"))
        give_integer(t->p, "xresolution", 640);
    if (!find(t, "yresolution"))
        give_integer(t->p, "yresolution", 480);
    drop(t, "scale");
    drop(t, "maxsampleluminance");
    drop(t, "diagonal");
    if (fabs(scale - 1.0) > 1e-9)
        give_float(t->p, "iso", 100.0 * scale);
}

static void translate_filter(const translation *t)
{
    rename_to(t, "xwidth", "xradius");
    rename_to(t, "ywidth", "yradius");
    if (strcmp(*t->kind, "gaussian") == 0) {
        double alpha = number(t, "alpha", 2.0);
        drop(t, "alpha");
        give_float(t->p, "sigma", 1.0 / sqrt(2.0 * fmax(alpha, 1e-6)));
        if (!find(t, "xradius"))
            give_float(t->p, "xradius", 2.0);
        if (!find(t, "yradius"))
            give_float(t->p, "yradius", 2.0);
    }
}

static void translate_sampler(const translation *t)
{
    static const char *const names[][2] = {{"lowdiscrepancy", "paddedsobol"},
                                           {"02sequence", "paddedsobol"},
                                           {"maxmindist", "pmj02bn"},
                                           {"random", "independent"}};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (strcmp(*t->kind, names[i][0]) == 0)
            set_kind(t, names[i][1]);
    drop(t, "dimensions");
    drop(t, "samplepixelcenter");
}

static void translate_integrator(const translation *t)
{
    static const char *const dropped[] = {
        "rrthreshold", "lightsamplestrategy", "imagewritefrequency", "pixelbounds",
        "strategy",    "visualizestrategies", "visualizeweights",    "cossample",
        "nsamples"};
    for (size_t i = 0; i < G_N_ELEMENTS(dropped); i++)
        drop(t, dropped[i]);
    if (strcmp(*t->kind, "sppm") == 0) {
        param *passes = find(t, "numiterations");
        if (!passes)
            passes = find(t, "iterations");
        if (passes)
            passes->name = g_intern_string("iterations");
        return;
    }
    if (strcmp(*t->kind, "directlighting") == 0 || strcmp(*t->kind, "whitted") == 0 ||
        strcmp(*t->kind, "ambientocclusion") == 0) {
        note(t, NULL, "this integrator becomes path, which finds indirect light too");
        set_kind(t, "path");
    }
}

static void translate_camera(const translation *t)
{
    if (strcmp(*t->kind, "environment") == 0) {
        set_kind(t, "spherical");
        give_text(t->p, PARAM_STRING, "mapping", "equirectangular");
    }
}

void pbrt_v3_translate(pbrt_v3_target target, char **kind, params *p, const log_sink *log)
{
    static void (*const translators[N_V3_TARGETS])(const translation *t) = {
        [V3_MATERIAL] = translate_material,     [V3_TEXTURE] = translate_texture,
        [V3_LIGHT] = translate_light,           [V3_AREA_LIGHT] = translate_area_light,
        [V3_SHAPE] = translate_shape,           [V3_FILM] = translate_film,
        [V3_FILTER] = translate_filter,         [V3_SAMPLER] = translate_sampler,
        [V3_INTEGRATOR] = translate_integrator, [V3_CAMERA] = translate_camera,
    };
    translators[target](&(translation){kind, p, log});
}
