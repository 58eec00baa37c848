/*
 * Neighbourhoods: which part of the disc around a point is the same surface and in sight
 * of it.
 *
 * The estimate divides by the area of a disc. Near an edge or a corner part of that disc
 * is no surface, and behind a thin wall it is another room: the estimate would be too
 * dark there, or leak. So short rays look around from a point lifted off the surface,
 *
 *        lifted ·───────────►· along the surface: is there a wall between?
 *               │            │ down: is there a surface, in the plane?
 *     ──────────x────────────q──────
 *
 * Four of them, to the rim, tell whether anything is amiss; where it is, photons are held
 * to the same test and the area is that of the part that passes it.
 *
 * A surface that bends evenly is whole too: a ball of radius r cuts π r² out of a sphere
 * of any size. It is met above or below the plane, where both normals make the same angle
 * with the chord, as on an arc.
 *
 * Without the down of it /neighbourhood/edge and /knob-pictures/edges fail, without the
 * along /neighbourhood/wall, without the arc /neighbourhood/bent. bench/edges says what
 * it is worth.
 */
#pragma once

#include "photon/kernel.h"
#include "scene/scene.h"

/** Of a circle, two an octant, which signs and tangents tell apart
 * (neighbourhood_sector). */
enum { NEIGHBOURHOOD_SECTORS = 16 };

/** @brief A side of the horizon: points with x nx + y ny > c lie within. */
typedef struct horizon_side {
    float nx, ny, c;
} horizon_side;

/** @brief A disc to be looked at. Those before frame are the caller's; thread-safe. */
typedef struct neighbourhood {
    const scene *scene;
    vec3 p, n;        /**< centre, unit geometric normal on the side that is seen */
    float radius;     /**< m */
    float time;       /**< of the shutter, at which it is looked at */
    uint32_t n_looks; /**< rays sent so far; the caller's zero */
    frame frame;      /**< turned by an angle of its own for every place */
    float offset;     /**< of the places looked at, 0..1, of its own for every place */
    /** How far one sees along the surface, in the frame's plane: the sides of a polygon
     * around the centre, one a sector. */
    horizon_side side[NEIGHBOURHOOD_SECTORS];
} neighbourhood;

/** Height over radius within which a surface counts as the disc's. In bench/edges relMSE
 * with half and twice as much is 1.4 and 0.9 times as much of indirect light at the
 * widest radius, 1.15 and 1.0 of all, alike at the narrower two (one pass of each). */
#define NEIGHBOURHOOD_FLATTEN 0.03f

/** What was found at a place, looks or light, serves others that lie so far off, over the
 * radius. At a straight edge coverage differs there by a sixth, one way as often as the
 * other; with 0.5 it is 1.6 % too dark beside one. Light kept at twice that distance
 * leaks
 * (/transport, /flat-curves). */
#define SHARED_REACH 0.25f

/** @brief True if looks at the rim find nothing amiss; comes before the other calls. */
bool neighbourhood_is_whole(neighbourhood *hood);

/** @brief Finds the horizon, and gives the share of the kernel's area that is surface in
 * sight, in (0, 1]. After it neighbourhood_sees may be asked. */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k);

/** @brief The sector, a sixteenth of the circle, that (x, y) lies in: its quadrant, and
 * there between the tangents of the sectors. */
static inline int neighbourhood_sector(float x, float y)
{
    const float tangent = (float)(M_SQRT2 - 1.0); /* of a sixteenth */
    int left = x < 0.0f, below = y < 0.0f, odd = left ^ below;
    float across = odd ? fabsf(y) : fabsf(x), up = odd ? fabsf(x) : fabsf(y);
    int within = (up > tangent * across) + (up > across) + (tangent * up > across);
    return 8 * below + 4 * odd + within;
}

/** @brief True if q, a point near the plane, lies within the horizon. */
static inline bool neighbourhood_sees(const neighbourhood *hood, vec3 q)
{
    vec3 d = q - hood->p;
    float x = dot3(d, hood->frame.s), y = dot3(d, hood->frame.t);
    const horizon_side *side = &hood->side[neighbourhood_sector(x, y)];
    return x * side->nx + y * side->ny > side->c;
}
