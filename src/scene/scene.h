/*
 * The world, as a builder (scene/builder.h) made it: const. Every query is thread-safe;
 * what it finds goes to the caller's own struct.
 */
#pragma once

#include "accel/accel.h"
#include "light/light.h"
#include "material/material.h"
#include "medium/medium.h"
#include "params/params.h"
#include "settings/settings.h"
#include "shape/instance.h"
#include "texture/texture.h"

#include "math/distribution.h"

/** @brief What an instance takes: an array that grows holds up to twice what is in it. */
#define INSTANCE_SIZE (2 * sizeof(instance))

/** @brief What pbrt's options switch off: for debugging, since the image is worse. */
typedef struct scene_switches {
    bool fixed_pixels; /**< the eye sees pixels' middles, through the lens's middle, at
                          half time, unfiltered; light that finds the eye does not */
    bool fixed_wavelengths; /**< all passes have the same eight */
    bool sharp_textures;    /**< footprints are points */
} scene_switches;

typedef struct scene {
    GPtrArray *shapes;    /**< shape* */
    GPtrArray *materials; /**< material* */
    GPtrArray *lights;    /**< light* */
    GPtrArray *textures;  /**< texture* */
    GPtrArray *media;     /**< medium*, participating */
    guint n_objects;      /**< what instances put into the world: the shapes of the
                             same shape.object */
    GArray *instances;    /**< instance */
    size_t instance_room; /**< as many have their memory reserved */
    float shutter[2];     /**< s, when it opens and closes */
    scene_switches switches;
    settings settings; /**< defaults, then what the file asks for */

    /* From here on found by the commit. */
    accel *accel;
    box3 bounds;  /**< of all shapes */
    vec3 center;  /**< of the bounding sphere */
    float radius; /**< of the bounding sphere; > 0 also for an empty scene */
    distribution
        light_power;        /**< over lights, by power: which one a photon starts from */
    light_tree *light_tree; /**< which one a point is lit by */
    wavelength_density *lines; /**< how wavelengths are drawn; NULL: evenly, since no
                                  light has a spectrum of lines */
    char **light_groups;       /**< names; those of lights without one: "default" */
    int n_light_groups;        /**< 0: no light names one */
    int *environments;         /**< indices of lights that are environments */
    int n_environments;
    const medium **solids; /**< what those of a medium_stack's rank are filled with,
                              from [1]; NULL: clear. NULL: nothing absorbs */
    uint32_t outer_medium; /**< around the scene: of no bounds; as in a medium_stack
                            */
    float media_radius;    /**< m, around center: where such a medium ends */
    bool is_animated;      /**< it may look otherwise at another time */
    bool moves;            /**< some instance does while the shutter is open */
    bool camera_facing;    /**< some shape may (surface_hit.camera_facing) */
    bool has_panes;        /**< light may go straight through some shape's material */
} scene;

/** @brief Those of a pass. */
wavelengths scene_wavelengths(const scene *s, const settings *how, uint32_t pass);
/** @brief Those of a trial before the first pass: the same for all trials, unless lights
 * have lines that they might miss. */
wavelengths scene_trial_wavelengths(const scene *s, uint32_t trial);

/** @brief An empty one, for a builder. */
scene *scene_new(void);
/** @brief Frees all that a commit finds: a builder may go on. */
void scene_forget_commit(scene *s);
void scene_free(scene *s);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(scene, scene_free)

/* ---- Queries ---- */

/** @brief What a hit's shape is made of. */
static inline void scene_fill_hit(const scene *s, const ray *r, surface_hit *hit)
{
    const shape *on = s->shapes->pdata[hit->shape];
    hit->material = on->material;
    hit->light = on->light;
    hit->media = r->media;
    hit->solid = on->solid;
    hit->from_inside = on->solid && dot3(r->direction, hit->n_geom) > 0.0f;
    hit->boundary = on->parts_media ? &on->media : NULL;
}

/** @brief Nearest hit of a ray, with material and light. */
static inline bool scene_intersect(const scene *s, const ray *r, surface_hit *hit)
{
    if (!accel_intersect(s->accel, r, hit))
        return false;
    scene_fill_hit(s, r, hit);
    return true;
}

/** @brief The same, cut-outs (alpha) taken as solid. */
static inline bool scene_intersect_solid(const scene *s, const ray *r, surface_hit *hit)
{
    if (!accel_intersect_solid(s->accel, r, hit))
        return false;
    scene_fill_hit(s, r, hit);
    return true;
}

/** @brief True if something stands on the ray that lets no light through (scene_sees). */
static inline bool scene_occluded(const scene *s, const ray *r)
{
    return accel_occluded(s->accel, r);
}

/** @brief The solids that a point is in: those that more surfaces of are left than
 * entered on the way out, by most of a few ways. Bodies that are not closed may be
 * missed. */
medium_stack scene_solids_at(const scene *s, vec3 p);

/** @brief True if something in the scene may be in a participating medium. */
static inline bool scene_has_media(const scene *s)
{
    return s->media->len > 0;
}

/** @brief The participating medium of that number (medium_stack); NULL of 0. */
static inline const medium *scene_medium(const scene *s, uint32_t number)
{
    return number ? s->media->pdata[number - 1] : NULL;
}

/** @brief What absorbs light in the smallest of the solids; NULL: nothing. */
static inline const medium *scene_solid_medium(const scene *s, const medium_stack *in)
{
    return in->solid[0] ? s->solids[in->solid[0]] : NULL;
}

/** @brief Share of light that the solids leave after t metres. */
static inline spectrum scene_solid_transmittance(const scene *s, const medium_stack *in,
                                                 float t, const wavelengths *w)
{
    return medium_transmittance(scene_solid_medium(s, in), t, w);
}

/** @brief True unless all is dark: there is no light, or all that there is is black. */
static inline bool scene_is_lit(const scene *s)
{
    return distribution_total(&s->light_power) > 0.0;
}

static inline const instance *scene_instance(const scene *s, int i)
{
    return &g_array_index(s->instances, instance, (guint)i);
}

/** @brief Bounds of what an instance puts somewhere, on all of its way. */
box3 scene_placed_bounds(const scene *s, const instance *is, box3 box);
/** @brief How many times the area of what an instance puts somewhere becomes by that, by
 * the mean of directions, at the opening of the shutter. */
double scene_instance_growth(const scene *s, const instance *is);

/** @brief True if the hit is on something that moves while the shutter is open. */
static inline bool scene_hit_moves(const scene *s, const surface_hit *hit)
{
    return hit->instance != NO_INDEX && accel_instance_moves(s->accel, hit->instance);
}

/** @brief How what a hit is on moves from the hit's time to another one: identity for
 * what stands still. */
transform scene_motion_to(const scene *s, const surface_hit *hit, float time);
/** @brief Where the axis is that the surface at the hit turns about
 * (surface_hit.camera_facing).
 */
vec3 scene_axis_at(const scene *s, const surface_hit *hit);
/** @brief Where light that arrives at the hit is kept: on that axis, of what
 * camera_facing; else at the hit. */
static inline vec3 scene_hit_place(const scene *s, const surface_hit *hit)
{
    return hit->camera_facing ? scene_axis_at(s, hit) : hit->p;
}
/** @brief Which of the surfaces that turn a hit is on, from 1; 0: it is on none. (The
 * number goes round after 2³² of shapes times instances.) */
uint32_t scene_curve_of(const scene *s, const surface_hit *hit);
/** @brief Pieces of that surface, of all whose axis is within radius of p. */
void scene_pieces_near(const scene *s, const surface_hit *hit, vec3 p, float radius,
                       shape_piece piece, void *data);
/** @brief How many times an area around the hit becomes by that. */
double scene_area_change(const scene *s, const surface_hit *hit, float time);

static inline const light *scene_light(const scene *s, int i)
{
    return s->lights->pdata[i];
}

/** @brief The participating medium around a light, as in a medium_stack.
 * @param n normal there, as light_emission has it */
static inline uint32_t scene_light_medium(const scene *s, int i, vec3 n, vec3 direction)
{
    const medium_interface *around = &scene_light(s, i)->media;
    return dot3(direction, n) < 0.0f ? around->inside : around->outside;
}

/** @brief Puts a ray that light takes from light i into the media there. One that comes
 * from beyond the scene is moved to where the medium around it begins, if there is one,
 * and one that comes through a portal to the portal: what lies before that only casts
 * shadows, as in pbrt-v4.
 * @param n as above
 * @return share of the light that gets there */
spectrum scene_leave_light(const scene *s, int i, vec3 n, const wavelengths *w, ray *r);

/** @brief Index of a light's group, if the scene has groups. */
static inline int scene_light_group(const scene *s, int i)
{
    return scene_light(s, i)->group_index;
}

/** @brief Radiance that the surface itself sends from the hit to wo; zero if it does not
 * shine. */
spectrum scene_emitted(const scene *s, const surface_hit *hit, vec3 wo,
                       const wavelengths *w);
/** @brief True if some light is one that no ray meets: such as a point, or a light of
 * alpha 0. What it sends through glass or by mirrors only photons find. */
bool scene_has_delta_lights(const scene *s);
/** @brief True if some light is none of these. */
bool scene_has_lights_to_see(const scene *s);
/** @brief Lobe classes and sides that may occur on what was hit, which has a material. */
unsigned scene_possible_lobes(const scene *s, const surface_hit *hit);
/** @brief Lobe classes and sides of the surface at the hit or beside it: a mixture is one
 * material here and another a hair away, where the eye may gather what landed here. */
unsigned scene_lobes_around(const scene *s, const surface_hit *hit, const bsdf *b);
/** @brief The bsdf at a hit. @return false if the hit has no material (an interface). */
bool scene_bsdf(const scene *s, const surface_hit *hit, const wavelengths *w,
                int wavelength, const bsdf_options *options, bsdf *out);
/** @brief A direction from ref to light i. @return false if none reaches ref that way. */
bool scene_sample_one_light(const scene *s, int i, const wavelengths *w, vec3 ref,
                            float u_primitive, vec2 u, light_sample *out);
/** @brief One light, by about what it sends to ref, and a direction to it. *light gets
 * its index; out->pdf includes the probability of the choice. @return false if no light
 * reaches ref that way.
 */
bool scene_sample_light(const scene *s, const wavelengths *w, vec3 ref, float u_light,
                        float u_primitive, vec2 u, int *light, light_sample *out);
/** @brief pdf_solid_angle with which scene_sample_one_light gives direction wi for light
 * i, which wi meets at `hit` (an area light) or, with hit NULL, beyond the scene (an
 * environment). */
float scene_one_light_pdf(const scene *s, int i, vec3 ref, vec3 wi,
                          const surface_hit *hit);
/** @brief The same for scene_sample_light: includes the choice of light i. */
float scene_light_pdf(const scene *s, int i, vec3 ref, vec3 wi, const surface_hit *hit);
