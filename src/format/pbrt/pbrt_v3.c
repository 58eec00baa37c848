/*
 * From pbrt-v3 to pbrt-v4, directive by directive, as far as the two mean the same; the
 * formulas are those of Pharr, Jakob & Humphreys, "Physically Based Rendering", third
 * edition, and of pbrt-v4's own upgrade.
 *
 * Colours of lights need care: v3 takes spectra as they are, v4 divides them by their
 * luminance, which is undone in "scale".
 */
#include "format/pbrt/pbrt_v3_words.h"

#include "base/intern.h"
#include "format/pbrt/pbrt_parser.h"
#include "medium/medium_presets.h"

#include <math.h>
#include <string.h>

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
    "\"string type\" \"disney\"",
    "\"string type\" [ \"matte\"",
    "\"string type\" [ \"plastic\"",
    "\"string type\" [ \"uber\"",
    "\"string type\" [ \"substrate\"",
    "\"string type\" \"heterogeneous\"",
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

/* Material is no word of NamedMaterial. */
static bool begins_word(const char *text, const char *at)
{
    return at == text || !g_ascii_isalnum(at[-1]);
}

static bool find_word(const char *text, size_t size, const char *word)
{
    size_t length = strlen(word);
    const char *end = text + size;
    for (const char *at = text; (size_t)(end - at) >= length; at++) {
        at = memchr(at, word[0], (size_t)(end - at) - length + 1);
        if (!at)
            return false;
        if (memcmp(at, word, length) == 0 && begins_word(text, at) &&
            !in_comment(text, at))
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
    double scale = lost_scale(t, name), luminance;
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
    } else if (by && pbrt_v3_luminance(t, by, &luminance)) {
        note(t, by, "a light is multiplied by the luminance of its scale");
        scale *= luminance;
        drop(t, "scale");
    }
    if (fabs(scale - 1.0) > 1e-9)
        set_number(t, "scale", scale);
    drop(t, "nsamples");
    drop(t, "samples");
}

/* v3 multiplies a picture by a colour, v4 by a number. */
static double take_tint(const translation *t, const char *name)
{
    const param *q = find(t, name);
    if (!is_rgb(q)) {
        drop_noted(t, name, "a spectrum beside a picture is left out");
        return 1.0;
    }
    const float *c = q->numbers;
    double mean = ((double)c[0] + (double)c[1] + (double)c[2]) / 3.0;
    if (fabsf(c[0] - c[1]) > 0.0f || fabsf(c[1] - c[2]) > 0.0f)
        note(t, q, "a picture is multiplied by the mean of the colour beside it");
    drop(t, name);
    return mean;
}

/* No name is no picture. */
static void drop_empty(const translation *t, const char *name)
{
    const param *q = find(t, name);
    if (q && q->type == PARAM_STRING && q->n == 1 && !*q->strings[0])
        drop(t, name);
}

static void translate_light(const translation *t)
{
    bool parallel = strcmp(*t->kind, "distant") == 0 || strcmp(*t->kind, "infinite") == 0;
    if (strcmp(*t->kind, "exinfinite") == 0)
        set_kind(t, "infinite");
    rename_to(t, "mapname", "filename");
    drop_empty(t, "filename");
    const char *name = parallel ? "L" : "I";
    bool has_own = strcmp(*t->kind, "goniometric") == 0;
    bool is_tinted = find(t, "filename") && !has_own && find(t, name);
    double tint = is_tinted ? take_tint(t, name) : 1.0;
    translate_emission(t, name);
    if (is_tinted)
        set_number(t, "scale", number(t, "scale", 1.0) * tint);
}

static void translate_area_light(const translation *t)
{
    if (strcmp(*t->kind, "area") == 0)
        set_kind(t, "diffuse");
    translate_emission(t, "L");
}

/* ---- Media ---- */

static void default_measured(const translation *t, const char *name, const float mean[3])
{
    if (!find(t, name))
        give_triple(t->p, PARAM_RGB, name, (double)mean[0], (double)mean[1],
                    (double)mean[2]);
}

/* v3 takes milk where the file says nothing, and what it says goes before the preset. */
static void translate_medium(const translation *t)
{
    const param *named = find(t, "preset");
    bool is_text = named && named->type == PARAM_STRING && named->n == 1;
    if (strcmp(*t->kind, "homogeneous") != 0 || (named && !is_text))
        return;
    bool is_none = !named || !*named->strings[0];
    const medium_preset *from =
        medium_preset_find(is_none ? "Wholemilk" : named->strings[0]);
    if (!from)
        return;
    default_measured(t, "sigma_a", from->absorption);
    default_measured(t, "sigma_s", from->scattering);
    drop(t, "preset");
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
    const param *crop = find(t, "cropwindow");
    if (crop && crop->n != 4)
        drop_noted(t, "cropwindow", "'cropwindow' is left out: it has not four numbers");
    double most = number(t, "maxsampleluminance", 0.0);
    drop(t, "scale");
    drop_noted(t, "maxsampleluminance",
               "'maxsampleluminance' bounds each component, not the luminance");
    if (most > 0.0 && most * scale > 0.0 && !isinf(most))
        give_float(t->p, "maxcomponentvalue", most * scale);
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

/* Whatever it is called, it finds the same light. */
static void replace_unknown(const translation *t, const char *what, kind_at known,
                            const char *instead)
{
    const char *name;
    for (size_t i = 0; (name = known(i).name); i++)
        if (strcmp(*t->kind, name) == 0)
            return;
    log_at(t->log, LOG_WARNING, t->p->place,
           "%s \"%s\" is unknown: \"%s\" is taken for it", what, *t->kind, instead);
    set_kind(t, instead);
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
    replace_unknown(t, "sampler", pbrt_sampler_kind, "halton");
    drop(t, "dimensions");
    drop(t, "samplepixelcenter");
}

static void translate_integrator(const translation *t)
{
    static const char *const dropped[] = {"rrthreshold",         "lightsamplestrategy",
                                          "imagewritefrequency", "strategy",
                                          "cossample",           "nsamples"};
    static const char *const lost[] = {"pixelbounds", "visualizestrategies",
                                       "visualizeweights"};
    for (size_t i = 0; i < G_N_ELEMENTS(dropped); i++)
        drop(t, dropped[i]);
    for (size_t i = 0; i < G_N_ELEMENTS(lost); i++) {
        g_autofree char *text =
            g_strdup_printf("'%s' is left out: the whole picture is rendered", lost[i]);
        drop_noted(t, lost[i], text);
    }
    if (strcmp(*t->kind, "sppm") == 0) {
        param *passes = find(t, "numiterations");
        if (!passes)
            passes = find(t, "iterations");
        if (passes)
            passes->name = intern("iterations");
        return;
    }
    if (strcmp(*t->kind, "directlighting") == 0 || strcmp(*t->kind, "whitted") == 0 ||
        strcmp(*t->kind, "ambientocclusion") == 0) {
        note(t, NULL, "this integrator becomes path, which finds indirect light too");
        set_kind(t, "path");
    }
    replace_unknown(t, "integrator", pbrt_integrator_kind, "path");
}

static void translate_camera(const translation *t)
{
    if (strcmp(*t->kind, "environment") == 0) {
        set_kind(t, "spherical");
        give_text(t->p, PARAM_STRING, "mapping", "equirectangular");
    }
}

static bool is_color(const param *q)
{
    return q->type == PARAM_RGB || q->type == PARAM_BLACKBODY ||
           q->type == PARAM_SPECTRUM || q->type == PARAM_SPECTRUM_NAME ||
           q->type == PARAM_TEXTURE;
}

/* In pbrt-v3 the type belongs to the name: a colour given as a number is none. */
static void drop_numbers(const translation *t)
{
    static const char *const colors[] = {
        "Kd",    "Ks", "Kr", "Kt", "reflect", "transmit", "opacity",
        "color", "k",  "L",  "I",  "sigma_a", "sigma_s",  NULL};
    bool is_metal = strcmp(*t->kind, "metal") == 0;
    for (guint i = t->p->list->len; i-- > 0;) {
        const param *q = t->p->list->pdata[i];
        bool wants =
            g_strv_contains(colors, q->name) || (is_metal && strcmp(q->name, "eta") == 0);
        if (wants && !is_color(q)) {
            g_autofree char *text =
                g_strdup_printf("'%s' is left out: it is no colour", q->name);
            note(t, q, text);
            g_ptr_array_remove_index(t->p->list, i);
        }
    }
}

bool pbrt_v3_translate(pbrt_v3_target target, char **kind, params *p, const log_sink *log,
                       GError **error)
{
    static void (*const translators[N_V3_TARGETS])(const translation *t) = {
        [V3_MATERIAL] = pbrt_v3_material,
        [V3_TEXTURE] = pbrt_v3_texture,
        [V3_MEDIUM] = translate_medium,
        [V3_LIGHT] = translate_light,
        [V3_AREA_LIGHT] = translate_area_light,
        [V3_SHAPE] = pbrt_v3_shape,
        [V3_FILM] = translate_film,
        [V3_FILTER] = translate_filter,
        [V3_SAMPLER] = translate_sampler,
        [V3_INTEGRATOR] = translate_integrator,
        [V3_CAMERA] = translate_camera,
    };
    GError *refused = NULL;
    const translation t = {kind, p, log, &refused};
    if (target == V3_MATERIAL || target == V3_LIGHT || target == V3_AREA_LIGHT ||
        target == V3_MEDIUM)
        drop_numbers(&t);
    if (target == V3_MATERIAL || target == V3_TEXTURE || target == V3_MEDIUM)
        pbrt_v3_heat(&t);
    translators[target](&t);
    if (refused)
        error_move_at(error, p->place, refused);
    return !refused;
}
