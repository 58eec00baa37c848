/*
 * What stands before WorldBegin. pbrt lets film, camera, sampler ... come in any order,
 * so they are kept and given to the scene together.
 */
#include "format/pbrt_parser.h"

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
        pbrt_v3_translate(target, &kind, p, &parser->scene->log);
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
    parser->camera.ctm = transform_inverse(&parser->state.ctm);
    parser->camera.ctm_end = transform_inverse(&parser->state.ctm_end);
    pbrt_name_transform(parser, "camera", &parser->camera.ctm, &parser->camera.ctm_end);
    return true;
}

bool pbrt_accelerator(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *kind = pbrt_read_string(parser, "a kind", &at);
    g_autoptr(params) p = kind ? pbrt_read_params(parser, place) : NULL;
    if (!p)
        return false;
    if (strcmp(kind, "bvh") == 0 || strcmp(kind, "kdtree") == 0)
        log_message(&parser->scene->log, LOG_NOTE,
                    "%s:%d:%d: Accelerator '%s': rays are traced by Embree, which needs "
                    "no parameters",
                    at.file, at.line, at.column, kind);
    else
        pbrt_error(parser, at, "expected Accelerator \"bvh\" or \"kdtree\", found \"%s\"",
                   kind);
    return true;
}

/** Switches of pbrt's that must be off, or that do not change the image. */
static void apply_option(pbrt_parser *parser, const params *p, const param *q)
{
    static const char *const harmless[] = {"rendercoordsys",
                                           "displacementedgescale",
                                           "pixelstats",
                                           "wavefront",
                                           "gpu",
                                           NULL};
    GError *error = NULL;
    int seed = 0;
    if (strcmp(q->name, "seed") == 0) {
        g_autofree char *text = NULL;
        if (!params_integer(p, "seed", &seed, &error)) {
            pbrt_report(parser, error);
            return;
        }
        text = g_strdup_printf("%d", seed);
        if (!settings_set(&parser->scene->settings, "seed", text, &error)) {
            pbrt_error(parser, q->place, "%s", error->message);
            g_error_free(error);
        }
    } else if (g_strv_contains(harmless, q->name)) {
        log_message(&parser->scene->log, LOG_NOTE,
                    "%s:%d:%d: option '%s' does not change the image", q->place.file,
                    q->place.line, q->place.column, q->name);
    } else if (q->type != PARAM_BOOL || q->n != 1 || q->integers[0]) {
        pbrt_error(parser, q->place, "option '%s' is not supported", q->name);
    }
}

bool pbrt_option(pbrt_parser *parser, source_place place)
{
    g_autoptr(params) p = pbrt_read_params(parser, place);
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
            pbrt_v3_translate(V3_FILM, &d->kind, d->p, &parser->scene->log);
    }
    return d->p;
}

static void finish_film(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    const params *p = given_or_default(parser, &parser->film, "rgb", place);
    if (scene_set_film(parser->scene, parser->film.kind, p, &error))
        pbrt_check_used(parser, p, "Film", parser->film.kind);
    else
        pbrt_report(parser, error);
}

static void finish_filter(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    const params *p = given_or_default(parser, &parser->filter,
                                       parser->is_v3 ? "box" : "gaussian", place);
    if (scene_set_filter(parser->scene, parser->filter.kind, p, &error))
        pbrt_check_used(parser, p, "PixelFilter", parser->filter.kind);
    else
        pbrt_report(parser, error);
}

static void move_camera(pbrt_parser *parser, const pending *c)
{
    motion to_world =
        motion_make(&c->ctm, &c->ctm_end, parser->times[0], parser->times[1]);
    scene_move_camera(parser->scene, &to_world);
    pbrt_check_used(parser, c->p, "Camera", c->kind);
}

static void finish_camera(pbrt_parser *parser, source_place place)
{
    GError *error = NULL;
    const pending *c = &parser->camera;
    if (!c->kind)
        pbrt_error(parser, place, "expected a Camera before WorldBegin, found none");
    else if (scene_set_camera(parser->scene, c->kind, c->p, &c->ctm, &error))
        move_camera(parser, c);
    else
        pbrt_report(parser, error);
}

bool pbrt_world_begin(pbrt_parser *parser, source_place place)
{
    guint n_errors = parser->errors->len;
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
    if (!parser->is_v3)
        pbrt_error(parser, place, "WorldEnd is of pbrt-v3, the scene of pbrt-v4");
    return true;
}
