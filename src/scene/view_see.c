/*
 * What an eye sees first: below all that travels, as placing it is above.
 */
#include "scene/view.h"

bool view_see(const view *v, const ray *r, surface_hit *hit)
{
    const scene *s = v->scene;
    ray rest = *r;
    while (scene_intersect(s, &rest, hit)) {
        const shape *on = s->shapes->pdata[hit->shape];
        if (!on->camera_hidden) {
            hit->t = length3(hit->p - r->origin);
            hit->footprint = s->switches.sharp_textures
                                 ? 0.0f
                                 : v->pixel_width + hit->t * v->pixel_spread;
            return true;
        }
        rest = hit_ray(hit, r->direction);
        rest.media = r->media; /* what is not seen absorbs nothing */
        rest.t_max = r->t_max - length3(rest.origin - r->origin);
    }
    return false;
}

float view_imaging_ratio(const view *v)
{
    return v->film.iso / 100.0f * (v->camera.shutter_close - v->camera.shutter_open);
}
