#include "photon/trace/emit.h"

#include "math/warp.h"
#include "scene/advance.h"

/* A point by area on all surfaces that cast caustics. */
static vec3 caustic_target(const caustic_casters *c, float time, sampler *random)
{
    float u_shape = sampler_1d(random);
    return caustic_casters_sample(c, u_shape, sampler_2d(random), time);
}

/* The density with which targets chosen by area give this ray: per solid angle at its
   origin, or for parallel light per area across it. Cut-outs are solid, as targets on
   them are. */
static double aimed_density(const caustic_casters *c, ray r, bool parallel)
{
    double density = 0.0;
    float distance = 0.0f;
    vec3 from = r.origin;
    surface_hit hit;
    for (int i = 0; i < MOST_CROSSINGS && scene_cross(c->scene, &r, &hit); i++) {
        distance += length3(hit.p - from);
        from = r.origin;
        if (caustic_casters_include(c, &hit)) {
            double cosine = fabs((double)dot3(hit.n_geom, r.direction));
            double d2 = parallel ? 1.0 : (double)distance * (double)distance;
            double by_area = caustic_casters_density(c, &hit);
            density += cosine > 0.0 ? by_area * d2 / cosine : 0.0;
        }
    }
    return density;
}

/* True if the first surface that stops the ray casts caustics. */
static bool meets_caster(const caustic_casters *c, const wavelengths *w, ray r)
{
    uint64_t untold = 0;
    const scene_traveller who = {.scene = c->scene, .w = w, .n_rays = &untold};
    path_segment segment = {.ray = r};
    surface_hit hit;
    return scene_advance(&who, &segment, &hit) == EVENT_SURFACE &&
           caustic_casters_include(c, &hit);
}

/* Chooses a light by power; *u becomes uniform again. NULL: the light that was given has
   none. */
static const light *choose_light(const scene *s, const distribution *power, float *u,
                                 photon_start *out)
{
    if (!out->light_is_given) {
        out->light = (int)distribution_sample(power, u);
        out->p_light = distribution_pdf(power, (size_t)out->light);
    } else if (!(distribution_pdf(power, (size_t)out->light) > 0.0f)) {
        return NULL;
    }
    return scene_light(s, out->light);
}

static bool finish(const light_emission *emission, float density, photon_start *out)
{
    float time = out->ray.time;
    out->ray = emission->ray;
    out->ray.time = time;
    out->n = emission->n;
    out->primitive = emission->primitive;
    out->flux = emission->flux / (out->p_light * density);
    return !spectrum_is_black(out->flux) && spectrum_is_finite(out->flux);
}

bool photon_emit_aimed(const caustic_casters *c, const wavelengths *w, sampler *random,
                       photon_start *out)
{
    light_emission emission;
    float u_light = sampler_1d(random), u_primitive = sampler_1d(random);
    vec2 u = sampler_2d(random);
    if (!(distribution_total(&c->power) > 0.0))
        return false;
    const light *l = choose_light(c->scene, &c->power, &u_light, out);
    vec3 target = caustic_target(c, out->ray.time, random);
    if (!l || !l->kind->emit_toward(l->self, w, u_primitive, u, target, &emission))
        return false;
    emission.ray.time = out->ray.time;
    if (!meets_caster(c, w, emission.ray))
        return false;
    double density = aimed_density(c, emission.ray, l->kind->is_parallel);
    return density > 0.0 && finish(&emission, (float)density, out);
}

bool photon_emit(const scene *s, const wavelengths *w, const emission_guide *guide,
                 sampler *random, photon_start *out)
{
    float u[EMISSION_DIMENSIONS];
    light_emission emission;
    if (!scene_is_lit(s))
        return false;
    float density = emission_guide_draw(guide, random, u);
    const light *l = choose_light(s, &s->light_power, &u[0], out);
    if (!l || !l->kind->emit(l->self, w, u[1], (vec2){u[2], u[3]}, (vec2){u[4], u[5]},
                             &emission))
        return false;
    return finish(&emission, density, out);
}

/* Parallel light through the disc of the sphere around what casts caustics. */
static bool emit_at_disc(const caustic_casters *c, const light *l, const wavelengths *w,
                         const float u[EMISSION_DIMENSIONS], light_emission *out)
{
    vec2 u_direction = {u[4], u[5]}, disk = warp_disk((vec2){u[2], u[3]});
    if (!l->kind->emit_toward(l->self, w, u[1], u_direction, c->center, out))
        return false;
    frame f = frame_from_normal(out->ray.direction);
    out->ray.origin += c->radius * (disk.x * f.s + disk.y * f.t);
    out->flux *= PI_F * c->radius * c->radius;
    return true;
}

/* math: how far off rounding may turn a unit direction (radians). */
#define DIRECTION_ERROR 2e-7

/* 1 - cos of the half angle of the cone in which p sees the sphere, for all that rounding
   does to the directions in it. */
static float cone_of_sphere(const caustic_casters *c, vec3 p)
{
    double distance = (double)length3(c->center - p);
    double sine = (double)c->radius / distance + DIRECTION_ERROR;
    return (float)one_minus_cos_of_sine2(fmin(sine * sine, 1.0));
}

float photon_cone_pdf(const caustic_casters *c, vec3 p)
{
    return warp_cone_pdf(cone_of_sphere(c, p));
}

/* A point in direction d from p and at least as far as q: so far that rounding of its
   coordinates does not turn the direction. */
static vec3 far_along(vec3 p, vec3 d, vec3 q)
{
    return p + (length3(p) + length3(q)) * d;
}

/* How a direction in the cone is drawn, once it is known from where. */
typedef struct cone_aim {
    const caustic_casters *casters;
    vec2 u;
    float density; /* of the direction */
} cone_aim;

/* Uniform in the cone in which the start sees the sphere. */
static vec3 target_in_cone(void *data, vec3 start)
{
    cone_aim *aim = data;
    const caustic_casters *c = aim->casters;
    frame f = frame_from_normal(normalize3(c->center - start));
    float cone = cone_of_sphere(c, start);
    aim->density = warp_cone_pdf(cone);
    return far_along(start, frame_to_world(&f, warp_cone(aim->u, cone)), c->center);
}

/* From a light apart: the place is drawn by the light, the direction in the cone, which
   depends on the place. */
static bool emit_in_cone(const caustic_casters *c, const light *l, const wavelengths *w,
                         const float u[EMISSION_DIMENSIONS], light_emission *out)
{
    vec2 u_place = {u[2], u[3]};
    cone_aim cone = {.casters = c, .u = {u[4], u[5]}};
    const light_aim aim = {target_in_cone, &cone};
    bool emitted;
    *out = (light_emission){0};
    if (l->kind->emit_aimed) {
        emitted = l->kind->emit_aimed(l->self, w, u[1], u_place, c->center, &aim, out);
    } else {
        l->kind->emit_toward(l->self, w, u[1], u_place, c->center, out);
        vec3 target = target_in_cone(&cone, out->ray.origin);
        emitted = l->kind->emit_toward(l->self, w, u[1], u_place, target, out);
    }
    out->flux /= cone.density;
    return emitted;
}

bool photon_emit_caustic(const caustic_casters *c, const wavelengths *w,
                         const emission_guide *guide, sampler *random, photon_start *out)
{
    float u[EMISSION_DIMENSIONS];
    light_emission emission;
    if (!(distribution_total(&c->power) > 0.0))
        return false;
    float density = emission_guide_draw(guide, random, u);
    const light *l = choose_light(c->scene, &c->power, &u[0], out);
    if (!l)
        return false;
    bool emitted = l->kind->is_parallel ? emit_at_disc(c, l, w, u, &emission)
                   : c->is_apart[out->light]
                       ? emit_in_cone(c, l, w, u, &emission)
                       : l->kind->emit(l->self, w, u[1], (vec2){u[2], u[3]},
                                       (vec2){u[4], u[5]}, &emission);
    return emitted && finish(&emission, density, out);
}
