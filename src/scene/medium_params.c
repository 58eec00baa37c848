/*
 * Reading media: the parameters of what fills a solid, and pbrt's kinds of participating
 * media.
 */
#include "scene/medium.h"

#include <math.h>
#include <string.h>

void medium_free(medium *m)
{
    if (!m)
        return;
    g_free(m->name);
    curve_unref(m->color);
    curve_unref(m->absorption);
    curve_unref(m->scattering);
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
    m->scale = 1.0f;
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

/* ---- Participating media ---- */

static const struct {
    const char *name, *parameters;
} kinds[] = {{"homogeneous", "sigma_a sigma_s scale g"}};

const char *medium_kind_name(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].name : NULL;
}

const char *medium_kind_parameters(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].parameters : NULL;
}

/* 1 per metre where the file does not say, as pbrt has it. */
static bool read_coefficient(const params *p, const char *name, curve **out,
                             GError **error)
{
    if (!params_curve(p, name, CURVE_UNBOUNDED, out, error) ||
        !check_range(p, name, *out, INFINITY, error))
        return false;
    if (!*out)
        *out = curve_constant(1.0f);
    return true;
}

static bool is_zero(const curve *c, float scale)
{
    for (float nm = LAMBDA_MIN; nm <= LAMBDA_MAX; nm += 5.0f)
        if (scale * curve_at(c, nm) > 0.0f)
            return false;
    return true;
}

static bool read_homogeneous(medium *m, const params *p, GError **error)
{
    if (!read_coefficient(p, "sigma_a", &m->absorption, error) ||
        !read_coefficient(p, "sigma_s", &m->scattering, error) ||
        !params_float(p, "scale", &m->scale, error) ||
        !params_float(p, "g", &m->g, error))
        return false;
    if (!(m->scale >= 0.0f)) {
        error_at(error, params_find(p, "scale")->place,
                 "parameter 'scale': expected a number >= 0, found %g", (double)m->scale);
        return false;
    }
    if (!(fabsf(m->g) < 1.0f)) {
        error_at(error, params_find(p, "g")->place,
                 "parameter 'g': expected a number between -1 and 1, found %g",
                 (double)m->g);
        return false;
    }
    if (is_zero(m->absorption, m->scale))
        g_clear_pointer(&m->absorption, curve_unref);
    if (is_zero(m->scattering, m->scale))
        g_clear_pointer(&m->scattering, curve_unref);
    return true;
}

medium *medium_new(const char *name, const char *kind, const params *p, GError **error)
{
    g_autofree char *what = g_strdup_printf("medium '%s'", kind);
    if (strcmp(kind, kinds[0].name) != 0) {
        error_at(error, p->place, "medium \"%s\" is not supported; known is homogeneous",
                 kind);
        return NULL;
    }
    if (!params_known(p, what, kinds[0].parameters, NULL, error))
        return NULL;
    medium *m = g_new0(medium, 1);
    *m = (medium){.name = g_strdup(name), .scale = 1.0f};
    if (!read_homogeneous(m, p, error) || !params_all_used(p, what, error)) {
        medium_free(m);
        return NULL;
    }
    return m;
}
