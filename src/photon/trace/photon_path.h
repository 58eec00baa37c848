/*
 * One photon's path, by stages; trace.c leads it from one to the next:
 *
 *   photon_start.c ─► photon_medium.c ─► photon_land.c ─► photon_scatter.c ─┐
 *                       ▲                                                   │
 *                       └───────────────────────────────────────────────────┘
 *
 * Its flux is set where it starts, and changes where it scatters, on a surface or in a
 * medium, and by roulette alone (photon_path.c).
 */
#pragma once

#include "photon/trace/trace.h"
#include "photon/trace/trace_chunk.h"
#include "scene/advance.h"

/** @brief One photon on its way. */
typedef struct photon_path {
    const trace_task *task;
    uint64_t index;
    const sampler_ahead *ahead; /* numbers that it starts with; NULL: none are known */
    sampler random;
    path_segment at;
    int light;
    float mis_weight; /* of its light that it carries */
    caustic_end end;  /* the light's end of it, as far as is known: for its MIS weight */
    uint32_t primitive;  /* of the light */
    bool from_delta;     /* the light cannot be hit by a ray */
    bool specular_only;  /* no lobe but SPECULAR so far */
    unsigned n_followed; /* specular or glossy bounces; straight through panes is none */
    unsigned n_diffuse;
    unsigned n_after;    /* followed bounces since the last diffuse one */
    unsigned n_in_media; /* scatterings in media */
    trace_chunk *out;    /* NULL when telling */
    void (*tell)(const photon_event *event, void *data);
    void *tell_data;
} photon_path;

/** @brief Tells who listens what happened, at a hit or (NULL) where the path is. */
void photon_path_tell_flux(const photon_path *path, photon_event_kind kind,
                           const surface_hit *hit, unsigned lobe, spectrum flux);

/** @brief The same of the path's own flux. Nearly always nobody listens. */
static inline void photon_path_tell(const photon_path *path, photon_event_kind kind,
                                    const surface_hit *hit, unsigned lobe)
{
    if (path->tell)
        photon_path_tell_flux(path, kind, hit, lobe, path->at.throughput);
}

/** @brief Whether a photon that lands now is of the class that is traced. */
bool photon_path_is_wanted(const photon_path *path);

/** @brief Whether it goes on by any lobe after it has landed as a caustic: if caustics
 * are shared with paths, the light of a bright spot that glass throws elsewhere is one
 * too. */
bool photon_path_goes_on(const photon_path *path);

/** @brief With which probability a photon whose flux becomes this lives on by its power.
 */
float photon_path_survival(const photon_path *path, spectrum flux);

/** @brief Roulette by the number u: gives the photon a new flux, or ends it (false). */
bool photon_path_survives(photon_path *path, spectrum flux, float survival, float u);

/** @brief The random numbers of a photon. */
sampler photon_stream(const trace_task *task, uint64_t index);

/** @brief Emits the photon that path->index is. @return false: this one carries nothing
 */
bool photon_path_start(photon_path *path);

/** @brief Stores it, if its class is the one traced and the surface has a lobe for it. */
void photon_path_land(photon_path *path, const surface_hit *hit, const bsdf *b);

/** @brief The lobes that a photon of this class may take on its way: a caustic one has
 * only met specular and glossy ones, or goes on after it has landed; a direct one goes
 * straight through panes.
 */
unsigned photon_path_lobes(const photon_path *path);

/** @brief Where only survivors are stored, a photon has its roulette before it lands: by
 * the share of it that the surface sends on. */
bool photon_path_survives_landing(photon_path *path, const surface_hit *hit,
                                  const bsdf *b);

/** @brief Scatters at the hit. @return false if the photon's path ends here */
bool photon_path_scatter(photon_path *path, const surface_hit *hit, const bsdf *b);

/** @brief Takes a photon through its medium, where it leaves another of the volume map;
 * a scene_traveller's cross_medium. One that no diffuse lobe would take goes straight on,
 * as far as its light does. */
scene_event photon_path_cross_medium(void *photon_path, float length,
                                     const surface_hit *behind, surface_hit *at);
