/*
 * Photons alone: traced and shown without a picture, or told event by event (000 §4.3,
 * §4.4).
 */
#pragma once

#include "color/wavelengths.h"
#include "render/render.h"

/** @brief The photons of pass 0. */
typedef struct render_photons {
    photon_store stores[N_PHOTON_CLASSES];
    wavelengths w;
    render_statistics statistics;
} render_photons;

/** @brief Traces what a render with these settings would, with the direct class also
 * where the render itself would not need it. Owned by the caller. */
render_photons *render_trace_photons(const scene *s, const settings *how, GError **error);
void render_photons_free(render_photons *p);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(render_photons, render_photons_free)

/** @brief The story of the first n photons of each class, a line an event. */
bool render_photon_story(const scene *s, const settings *how, size_t n,
                         void (*write)(const char *line, void *data), void *data,
                         GError **error);
