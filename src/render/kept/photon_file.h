/*
 * Photons in a file: those of some passes of a render with the plan that sent them, so
 * that other renders of the same scene, from wherever it is seen, need not send their own
 * and are all lit alike.
 *
 *   header      program, scene, settings, how many passes
 *   plan        transport/plan/plan_bytes.h
 *   photons     of a pass, slice of time and class, a mebi of emitted ones after another,
 *   ...         array by array, in order of emission
 *   end
 *
 * Each section has a head; all is checked (checked_file.h). Writing holds no more than
 * the photons of one section, reading those of a class of a pass.
 *
 * Pass i of a render that uses a file of n passes has the photons, wavelengths and radii
 * of pass i mod n: up to n passes the picture is, bit for bit, that of a render that
 * sends them itself, if that plans alike.
 */
#pragma once

#include "render/render.h"
#include "transport/transport.h"

/** @brief What is to be written. */
typedef struct photon_file_order {
    const view *view;
    const settings *how;
    const render_identity *who; /**< its scene: of what photons see */
    int64_t n_passes;           /**< 1 or more */
    const cancel_flag *cancel;  /**< may be NULL */
} photon_file_order;

/** @brief Plans, traces and writes. ERROR_USAGE if there are no photons to be kept.
 * @param statistics of all passes; may be NULL */
bool photon_file_write(const photon_file_order *order, const char *path,
                       render_statistics *statistics, GError **error);

typedef struct photon_file photon_file;

/** @brief Opens one whose heads are all sound. ERROR_INPUT with the reason. */
photon_file *photon_file_open(const char *path, GError **error);
void photon_file_free(photon_file *file);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(photon_file, photon_file_free)

/** @brief Whether it is of this program and scene and, but for settings that photons do
 * not depend on, of these. ERROR_INPUT with the reason if not. */
bool photon_file_suits(const photon_file *file, const render_identity *who,
                       const settings *asked, GError **error);
/** @brief The settings that it was made by. */
settings photon_file_settings(const photon_file *file);
int64_t photon_file_passes(const photon_file *file);
/** @brief What tells it from other files. The file's. */
const char *photon_file_id(const photon_file *file);
/** @brief Reads the plan, but keeps of plan->how what photons do not depend on. */
bool photon_file_plan(photon_file *file, transport_plan *plan, GError **error);
/** @brief photon_supply.take; data: photon_file. */
bool photon_file_take(const void *file, uint32_t pass, photon_class c, int slice,
                      trace_result *result, GError **error);
