/*
 * What an eye sees first: below all that travels, as placing it is above.
 */
#include "scene/view.h"

bool view_see(const view *v, const ray *r, surface_hit *hit)
{
    const scene *s = v->scene;
    ray left = *r;
    while (scene_intersect(s, &left, hit)) {
        const shape *on = s->shapes->pdata[hit->shape];
        if (!on->camera_hidden) {
            hit->t = length3(hit->p - r->origin);
            hit->footprint = s->switches.sharp_textures
                                 ? 0.0f
                                 : v->pixel_width + hit->t * v->pixel_spread;
            return true;
        }
        left = hit_ray(hit, r->direction);
        left.media = r->media; /* what is not seen absorbs nothing */
        left.t_max = r->t_max - length3(left.origin - r->origin);
    }
    return false;
}

float view_imaging_ratio(const view *v)
{
    return v->film.iso / 100.0f * (v->camera.shutter_close - v->camera.shutter_open);
}
