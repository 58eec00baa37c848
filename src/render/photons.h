/*
 * Photons alone: traced and shown without a picture, or told event by event.
 */
#pragma once

#include "color/wavelengths.h"
#include "photon/trace.h"
#include "render/render.h"
#include "transport/transport.h"

/** @brief Whose photon one is: found by following the paths once more. */
typedef struct photon_origin {
    uint32_t path;    /**< which emitted photon of its class */
    uint32_t bounces; /**< scatterings before it landed */
} photon_origin;

/** @brief The photons of pass 0. */
typedef struct render_photons {
    photon_store stores[N_PHOTON_CLASSES];   /**< on surfaces */
    photon_store in_media[N_PHOTON_CLASSES]; /**< scattered in media */
    wavelengths w;
    render_statistics statistics; /**< radius: only once followed */
    transport_plan plan;
    photon_origin *origins[N_PHOTON_CLASSES]; /**< one a photon, those in media last; NULL
                                                 until followed */
    bool has_radii;
} render_photons;

/** @brief Traces what a render with these settings would, with the direct class also
 * where the render itself would not need it. Owned by the caller.
 * @param cancel may be NULL */
render_photons *render_trace_photons(const scene *s, const settings *how,
                                     const cancel_flag *cancel, GError **error);
/** @brief Photons of a class, on surfaces and in media. */
size_t render_photons_count(const render_photons *p, photon_class c);
/** @brief Photon i of a class: those on surfaces come first. */
photon render_photons_get(const render_photons *p, photon_class c, size_t i);
/** @brief Finds the origin of every photon, and the radius of each class that a render
 * would gather within. Costs about what tracing did. */
bool render_photons_follow(render_photons *p, const cancel_flag *cancel, GError **error);
/** @brief The task that the photons of a class came from; borrows from p. */
trace_task render_photons_task(const render_photons *p, photon_class c);
void render_photons_free(render_photons *p);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(render_photons, render_photons_free)

/** @brief The story of the first n photons of each class, a line an event. */
bool render_photon_story(const scene *s, const settings *how, size_t n,
                         void (*write)(const char *line, void *data), void *data,
                         GError **error);
