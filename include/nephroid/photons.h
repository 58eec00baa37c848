/*
 * Nephroid's photons alone: traced, looked at, followed and kept, without a picture. Part
 * of nephroid.h, which includes it.
 */
#ifndef NEPHROID_PHOTONS_H
#define NEPHROID_PHOTONS_H

#include <nephroid/nephroid.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct NephPhoton {
    float position[3], direction[3]; /**< direction: to where it came from, unit; off by
                                        1e-4 at most, and not at all, but on what moves,
                                        after neph_photons_follow */
    float rgb[3];                    /**< flux as linear sRGB, W of 683 lm */
    NephPhotonClass photon_class;
    uint32_t bounces; /**< scatterings before it landed; 0 until neph_photons_follow */
} NephPhoton;

typedef struct NephPhotons NephPhotons;
/** @brief Traces the photons that pass 0 of a render with these settings stores, as it
 * plans and sends them, without rendering. Classes that such a render does not send have
 * none, and `emitted` 0 in the statistics: of integrator path all, of auto all but
 * caustics; the light vertices of vcm are counted as indirect. Where something moves,
 * each slice of the shutter's time has the flux of the lights. What a render leaves out
 * for want of time (the setting) or memory is sent here. The scene must outlive them. */
NEPH_API NephPhotons *neph_photons_trace(const NephScene *scene,
                                         const NephSettings *settings, GError **error);
/** @brief The same, as long as go_on says so; else NULL with NEPH_ERROR_CANCELLED. */
NEPH_API NephPhotons *neph_photons_trace_while(const NephScene *scene,
                                               const NephSettings *settings,
                                               NephGoOnFunc go_on, void *data,
                                               GError **error);
/** @brief Finds every photon's path, which bounces and neph_photons_path tell. Takes
 * about as long as tracing did. go_on may be NULL. */
NEPH_API bool neph_photons_follow(NephPhotons *photons, NephGoOnFunc go_on, void *data,
                                  GError **error);
NEPH_API void neph_photons_free(NephPhotons *photons);
NEPH_API size_t neph_photons_count(const NephPhotons *photons);
/** @brief @return false if there are fewer; out is then zero */
NEPH_SIZED bool neph_photons_get(const NephPhotons *photons, size_t i, NephPhoton *out);
/** @brief The medium in which photon i was scattered, "" if it landed on a surface or is
 * none; the scene's. Those count for no estimate on a surface. */
NEPH_API const char *neph_photons_medium(const NephPhotons *photons, size_t i);
/** @brief How photons are kept; zero-initialise. */
typedef struct NephSaveOptions {
    int64_t passes;     /**< that they are of; 0: one */
    NephGoOnFunc go_on; /**< as long as it says so; may be NULL */
    void *go_on_data;
    NephStatistics *statistics; /**< gets those of all passes; may be NULL */
} NephSaveOptions;
/** @brief Traces the photons of passes 0 to passes - 1 of a render with these settings
 * into a file for neph_render_use_photons, with the plan that they are sent by. No more
 * than a few of them are in memory at a time. The file is whole or not there.
 * NEPH_ERROR_USAGE where none are sent (integrator path) or they are of no use to another
 * render (vcm). */
NEPH_SIZED bool neph_photons_save(const NephScene *scene, const NephSettings *settings,
                                  const char *path, const NephSaveOptions *options,
                                  GError **error);
/** @brief Before the run, and before neph_render_resume: passes have the photons of such
 * a file in place of their own, pass i those of its pass i modulo their number, with
 * their wavelengths and radii. Size, camera and film may be others than those of the
 * render that it was made for, and so may the settings that photons do not depend on:
 * `passes`, `time`, `noise`, `threads`, `denoise`, `first_spp`, `camera_seed`,
 * `gather_rays`,
 * `photon_map`, and kernels. NEPH_ERROR_INPUT with the reason if the file is damaged, cut
 * off, or of another program, scene or settings. */
NEPH_API bool neph_render_use_photons(NephRender *render, const char *path,
                                      GError **error);
/** @brief The settings that such a file was made by, and of how many passes it is; passes
 * may be NULL. Owned by the caller; NULL with NEPH_ERROR_INPUT. */
NEPH_API NephSettings *neph_photons_settings(const char *path, int64_t *passes,
                                             GError **error);
NEPH_SIZED void neph_photons_statistics(const NephPhotons *photons, NephStatistics *out);
/** @brief Binary PLY: x y z, nx ny nz (direction), red green blue (flux), all float, and
 * class. */
NEPH_API bool neph_photons_write_ply(const NephPhotons *photons, const char *path,
                                     GError **error);
/** @brief The event log of the first n photons of each class, one line an event:
 * position, surface, what happened, flux. Each line is given to write. */
NEPH_API bool neph_photons_event_log(const NephScene *scene, const NephSettings *settings,
                                     size_t n,
                                     void (*write)(const char *line, void *data),
                                     void *data, GError **error);

typedef enum {
    NEPH_PHOTON_EMITTED,
    NEPH_PHOTON_STORED,
    NEPH_PHOTON_SCATTERED,
    NEPH_PHOTON_ABSORBED,
    NEPH_PHOTON_ENDED, /**< no lobe left for its class, or the bounce limit */
    NEPH_PHOTON_LEFT   /**< the scene */
} NephPhotonEventKind;

/** @brief What happened to a photon at one place. */
typedef struct NephPhotonEvent {
    NephPhotonEventKind kind;
    float position[3];
    float direction[3];   /**< whither it goes on */
    float rgb[3];         /**< its flux after the event, linear sRGB, W */
    const char *what;     /**< "emitted", "diffuse reflected", "scattered" (in a medium),
                             ...; static */
    const char *material; /**< of the surface, or the medium, or of the light that emitted
                             it its kind; "" if none; the scene's */
} NephPhotonEvent;

/** @brief The life of the emitted photon that left photon i: at most capacity events go
 * to events, none where that is NULL. @return how many there are; 0 until
 * neph_photons_follow, and of no photon */
NEPH_SIZED size_t neph_photons_path(const NephPhotons *photons, size_t i,
                                    NephPhotonEvent *events, size_t capacity);

/** @brief What an estimate of irradiance at a point is made of, map by map. */
typedef struct NephEstimate {
    double radius[NEPH_N_PHOTON_CLASSES]; /**< within which photons count, m */
    size_t n[NEPH_N_PHOTON_CLASSES];      /**< photons within it, on the normal's side */
    double irradiance[NEPH_N_PHOTON_CLASSES][3]; /**< linear sRGB, W/m²: kernel-weighed
                                                    flux over the kernel's area */
} NephEstimate;

/** @brief The estimate of irradiance on a surface at a point, with the kernels of the
 * settings, without looking at edges. radius: m; 0: as a render would gather, within
 * those of the statistics or nearer than the last of so many nearest. */
NEPH_SIZED void neph_photons_estimate(const NephPhotons *photons, const double point[3],
                                      const double normal[3], double radius,
                                      NephEstimate *out);
/** @brief The photons that the estimate counts, none of them in a medium, nearest first:
 * at most capacity go to index. @return how many there are */
NEPH_API size_t neph_photons_near(const NephPhotons *photons, const double point[3],
                                  const double normal[3], double radius, size_t *index,
                                  size_t capacity);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephPhotons, neph_photons_free)

#ifdef __cplusplus
}
#endif

#include <nephroid/sized.h>

#endif
