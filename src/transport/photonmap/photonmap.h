/*
 * Photon mapping (Jensen 1996, 2001): photons are traced from the lights into three maps,
 * and camera paths gather from them at the first diffuse surface.
 *
 * A pass holds the maps; camera.c follows camera paths, final_gather.c makes the indirect
 * light by one more bounce, radius.c chooses radii.
 */
#pragma once

#include "photon/volume_map.h"
#include "transport/transport.h"

extern const photon_sender photonmap_photons;

/** @brief Irradiance at places of surfaces. */
typedef struct irradiance_cache {
    point_arrays places;
    point_index *index;   /**< of the places; all arrays are in its order */
    uint32_t *normal;     /**< packed (direction_pack) */
    spectrum *irradiance; /**< W/m² per nm */
    spectrum *groups; /**< its parts by light groups, [place * n_light_groups + group];
                         NULL without groups */
} irradiance_cache;

void irradiance_cache_free(irradiance_cache *cache);

/** @brief One pass: photons traced, maps built. Const while the camera looks. */
typedef struct photonmap_pass {
    const transport_plan *plan;
    const scene *scene;
    const settings *how;
    uint32_t index; /**< of the pass */
    wavelengths w;
    bsdf_options options;
    unsigned followed; /**< lobes that paths from the eye go on by */
    unsigned gathered; /**< all others, by which photons are gathered */
    int n_slices;      /**< of the shutter's time; 1 where nothing moves */
    photon_map *maps[MOST_TIME_SLICES][N_PHOTON_CLASSES]; /**< NULL: the class is not
                                                             needed */
    /** Of photons in media; NULL: there are none. */
    volume_map *in_media[MOST_TIME_SLICES][N_PHOTON_CLASSES];
    irradiance_cache *irradiance[MOST_TIME_SLICES]; /**< of each slice, for final
                                                       gathering; NULL: not asked for */
    estimate_options estimates[N_PHOTON_CLASSES];
    caustic_mis mis; /**< if plan->uses_mis */
    bool has_delta_lights;
    bool caustics_apart; /**< as of path_pass */
} photonmap_pass;

/** @brief Whether the bsdf has one of the lobes. */
static inline bool has_lobes(const bsdf *b, unsigned lobes)
{
    return (b->lobes & lobes & ~(unsigned)LOBE_ANY_SIDE) != 0;
}

/** @brief Radius of pass i from that of pass 0 (Knaus & Zwicker 2011, eq. 20). */
double photonmap_radius(double radius, double alpha, uint32_t pass);

/** @brief caustic_mis.discs of a pass with that radius. */
float caustic_discs(const transport_plan *plan, double radius);

/** @brief How the given class is to be estimated with radius r. */
estimate_options photonmap_estimate_options(const settings *how, photon_class c,
                                            double radius);

/** @brief The same in a pass at a place, whose radius is its own. @param hits scratch */
estimate_options photonmap_options_at(const photonmap_pass *pass, photon_class c, vec3 p,
                                      point_hits *hits);

/** @brief Radiance toward wo from the photons of one class around the hit. */
spectrum photonmap_gather(const photonmap_pass *pass, photon_class c,
                          const shading_point *at, unsigned delta_lobes,
                          transport_scratch *scratch);

/** @brief The time at which a slice's maps are queried: its middle, 0 where nothing
 * moves.
 */
float photonmap_slice_time(const photonmap_pass *pass, int slice);

/** @brief Follows a camera ray (transport_kind.radiance). */
void photonmap_radiance(const void *pass, const ray *r, sampler *random,
                        transport_scratch *scratch, radiance_sample *out);

/** @brief Indirect radiance toward wo by M rays over the diffuse lobes (final gathering).
 *  scratch->gathered gets the parts of the light groups.
 *  @param importance share of the pixel that this is, 0..1: fewer rays where little
 *  @param events how many times they may scatter, > 0: the last time where they gather;
 *  negative: as often as they like */
spectrum final_gather(const photonmap_pass *pass, const shading_point *at,
                      float importance, int64_t events, sampler *random,
                      transport_scratch *scratch);

/** @brief Finds irradiance at some of the photons of a slice of time, to look the nearest
 * up (Christensen, "Faster Photon Map Global Illumination", 1999): pass->irradiance.
 *  @param points photons stored, oriented, of n classes; every fourth photon was set
 * apart for them */
bool irradiance_cache_build(photonmap_pass *pass, int slice, const trace_result *points,
                            size_t n, GError **error);

/** @brief Sets plan->n_photons: classes with a budget of their own keep it, the rest
 * share `photons` evenly. The casters must have been found. */
void photonmap_share_photons(transport_plan *plan);

/** @brief Chooses plan->radius of each class that is needed. */
bool photonmap_choose_radii(transport_plan *plan, const cancel_flag *cancel,
                            GError **error);
