/*
 * Reading media and Beer-Lambert's law.
 */
#include "scene/medium.h"

#include <math.h>

void medium_free(medium *m)
{
    if (!m)
        return;
    curve_unref(m->color);
    curve_unref(m->absorption);
    g_free(m);
}

static bool check_distance(const medium *m, const params *p, GError **error)
{
    bool given = params_has(p, "attenuationdistance");
    if (m->color ? given && m->distance > 0.0f : !given)
        return true;
    const param *q = params_find(p, given ? "attenuationdistance" : "attenuationcolor");
    if (!m->color)
        error_at(error, q->place, "'attenuationdistance' needs an 'attenuationcolor'");
    else if (!given)
        error_at(error, q->place, "'attenuationcolor' needs an 'attenuationdistance'");
    else
        error_at(error, q->place,
                 "parameter 'attenuationdistance': expected a length > 0, found %g",
                 (double)m->distance);
    return false;
}

static bool check_range(const params *p, const char *name, const curve *c, float most,
                        GError **error)
{
    for (float nm = LAMBDA_MIN; c && nm <= LAMBDA_MAX; nm += 5.0f) {
        float value = curve_at(c, nm);
        if (value >= 0.0f && value <= most)
            continue;
        error_at(error, params_find(p, name)->place,
                 "parameter '%s': expected %s, found %g at %g nm", name,
                 most <= 1.0f ? "numbers in 0..1" : "numbers >= 0", (double)value,
                 (double)nm);
        return false;
    }
    return true;
}

bool medium_read(const params *p, medium **out, GError **error)
{
    medium *m = g_new0(medium, 1);
    bool fine = params_curve(p, "attenuationcolor", CURVE_ALBEDO, &m->color, error) &&
                params_float(p, "attenuationdistance", &m->distance, error) &&
                check_distance(m, p, error) &&
                check_range(p, "attenuationcolor", m->color, 1.0f, error) &&
                params_curve(p, "absorption", CURVE_UNBOUNDED, &m->absorption, error) &&
                check_range(p, "absorption", m->absorption, INFINITY, error);
    *out = NULL;
    if (fine && (m->color || m->absorption))
        *out = g_steal_pointer(&m);
    medium_free(m);
    return fine;
}

spectrum medium_transmittance(const medium *m, float t, const wavelengths *w)
{
    spectrum out = spectrum_fill(1.0f);
    if (m->absorption)
        out = spectrum_exp(curve_eval(m->absorption, w) * -t);
    if (m->color) {
        spectrum color = curve_eval(m->color, w);
        for (int i = 0; i < N_LANES; i++)
            out[i] *= powf(color[i], t / m->distance);
    }
    return out;
}
