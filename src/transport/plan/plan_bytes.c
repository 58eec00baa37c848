#include "transport/plan/plan_bytes.h"

#include "base/bytes.h"

#include <math.h>

/* Fields that are plain numbers. */
#define NUMBERS(PLAIN)                                                                   \
    PLAIN(work)                                                                          \
    PLAIN(planning)                                                                      \
    PLAIN(n_photons)                                                                     \
    PLAIN(radius)                                                                        \
    PLAIN(radius_in_media)                                                               \
    PLAIN(n_vertex_paths)                                                                \
    PLAIN(p_spots)                                                                       \
    PLAIN(sample_rays)                                                                   \
    PLAIN(photon_rays)                                                                   \
    PLAIN(p_blurred)                                                                     \
    PLAIN(p_blurred_in_media)

/* ---- Writing ---- */

static void put_settings(const settings *how, GByteArray *to)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    GString *text = g_string_new(NULL);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(how, &rows[i]);
        g_string_append_printf(text, "%s=%s\n", rows[i].name, value);
    }
    bytes_put_count(to, text->len);
    bytes_put(to, text->str, text->len, 1);
    g_string_free(text, TRUE);
}

static void put_trials(const transport_plan *plan, GByteArray *to)
{
    bytes_put_count(to, (size_t)plan->n_trials);
    for (int i = 0; i < plan->n_trials; i++) {
        const plan_trial *t = &plan->trials[i];
        size_t length = strlen(t->what);
        bytes_put_count(to, length);
        bytes_put(to, t->what, length, 1);
        bytes_put(to, &t->without, 1, sizeof t->without);
        bytes_put(to, &t->with, 1, sizeof t->with);
        bytes_put_bool(to, t->taken);
    }
}

static void put_cache(const radius_cache *cache, GByteArray *to)
{
    size_t n = cache ? radius_cache_count(cache) : 0;
    bytes_put_bool(to, cache != NULL);
    bytes_put_count(to, n);
    for (size_t i = 0; i < n; i++) {
        const vec3 p = radius_cache_place(cache, i);
        const float radius = radius_cache_nth(cache, i);
        bytes_put(to, &p, 1, sizeof p);
        bytes_put(to, &radius, 1, sizeof radius);
    }
}

static void put_lit(const transport_plan *plan, GByteArray *to)
{
    bytes_put_count(to, plan->n_lit);
    bytes_put(to, plan->lit, plan->n_lit, sizeof *plan->lit);
}

static void put_shares(const transport_plan *plan, GByteArray *to)
{
    size_t n = plan->boost ? plan->scene->lights->len : 0;
    bytes_put_bool(to, plan->casters != NULL);
    bytes_put_bool(to, plan->mis.casters != NULL);
    bytes_put(to, &plan->mis.discs, 1, sizeof plan->mis.discs);
    bytes_put_count(to, n);
    bytes_put(to, plan->boost, n, sizeof *plan->boost);
}

void plan_put(const transport_plan *plan, GByteArray *to)
{
#define PUT(field) bytes_put(to, &plan->field, 1, sizeof plan->field);
    NUMBERS(PUT)
#undef PUT
    bytes_put_bool(to, plan->uses_mis);
    bytes_put_bool(to, plan->gathers);
    put_settings(&plan->how, to);
    put_trials(plan, to);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        put_cache(plan->radius_cache[c], to);
        put_cache(plan->radius_cache_in_media[c], to);
    }
    put_cache(plan->vertex_radii, to);
    put_lit(plan, to);
    put_shares(plan, to);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        emission_guide_put(plan->guide[c], to);
}

/* ---- Reading ---- */

static void get_settings(settings *how, bytes_reader *from)
{
    size_t length = bytes_get_count(from, 1);
    g_autofree char *text = g_malloc0(length + 1);
    bytes_get(from, text, length, 1);
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    for (char **line = lines; *line && **line; line++) {
        char *value = strchr(*line, '=');
        if (value)
            *value++ = '\0';
        from->failed |= !value || !settings_set(how, *line, value, NULL);
    }
}

static void get_trials(transport_plan *plan, bytes_reader *from)
{
    size_t n = bytes_get_count(from, 1);
    from->failed |= n > MOST_PLAN_TRIALS;
    plan->n_trials = from->failed ? 0 : (int)n;
    for (int i = 0; i < plan->n_trials; i++) {
        plan_trial *t = &plan->trials[i];
        size_t length = bytes_get_count(from, 1);
        g_autofree char *what = g_malloc0(length + 1);
        bytes_get(from, what, length, 1);
        t->what = g_intern_string(what);
        bytes_get(from, &t->without, 1, sizeof t->without);
        bytes_get(from, &t->with, 1, sizeof t->with);
        t->taken = bytes_get_bool(from);
    }
}

/* @return false: out of memory */
static bool get_cache(radius_cache **cache, bytes_reader *from, GError **error)
{
    bool is_there = bytes_get_bool(from), ok = true;
    size_t n = bytes_get_count(from, sizeof(vec3) + sizeof(float));
    vec3 *places = g_aligned_alloc0(MAX(n, 1), sizeof *places, 16);
    g_autofree float *radii = g_new0(float, MAX(n, 1));
    for (size_t i = 0; i < n; i++) {
        bytes_get(from, &places[i], 1, sizeof places[i]);
        bytes_get(from, &radii[i], 1, sizeof radii[i]);
        from->failed |= !isfinite(radii[i]);
    }
    if (is_there && !from->failed)
        ok = (*cache = radius_cache_of(places, radii, n, error)) != NULL;
    g_aligned_free(places);
    return ok;
}

static void get_lit(transport_plan *plan, bytes_reader *from)
{
    size_t n = bytes_get_count(from, sizeof *plan->lit);
    if (n == 0)
        return;
    plan->lit = g_new0(lit_place, n);
    bytes_get(from, plan->lit, n, sizeof *plan->lit);
    plan->n_lit = from->failed ? 0 : n;
}

static bool get_shares(transport_plan *plan, bytes_reader *from, GError **error)
{
    bool finds = bytes_get_bool(from), weighs = bytes_get_bool(from);
    bytes_get(from, &plan->mis.discs, 1, sizeof plan->mis.discs);
    size_t n = bytes_get_count(from, sizeof *plan->boost);
    from->failed |= n > 0 && n != plan->scene->lights->len;
    if (n > 0 && !from->failed) {
        plan->boost = g_new0(float, n);
        bytes_get(from, plan->boost, n, sizeof *plan->boost);
    }
    plan->mis.boost = plan->boost;
    if (finds && !transport_plan_find_casters(plan, error))
        return false;
    plan->mis.casters = weighs ? plan->casters : NULL;
    from->failed |= (weighs || plan->uses_mis) && !plan->casters;
    return true;
}

static bool get_all(transport_plan *plan, bytes_reader *from, GError **error)
{
#define GET(field) bytes_get(from, &plan->field, 1, sizeof plan->field);
    NUMBERS(GET)
#undef GET
    plan->uses_mis = bytes_get_bool(from);
    plan->gathers = bytes_get_bool(from);
    get_settings(&plan->how, from);
    get_trials(plan, from);
    bool ok = true;
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        ok = get_cache(&plan->radius_cache[c], from, error) &&
             get_cache(&plan->radius_cache_in_media[c], from, error);
    ok = ok && get_cache(&plan->vertex_radii, from, error);
    if (ok)
        get_lit(plan, from);
    ok = ok && get_shares(plan, from, error);
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        plan->guide[c] = emission_guide_get(from);
    return ok;
}

bool plan_get(transport_plan *plan, const void *data, size_t size, GError **error)
{
    bytes_reader from = {.at = data, .end = (const guint8 *)data + size};
    const settings how = plan->how;
    if (!get_all(plan, &from, error))
        return false;
    plan->how.threads = how.threads;
    plan->how.given = how.given;
    if (!from.failed && from.at == from.end && plan->how.integrator == how.integrator)
        return true;
    error_set(error, ERROR_INPUT, "this is no plan of this render");
    return false;
}
