/*
 * The radius cache: radii at some places all over the scene, by how close points lie
 * there. What is asked anywhere is answered by the nearest place.
 */
#pragma once

#include "base/parallel.h"

#include "photon/map/point_set.h"

/** Points whose distance tells how close they lie. With 8 and 32 relMSE x time is 0.95 to
 * 1.04 times as much, but for two plans by auto that one seed turned: 1.13 in glass with
 * 8, 0.54 behind a prism with 32 (nine scenes, 18 cases, 128 x 128, 4 and 8 passes, three
 * seeds). */
enum { RADIUS_NEAREST = 16 };

typedef struct radius_cache radius_cache;

/** @brief Distance to the furthest of the RADIUS_NEAREST points found nearest; of fewer,
 * the distance at which there would be so many, spread as those are; 0 of none. */
float radius_of_nearest(const point_hits *nearest);

/** @brief The same of points that lie in patches, on a surface: where a half or a quarter
 * of them lie so much closer than all do as chance seldom has it, the rest are beyond an
 * edge, and these tell. */
float radius_in_patch(const point_hits *nearest);

/** @brief What radii are made from. Both calls are thread-safe. */
typedef struct radius_source {
    /** Finds the RADIUS_NEAREST points nearest to p. @return false: memory is refused */
    bool (*nearest)(const void *data, vec3 p, point_hits *hits);
    /** The radius at p, from radius_of_nearest or _in_patch there. @param hits scratch */
    float (*radius)(const void *data, vec3 p, float distance, point_hits *hits);
    const void *data;
    bool has_edges;            /**< points lie in patches */
    const cancel_flag *cancel; /**< may be NULL */
} radius_source;

/** @brief At most so many places of a scene are asked about: one for a patch of 14 x 14
 * pixels in a picture of 1024 x 768, or as wide as a sixtieth of what holds the scene.
 * With half and twice as many relMSE x time is 0.97 to 1.05 times as much, with a quarter
 * 0.95 to 1.03 and 1.3 at a window by auto (five scenes, 128 x 128, 32 passes, two
 * seeds). */
enum { MOST_PLACES = 4096 };

/** @brief Of n points, evenly chosen, which is place i of MOST_PLACES or fewer. */
static inline size_t radius_place(size_t i, size_t n)
{
    return n > MOST_PLACES ? i * n / MOST_PLACES : i;
}

/** @brief Finds radii at n places, MOST_PLACES at most, which do not depend on the
 * number of threads. NULL: out of memory. */
radius_cache *radius_cache_build(const vec3 *places, size_t n,
                                 const radius_source *source, unsigned threads,
                                 GError **error);
void radius_cache_free(radius_cache *cache);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(radius_cache, radius_cache_free)

/** @brief From radii that are known, at n places. NULL: out of memory. */
radius_cache *radius_cache_of(const vec3 *places, const float *radii, size_t n,
                              GError **error);

/** @brief How many places there are. */
size_t radius_cache_count(const radius_cache *cache);
/** @brief Place i, in the order in which they were given. */
vec3 radius_cache_place(const radius_cache *cache, size_t i);
/** @brief That of place i, in the order in which they were given. */
float radius_cache_nth(const radius_cache *cache, size_t i);

/** @brief The radius nearest to p, or `none` if none is kept. Thread-safe.
 * @param distance gets that of its place, unless NULL or there is none
 * @param hits scratch */
float radius_cache_at(const radius_cache *cache, vec3 p, float none, float *distance,
                      point_hits *hits);
