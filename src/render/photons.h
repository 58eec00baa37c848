/*
 * Photons alone: traced and shown without a picture, or told event by event. They are
 * those that pass 0 of a render with the same settings stores, by its own plan, had it
 * time and memory enough: what these take away is found by the clock, and by what others
 * leave.
 */
#pragma once

#include "color/wavelengths.h"
#include "photon/trace/trace.h"
#include "render/render.h"
#include "transport/transport.h"

/** @brief Whose photon one is: found by following the paths once more. */
typedef struct photon_origin {
    uint32_t path;    /**< which emitted photon of its class */
    uint32_t bounces; /**< scatterings before it landed */
    float wi[3];      /**< to where it came from, in full; on what moves as it was met */
} photon_origin;

/** @brief The photons of pass 0. */
typedef struct render_photons {
    photon_store stores[N_PHOTON_CLASSES];   /**< on surfaces */
    photon_store in_media[N_PHOTON_CLASSES]; /**< scattered in media */
    wavelengths w;
    render_statistics statistics; /**< emitted: 0 of a class that this render sends not */
    transport_plan plan;
    transport_plan first_plan;   /**< of the first pass: borrows from plan */
    const photon_sender *sender; /**< NULL: the integrator sends no photons */
    void *pass;                  /**< the sender's */
    int n_wholes;                /**< how often all light is in them, see photon_sender */
    photon_origin *origins[N_PHOTON_CLASSES]; /**< one a photon, those in media last; NULL
                                                 until followed */
} render_photons;

/** @brief Traces what a render with these settings would. Owned by the caller.
 * @param cancel may be NULL */
render_photons *render_trace_photons(const view *v, const settings *how,
                                     const cancel_flag *cancel, GError **error);
/** @brief Photons of a class, on surfaces and in media. */
size_t render_photons_count(const render_photons *p, photon_class c);
/** @brief Photon i of a class: those on surfaces come first. */
photon render_photons_get(const render_photons *p, photon_class c, size_t i);
/** @brief Finds the origin of every photon. Costs about what tracing did; where it was
 * cancelled another call goes on. */
bool render_photons_follow(render_photons *p, const cancel_flag *cancel, GError **error);
/** @brief Tells each event of the i-th emitted photon of a class that is sent. */
void render_photons_tell(const render_photons *p, photon_class c, uint64_t i,
                         photon_listener tell, void *data);
void render_photons_free(render_photons *p);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(render_photons, render_photons_free)

/** @brief The event log of the first n photons of each class, a line an event. */
bool render_photon_event_log(const view *v, const settings *how, size_t n,
                             void (*write)(const char *line, void *data), void *data,
                             GError **error);
