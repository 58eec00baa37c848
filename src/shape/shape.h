/*
 * Shapes. Curved ones are intersected exactly (in double precision), never tessellated:
 * caustics show every facet.
 */
#pragma once

#include "math/box.h"
#include "math/mesh.h"
#include "math/transform.h"
#include "medium/hit.h"
#include "params/params.h"
#include "texture/texture.h"

/** @brief Where a shape stands and what it is made of. */
typedef struct shape_place {
    transform to_world;
    bool reverse_orientation;
    int material;             /**< index in scene->materials, or NO_INDEX */
    const params *area_light; /**< borrowed; NULL: does not shine */
    bool camera_hidden;       /**< rays straight from the camera pass it unseen */
    const float_input *alpha; /**< copied; the share of rays that the surface stops, by
                                 place; NULL: all */
} shape_place;

/** @brief A point drawn on a shape. */
typedef struct shape_sample {
    vec3 p, n; /**< n: geometric normal, as surface_hit's n_geom */
    vec2 uv;
    uint32_t primitive;
    const mesh *mesh; /**< mesh and corners as in surface_hit */
    vec2 corners;
    float pdf;   /**< per area (m⁻²) or per solid angle, by the call that made it */
    float error; /**< as in surface_hit */
} shape_sample;

typedef struct shape shape;

/** @brief Takes a piece of what turns about an axis: the middle of the piece of axis and
 * the area that it shows to a ray across it, m². */
typedef void (*shape_piece)(vec3 middle, float area, void *data);

/** @brief What a kind of shape must do; one of traced by Embree as triangles or by
 * intersect. */
typedef struct shape_kind {
    const char *name;       /**< "sphere" */
    const char *parameters; /**< names, blank-separated, for the manual */
    /** What create makes is of that kind; NULL: of this one. */
    const struct shape_kind *becomes;
    bool may_be_flat; /**< its points are moved to the world one by one, which a transform
                         that flattens does as well */
    /** From parameters. NULL with ERROR_INPUT. */
    void *(*create)(const params *p, const shape_place *at, GError **error);
    void (*free)(void *self);
    box3 (*bounds)(const void *self);
    /** The mesh to hand to Embree; NULL for kinds with intersect. */
    const mesh *(*triangles)(const void *self);
    /** Nearest t in (t_min, t_max), with u and v; NULL for meshes. */
    bool (*intersect)(const void *self, uint32_t primitive, const ray *r, float t_min,
                      float tuv[3]);
    /** Of kinds with intersect; NULL: one primitive, with the bounds of all. */
    size_t (*n_primitives)(const void *self);
    box3 (*primitive_bounds)(const void *self, uint32_t primitive);
    /** Of kinds with intersect whose primitives are parallelograms, u and v along their
     * sides: triangles 2 i, with corners (0,0) (1,0) (1,1), and 2 i + 1, with (0,0) (1,1)
     * (0,1), make up primitive i. *out borrows. false: they are none. NULL: they never
     * are. */
    bool (*halves)(const void *self, mesh *out);
    /** Fills p, n_geom, n, dpdu, uv from the primitive and Embree's or intersect's u, v.
     */
    void (*fill_hit)(const void *self, const ray *r, float u, float v, surface_hit *hit);
    float (*area)(const void *self); /**< m² in world space, one side */
    /** Uniform by area; pdf per area. */
    shape_sample (*sample_area)(const void *self, float u_primitive, vec2 u);
    /** Toward ref; pdf per solid angle at ref. NULL: made from sample_area. */
    bool (*sample_toward)(const void *self, vec3 ref, float u_primitive, vec2 u,
                          shape_sample *out);
    /** pdf_solid_angle of sample_toward for a hit on the shape seen from ref. NULL as
     * above. */
    float (*pdf_toward)(const void *self, vec3 ref, const surface_hit *hit);
    /** Of surfaces that turn (surface_hit.camera_facing), else NULL: where their axis is
     * at a hit.
     */
    vec3 (*axis_at)(const void *self, const surface_hit *hit);
    /** ... and short pieces of them, of all whose axis is within radius of p. */
    void (*pieces_near)(const void *self, vec3 p, float radius, shape_piece piece,
                        void *data);
} shape_kind;

struct shape {
    const shape_kind *kind;
    void *self;
    int material;
    int light; /**< index in scene->lights or NO_INDEX */
    bool camera_hidden;
    uint32_t solid;         /**< that it bounds, as in a medium_stack, once the scene is
                               committed; 0: none */
    medium_interface media; /**< around it when it was added */
    bool parts_media;       /**< they differ */
    bool is_invisible; /**< alpha is 0 everywhere: no ray meets it, but it may shine */
    bool lets_through; /**< it has no material, or light may go straight through that one
                          (bsdf_straight): rays that look for light are not stopped */
    bool has_alpha;
    float_input alpha;
    int object; /**< index in scene->objects it is a part of, or NO_INDEX: the world */
    float area; /**< m², in the space of its object */
    source_place place;
};

/** @brief Name of kind number i of the table; NULL behind the last. */
const char *shape_kind_name(size_t i);
/** @brief What it may be given, blank-separated; NULL as above. */
const char *shape_kind_parameters(size_t i);
/** @brief True if a shape of that kind may stand in a transform that flattens. */
bool shape_may_be_flat(const char *kind);
shape *shape_new(const char *kind, const params *p, const shape_place *at,
                 GError **error);
/** @brief A shape from a mesh in object space (moved to world space here; arrays are
 * taken, also on failure). Checks indices, counts and finiteness, ERROR_INPUT at place
 * otherwise. */
shape *shape_new_mesh(mesh *m, const shape_place *at, source_place place, GError **error);
void shape_free(shape *s);

/** @brief The share of rays that the surface stops at a hit, 0..1. */
static inline float shape_opacity(const shape *s, const surface_hit *hit)
{
    return s->has_alpha ? clampf(float_input_eval(&s->alpha, hit), 0.0f, 1.0f) : 1.0f;
}

/** @brief For kinds that sample by rejection: two uniform numbers and a third for the
 * given attempt, made from u. */
vec2 shape_retry(vec2 u, uint64_t attempt, float *third);

/** @brief pdf_area to pdf_solid_angle at ref; 0 where the surface, with normal n at p, is
 * seen edge on or from itself. */
float shape_to_solid_angle(float pdf_area, vec3 ref, vec3 p, vec3 n);

/** @brief Uniform by area; pdf per area. */
shape_sample shape_sample_area(const shape *s, float u_primitive, vec2 u);
/** @brief Toward ref; pdf per solid angle. false: cannot be seen from there. */
bool shape_sample_toward(const shape *s, vec3 ref, float u_primitive, vec2 u,
                         shape_sample *out);
float shape_pdf_toward(const shape *s, vec3 ref, const surface_hit *hit);
