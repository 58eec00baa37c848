/*
 * The pass loop: plan once, then pass after pass onto the film, until all are done or
 * someone asks to stop.
 */
#pragma once

#include "image/image.h"
#include "photon/photon.h"
#include "scene/scene.h"

/** @brief What a render did so far; the fields of NephStatistics. Seconds, summed over
 * passes. */
typedef struct render_statistics {
    int64_t passes;
    double time_total, time_prepare, time_trace, time_build, time_gather, time_camera;
    uint64_t photon_rays, camera_rays, shadow_rays;
    uint64_t emitted[N_PHOTON_CLASSES], stored[N_PHOTON_CLASSES];
    double radius[N_PHOTON_CLASSES]; /**< m, of the last pass */
    uint64_t memory_peak, memory_photons;
    uint64_t n_not_finite;
} render_statistics;

/** @brief Told on the thread that called; fraction 0..1. @return false to stop. */
typedef bool (*render_progress)(double fraction, const render_statistics *statistics,
                                void *data);

typedef struct render render;

/** @brief Prepares a render of a committed scene, which must outlive it. */
render *render_new(const scene *s, const settings *how, GError **error);
void render_free(render *r);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(render, render_free)
/** @brief Renders the passes that are left. ERROR_CANCELLED when stopped: the film then
 * holds what was done. progress may be NULL. */
bool render_run(render *r, render_progress progress, void *data, GError **error);
/** @brief Asks render_run to stop soon. Any thread, also a signal handler. */
void render_cancel(render *r);
/** @brief The mean of what was rendered so far, with layers and metadata; owned by the
 * caller. */
image *render_image(const render *r, GError **error);
render_statistics render_get_statistics(const render *r);
