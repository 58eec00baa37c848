/*
 * Photons as arrays to draw: where they lie, whence they came, their colour.
 *
 * Made on a worker, immutable but for the colours; photons of a map lie together, so that
 * a map is shown or hidden by drawing its range or not.
 */
#pragma once

#include "session/held.h"

typedef enum cloud_coloring {
    COLOR_FLUX,   /**< linear flux over its largest component */
    COLOR_MAP,    /**< direct, indirect, caustic */
    COLOR_BOUNCE, /**< how often it was scattered before */
    COLOR_POWER,  /**< flux, over the largest component of all photons */
    N_CLOUD_COLORINGS
} cloud_coloring;

extern const char *const cloud_coloring_names[]; /**< for people, NULL-terminated */

/** @brief What the graphics card reads. */
typedef struct cloud_vertex {
    float position[3];
    uint8_t color[4];
} cloud_vertex;

typedef struct photon_cloud {
    size_t n;
    size_t first[NEPH_N_PHOTON_CLASSES +
                 1]; /**< photons of map c: first[c] .. first[c + 1] */
    cloud_coloring coloring;
    cloud_vertex *vertices;
    float (*direction)[3]; /**< to where it came from */
    float (*rgb)[3];
    uint8_t *bounces; /**< 255: that or more */
} photon_cloud;

/** @brief All photons, coloured by flux. */
photon_cloud *photon_cloud_new(const NephPhotons *photons);
void photon_cloud_free(photon_cloud *cloud);
void photon_cloud_color(photon_cloud *cloud, cloud_coloring coloring);
/** @brief The colour of a map. */
void photon_cloud_map_color(int c, uint8_t color[4]);
/** @brief So many bounces have colours; the last is that of more, too. */
enum { N_BOUNCE_COLORS = 7 };
void photon_cloud_bounce_color(size_t bounces, uint8_t color[4]);

/** @brief The vertices, those of a map in an order in which any first part of them is
 * spread over the whole; owned by the caller. */
cloud_vertex *photon_cloud_mixed(const photon_cloud *cloud);

/** @brief Arrows for the photons of the maps in mask (bit c), from where it landed
 * toward where it came from, as a list of line ends; owned by the caller. *n: number of
 * vertices. */
cloud_vertex *photon_cloud_arrows(const photon_cloud *cloud, unsigned mask, float length,
                                  size_t *n);
/** @brief Photons of the maps in mask. */
size_t photon_cloud_count(const photon_cloud *cloud, unsigned mask);

/** @brief The foremost photon of the maps in mask that is seen within reach of a place of
 * the picture (0..1, reach as share of its height; aspect: width over height). false:
 * none.
 */
bool photon_cloud_pick(const photon_cloud *cloud, unsigned mask, const NephCamera *camera,
                       const double place[2], double reach, size_t *index);
