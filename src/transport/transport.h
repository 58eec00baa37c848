/*
 * Light transport: one file per algorithm, each a row of one table.
 *
 *   prepare ─► plan (once a render: radii, budgets)
 *   begin_pass(plan, i) ─► pass (photons, maps) ─► radiance(pass, camera ray) ...
 *                                               ─► end_pass
 *
 * A pass is a pure function of (scene, settings, pass number); threads call `radiance` on
 * it at once, each with scratch of its own.
 */
#pragma once

#include "base/parallel.h"
#include "math/sampler.h"
#include "photon/estimate.h"
#include "photon/spots.h"
#include "photon/time_slice.h"
#include "photon/trace/caustic_mis.h"
#include "photon/trace/trace.h"
#include "scene/advance.h"
#include "transport/radius_cache.h"
#include "transport/sketch.h"

/** @brief The layers of the picture. Their sum is the beauty image. */
typedef enum radiance_layer {
    LAYER_DIRECT,   /**< light → surface → eye */
    LAYER_INDIRECT, /**< by at least one diffuse bounce before the seen surface */
    LAYER_CAUSTIC,  /**< light → specular or glossy → seen surface → eye */
    LAYER_SPECULAR, /**< all that is seen by way of a specular or glossy bounce, or of a
                       point in a medium: by what is not the first surface, whose albedo
                       the denoiser divides the layers above by */
    LAYER_EMISSION, /**< lights and environment seen directly */
    N_LAYERS
} radiance_layer;

/** @brief What the denoiser goes by beside light: of the first surface that scatters
 * diffusely or in a lobe with some width, as it is seen by way of mirrors and glass.
 * Sums, where there are several, weighed by how much of their light arrives. */
typedef struct light_guide {
    spectrum albedo;
    spectrum lights; /**< what of LAYER_SPECULAR comes from lights by mirrors, and by
                       sides of glass that are always followed, without any chance:
                       radiance, whatever the weight */
    spectrum glints; /**< likewise by mirrors and glass, where chance chose the way */
    vec3 normal;     /**< shading normal, toward where it is seen from */
    float depth;     /**< distance from the eye as the crow flies, m */
    float weight;    /**< 0: nothing is seen yet */
} light_guide;

/** @brief What one camera ray found. */
typedef struct radiance_sample {
    spectrum layers[N_LAYERS]; /**< radiance */
    spectrum *groups;   /**< the same light, apart by the group of the light it came
                           from: the caller's, zeroed; NULL: not asked for */
    spectrum scattered; /**< what of LAYER_SPECULAR comes straight from lights to a
                           medium, and from there to the eye: by photon mapping, else 0 */
    spectrum albedo;    /**< of the first surface */
    vec3 normal;        /**< shading normal of the first surface, toward the eye */
    float depth;        /**< distance to it, m; 0: none */
    vec3 p, n_geom;     /**< of it; the true normal toward the eye too */
    light_guide guide;
    vec2 uv; /**< of it */
} radiance_sample;

/** @brief Notes the first surface, seen from a point in direction -wo. */
void radiance_sample_note(radiance_sample *out, const surface_hit *hit, const bsdf *b,
                          vec3 wo, vec3 from);

/** @brief Adds a surface to the guide if it ends what is specular.
 * @param eye where the camera ray began @param arrives of the surface's light, mean over
 * wavelengths @return whether it does */
bool radiance_sample_guide(radiance_sample *out, const surface_hit *hit, const bsdf *b,
                           vec3 wo, vec3 eye, float arrives);

/** @brief Adds a light that a path from the eye meets to the guide, if it is seen by way
 * of nothing but mirrors and glass. @param radiance toward where the path has come from
 */
void radiance_sample_light(radiance_sample *out, const path_segment *at,
                           spectrum radiance);

/** @brief Light that a pass found on its way from the lights, at a place of the film. */
typedef struct splat {
    spectrum value; /**< a pass' splats on an area of the film, in pixels, sum up to the
                       integral of radiance over it */
    vec2 raster;
    radiance_layer layer;
    int group; /**< of the light it came from: scene_light_group */
} splat;

/** @brief The splats of a pass, in an order that does not depend on threads. Borrowed. */
typedef struct splat_list {
    const splat *splats;
    size_t n;
} splat_list;

/** @brief A surface point as a camera path meets it. */
typedef struct shading_point {
    const surface_hit *hit;
    const bsdf *bsdf;
    vec3 wo;       /**< to where the path came from */
    bool blurred;  /**< seen by way of a diffuse bounce: edges need not be exact */
    bool in_pixel; /**< others of the pixel lie beside it: looks for edges are shared */
} shading_point;

/** @brief What a pass did, summed over its threads. */
typedef struct transport_counts {
    double time_trace, time_build, time_gather;
    uint64_t photon_rays, camera_rays, shadow_rays, n_not_finite;
    uint64_t emitted[N_PHOTON_CLASSES], stored[N_PHOTON_CLASSES];
    double radius[N_PHOTON_CLASSES];
    uint64_t memory_photons; /**< bytes of the maps */
} transport_counts;

/** @brief From so many bounces on, weak paths from the eye end by chance: a picture has
 * little light that came by more, and what comes by fewer shows each chance as grain.
 * With 2 relMSE x time is 0.9 to 1.2 times as much, 1.06 in the mean; with 8 it is half
 * as much behind a prism, but 1.2 to 1.3 times by auto in glass and at a window (nine
 * scenes, 18 cases, 128 x 128, 4 and 8 passes, three seeds). */
enum { ROULETTE_BOUNCES = 4 };

/** @brief True where clear glass parts a path from the eye that no chance has led there
 * (path_sides), until roulette begins. */
static inline bool path_is_parted(const path_segment *at, unsigned bounces, const bsdf *b)
{
    return at->certain && bounces + 1 < ROULETTE_BOUNCES &&
           b->lobes == (LOBE_SPECULAR | LOBE_ANY_SIDE);
}

/** @brief How the sides of such glass are followed: the one that has more of the light
 * always, so that no path misses a lamp behind panes, and now and then both; of the first
 * glass always. Few paths would find a light that it mirrors by chance, and of few of
 * them a denoiser makes a smear.
 *
 * With the share R of the other's light and both followed as often as q, the usual one
 * weighs 1 alone and 1 - R/q beside the other's R/q: all of it is 1 each time, which has
 * no noise where both see the same, and R² (1 - q)/q of the square of what they differ by
 * where they do not. q = R is one of them by chance; q = √R has .17 of its variance in a
 * pane. */
typedef struct path_sides {
    unsigned usual, other; /**< LOBE_REFLECTION or LOBE_TRANSMISSION */
    float p_both;
    float alone, beside; /**< times the usual one's throughput */
} path_sides;

/** @brief At the bounce after so many, of light toward wo. */
path_sides path_part(unsigned bounces, const bsdf *b, vec3 wo);

/** @brief A point where the camera looks (transport/visible.h). */
typedef struct visible_point {
    vec3 p;
    float pixel;  /**< width of a pixel's footprint there, facing the camera, m */
    float area;   /**< that it covers of the surface, m² */
    float albedo; /**< mean over wavelengths */
    vec2 raster;  /**< where it is on the film */
} visible_point;

/** Of how much there may be of a technique trials compare all and half, beside none. With
 * all alone relMSE x time is 1.1 and 1.2 times as much in two scenes with glass; smaller
 * shares than half gain nothing (six scenes, 128 x 128, 4 and 8 passes, three seeds). */
enum { SHARE_ALL, SHARE_HALF, N_SHARES };
static inline double plan_share(int i)
{
    return i == SHARE_ALL ? 1.0 : 0.5;
}

/** @brief What one of something costs, as trials measured it. */
typedef struct plan_cost {
    double variance; /**< up to a factor that is the same of all that it is compared with
                      */
    double rays;     /**< and what takes as long as rays */
} plan_cost;

/** @brief A technique that was tried. */
typedef struct plan_trial {
    const char *what; /**< static */
    plan_cost without, with;
    bool taken;
} plan_trial;

enum { MOST_PLAN_TRIALS = 4 }; /* size: caustic photons, guide, bright spots, gather */

/** @brief Photons that were traced before, in place of those that a pass would trace. */
typedef struct photon_supply {
    /** Those of a class in a slice of the shutter's time, in order of emission. */
    bool (*take)(const void *data, uint32_t pass, photon_class c, int slice,
                 trace_result *result, GError **error);
    const void *data;
} photon_supply;

/** @brief Decisions taken once, before the first pass: of scene and settings alone, the
 * same on any machine with any number of threads. */
typedef struct transport_plan {
    const scene *scene;
    const view *view; /**< of it */
    settings how;
    double work;       /**< asked for, in rays: a first guess */
    double planning;   /**< rays that trials cost */
    double n_tried;    /**< photons of trials ... */
    double tried_rays; /**< and what they took, in rays */
    plan_trial trials[MOST_PLAN_TRIALS];
    int n_trials;
    visible_point *sight;    /**< where the camera looks; owned; NULL: not looked yet */
    size_t n_sight, n_looks; /**< of them, and of all looks, some of which met nothing */
    sketch *sketch; /**< of the picture (path_effort_measure); owned; NULL: none yet */
    const cancel_flag *cancel; /**< of the render that this is for: once set, passes and
                                  samples end as they are, worth nothing; NULL: never */
    caustic_casters *casters;  /**< owned; NULL: nobody has asked for them yet */
    uint64_t
        n_photons[N_PHOTON_CLASSES]; /**< emitted each pass; 0: the class is not needed */
    double radius[N_PHOTON_CLASSES]; /**< of pass 0, m: everywhere, or the median */
    /** Where the radius is automatic: of pass 0, place by place; owned. NULL: the same
     * everywhere. */
    radius_cache *radius_cache[N_PHOTON_CLASSES];
    /** The same for photons in media. */
    double radius_in_media[N_PHOTON_CLASSES];
    radius_cache *radius_cache_in_media[N_PHOTON_CLASSES];
    /** vcm: how far the nearest vertices of some light subpaths lie, place by place;
     * owned. NULL: not known. */
    radius_cache *vertex_radii;
    size_t n_vertex_paths;                   /**< light subpaths that these are of */
    emission_guide *guide[N_PHOTON_CLASSES]; /**< owned; NULL: none pays */
    double brought[N_PHOTON_CLASSES]; /**< mean square flux, W² nm⁻², that a photon alone
                                         brings, as trials told (aim_photons) ... */
    double price[N_PHOTON_CLASSES]; /**< ... and what it takes, in rays */
    bool uses_mis;                  /**< photons share caustics with paths from the eye */
    caustic_mis mis; /**< their MIS weights before radii are known, for trials */
    float *boost;    /**< caustic_mis.boost; owned */
    const photon_supply *supply; /**< borrowed; NULL: photons are traced */
    lit_place *lit; /**< that light sampling found (path_effort_measure); owned */
    size_t n_lit;
    float looked_share; /**< estimate_options.looked_share, of a trial of few photons */
    float p_spots;      /**< path_pass.p_spots */
    bool gathers;       /**< auto: photons carry indirect light too (plan/gather.h) */
    double path_noise;  /**< variance of a sample by paths, relative as sketch_weight has
                           it: of what no photons bring */
    double alike;       /**< variance of a sample that is alike in neighbouring pixels, by
                           photons of caustics, times what it weighs in the picture */
    double sample_rays; /**< that a sample costs, photons apart ... */
    double photon_rays; /**< and its part of the photons of a pass */
    float p_blurred;    /**< probability of a gather that is seen by way of a diffuse
                           bounce, where photons share */
    float p_blurred_in_media; /**< the same of one along a segment through a medium: about
                                 one such a path */
} transport_plan;

/** @brief Who works for the render that a plan is for. */
static inline workers plan_workers(const transport_plan *plan)
{
    return (workers){(unsigned)plan->how.threads, plan->cancel};
}

/** @brief A plan in which nothing is decided yet. */
transport_plan transport_plan_of(const view *v, const settings *how);
/** @brief Decides all that a render with these settings does alike in every pass; what
 * was decided before is forgotten. Deterministic. */
bool transport_plan_prepare(transport_plan *plan, const cancel_flag *cancel,
                            GError **error);
/** @brief Finds the plan's casters of caustics, if they are not known. */
bool transport_plan_find_casters(transport_plan *plan, GError **error);
/** @brief Frees what the plan owns. */
void transport_plan_clear(transport_plan *plan);

/** @brief One thread's scratch, zero-initialised; counts are added up after the pass. */
typedef struct transport_scratch {
    estimate_scratch estimate;
    uint64_t camera_rays, shadow_rays, n_not_finite;
    bool timed;          /**< the camera sample under way is: its gathers are too */
    int64_t time_gather; /**< microseconds, of gathers in samples that were timed */
    spectrum *gathered;  /**< final_gather's result by light groups; owned */
} transport_scratch;

/** @brief Makes zeroed scratch usable for a scene with so many light groups. */
bool transport_scratch_init(transport_scratch *scratch, size_t n_groups, GError **error);
void transport_scratch_clear(transport_scratch *scratch);

/** @brief Some of the photons of a pass: [begin, end) of a class in a slice of time. */
typedef struct photon_part {
    photon_class c;
    int slice;
    uint64_t begin, end;
} photon_part;

/** @brief The photons of a pass without its picture: sent by what begin_pass sends them
 * with. */
typedef struct photon_sender {
    /** A pass that has sent nothing. */
    void *(*open)(const transport_plan *plan, uint32_t index);
    /** How many are emitted of a class. */
    uint64_t (*count)(const void *pass, photon_class c);
    /** Those of one class, in order of emission; counts are added to. */
    bool (*trace)(const void *pass, photon_class c, const cancel_flag *cancel,
                  transport_counts *counts, trace_result *result, GError **error);
    /** Some of those alone, whose flux is their share of all. NULL: no pass can be made
     * of photons that were traced before. */
    bool (*trace_part)(const void *pass, const photon_part *part,
                       const cancel_flag *cancel, transport_counts *counts,
                       trace_result *result, GError **error);
    /** Tells each event of photon i of a class. Thread-safe. */
    void (*tell)(const void *pass, photon_class c, uint64_t i, photon_listener tell,
                 void *data);
    /** How often all light is in them: once, or in each slice of the shutter's time. */
    int (*n_wholes)(const void *pass);
    void (*close)(void *pass);
} photon_sender;

typedef struct transport_kind {
    const char *name; /**< as the setting `integrator` says it */
    /** Fills the plan's budgets and radii. */
    bool (*prepare)(transport_plan *plan, const cancel_flag *cancel, GError **error);
    /** Makes pass number `index`; counts are added to. */
    void *(*begin_pass)(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error);
    /** Radiance along a camera ray at the pass' wavelengths. Thread-safe. */
    void (*radiance)(const void *pass, const ray *r, sampler *random,
                     transport_scratch *scratch, radiance_sample *out);
    const wavelengths *(*pass_wavelengths)(const void *pass);
    /** What is added to the radiance of camera rays; NULL: nothing. */
    splat_list (*splats)(const void *pass);
    void (*end_pass)(void *pass);
    const photon_sender *photons; /**< NULL: it sends none */
} transport_kind;

#define INTEGRATOR(choice, word) extern const transport_kind transport_##word;
#include "settings/integrator.def"
#undef INTEGRATOR

/** @brief The row for an integrator_choice. */
const transport_kind *transport_find(int integrator);
