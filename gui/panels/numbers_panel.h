/*
 * The page of numbers: what the render did so far, how long each part took, and what was
 * decided before.
 */
#pragma once

#include "photons/photon_view.h"

typedef struct numbers_panel numbers_panel;

numbers_panel *numbers_panel_new(void);
/** @brief When the widget has gone. */
void numbers_panel_free(numbers_panel *p);
GtkWidget *numbers_panel_widget(numbers_panel *p);
/** @brief frame: of the photon view. */
void numbers_panel_show(numbers_panel *p, const NephStatistics *s,
                        const photon_frame *frame);
/** @brief plan->integrator NULL: there is none yet. */
void numbers_panel_show_plan(numbers_panel *p, const NephPlan *plan);
