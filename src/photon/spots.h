/*
 * Bright spots: where photons landed, as lights to sample.
 *
 *        from
 *         \  \
 *          \  \  ω         a path that leaves a diffuse surface hardly ever finds the
 *           \  \           small spot that a lens makes; but photons know where it is
 *     ──────(===)─────
 *        spot: a disc
 *
 * A few photons, chosen in proportion to their flux, become discs as wide as the way to
 * their neighbours, so that together they cover what is lit. A tree chooses one of them
 * for a point in proportion to about how much it sends there (light_tree.h), and a place
 * on it gives a direction. A ray in this direction counts if it lands at that
 * disc. The density of a direction is the sum over all discs that its ray lands at, so
 * that it can be weighed against others (Veach 1997, §9.2). What light comes from there
 * is not asked here: discs only say where to look.
 */
#pragma once

#include "photon/photon_map.h"

typedef struct photon_spots photon_spots;

/** @brief A place that is lit and lights others. */
typedef struct lit_place {
    float p[3], n[3]; /**< where; unit geometric normal on the side that is lit */
    float power;      /**< up to a factor that is the same of all */
} lit_place;

/** @brief What to make spots of: photons, or places. */
typedef struct spot_source {
    const photon_store *photons; /**< NULL, or they keep no normals: none */
    const lit_place *places;     /**< where there are no photons; NULL: none */
    size_t n_places;
    float least; /**< radius of a spot, m: what an estimate there blurs */
} spot_source;

/** @brief Spots of some sources, as many of each.
 *  @return NULL when memory is refused or, without an error, where nothing is lit */
photon_spots *photon_spots_new(const spot_source *sources, size_t n, GError **error);
void photon_spots_free(photon_spots *spots);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(photon_spots, photon_spots_free)

/** @brief A direction from a point to a spot.
 *  @param u_choice,u uniform in [0,1)
 *  @param spot which it is: for photon_spots_landed
 *  @return false if there is none */
bool photon_spots_sample(const photon_spots *spots, vec3 from, float u_choice, vec2 u,
                         int *spot, vec3 *wi);

/** @brief True if a ray sent to a spot landed there, and not before or behind it. */
bool photon_spots_landed(const photon_spots *spots, int spot, vec3 from, vec3 wi,
                         vec3 landed);

/** @brief pdf_solid_angle with which photon_spots_sample gives direction wi and the ray
 *  then lands there.
 *  @param landed where the ray meets a surface */
float photon_spots_pdf(const photon_spots *spots, vec3 from, vec3 wi, vec3 landed);
