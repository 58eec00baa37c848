/*
 * The pass loop: plan once, then pass after pass onto the film, until the settings'
 * `passes`, `time` or `noise` say that it is enough, or someone asks to stop.
 */
#pragma once

#include "image/image.h"
#include "photon/photon.h"
#include "render/plan.h"
#include "scene/view.h"

/** @brief Why a render is over. */
typedef enum render_stop {
    RENDER_GOES_ON,
    RENDER_PASSES_DONE,
    RENDER_TIME_UP,
    RENDER_NOISE_REACHED,
    RENDER_CANCELLED
} render_stop;

/** @brief What a render did so far; the fields of NephStatistics. Seconds, summed over
 * passes. */
typedef struct render_statistics {
    int64_t passes;
    int64_t passes_wanted; /**< 0: time or noise decides */
    double time_total, time_prepare, time_trace, time_build, time_gather, time_camera;
    uint64_t photon_rays, camera_rays, shadow_rays;
    uint64_t emitted[N_PHOTON_CLASSES], stored[N_PHOTON_CLASSES];
    double radius[N_PHOTON_CLASSES]; /**< m, of the last pass */
    uint64_t memory_peak, memory_photons;
    uint64_t n_not_finite;
    double noise; /**< relative error of the picture (film_noise), INFINITY if unknown */
    int64_t photons_wanted; /**< a pass by the settings, if the plan has fewer; else 0 */
    bool short_of_memory;   /**< more would not fit into the memory limit */
    bool left_noisy; /**< noise was to be taken out, but for that there was no time */
    bool can_look;   /**< render_image may be called now */
    double part; /**< of the pixels of the pass under way are in the picture, if it ended
                    early or is the first */
    render_stop stopped_by;
} render_statistics;

/** @brief Told on the thread that called, after every pass and now and then within one;
 * fraction 0..1. It may call render_image where statistics->can_look says so: once a pass
 * is done, and when the first has the whole picture on a
 * finer grid. @return false to stop. */
typedef bool (*render_progress)(double fraction, const render_statistics *statistics,
                                void *data);

typedef struct render render;

/** @brief A render of a view, which must outlive it. */
render *render_new(const view *v, const settings *how, GError **error);
void render_free(render *r);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(render, render_free)
/** @brief Renders the passes that are left. ERROR_CANCELLED when asked to stop: the film
 * then holds the passes done, and the next call goes on as if nothing had happened.
 * progress may be NULL. */
bool render_run(render *r, render_progress progress, void *data, GError **error);
/** @brief Asks render_run to stop soon. Any thread, also a signal handler. */
void render_cancel(render *r);
/** @brief The mean of the passes done, with layers and metadata; before there is one,
 * what was done of the first. Owned by the caller. */
image *render_image(const render *r, GError **error);
/** @brief The same, unless cancelled: ERROR_CANCELLED. */
image *render_image_while(const render *r, const cancel_flag *cancel, GError **error);
/** @brief Of the setting `time`, so many seconds have gone by before the run begins, and
 * what it takes to write the picture to these files is kept for after it.
 * @param paths NULL-terminated, copied */
void render_set_time_around(render *r, double before, const char *const *paths);
/** @brief What that takes by what is known now, with taking the noise out, s. */
double render_seconds_after(const render *r);
/** @brief What a pass is expected to take, s, by the trial that its plan was made with
 * for `time`, or one made now; 0: unknown. */
double render_pass_seconds(render *r);
/** @brief The settings "name=value" that make a render without `time` and `noise` give
 * the same picture: passes, and what was chosen otherwise than asked for. Owned by the
 * caller; NULL: no pass is done. */
GStrv render_repeat(const render *r);
/** @brief What is decided before the first pass: now, if it was not yet. Not on another
 * thread while it runs; from its progress function once planning is over, before that
 * false without an error. */
bool render_get_plan(render *r, render_plan *out, GError **error);
/** @brief What a checkpoint says of who wrote it; both must be the same to go on. */
typedef struct render_identity {
    char *program; /**< which program, of which version */
    char *scene;   /**< fingerprint of what is rendered */
} render_identity;
/** @brief Writes the passes done to a file (checkpoint.h); where render_image may be
 * called. ERROR_USAGE if no pass is done. */
bool render_save_checkpoint(const render *r, const render_identity *who, const char *path,
                            GError **error);
/** @brief Before the first run: takes over the passes of a file, after which the next
 * ones are as if there had been no break. Settings must be those of the file, but for
 * `passes`, `time`, `noise` and `threads`; time goes on from where it was.
 * ERROR_INPUT with the reason if the file is damaged or of something else; then the
 * render is as new. */
bool render_resume(render *r, const render_identity *who, const char *path,
                   GError **error);
/** @brief Before the first run, and before render_resume: passes have the photons of a
 * file (photon_file.h), and the plan that these were sent by. ERROR_INPUT with the reason
 * if it is damaged or of something else. What is damaged within is found when the pass
 * whose photons they are begins. */
bool render_use_photons(render *r, const render_identity *who, const char *path,
                        GError **error);
/** @brief The plan, made now if it was not, for render_take_plan in another process.
 * Owned by the caller. */
GBytes *render_plan_bytes(render *r, const render_identity *who, GError **error);
/** @brief Before the first run: has the plan of another process, and by it settings, in
 * place of one of its own. ERROR_INPUT with the reason if it is damaged or of another
 * program, scene or integrator, ERROR_FAILED where its photons do not fit into memory;
 * then the render is as new. */
bool render_take_plan(render *r, const render_identity *who, GBytes *bytes,
                      GError **error);
/** @brief Renders one pass by its number, which comes once, as part of a render whose
 * passes are dealt out to many; `time` and `noise` mean nothing then. After it progress
 * is told no more. Not to be mixed with render_run. */
bool render_dealt_pass(render *r, uint32_t index, render_progress progress, void *data,
                       GError **error);
/** @brief The sums over passes, as numbers that may be added up over processes. */
size_t render_count_sums(const render *r);
void render_get_sums(const render *r, size_t first, size_t n, double *out);
void render_add_sums(render *r, size_t first, size_t n, const double *more);
/** @brief Adds passes, rays and times of others, once their sums are all added. */
void render_add_statistics(render *r, const render_statistics *more);
/** @brief Forgets the passes, which someone else has now; the plan stays. */
void render_forget(render *r);
/** @brief The settings that passes are rendered by, once that is decided. */
settings render_settings(const render *r);
render_statistics render_get_statistics(const render *r);
/** @brief film_noise of the passes done. */
double render_noise(const render *r);
