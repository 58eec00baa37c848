/*
 * Parameters that are functions of wavelength: rgb, blackbody, spectrum, and, where pbrt
 * allows it (an index of refraction), a plain number.
 */
#include "params/params.h"

static bool exactly(const param *q, size_t n, const char *what, GError **error)
{
    if (q->n == n)
        return true;
    error_at(error, q->place, "parameter '%s': expected %s, found %zu numbers", q->name,
             what, q->n);
    return false;
}

static curve *from_pairs(const param *q, GError **error)
{
    if (q->n < 2 || q->n % 2) {
        error_at(error, q->place,
                 "parameter '%s': expected pairs of wavelength and value, found %zu "
                 "numbers",
                 q->name, q->n);
        return NULL;
    }
    size_t n = q->n / 2;
    if (n > CURVE_MOST_POINTS) {
        error_at(error, q->place, "parameter '%s': expected at most %d pairs, found %zu",
                 q->name, CURVE_MOST_POINTS, n);
        return NULL;
    }
    g_autofree float *nm = g_new(float, n);
    g_autofree float *values = g_new(float, n);
    for (size_t i = 0; i < n; i++) {
        nm[i] = q->numbers[2 * i];
        values[i] = q->numbers[2 * i + 1];
    }
    return curve_tabulated(nm, values, (int)n, error);
}

static curve *from_kelvin(const param *q, GError **error)
{
    if (!exactly(q, 1, "one temperature in kelvin", error))
        return NULL;
    if (!(q->numbers[0] > 0.0f) || !isfinite(q->numbers[0])) {
        error_at(error, q->place,
                 "parameter '%s': expected a temperature > 0 K, found %g", q->name,
                 (double)q->numbers[0]);
        return NULL;
    }
    return curve_blackbody(q->numbers[0]);
}

static curve *from_name(const param *q, GError **error)
{
    if (q->n != 1) {
        error_at(error, q->place, "parameter '%s': expected one spectrum, found %zu",
                 q->name, q->n);
        return NULL;
    }
    curve *c = curve_named(q->strings[0]);
    if (!c)
        error_at(error, q->place,
                 "parameter '%s': expected a spectrum's name or file, found '%s'",
                 q->name, q->strings[0]);
    return c;
}

static curve *from_number(const param *q, GError **error)
{
    if (!exactly(q, 1, "one number", error))
        return NULL;
    if (!isfinite(q->numbers[0]) || q->numbers[0] < 0.0f) {
        error_at(error, q->place, "parameter '%s': expected a number >= 0, found %g",
                 q->name, (double)q->numbers[0]);
        return NULL;
    }
    return curve_constant(q->numbers[0]);
}

static curve *make(const params *p, const param *q, curve_role role, GError **error)
{
    switch (q->type) {
    case PARAM_RGB:
        return exactly(q, 3, "three numbers", error)
                   ? curve_rgb(p->space, q->numbers, role, error)
                   : NULL;
    case PARAM_BLACKBODY:
        return from_kelvin(q, error);
    case PARAM_SPECTRUM:
        return from_pairs(q, error);
    case PARAM_SPECTRUM_NAME:
        return from_name(q, error);
    default:
        if (q->type == PARAM_FLOAT && role == CURVE_UNBOUNDED)
            return from_number(q, error);
        error_at(
            error, q->place,
            "parameter '%s': expected rgb, blackbody or spectrum, found another type",
            q->name);
        return NULL;
    }
}

/* Errors of the curves know no place; those made here begin with it already. */
static void locate(GError *inner, const param *q, GError **error)
{
    g_autofree char *file = g_strdup_printf("%s:", q->place.file ? q->place.file : "");
    if (q->place.file && g_str_has_prefix(inner->message, file)) {
        g_propagate_error(error, inner);
        return;
    }
    error_at(error, q->place, "%s", inner->message);
    g_error_free(inner);
}

bool params_curve(const params *p, const char *name, curve_role role, curve **out,
                  GError **error)
{
    const param *q = params_find(p, name);
    if (!q)
        return true;
    GError *inner = NULL;
    curve *c = make(p, q, role, &inner);
    if (!c) {
        locate(inner, q, error);
        return false;
    }
    *out = c;
    return true;
}
