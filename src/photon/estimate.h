/*
 * The radiance estimate (Jensen 2001, §7): reflected radiance from the photons around a
 * point.
 *
 *   L(x, wo) = Σ f(x, wi_p, wo) |wi_p·n|/|wi_p·n_geom| κ(d_p) Φ_p / ∫∫ κ(s) s ds dθ
 *
 * f is the full BSDF of the gathered lobes. The cosine ratio makes photons (a density
 * over the true surface) see the shading normal as light does. Unless the BSDF transmits,
 * photons that arrived on the far side of the surface are not seen at all: they weigh
 * nothing and never shrink the radius.
 *
 * Of the k nearest, the k-th tells how far r reaches and is not counted: given r, the
 * other k-1 lie evenly in the disc, so that the sum is on average (k-1)/(π r²) times
 * their flux whatever the kernel, and E[(k-1)/(π r²)] is the density of photons, as π r²
 * times it is a sum of k exponential variables and E[1/that] = 1/(k-1). It takes two
 * photons at least. With the k-th counted a constant kernel would show k/(k-1) times the
 * light.
 */
#pragma once

#include "photon/flat_curve.h"
#include "photon/looked_around.h"
#include "photon/photon_map.h"

/** @brief How to estimate. */
typedef struct estimate_options {
    kernel kernel;
    size_t nearest; /**< k >= 2; 0: all within radius */
    float radius;   /**< m; with k nearest the largest allowed (INFINITY: none), and the
                       one used when fewer than k are found in it */
    float flatten;  /**< photons further than flatten * r from the tangent plane are left
                       out, without shrinking r (see photon_filter); 1: a ball */
    const scene *scene;      /**< to find edges, corners and thin walls with (see
                                neighbourhood.h); NULL: the disc is taken as whole */
    float time;              /**< of the shutter, at which they are looked for */
    bool shares_looks;       /**< with queries nearby: scratch->looked is of the pixel */
    float looked_share;      /**< of the radius, within which they are looked for: what
                                narrower discs would take, not what they say; 0: of all */
    const flat_curve *curve; /**< that the point is on; NULL: on none */
    unsigned lobes;          /**< used for all photons, e.g. LOBE_GATHERED */
    unsigned
        delta_lobes; /**< added for photons flagged PHOTON_FROM_DELTA, e.g. LOBE_GLOSSY */
} estimate_options;

/** @brief Scratch of one thread, reused from query to query: zero-initialise, clear at
 * the end. */
typedef struct estimate_scratch {
    point_hits hits;
    uint64_t n_queries, n_looks; /**< of maps and spots so far, and short rays for
                                    edges */
    uint64_t n_weighed;          /**< photons, once for each number that they were
                                    weighed by: a kernel's, or a BSDF's wavelengths */
    looked_around looked;        /**< what queries that share their looks have seen */
    bool failed;      /**< memory was refused in a query, which then gave zero */
    spectrum *groups; /**< owned, big_alloc'ed; each query leaves there what the photons
                         of each tag gave of the result */
    size_t n_groups;  /**< 0: not asked for; else the map's store must be tagged */
} estimate_scratch;

/** @brief Memory was refused since it was set up: something was estimated in part. */
static inline bool estimate_scratch_refused(const estimate_scratch *scratch)
{
    return scratch->failed || scratch->hits.refused;
}

/** @brief Asks for results apart by tags below n, if n is not 0. */
bool estimate_scratch_init(estimate_scratch *scratch, size_t n_groups, GError **error);

void estimate_scratch_clear(estimate_scratch *scratch);

/** @brief What an estimate saw, for statistics and the inspector. */
typedef struct estimate_info {
    size_t n_photons; /**< that weighed in */
    float radius;     /**< used, m */
} estimate_info;

/** @brief Radiance leaving hit point p toward wo. info may be NULL. */
spectrum photon_estimate(const photon_map *map, vec3 p, const bsdf *b, vec3 wo,
                         const estimate_options *options, estimate_scratch *scratch,
                         estimate_info *info);

/** @brief Irradiance at p on the side of n_geom, W m⁻² nm⁻¹ (no BSDF). */
spectrum photon_irradiance(const photon_map *map, vec3 p, vec3 n_geom,
                           const estimate_options *options, estimate_scratch *scratch,
                           estimate_info *info);
