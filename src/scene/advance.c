#include "scene/advance.h"

/* Goes on behind a surface. */
static void go_behind(ray *r, const surface_hit *hit)
{
    float left = r->t_max - hit->t;
    *r = hit_ray(hit, r->direction);
    r->t_max = left;
}

/* The nearest surface that the path sees. */
static bool meet(const scene_traveller *who, const path_segment *path, surface_hit *hit)
{
    (*who->n_rays)++;
    return path->eye ? view_see(path->eye, &path->ray, hit)
                     : scene_intersect(who->scene, &path->ray, hit);
}

static scene_event cross_medium(const scene_traveller *who, path_segment *path,
                                const surface_hit *behind, surface_hit *at)
{
    const scene *s = who->scene;
    float length = scene_medium_end(s, &path->ray, behind ? behind->t : INFINITY);
    if (who->cross_medium)
        return who->cross_medium(who->path, length, behind, at);
    const medium *m = scene_medium(s, path->ray.media.participating);
    path->throughput *= medium_transmittance(m, length, who->w);
    return EVENT_NONE;
}

static void weaken_in_solid(const scene_traveller *who, path_segment *path, float way)
{
    const medium_stack *in = &path->ray.media;
    if (in->solid[0])
        path->throughput *= scene_solid_transmittance(who->scene, in, way, who->w);
}

static bool lets_through(const scene *s, const surface_hit *hit)
{
    const shape *on = s->shapes->pdata[hit->shape];
    return on->lets_through;
}

/* Share of light that a surface with a material leaves of what goes straight to wo. */
static spectrum straight_share(const scene *s, const surface_hit *hit, vec3 wo,
                               const wavelengths *w, const bsdf_options *options)
{
    bsdf b;
    scene_bsdf(s, hit, w, ALL_WAVELENGTHS, options, &b);
    return bsdf_straight(&b, wo);
}

/* Straight through a pane. */
static bool goes_through(const scene_traveller *who, path_segment *path,
                         const surface_hit *hit)
{
    if (!who->through_panes || !lets_through(who->scene, hit))
        return false;
    path->throughput *=
        straight_share(who->scene, hit, -path->ray.direction, who->w, who->through_panes);
    return true;
}

scene_event scene_advance(const scene_traveller *who, path_segment *path,
                          surface_hit *hit)
{
    for (int i = 0; i < MOST_CROSSINGS; i++) {
        bool met = meet(who, path, hit);
        if (path->ray.media.participating) {
            surface_hit within;
            scene_event event = cross_medium(who, path, met ? hit : NULL, &within);
            if (event == EVENT_MEDIUM) {
                *hit = within;
                weaken_in_solid(who, path, within.t);
            }
            if (event != EVENT_NONE)
                return event;
        }
        if (!met)
            return EVENT_ESCAPE;
        weaken_in_solid(who, path, hit->t);
        if (hit->light != NO_INDEX && who->meet_light)
            who->meet_light(who->path, hit);
        if (hit->material != NO_INDEX && !goes_through(who, path, hit))
            return EVENT_SURFACE;
        go_behind(&path->ray, hit);
    }
    return EVENT_ESCAPE;
}

bool scene_scatterer(const scene *s, const surface_hit *hit, const wavelengths *w,
                     int wavelength, const bsdf_options *options, bsdf *out)
{
    if (hit->shape != NO_INDEX)
        return scene_bsdf(s, hit, w, wavelength, options, out);
    const medium *m = scene_medium(s, hit->media.participating);
    bsdf_make_phase(out, m->g, wavelength);
    return true;
}

bool scene_meet_behind(const scene *s, const ray *r, surface_hit *hit)
{
    ray on = *r;
    float length = 0.0f;
    for (int i = 0; i < MOST_CROSSINGS; i++) {
        length += hit->t;
        go_behind(&on, hit);
        if (!scene_intersect(s, &on, hit))
            break;
        if (hit->material != NO_INDEX) {
            hit->t += length;
            return true;
        }
    }
    hit->shape = NO_INDEX;
    return false;
}

bool scene_meet_surface(const scene *s, const ray *r, surface_hit *hit)
{
    return scene_intersect(s, r, hit) &&
           (hit->material != NO_INDEX || scene_meet_behind(s, r, hit));
}

void scene_meet_surfaces(const scene *s, const ray *rays, int n, surface_hit *hits)
{
    accel_intersect_packet(s->accel, rays, n, hits);
    for (int i = 0; i < n; i++) {
        if (hits[i].shape == NO_INDEX)
            continue;
        scene_fill_hit(s, &rays[i], &hits[i]);
        if (hits[i].material == NO_INDEX)
            scene_meet_behind(s, &rays[i], &hits[i]);
    }
}

bool scene_cross(const scene *s, ray *r, surface_hit *hit)
{
    if (!scene_intersect_solid(s, r, hit))
        return false;
    go_behind(r, hit);
    return true;
}

/* Share of light that participating media leave. */
static spectrum participating_transmittance(const scene *s, ray r, const wavelengths *w)
{
    spectrum out = spectrum_fill(1.0f);
    bool met = scene_has_media(s);
    for (int i = 0; i < MOST_CROSSINGS && met && !spectrum_is_black(out); i++) {
        const ray segment = r;
        const medium *through = scene_medium(s, segment.media.participating);
        surface_hit hit;
        met = scene_cross(s, &r, &hit);
        if (through) {
            float length = minf(met ? hit.t : INFINITY, segment.t_max);
            out *=
                medium_transmittance(through, scene_medium_end(s, &segment, length), w);
        }
    }
    return out;
}

spectrum scene_transmittance(const scene *s, const ray *r, const wavelengths *w)
{
    return participating_transmittance(s, *r, w) *
           scene_solid_transmittance(s, &r->media, r->t_max, w);
}

/* Share of light that panes leave. Cut-outs that the whole ray passed stay passed. */
static spectrum through_panes(const scene_look *look, ray r)
{
    const scene *s = look->scene;
    spectrum out = spectrum_fill(1.0f);
    surface_hit hit;
    int64_t n = 0;
    for (int i = 0; i < MOST_CROSSINGS && !spectrum_is_black(out); i++) {
        if (!scene_intersect(s, &r, &hit))
            return out;
        bool is_pane = hit.material != NO_INDEX && lets_through(s, &hit);
        if (is_pane && look->most_panes >= 0 && n++ >= look->most_panes)
            break;
        if (is_pane)
            out *= straight_share(s, &hit, -r.direction, look->w, look->options);
        go_behind(&r, &hit);
    }
    return (spectrum){0};
}

/* @param distance m, all of it: the ray ends short of what it looks for */
static bool sees(const scene_look *look, const ray *r, float distance, spectrum *share)
{
    const scene *s = look->scene;
    *share = spectrum_fill(1.0f);
    if (scene_occluded(s, r))
        return false;
    if (s->has_panes)
        *share = through_panes(look, *r);
    if (scene_has_media(s))
        *share *= participating_transmittance(s, *r, look->w);
    if (r->media.solid[0])
        *share *= scene_solid_transmittance(s, &r->media, distance, look->w);
    return !spectrum_is_black(*share);
}

bool scene_sees(const scene_look *look, const ray *r, spectrum *share)
{
    return sees(look, r, r->t_max, share);
}

bool scene_sees_from(const scene_look *look, const surface_hit *from, vec3 direction,
                     float distance, spectrum *share)
{
    const ray r = hit_ray_to(from, direction, distance);
    return sees(look, &r, distance, share);
}

/* Where a line leaves the sphere at which media end; < 0: it does not meet it, or before
   the ray starts. *enters gets where it comes in. */
static float sphere_end(const scene *s, const ray *r, float *enters)
{
    vec3 to = s->center - r->origin;
    float middle = dot3(to, r->direction);
    float d2 = length3_2(to - middle * r->direction);
    float half2 = s->media_radius * s->media_radius - d2;
    float half = sqrtf(maxf(half2, 0.0f));
    *enters = middle - half;
    return half2 > 0.0f ? middle + half : -1.0f;
}

float scene_medium_end(const scene *s, const ray *r, float length)
{
    float enters;
    return isfinite(length) ? length : maxf(sphere_end(s, r, &enters), 0.0f);
}

/* What is around where light from beyond comes in: a boundary on its way says so, and
   else it is what leads there from the camera. */
static uint32_t medium_beyond(const scene *s, const ray *r)
{
    surface_hit hit;
    bool is_told =
        scene_has_media(s) && scene_intersect_solid(s, r, &hit) && hit.boundary;
    return is_told ? hit_media(&hit, -r->direction).participating : s->outer_medium;
}

/* Lets a ray begin at a portal. */
static spectrum come_in(const scene *s, float begins, const wavelengths *w, ray *r)
{
    r->origin += begins * r->direction;
    r->media.participating = medium_beyond(s, r);
    ray back = *r;
    back.direction = -r->direction;
    static const bsdf_options options = {0};
    const scene_look look = {s, w, &options, -1};
    spectrum share;
    return scene_sees(&look, &back, &share) ? share : spectrum_fill(0.0f);
}

spectrum scene_leave_light(const scene *s, int i, vec3 n, const wavelengths *w, ray *r)
{
    const light *from = scene_light(s, i);
    const spectrum all = spectrum_fill(1.0f);
    float begins = -INFINITY, enters;
    r->media = from->inside;
    if (!from->kind->is_environment && !from->kind->is_parallel) {
        r->media.participating = scene_light_medium(s, i, n, r->direction);
        return all;
    }
    if (from->kind->admits && !from->kind->admits(from->self, r, &begins))
        return spectrum_fill(0.0f);
    if (isfinite(begins))
        return come_in(s, begins, w, r);
    uint32_t around = r->media.participating = medium_beyond(s, r);
    if (around && sphere_end(s, r, &enters) > 0.0f)
        r->origin += enters * r->direction;
    return all;
}
