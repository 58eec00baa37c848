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
 * No photons are kept on mirrors and clear glass: they are no surface, and glass that
 * lies along the disc, a pane in a wall or the foot of a glass on a table, is looked
 * through for what is. Else the wall around a pane would be dark.
 *
 * A surface that bends evenly is whole too: a ball of radius r cuts π r² out of a sphere
 * of any size. It is met above or below the plane, where both normals make the same angle
 * with the chord, as on an arc.
 *
 * Without the down of it /neighbourhood/edge and /knob-pictures/edges fail, without the
 * along /neighbourhood/wall, without the arc /neighbourhood/bent, with panes as surfaces
 * /neighbourhood/flush. bench/edges says what it is worth.
 */
#pragma once

#include "photon/kernel.h"
#include "photon/map/query.h"
#include "scene/scene.h"

/** Of a circle, two an octant, which signs and tangents tell apart
 * (neighbourhood_sector). */
enum { NEIGHBOURHOOD_SECTORS = 16 };

/** @brief The sides of a horizon: points of a sector with x nx + y ny > c lie within. */
typedef struct horizon {
    float nx[NEIGHBOURHOOD_SECTORS], ny[NEIGHBOURHOOD_SECTORS], c[NEIGHBOURHOOD_SECTORS];
} horizon;

/** @brief A disc to be looked at. Those before frame are the caller's; thread-safe. */
typedef struct neighbourhood {
    const scene *scene;
    vec3 p, n;        /**< centre, unit geometric normal on the side that is seen */
    float radius;     /**< m */
    float time;       /**< of the shutter, at which it is looked at */
    uint32_t n_looks; /**< rays sent so far; the caller's zero */
    frame frame;      /**< turned by an angle of its own for every place */
    float offset;     /**< of the places looked at, 0..1, of its own for every place */
    /** How far one sees along the surface, in the frame's plane: a polygon around the
     * centre, a side each sector. */
    horizon horizon;
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

/** Of a sixteenth of the circle. */
#define SECTOR_TANGENT ((float)(M_SQRT2 - 1.0))

/** @brief The sector, a sixteenth of the circle, that (x, y) lies in: its quadrant, and
 * there between the tangents of the sectors. */
static inline int neighbourhood_sector(float x, float y)
{
    int left = x < 0.0f, below = y < 0.0f, odd = left ^ below;
    float across = odd ? fabsf(y) : fabsf(x), up = odd ? fabsf(x) : fabsf(y);
    int within =
        (up > SECTOR_TANGENT * across) + (up > across) + (SECTOR_TANGENT * up > across);
    return 8 * below + 4 * odd + within;
}

/** @brief The same of some points. */
static inline lane_ints neighbourhood_sectors(lane_floats x, lane_floats y)
{
    const lane_ints left = x < 0.0f, below = y < 0.0f, odd = left ^ below;
    const lane_ints flat = (lane_ints)abs_lanes(x), steep = (lane_ints)abs_lanes(y);
    lane_floats across = (lane_floats)((odd & steep) | (~odd & flat));
    lane_floats up = (lane_floats)((odd & flat) | (~odd & steep));
    lane_ints within =
        (up > SECTOR_TANGENT * across) + (up > across) + (SECTOR_TANGENT * up > across);
    return -(8 * below + 4 * odd + within); /* true is -1 */
}

/** @brief True if q, a point near the plane, lies within the horizon. */
static inline bool neighbourhood_sees(const neighbourhood *hood, vec3 q)
{
    vec3 d = q - hood->p;
    float x = fused_dot3(d, hood->frame.s), y = fused_dot3(d, hood->frame.t);
    int i = neighbourhood_sector(x, y);
    return fused(y, hood->horizon.ny[i], x * hood->horizon.nx[i]) > hood->horizon.c[i];
}

/** @brief Of those points in bits, the bits of those that lie within the horizon; the
 * point of a lane is index[lane], also where its bit is not set. The same bits as
 * neighbourhood_sees. */
static inline unsigned neighbourhood_sees_of(const neighbourhood *hood,
                                             const point_arrays *points,
                                             const uint32_t *index, unsigned bits)
{
    const lane_vec3 d = {gather_float_lanes(points->x, index) - hood->p[0],
                         gather_float_lanes(points->y, index) - hood->p[1],
                         gather_float_lanes(points->z, index) - hood->p[2]};
    lane_floats x = dot3_lanes(d, hood->frame.s), y = dot3_lanes(d, hood->frame.t);
    lane_ints i = neighbourhood_sectors(x, y);
    lane_floats reach = fused_lanes(y, pick_lanes(hood->horizon.ny, i),
                                    x * pick_lanes(hood->horizon.nx, i));
    return bits & bits_below(pick_lanes(hood->horizon.c, i), reach);
}
