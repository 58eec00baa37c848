/*
 * Values as pbrt-v3 reads them: numbers by their beginning, as C does, and colours in
 * ways that pbrt-v4 gave up.
 */
#include "format/pbrt/pbrt_parser.h"

#include "format/number.h"
#include "format/pbrt/pbrt_v3_words.h"

/* ---- Words ---- */

bool pbrt_v3_number(pbrt_parser *parser, const token *t, double *out)
{
    enum { LONGEST = 64 };
    if (!parser->is_v3 || t->kind != TOKEN_WORD)
        return false;
    for (size_t n = MIN(t->length, (size_t)LONGEST); n-- > 1;)
        if (number_double(t->text, n, out)) {
            if (!parser->has_cut_numbers)
                pbrt_warning(parser, t->place,
                             "'%.*s' is taken as %g, and others as this one",
                             (int)MIN(t->length, (size_t)LONGEST), t->text, *out);
            parser->has_cut_numbers = true;
            return true;
        }
    return false;
}

/* ---- Of a shape's material ---- */

static bool is_of_material(const param *q)
{
    static const char *const names[] = {"Kd",
                                        "Ks",
                                        "Kr",
                                        "Kt",
                                        "reflect",
                                        "transmit",
                                        "opacity",
                                        "color",
                                        "eta",
                                        "k",
                                        "index",
                                        "sigma",
                                        "roughness",
                                        "uroughness",
                                        "vroughness",
                                        "amount",
                                        "bumpmap",
                                        "metallic",
                                        "sheen",
                                        "sheentint",
                                        "clearcoat",
                                        "anisotropic",
                                        "spectrans",
                                        "thin",
                                        "clearcoatgloss",
                                        "difftrans",
                                        "flatness",
                                        "speculartint",
                                        "remaproughness",
                                        NULL};
    return g_strv_contains(names, q->name);
}

params *pbrt_v3_material_of_shape(const pbrt_parser *parser, params *p)
{
    const params *given = parser->state.v3_given;
    params *out = NULL;
    for (guint i = 0; i < p->list->len;) {
        const param *q = p->list->pdata[i];
        if (!is_of_material(q)) {
            i++;
            continue;
        }
        out = out ? out : params_new_like(given ? given : p);
        params_add_copy(out, q, NULL);
        g_ptr_array_remove_index(p->list, i);
    }
    for (guint i = 0; out && given && i < given->list->len; i++) {
        const param *q = given->list->pdata[i];
        if (!params_find(out, q->name))
            params_add_copy(out, q, NULL);
    }
    return out;
}

/* ---- Colours ---- */

bool pbrt_v3_luminance(const translation *t, const param *q, double *out)
{
    g_autoptr(curve) c = NULL;
    if (q->type != PARAM_SPECTRUM && q->type != PARAM_SPECTRUM_NAME)
        return false;
    params_curve(t->p, q->name, CURVE_UNBOUNDED, &c, NULL);
    *out = c ? (double)curve_photometric(c) / CIE_Y_INTEGRAL : 0.0;
    return c != NULL;
}

/* The spectrum, 1 where it is brightest, times the number behind the temperature. */
static void heat(const translation *t, const char *name)
{
    enum { FROM = 360, TO = 830, STEP = 10, N = (TO - FROM) / STEP + 1 };
    float pairs[2 * N];
    const param *q = find(t, name);
    source_place place = q->place;
    float scale = q->numbers[1];
    g_autoptr(curve) c = curve_blackbody(q->numbers[0]);
    for (int i = 0; i < N; i++) {
        pairs[2 * i] = (float)(FROM + i * STEP);
        pairs[2 * i + 1] = scale * curve_at(c, pairs[2 * i]);
    }
    drop(t, name);
    params_add_numbers(t->p, place, PARAM_SPECTRUM, name, pairs, (size_t)2 * N, NULL);
}

void pbrt_v3_heat(const translation *t)
{
    for (guint i = t->p->list->len; i-- > 0;) {
        const param *q = t->p->list->pdata[i];
        if (q->type == PARAM_BLACKBODY && q->n == 2 && q->numbers[0] > 0.0f)
            heat(t, q->name);
    }
}
