/*
 * What stands before WorldBegin. pbrt lets film, camera, sampler ... come in any order,
 * so they are kept and given to the scene together.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/intern.h"

#include <string.h>

/** Keeps a directive until WorldBegin; a later one of its kind takes its place. */
static bool keep(pbrt_parser *parser, pending *d, pbrt_v3_target target,
                 source_place place)
{
    source_place at = place;
    char *kind = pbrt_read_string(parser, "a kind", &at);
    params *p = kind ? pbrt_read_params(parser, place) : NULL;
    if (!p) {
        g_free(kind);
        return false;
    }
    if (parser->is_v3)
        pbrt_v3_translate(target, &kind, p, &parser->builder->build.log, NULL);
    g_free(d->kind);
    params_free(d->p);
    *d = (pending){kind, p, at, parser->state.ctm, parser->state.ctm_end};
    return true;
}

bool pbrt_film(pbrt_parser *parser, source_place place)
{
    return keep(parser, &parser->film, V3_FILM, place);
}

bool pbrt_pixel_filter(pbrt_parser *parser, source_place place)
{
    return keep(parser, &parser->filter, V3_FILTER, place);
}

bool pbrt_sampler(pbrt_parser *parser, source_place place)
{
    return keep(parser, &parser->sampler, V3_SAMPLER, place);
}

bool pbrt_integrator(pbrt_parser *parser, source_place place)
{
    return keep(parser, &parser->integrator, V3_INTEGRATOR, place);
}

/** The transform here takes the world to the camera; its inverse is named "camera". */
bool pbrt_camera(pbrt_parser *parser, source_place place)
{
    if (!keep(parser, &parser->camera, V3_CAMERA, place))
        return false;
    parser->camera.ctm = parser->camera.ctm_end = transform_identity();
    if (pbrt_is_flat(parser)) {
        pbrt_error(parser, place,
                   "expected a transform that can be inverted, found one that flattens");
    } else {
        parser->camera.ctm = transform_inverse(&parser->state.ctm);
        parser->camera.ctm_end = transform_inverse(&parser->state.ctm_end);
    }
    parser->around_camera = parser->state.outside;
    pbrt_name_transform(parser, "camera", &parser->camera.ctm, &parser->camera.ctm_end);
    return true;
}

static const directive_kind accelerators[] = {
    {"bvh", "", "maxnodeprims splitmethod", "accepted", "rays are traced by Embree"},
    {"kdtree", "", "emptybonus intersectcost maxdepth maxprims traversalcost", "accepted",
     "rays are traced by Embree"},
};

directive_kind pbrt_accelerator_kind(size_t i)
{
    return i < G_N_ELEMENTS(accelerators) ? accelerators[i] : (directive_kind){0};
}

static const directive_kind *find_kind(const directive_kind *kinds, size_t n,
                                       const char *name)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    return NULL;
}

bool pbrt_accelerator(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a kind", &at);
    g_autoptr(params) p = name ? pbrt_read_params(parser, place) : NULL;
    GError *error = NULL;
    if (!p)
        return false;
    const directive_kind *kind =
        find_kind(accelerators, G_N_ELEMENTS(accelerators), name);
    g_autofree char *what = g_strdup_printf("accelerator '%s'", name);
    if (!kind && parser->is_v3)
        pbrt_warning(parser, at,
                     "accelerator \"%s\" is unknown; rays are traced by Embree", name);
    else if (!kind)
        pbrt_error(parser, at, "expected Accelerator \"bvh\" or \"kdtree\", found \"%s\"",
                   name);
    else if (!params_known(p, what, kind->idle, NULL, &error))
        pbrt_report(parser, error);
    else
        log_at(&parser->builder->build.log, LOG_NOTE, at,
               "Accelerator '%s': rays are traced by Embree, which needs "
               "no parameters",
               name);
    return true;
}

/* An option acts, or is accepted because the image is the same with it and without; those
 * in neither list are refused, or must be off if they say so. */
static const directive_kind options[] = {
    {"seed", "seed", "", NULL, NULL},
    {"displacementedgescale", "", "displacementedgescale", "accepted",
     "displacement bends normals and moves nothing"},
    {"gpu", "", "gpu", "accepted", NULL},
    {"pixelstats", "", "pixelstats", "accepted", NULL},
    {"rendercoordsys", "", "rendercoordsys", "accepted", NULL},
    {"wavefront", "", "wavefront", "accepted", NULL},
    {"disablepixeljitter", "disablepixeljitter", "", NULL,
     "of what the camera sees; `vcm`'s light that finds the camera is filtered as ever"},
    {"disabletexturefiltering", "disabletexturefiltering", "", NULL, NULL},
    {"disablewavelengthjitter", "disablewavelengthjitter", "", NULL, NULL},
    {"forcediffuse", "", "", "refused", "`false` is accepted"},
    {"msereferenceimage", "", "msereferenceimage", "accepted", NULL},
    {"msereferenceout", "", "msereferenceout", "accepted", NULL},
};

directive_kind pbrt_option_kind(size_t i)
{
    return i < G_N_ELEMENTS(options) ? options[i] : (directive_kind){0};
}

static void apply_seed(pbrt_parser *parser, const params *p, const param *q)
{
    GError *error = NULL;
    int seed = 0;
    if (params_integer(p, "seed", &seed, &error)) {
        g_autofree char *text = g_strdup_printf("%d", seed);
        if (settings_set(&parser->builder->scene->settings, "seed", text, &error))
            return;
        pbrt_error(parser, q->place, "%s", error->message);
        g_error_free(error);
    } else {
        pbrt_report(parser, error);
    }
}

/* What a boolean option switches; NULL: it is none of these. */
static bool *switch_of(scene_builder *to, const char *name)
{
    if (strcmp(name, "disablepixeljitter") == 0)
        return &to->scene->switches.fixed_pixels;
    if (strcmp(name, "disabletexturefiltering") == 0)
        return &to->scene->switches.sharp_textures;
    if (strcmp(name, "disablewavelengthjitter") == 0)
        return &to->scene->switches.fixed_wavelengths;
    return NULL;
}

static void apply_acting(pbrt_parser *parser, const params *p, const param *q)
{
    GError *error = NULL;
    bool *is_on = switch_of(parser->builder, q->name);
    if (!is_on)
        apply_seed(parser, p, q);
    else if (!params_bool(p, q->name, is_on, &error))
        pbrt_report(parser, error);
}

static void apply_option(pbrt_parser *parser, const params *p, const param *q)
{
    const directive_kind *option = find_kind(options, G_N_ELEMENTS(options), q->name);
    bool is_off = q->type == PARAM_BOOL && q->n == 1 && !q->integers[0];
    if (option && *option->parameters)
        apply_acting(parser, p, q);
    else if (option && *option->idle)
        log_at(&parser->builder->build.log, LOG_NOTE, q->place,
               "option '%s' does not change the image", q->name);
    else if (!option || !option->note || !is_off)
        pbrt_error(parser, q->place, "option '%s' is not supported", q->name);
}

/* Names of options may be written with capitals, '-' and '_'. */
static const char *option_name(const char *text)
{
    g_autoptr(GString) name = g_string_new(NULL);
    for (; *text; text++)
        if (*text != '-' && *text != '_')
            g_string_append_c(name, g_ascii_tolower(*text));
    return intern(name->str);
}

/* A word as the value that it looks like. */
static bool add_word(params *p, source_place at, const char *name, const char *word,
                     GError **error)
{
    char *end;
    int is_true = strcmp(word, "true") == 0;
    gint64 whole = g_ascii_strtoll(word, &end, 10);
    int integer = (int)CLAMP(whole, G_MININT, G_MAXINT);
    if (is_true || strcmp(word, "false") == 0)
        return params_add_integers(p, at, PARAM_BOOL, name, &is_true, 1, error);
    if (end != word && !*end)
        return params_add_integers(p, at, PARAM_INTEGER, name, &integer, 1, error);
    float number = (float)g_ascii_strtod(word, &end);
    if (end != word && !*end)
        return params_add_numbers(p, at, PARAM_FLOAT, name, &number, 1, error);
    error_at(error, at, "expected a value for option '%s', found '%s'", name, word);
    return false;
}

/* pbrt-v4 itself has a name and one value, Option "seed" 5. */
static params *read_bare_option(pbrt_parser *parser, source_place place)
{
    g_autoptr(params) p = params_new(place, parser->base_directory, parser->state.space);
    source_place at = place;
    GError *error = NULL;
    g_autofree char *text = pbrt_read_string(parser, "an option", &at);
    const char *name = option_name(text);
    token value = lexer_peek(parser->words);
    if (value.kind != TOKEN_WORD && value.kind != TOKEN_STRING) {
        pbrt_expected(parser, "a value", &value);
        return NULL;
    }
    lexer_next(parser->words);
    g_autofree char *word = value.kind == TOKEN_STRING
                                ? token_string(&value)
                                : g_strndup(value.text, value.length);
    const char *strings[] = {word};
    bool done = value.kind == TOKEN_STRING
                    ? params_add_strings(p, at, PARAM_STRING, name, strings, 1, &error)
                    : add_word(p, at, name, word, &error);
    if (done)
        return g_steal_pointer(&p);
    pbrt_report(parser, error);
    return NULL;
}

static bool is_bare_option(pbrt_parser *parser)
{
    token t = lexer_peek(parser->words);
    return t.kind == TOKEN_STRING && !memchr(t.text, ' ', t.length);
}

bool pbrt_option(pbrt_parser *parser, source_place place)
{
    g_autoptr(params) p = is_bare_option(parser) ? read_bare_option(parser, place)
                                                 : pbrt_read_params(parser, place);
    if (!p)
        return false;
    for (guint i = 0; i < p->list->len; i++)
        apply_option(parser, p, p->list->pdata[i]);
    return true;
}

/** A directive that was not given is as if it were, without parameters. */
static const params *given_or_default(pbrt_parser *parser, pending *d, const char *kind,
                                      source_place place)
{
    if (!d->kind) {
        d->kind = g_strdup(kind);
        d->p = params_new(place, parser->base_directory, parser->state.space);
        d->place = place;
        if (parser->is_v3 && d == &parser->film)
            pbrt_v3_translate(V3_FILM, &d->kind, d->p, &parser->builder->build.log, NULL);
    }
    return d->p;
}

static void finish_film(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    const params *p = given_or_default(parser, &parser->film, "rgb", place);
    if (builder_set_film(parser->builder, parser->film.kind, p, &error))
        pbrt_check_used(parser, p, "Film", parser->film.kind);
    else
        pbrt_report(parser, error);
}

static void finish_filter(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    const params *p = given_or_default(parser, &parser->filter,
                                       parser->is_v3 ? "box" : "gaussian", place);
    if (builder_set_filter(parser->builder, parser->filter.kind, p, &error))
        pbrt_check_used(parser, p, "PixelFilter", parser->filter.kind);
    else
        pbrt_report(parser, error);
}

static void move_camera(pbrt_parser *parser, const pending *c)
{
    motion to_world =
        motion_make(&c->ctm, &c->ctm_end, parser->times[0], parser->times[1]);
    builder_move_camera(parser->builder, &to_world);
    pbrt_check_used(parser, c->p, "Camera", c->kind);
}

static void finish_camera(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    pending *c = &parser->camera;
    pbrt_use_media(parser, &(medium_name){0}, &parser->around_camera);
    if (!c->kind) {
        log_at(&parser->builder->build.log, LOG_NOTE, place,
               "there is no Camera; pbrt's own looks from the origin along z");
        c->ctm = c->ctm_end = transform_identity();
        given_or_default(parser, c, "perspective", place);
    }
    if (builder_set_camera(parser->builder, c->kind, c->p, &c->ctm, &error))
        move_camera(parser, c);
    else
        pbrt_report(parser, error);
}

bool pbrt_world_begin(pbrt_parser *parser, source_place place)
{
    guint n_errors = parser->errors->len;
    pbrt_flatten_lens(parser);
    finish_film(parser, place);
    finish_filter(parser, place);
    if (parser->errors->len == n_errors)
        finish_camera(parser, place);
    pbrt_apply_integrator(parser);
    parser->in_world = true;
    parser->state.ctm = parser->state.ctm_end = transform_identity();
    parser->state.active = ACTIVE_ALL;
    pbrt_name_transform(parser, "world", &parser->state.ctm, &parser->state.ctm_end);
    return true;
}

bool pbrt_world_end(pbrt_parser *parser, source_place place)
{
    parser->has_ended = true;
    if (!parser->is_v3)
        pbrt_error(parser, place, "WorldEnd is of pbrt-v3, the scene of pbrt-v4");
    return true;
}
