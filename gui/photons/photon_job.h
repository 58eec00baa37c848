/*
 * Tracing photons for the photon view, on a thread of its own, beside a render or without
 * one.
 */
#pragma once

#include "photons/photon_cloud.h"

#include <gio/gio.h>

/** @brief What came of it. */
typedef struct photon_result {
    held_photons *photons;
    photon_cloud *cloud;
} photon_result;

void photon_result_free(photon_result *result);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(photon_result, photon_result_free)

/** @brief What a render would be of, whose photons are wanted. Borrowed. */
typedef struct photon_wish {
    held_scene *scene;
    const NephSettings *settings;
    const NephCamera *camera;
    int width, height;
} photon_wish;

/** @brief Begins; done is called in the main loop, also when cancelled. */
void photon_job_start(const photon_wish *wish, GCancellable *cancellable,
                      GAsyncReadyCallback done, void *data);
/** @brief To be called in done: owned by the caller, NULL with *error. */
photon_result *photon_job_finish(GAsyncResult *result, GError **error);
