/*
 * Lights: emission of photons, sampling toward a point, densities and power. One file and
 * one row of the kinds table each.
 *
 * Radiance, intensity and the rest are spectral, per nm, and scaled as pbrt-v4 scales
 * them: "rgb L" [1 1 1] has Y = 1.
 */
#pragma once

#include "light/light_tree.h"
#include "math/box.h"
#include "math/cone.h"
#include "math/transform.h"
#include "medium/hit.h"
#include "params/build_context.h"
#include "params/params.h"
#include "shape/shape.h"

typedef struct light light;

/** @brief A photon leaving a light. */
typedef struct light_emission {
    ray ray;
    vec3 n; /**< normal at the origin if on a surface; for distant and infinite lights,
                 ray.direction */
    spectrum flux; /**< Le cosθ / (pdf_position pdf_direction): Σ over N emissions of flux
                      / N is the light's power */
    float pdf_position;  /**< m⁻² (1 for a point light) */
    float pdf_direction; /**< sr⁻¹ (1 for a distant light) */
    uint32_t primitive;  /**< of an area light's mesh, where it left */
} light_emission;

/** @brief Light arriving at a point from one direction. */
typedef struct light_sample {
    vec3 wi;           /**< from the point to the light */
    float distance;    /**< m, INFINITY for distant and infinite lights */
    spectrum radiance; /**< Li; for delta lights the irradiance on a plane facing wi */
    float pdf;         /**< pdf_solid_angle; 1 for delta lights */
    vec3 n;            /**< geometric normal of an area light there; else -wi */
} light_sample;

/** @brief Chooses a target once it is known where a ray starts. */
typedef struct light_aim {
    vec3 (*target)(void *data, vec3 start);
    void *data;
} light_aim;

typedef struct light_kind {
    const char *name;       /**< as scenes say it; others may have the same */
    const char *parameters; /**< those it reads, with spaces between */
    /** Tells kinds of one name apart by their parameters, none of which it marks used;
     * NULL: always meant. The first in the table that is meant is made. */
    bool (*is_meant)(const params *p);
    bool is_delta;       /**< without an extent: point, spot, distant */
    bool is_environment; /**< shines from beyond the scene */
    bool is_parallel;    /**< emit_toward is given a direction and leaves the place across
                            the    ray open: distant and infinite lights */
    /** From parameters; area lights get their shape, others NULL. */
    void *(*create)(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error);
    void (*free)(void *self);
    /** Told the scene's bounding sphere before rendering. May be NULL. */
    void (*prepare)(void *self, vec3 center, float radius);
    /** Power (W per nm), over both sides if two-sided. */
    spectrum (*power)(const void *self, const wavelengths *w);
    /** Where it is and how strongly it shines in its main direction. */
    light_bound (*bound)(const void *self, const wavelengths *w);
    /** Emits by its own density: position first, then direction. */
    bool (*emit)(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out);
    /** Emission density for a given start and direction, for MIS: pdf_position,
     * pdf_direction. */
    void (*emit_pdf)(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction);
    /** A start toward a fixed target point y instead: for the aimed modes. Samples a
     * position by the light's own density (for environment: a direction), and aims the
     * ray at y. flux is Le cosθ / pdf_position (for distant/infinite: radiance or
     * irradiance over the density of the direction), still to be divided by the density
     * of the aimed direction (for distant/infinite: of the position across the ray).
     * The ray is filled in also where nothing is sent that way. */
    bool (*emit_toward)(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out);
    /** emit_toward a target that depends on the start, of lights whose start is costly to
     * find: aim is told where a ray toward `center` would start. NULL: emit_toward may as
     * well be asked twice. */
    bool (*emit_aimed)(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                       vec3 center, const light_aim *aim, light_emission *out);
    bool (*sample)(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out);
    /** pdf_solid_angle of `sample` for a hit on the light's shape (area) seen from ref.
     */
    float (*pdf)(const void *self, vec3 ref, vec3 wi, const surface_hit *hit);
    /** Radiance leaving the hit toward wo (area lights); NULL otherwise. */
    spectrum (*radiance)(const void *self, const surface_hit *hit, vec3 wo,
                         const wavelengths *w);
    /** Radiance arriving at p from direction d (environment); NULL otherwise. */
    spectrum (*environment)(const void *self, vec3 p, vec3 d, const wavelengths *w);
    /** The cone that all its light stays in, from the point that it leaves; NULL: light
     * goes everywhere. */
    cone3 (*beam)(const void *self);
    /** False if no light comes along this ray, which emit_toward's direction was given
     * another start: behind a portal. *begins gets the distance along it from which on
     * its light is there, and before which things only cast shadows; -INFINITY: it is
     * all along. NULL: light comes everywhere, and all along. */
    bool (*admits)(const void *self, const ray *r, float *begins);
} light_kind;

struct light {
    const light_kind *kind;
    void *self;
    source_place place;
    char *group;            /**< light group's name, NULL: the default one */
    int group_index;        /**< in scene->light_groups, if there are any */
    medium_stack inside;    /**< that it shines in; no participating medium */
    medium_interface media; /**< around it */
    bool is_delta;          /**< no ray can meet it: without an extent, or of alpha 0 */
};

/** @brief Kind number i of the table; NULL behind the last. */
const light_kind *light_kind_at(size_t i);
/** @brief The parameters that every light has. */
#define LIGHT_PARAMETERS "group"

light *light_new(const build_context *context, const char *kind, const params *p,
                 const transform *to_world, const shape *on, GError **error);
void light_free(light *l);
