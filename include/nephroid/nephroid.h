/*
 * Nephroid: a photon-mapping renderer. The only installed header.
 *
 *   neph_scene_load ─► neph_scene_settings ─► neph_render_new ─┐
 *           ┌──────────────────────────────────────────────────┘
 *           └─► neph_render_run ─► neph_render_image ─► neph_image_write
 *
 * Objects are opaque and owned by who made them. A function that can fail returns false
 * or NULL and sets GError **error (domain NEPH_ERROR_DOMAIN, codes NephError); messages
 * about input begin with file:line:column. The library never exits and never prints.
 * Calls on different objects may come from different threads; calls on one object from
 * one thread at a time, except neph_render_cancel, which may come from any. A scene may
 * be read (const NephScene *) by many at once, also while it renders; what changes its
 * size or camera waits until nothing renders it.
 */
#ifndef NEPHROID_H
#define NEPHROID_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NEPH_API __attribute__((visibility("default")))

/** @brief Why a call failed; also the exit codes of the command line. */
typedef enum {
    NEPH_ERROR_INPUT = 1,     /**< a scene, image or value is wrong */
    NEPH_ERROR_USAGE = 2,     /**< a call or setting is wrong */
    NEPH_ERROR_FAILED = 3,    /**< memory, disk or another resource failed */
    NEPH_ERROR_CANCELLED = 4, /**< a callback asked to stop */
} NephError;

/** @brief The domain of all errors from this library. */
NEPH_API GQuark neph_error_quark(void);
#define NEPH_ERROR_DOMAIN (neph_error_quark())

/** @brief The version, "0.1.0". Static. */
NEPH_API const char *neph_version(void);

typedef enum { NEPH_LOG_NOTE, NEPH_LOG_WARNING } NephLogLevel;
/** @brief Receives one line without newline, on the thread that called the library. */
typedef void (*NephLogFunc)(NephLogLevel level, const char *text, void *data);

/* ---- Files ---- */

/** @brief Whether a file can be written there; leaves no trace. */
NEPH_API bool neph_file_can_write(const char *path, GError **error);
/** @brief Writes a text under a temporary name beside it and renames it when whole. */
NEPH_API bool neph_file_write(const char *path, const char *text, GError **error);

/* ---- Settings ---- */

typedef enum {
    NEPH_SETTING_BOOL,
    NEPH_SETTING_COUNT,
    NEPH_SETTING_REAL,
    NEPH_SETTING_CHOICE
} NephSettingType;

/** @brief One knob, as the manual and user interfaces show it. All strings static. */
typedef struct NephSettingInfo {
    const char *name;
    NephSettingType type;
    const char *unit;          /**< "" if none */
    double low, high, initial; /**< inclusive; index for a choice */
    const char *const *words;  /**< of a choice, NULL-terminated; NULL otherwise */
    const char *aliases;       /**< other accepted names, blank-separated */
    const char *users;         /**< the integrators that read it */
    const char *doc;           /**< one sentence */
} NephSettingInfo;

/** @brief The table of all settings, *n rows, static. */
NEPH_API const NephSettingInfo *neph_settings_table(size_t *n);

/** @brief A full set of values. */
typedef struct NephSettings NephSettings;
NEPH_API NephSettings *neph_settings_new(void); /**< defaults */
NEPH_API NephSettings *neph_settings_copy(const NephSettings *settings);
NEPH_API void neph_settings_free(NephSettings *settings);
/** @brief Sets by name or alias, from text. */
NEPH_API bool neph_settings_set(NephSettings *settings, const char *name,
                                const char *value, GError **error);
/** @brief The value as text, owned by the caller (g_free); NULL if the name is unknown.
 */
NEPH_API char *neph_settings_get(const NephSettings *settings, const char *name);
/** @brief Reads "name = value" lines. */
NEPH_API bool neph_settings_load(NephSettings *settings, const char *path,
                                 GError **error);
/** @brief The table of all settings, for people (json false) or programs. Owned by
 * caller. */
NEPH_API char *neph_settings_describe(bool json);

/* ---- Scenes ---- */

/** @brief A loaded scene; immutable but for its size. */
typedef struct NephScene NephScene;
/** @brief Loads a pbrt-v4 file. log may be NULL. threads 0 = all. On failure the error
 * holds up to 20 messages, one a line. */
NEPH_API NephScene *neph_scene_load(const char *path, unsigned threads, NephLogFunc log,
                                    void *log_data, GError **error);
NEPH_API void neph_scene_free(NephScene *scene);
/** @brief The settings that the file asks for (defaults where it does not); owned by
 * caller. */
NEPH_API NephSettings *neph_scene_settings(const NephScene *scene);
NEPH_API void neph_scene_size(const NephScene *scene, int *width, int *height);
NEPH_API bool neph_scene_resize(NephScene *scene, int width, int height, GError **error);
/** @brief The output name in the file, or NULL. Owned by the scene. */
NEPH_API const char *neph_scene_output(const NephScene *scene);
/** @brief What is in the scene, for people (json false) or programs. Owned by caller. */
NEPH_API char *neph_scene_describe(const NephScene *scene, bool json);

/* ---- Where a scene is seen from ---- */

/** @brief A view: a plain value, taken from a scene, changed and given back. World
 * coordinates; metres and degrees. */
typedef struct NephCamera {
    double position[3];
    double direction[3];   /**< unit, into the picture */
    double up[3];          /**< unit, perpendicular to direction */
    bool mirrored;         /**< left and right exchanged, as "Scale -1 1 1" does */
    double fov;            /**< across the shorter side, 0 < fov < 180 */
    double screen[4];      /**< what the picture shows at distance 1: left, right, bottom,
                              top; follows from fov and the picture's shape */
    double lens_radius;    /**< 0: everything is sharp */
    double focal_distance; /**< sharp at this distance along direction */
} NephCamera;

/** @brief The present view. */
NEPH_API void neph_scene_camera(const NephScene *scene, NephCamera *out);
/** @brief Looks from elsewhere; while nothing renders the scene. Everything but screen is
 * taken over; NEPH_ERROR_USAGE if it is no view (not finite, direction zero or parallel
 * to up, fov or lens out of range), and the scene is as it was. */
NEPH_API bool neph_scene_set_camera(NephScene *scene, const NephCamera *camera,
                                    GError **error);
/** @brief Changes fov and with it screen. */
NEPH_API void neph_camera_set_fov(NephCamera *camera, double degrees);
/** @brief What the middle of the lens sees at a place of the picture: x to the right and
 * y down, both 0..1. direction is unit. */
NEPH_API void neph_camera_ray(const NephCamera *camera, double x, double y,
                              double origin[3], double direction[3]);
/** @brief Where a point is in the picture, as above, also outside of it; false if it is
 * behind the camera. */
NEPH_API bool neph_camera_project(const NephCamera *camera, const double point[3],
                                  double *x, double *y);
/** @brief The view as pbrt directives: LookAt, after Scale if mirrored, and Camera. Owned
 * by caller. */
NEPH_API char *neph_camera_text(const NephCamera *camera);
/** @brief Writes the view into a scene file: where its LookAt or Camera stands, the rest
 * as it was. The file is replaced only when whole. */
NEPH_API bool neph_camera_save(const NephCamera *camera, const char *scene_path,
                               GError **error);

/** @brief The box around all shapes; false if there are none. */
NEPH_API bool neph_scene_bounds(const NephScene *scene, double low[3], double high[3]);

/* ---- Images ---- */

typedef struct NephImage NephImage;
NEPH_API void neph_image_free(NephImage *image);
NEPH_API NephImage *neph_image_read(const char *path, GError **error);
/** @brief By the name's extension: .exr (float, all layers), .png, .jpg, .hdr, .pfm.
 * Written to a temporary name and renamed. exposure: stops, for 8-bit formats. */
NEPH_API bool neph_image_write(const NephImage *image, const char *path, float exposure,
                               GError **error);
NEPH_API bool neph_image_can_write(const char *path, GError **error);
NEPH_API void neph_image_size(const NephImage *image, int *width, int *height,
                              int *n_channels);
NEPH_API const char *neph_image_channel_name(const NephImage *image, int channel);
/** @brief [(y * width + x) * n_channels + c], row 0 at the top, linear. Owned by the
 * image. */
NEPH_API const float *neph_image_pixels(const NephImage *image);

typedef struct NephImageDifference {
    double mean_a, mean_b; /**< mean luminance */
    double rmse, relmse, psnr, flip;
    size_t n_not_finite;
} NephImageDifference;
/** @brief Compares image with reference over R, G, B. */
NEPH_API bool neph_image_compare(const NephImage *image, const NephImage *reference,
                                 NephImageDifference *out, GError **error);
/** @brief A comparison as a table for people (json false) or for programs. Owned by
 * caller. */
NEPH_API char *neph_image_difference_text(const NephImageDifference *difference,
                                          bool json);

/* ---- Rendering ---- */

typedef enum {
    NEPH_PHOTON_DIRECT,
    NEPH_PHOTON_INDIRECT,
    NEPH_PHOTON_CAUSTIC,
    NEPH_N_PHOTON_CLASSES
} NephPhotonClass;

/** @brief Why a render is over: by its settings `passes`, `time`, `noise`, or because
 * someone asked to stop. */
typedef enum {
    NEPH_GOES_ON,
    NEPH_PASSES_DONE,
    NEPH_TIME_UP,
    NEPH_NOISE_REACHED,
    NEPH_CANCELLED
} NephStop;

/** @brief What a render did so far. Times in seconds, summed over passes. */
typedef struct NephStatistics {
    int64_t passes;
    int64_t passes_wanted; /**< the most there will be; 0: time or noise decides */
    double time_total, time_prepare, time_trace, time_build, time_gather, time_camera;
    uint64_t photon_rays, camera_rays, shadow_rays;
    uint64_t emitted[NEPH_N_PHOTON_CLASSES], stored[NEPH_N_PHOTON_CLASSES];
    double radius[NEPH_N_PHOTON_CLASSES]; /**< m, of the last pass */
    uint64_t memory_peak, memory_photons; /**< bytes */
    uint64_t n_not_finite; /**< samples dropped since they were not finite */
    double noise; /**< relative error of the image, estimated from the scatter of its
                     passes; INFINITY while there are too few. While rendering it is only
                     kept if the setting `noise` asks for it. */
    NephStop stopped_by;
} NephStatistics;

/** @brief Told after every pass and some times within one, on the thread that called
 *  neph_render_run. fraction: 0..1 of the whole render. Once statistics->passes > 0 it
 *  may call neph_render_image. @return false to stop. */
typedef bool (*NephProgressFunc)(double fraction, const NephStatistics *statistics,
                                 void *data);

typedef struct NephRender NephRender;
/** @brief Prepares a render of the scene, which must outlive it. */
NEPH_API NephRender *neph_render_new(const NephScene *scene, const NephSettings *settings,
                                     GError **error);
NEPH_API void neph_render_free(NephRender *render);
/** @brief Renders the passes that are left. Stopped early (false, NEPH_ERROR_CANCELLED)
 * the image holds the passes finished, or the one begun if there is none; another call
 * goes on from there to the same image. */
NEPH_API bool neph_render_run(NephRender *render, NephProgressFunc progress, void *data,
                              GError **error);
/** @brief Asks neph_render_run to stop soon. Any thread; also from a signal handler. */
NEPH_API void neph_render_cancel(NephRender *render);
/** @brief The mean of the passes so far, with layers; owned by the caller. */
NEPH_API NephImage *neph_render_image(const NephRender *render, GError **error);
NEPH_API void neph_render_statistics(const NephRender *render, NephStatistics *out);
/** @brief The relative error of the image, as in NephStatistics, found now: also from the
 * progress function of a render that is not asked to keep it. */
NEPH_API double neph_render_noise(const NephRender *render);
/** @brief Statistics as JSON (json true) or a table for people; owned by caller. */
NEPH_API char *neph_statistics_text(const NephStatistics *statistics, bool json);

/* ---- Photons alone ---- */

typedef struct NephPhoton {
    float position[3], direction[3]; /**< direction: to where it came from, unit */
    float rgb[3];                    /**< flux as linear sRGB, W */
    NephPhotonClass photon_class;
} NephPhoton;

typedef struct NephPhotons NephPhotons;
/** @brief Traces the photons of pass 0 without rendering. */
NEPH_API NephPhotons *neph_photons_trace(const NephScene *scene,
                                         const NephSettings *settings, GError **error);
NEPH_API void neph_photons_free(NephPhotons *photons);
NEPH_API size_t neph_photons_count(const NephPhotons *photons);
NEPH_API void neph_photons_get(const NephPhotons *photons, size_t i, NephPhoton *out);
NEPH_API void neph_photons_statistics(const NephPhotons *photons, NephStatistics *out);
/** @brief Binary PLY: x y z, nx ny nz (direction), red green blue (float flux), class. */
NEPH_API bool neph_photons_write_ply(const NephPhotons *photons, const char *path,
                                     GError **error);
/** @brief The story of the first n photons of each class, one line an event: position,
 * surface, what happened, flux. Each line is given to write. */
NEPH_API bool neph_photons_story(const NephScene *scene, const NephSettings *settings,
                                 size_t n, void (*write)(const char *line, void *data),
                                 void *data, GError **error);

/* g_autoptr(NephScene) scene = neph_scene_load(...); frees itself. */
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephSettings, neph_settings_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephScene, neph_scene_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephImage, neph_image_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephRender, neph_render_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephPhotons, neph_photons_free)

#ifdef __cplusplus
}
#endif

#endif
