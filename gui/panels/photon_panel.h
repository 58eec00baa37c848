/*
 * The page of the photon view: tracing, what is shown, the numbers, and what was picked.
 */
#pragma once

#include "photons/photon_view.h"

typedef struct photon_panel photon_panel;

typedef struct photon_panel_events {
    void (*style_changed)(const photon_style *style, void *data);
    void (*radius_changed)(double radius, void *data);
    void *data;
} photon_panel_events;

/** @brief What a click found. */
typedef struct photon_pick {
    bool is_photon;
    NephPhoton photon;     /**< if is_photon */
    const char *medium;    /**< that the photon was scattered in; "": none */
    NephSurfacePoint at;   /**< the surface, or that under the photon; in a medium only
                              the position */
    NephEstimate estimate; /**< none in a medium */
    size_t n_events;
    const NephPhotonEvent *events; /**< of the photon's path; n_events may be 0 */
} photon_pick;

/** @brief number: the adjustment of the setting `photons`, shared with its control. */
photon_panel *photon_panel_new(GtkAdjustment *number, const photon_panel_events *events);
/** @brief When the widget has gone. */
void photon_panel_free(photon_panel *p);
GtkWidget *photon_panel_widget(photon_panel *p);
void photon_panel_show_tracing(photon_panel *p, bool tracing);
void photon_panel_show_frame(photon_panel *p, const photon_frame *frame);
void photon_panel_show_numbers(photon_panel *p, const NephStatistics *statistics);
/** @brief NULL: nothing. */
void photon_panel_show_pick(photon_panel *p, const photon_pick *pick);
/** @brief "12 of 34 · r 0.1 m": stored, emitted and the radius of a map; and a frame's
 * time. Owned by the caller. */
char *photon_share_text(const NephStatistics *statistics, int c);
char *photon_frame_text(const photon_frame *frame);
/** @brief Whether photons are to be traced anew when a setting changes. */
bool photon_panel_follows(const photon_panel *p);
