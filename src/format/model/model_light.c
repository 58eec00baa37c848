/*
 * Lights and cameras of models. Few formats say in what units lights shine, so colours
 * are taken as W/sr, or W/m² of directional light.
 */
#include "format/model/model_scene.h"

#include "format/given.h"

#include <math.h>

#define DEGREES (180.0 / G_PI)

static vec3 vector_of(const float v[3])
{
    return vec3_make(v[0], v[1], v[2]);
}

static bool give_light_color(params *p, const char *name, const float c[3])
{
    if (!(c[0] + c[1] + c[2] > 0.0f))
        return false;
    give_triple(p, PARAM_RGB, name, fmax(0.0, (double)c[0]), fmax(0.0, (double)c[1]),
                fmax(0.0, (double)c[2]));
    return true;
}

static void give_point(params *p, const char *name, vec3 v)
{
    give_triple(p, PARAM_POINT3, name, (double)v[0], (double)v[1], (double)v[2]);
}

static void give_cone(params *p, const stream_light *l)
{
    double outer = CLAMP((double)l->outer_angle * 0.5 * DEGREES, 1.0, 89.9);
    double inner = CLAMP((double)l->inner_angle * 0.5 * DEGREES, 0.0, outer);
    give_float(p, "coneangle", outer);
    give_float(p, "conedeltaangle", outer - inner);
}

/* A spot that points nowhere shines everywhere. */
static bool add_light(model_builder *b, const stream_light *l, GError **error)
{
    static const char *const kinds[N_STREAM_LIGHT_KINDS] = {"point", "spot", "distant"};
    vec3 from = vector_of(l->position), to = from + vector_of(l->direction);
    g_autoptr(params) p = model_params(b);
    transform to_world;
    bool directed = length3(to - from) > 0.0f && finite3(to);
    bool distant = l->kind == STREAM_DISTANT;
    stream_light_kind kind = l->kind == STREAM_SPOT && !directed ? STREAM_POINT : l->kind;
    if (!give_light_color(p, distant ? "L" : "I", l->color) || (distant && !directed) ||
        !model_transform(l->to_world, &to_world))
        return true;
    if (kind == STREAM_SPOT)
        give_cone(p, l);
    give_point(p, "from", from);
    if (kind != STREAM_POINT)
        give_point(p, "to", to);
    model_tell(b, "lights are taken to shine in W/sr and W/m²");
    return builder_add_light(b->builder, kinds[kind], p, &to_world, error);
}

bool model_add_lights(model_builder *b, GError **error)
{
    for (guint i = 0; i < b->source->lights->len; i++)
        if (!add_light(b, b->source->lights->pdata[i], error))
            return false;
    return true;
}

static bool camera_place(const stream_camera *c, transform *out)
{
    transform node;
    if (!model_transform(c->to_world, &node))
        return false;
    vec3 eye = transform_point(&node, vector_of(c->position));
    vec3 z = normalize3(transform_vector(&node, vector_of(c->look_at)));
    vec3 x = normalize3(cross3(z, transform_vector(&node, vector_of(c->up))));
    vec3 y = cross3(x, z);
    double m[4][4] = {{0}};
    for (int i = 0; i < 3; i++) {
        m[i][0] = (double)x[i];
        m[i][1] = (double)y[i];
        m[i][2] = (double)z[i];
        m[i][3] = (double)eye[i];
    }
    m[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])m, out);
}

bool model_add_camera(model_builder *b, GError **error)
{
    enum { HEIGHT = 720 };
    const stream_camera *c = b->source->camera;
    transform place;
    if (!c)
        return true;
    double aspect = c->aspect > 0.0f ? CLAMP((double)c->aspect, 0.1, 10.0) : 4.0 / 3.0;
    double wide = tan(0.5 * CLAMP((double)c->fov, 0.01, 3.0));
    if (!camera_place(c, &place)) {
        model_tell(b, "a camera that looks nowhere is left out");
        return true;
    }
    g_autoptr(params) film = model_params(b), p = model_params(b);
    give_integer(film, "yresolution", HEIGHT);
    give_integer(film, "xresolution", (int)lround(HEIGHT * aspect));
    give_float(p, "fov", 2.0 * atan(aspect > 1.0 ? wide / aspect : wide) * DEGREES);
    return builder_set_film(b->builder, "rgb", film, error) &&
           builder_set_camera(b->builder, "perspective", p, &place, error);
}
