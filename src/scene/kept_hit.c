#include "scene/kept_hit.h"

kept_hit hit_keep(const ray *r, const surface_hit *hit)
{
    const vec3 o = r->origin, d = r->direction;
    return (kept_hit){
        .origin = {o[0], o[1], o[2]},
        .direction = {d[0], d[1], d[2]},
        .t = hit->t,
        .time = hit->time,
        .shape = hit->shape,
        .instance = hit->instance,
        .primitive = hit->primitive,
        .corners = hit->corners,
        .media = hit->media,
    };
}

surface_hit scene_restore_hit(const scene *s, const kept_hit *kept)
{
    const float *o = kept->origin, *d = kept->direction;
    const ray r = {.origin = {o[0], o[1], o[2]},
                   .direction = {d[0], d[1], d[2]},
                   .t_max = INFINITY,
                   .time = kept->time,
                   .media = kept->media};
    surface_hit hit = {.t = kept->t,
                       .time = kept->time,
                       .shape = kept->shape,
                       .instance = kept->instance,
                       .primitive = kept->primitive,
                       .corners = kept->corners};
    accel_fill_hit(s->accel, &r, &hit);
    scene_fill_hit(s, &r, &hit);
    return hit;
}
