/*
 * Reading media: the parameters of what fills a solid, and pbrt's kinds of participating
 * media.
 */
#include "medium/medium.h"

#include "medium/medium_presets.h"

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
} kinds[] = {{"homogeneous", "sigma_a sigma_s scale g preset Le Lescale"}};

const char *medium_kind_name(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].name : NULL;
}

const char *medium_kind_parameters(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].parameters : NULL;
}

/* What was measured, if the file names it; then nothing else may say the same. */
static bool read_preset(const params *p, const medium_preset **out, GError **error)
{
    static const char *const same[] = {"sigma_a", "sigma_s"};
    const char *name = "";
    *out = NULL;
    if (!params_string(p, "preset", &name, error))
        return false;
    if (!*name)
        return true;
    *out = medium_preset_find(name);
    if (!*out) {
        error_at(error, params_find(p, "preset")->place,
                 "parameter 'preset': expected the name of a medium that the manual "
                 "lists under \"Participating media\", found \"%s\"",
                 name);
        return false;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(same); i++) {
        const param *q = params_find(p, same[i]);
        if (!q || q->is_default)
            continue;
        error_at(error, q->place,
                 "parameter '%s': expected no 'preset' beside it, "
                 "found \"%s\"",
                 same[i], name);
        return false;
    }
    return true;
}

/* 1 per metre where the file says nothing, as pbrt has it. */
static bool read_coefficient(const params *p, const char *name, const float *measured,
                             curve **out, GError **error)
{
    if (measured) {
        *out = curve_rgb(color_space_srgb(), measured, CURVE_UNBOUNDED, error);
        return *out != NULL;
    }
    if (!params_curve(p, name, CURVE_UNBOUNDED, out, error) ||
        !check_range(p, name, *out, INFINITY, error))
        return false;
    if (!*out)
        *out = curve_constant(1.0f);
    return true;
}

static float largest(const curve *c, float scale)
{
    float most = 0.0f;
    for (float nm = LAMBDA_MIN; c && nm <= LAMBDA_MAX; nm += 5.0f)
        most = fmaxf(most, scale * curve_at(c, nm));
    return most;
}

static bool wrong_number(const params *p, const char *name, const char *what, float found,
                         GError **error)
{
    error_at(error, params_find(p, name)->place, "parameter '%s': expected %s, found %g",
             name, what, (double)found);
    return false;
}

static bool read_scale_and_g(medium *m, const params *p, GError **error)
{
    if (!params_float(p, "scale", &m->scale, error) ||
        !params_float(p, "g", &m->g, error))
        return false;
    if (!(m->scale >= 0.0f))
        return wrong_number(p, "scale", "a number >= 0", m->scale, error);
    if (!isfinite(largest(m->absorption, m->scale) + largest(m->scattering, m->scale)))
        return wrong_number(p, "scale", "a number that leaves the medium's finite",
                            m->scale, error);
    if (!(fabsf(m->g) < 1.0f))
        return wrong_number(p, "g", "a number between -1 and 1", m->g, error);
    return true;
}

/* Le and Lescale are accepted where they mean darkness. */
static bool check_dark(const params *p, GError **error)
{
    g_autoptr(curve) glow = NULL;
    float scale = 1.0f;
    if (!params_curve(p, "Le", CURVE_EMISSION, &glow, error) ||
        !params_float(p, "Lescale", &scale, error))
        return false;
    if (!(largest(glow, fabsf(scale)) > 0.0f))
        return true;
    error_at(error, params_find(p, "Le")->place,
             "parameter 'Le': expected 0, since media that glow are not supported, found "
             "more");
    return false;
}

static bool read_homogeneous(medium *m, const params *p, GError **error)
{
    const medium_preset *of;
    if (!read_preset(p, &of, error) ||
        !read_coefficient(p, "sigma_a", of ? of->absorption : NULL, &m->absorption,
                          error) ||
        !read_coefficient(p, "sigma_s", of ? of->scattering : NULL, &m->scattering,
                          error) ||
        !read_scale_and_g(m, p, error) || !check_dark(p, error))
        return false;
    if (!(largest(m->absorption, m->scale) > 0.0f))
        g_clear_pointer(&m->absorption, curve_unref);
    if (!(largest(m->scattering, m->scale) > 0.0f))
        g_clear_pointer(&m->scattering, curve_unref);
    return true;
}

medium *medium_new(const char *name, const char *kind, const params *p, GError **error)
{
    g_autofree char *what = g_strdup_printf("medium \"%s\"", kind);
    if (strcmp(kind, kinds[0].name) != 0) {
        error_at(error, p->place, "expected a medium \"homogeneous\", found \"%s\"",
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
