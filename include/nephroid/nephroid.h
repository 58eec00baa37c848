/*
 * Nephroid: a photon-mapping renderer. The header to include; it brings photons.h, which
 * is about photons without a picture.
 *
 *   neph_scene_load ─► neph_scene_settings ─► neph_render_new ─┐
 *           ┌──────────────────────────────────────────────────┘
 *           └─► neph_render_run ─► neph_render_image ─► neph_image_write
 *
 * Objects are opaque and owned by who made them. A function that can fail returns false
 * or NULL and sets GError **error (domain NEPH_ERROR_DOMAIN, codes NephError); messages
 * about input begin with FILE:LINE:COLUMN. The library never exits and never prints.
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

/* What takes a plain struct is compiled into the program, and tells the library the
   struct's size (sized.h): programs go on with a library whose structs have grown. */
#ifdef NEPHROID_INSIDE
#define NEPH_SIZED
#else
#define NEPH_SIZED static inline
#endif

/** @brief Why a call failed; the first three are also exit codes of the command line,
 * which ends with 3 if it was stopped. */
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

/** @brief A copy of a text that came from a file, such as a material's name, fit for a
 * terminal: control characters, line ends and what is not UTF-8 are spelt out. Errors,
 * logs and descriptions have been through it. @return owned by the caller (g_free) */
NEPH_API char *neph_text_printable(const char *text);

typedef enum { NEPH_LOG_NOTE, NEPH_LOG_WARNING } NephLogLevel;
/** @brief Receives one line without newline, on the thread that called the library. */
typedef void (*NephLogFunc)(NephLogLevel level, const char *text, void *data);

/* ---- Files ---- */

/** @brief Whether a file can be written there; leaves no trace. */
NEPH_API bool neph_file_can_write(const char *path, GError **error);
/** @brief Writes a text under a temporary name beside it and renames it when whole. */
NEPH_API bool neph_file_write(const char *path, const char *text, GError **error);
/** @brief Refuses a path whose file is one of others, such as neph_scene_files, by
 * whatever name or link: NEPH_ERROR_USAGE naming both. @param others NULL-terminated */
NEPH_API bool neph_file_spares(const char *path, const char *const *others,
                               GError **error);
/** @brief Removes the temporary files of all that is being written. For the handler of a
 * signal that is about to end the program: no file can be finished afterwards. */
NEPH_API void neph_file_abandon_all(void);

/* ---- Memory ---- */

/** @brief Limits the memory that all scenes, images, photons and pictures of the process
 * take together. What would take more fails with NEPH_ERROR_FAILED, before it is
 * allocated; the message says how much was wanted for what, and how much is left. What is
 * in use stays.
 * @param size a number of bytes, with K, M, G or T of 1024, 1024², ...: "2G", "500M";
 * NULL: as at first, 80 % of what the machine, the process's cgroup and ulimit -v have,
 * whichever is least
 * A render whose photons would not fit sends fewer (NephStatistics.short_of_memory), and
 * one of which the fewest do not fails before its first pass, saying what it takes and
 * what the limit is: there all memory of the process counts.
 * @return false with NEPH_ERROR_USAGE; the limit is as it was. From any thread. */
NEPH_API bool neph_memory_set_limit(const char *size, GError **error);
/** @brief The limit in bytes. */
NEPH_API size_t neph_memory_limit(void);

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
    double low, high, initial; /**< inclusive; index for a choice. An initial value below
                                  low is allowed too, and means none. */
    const char *const *words;  /**< NULL-terminated: those of a choice; of a number how
                                  the value below low is written; NULL: none */
    const char *aliases;       /**< other accepted names, blank-separated */
    const char *users;         /**< the integrators that read it */
    const char *doc;           /**< one sentence */
} NephSettingInfo;

/** @brief The table of all settings, *n rows, static. */
NEPH_SIZED const NephSettingInfo *neph_settings_table(size_t *n);

/** @brief A full set of values. */
typedef struct NephSettings NephSettings;
NEPH_API NephSettings *neph_settings_new(void); /**< defaults */
NEPH_API NephSettings *neph_settings_copy(const NephSettings *settings);
NEPH_API void neph_settings_free(NephSettings *settings);
/** @brief Sets by name or alias, from text. NEPH_ERROR_USAGE if there is no such setting
 * or the value is out of range; the settings are as they were. */
NEPH_API bool neph_settings_set(NephSettings *settings, const char *name,
                                const char *value, GError **error);
/** @brief The value as text, owned by the caller (g_free); NULL if the name is unknown.
 */
NEPH_API char *neph_settings_get(const NephSettings *settings, const char *name);
/** @brief Whether the integrator of the settings reads one of that name. */
NEPH_API bool neph_settings_reads(const NephSettings *settings, const char *name);
/** @brief "NAME is not read by INTEGRATOR, only by ..." for each setting that `given` was
 * told (neph_settings_set, neph_settings_load) and that the integrator of `settings` does
 * not read. NULL-terminated, freed with g_strfreev. */
NEPH_API char **neph_settings_unread(const NephSettings *settings,
                                     const NephSettings *given);
/** @brief Reads "name = value" lines; '#' begins a comment. NEPH_ERROR_INPUT with the
 * place of the first mistake; the settings are as they were. */
NEPH_API bool neph_settings_load(NephSettings *settings, const char *path,
                                 GError **error);
/** @brief The presets that come with the program: settings as a text on photon mapping
 * describes them. Names in order, NULL-terminated, freed with g_strfreev. */
NEPH_API char **neph_settings_presets(void);
/** @brief The lines of a preset, as neph_settings_load reads them; the first is a comment
 * that says what it follows. Owned by the caller (g_free). NEPH_ERROR_USAGE with the list
 * of presets if there is none of that name. */
NEPH_API char *neph_settings_preset_text(const char *name, GError **error);
/** @brief Sets what a preset says; all else stays as it is. Errors as above. */
NEPH_API bool neph_settings_load_preset(NephSettings *settings, const char *name,
                                        GError **error);
/** @brief The table of all settings, for people (json false) or programs. Owned by
 * caller. */
NEPH_API char *neph_settings_describe(bool json);
/** @brief What of pbrt-v4's language is rendered, approximated or refused, as a table in
 * Markdown. Owned by caller. */
NEPH_API char *neph_features_describe(void);

/* ---- Scenes ---- */

/** @brief What names of scene files end in, with the dot: ".pbrt" and so on;
 * NULL-terminated, static. */
NEPH_API const char *const *neph_scene_extensions(void);
/** @brief The same of pictures that are read: ".exr" and so on. */
NEPH_API const char *const *neph_image_extensions(void);
/** @brief The same of pictures that neph_image_write writes. */
NEPH_API const char *const *neph_image_written_extensions(void);
/** @brief Whether neph_image_write writes a picture to such a path, by its ending.
 * @param eight_bits may be NULL; whether that is as it is seen, with a tone curve and
 * eight bits, and not linear */
NEPH_API bool neph_image_is_written(const char *path, bool *eight_bits);
/** @brief A loaded scene; immutable but for its size and camera. */
typedef struct NephScene NephScene;
/** @brief Loads a scene (pbrt, glTF, OBJ ...). log may be NULL. threads 0 = all. On
 * failure the error holds up to 20 messages, one a line. */
NEPH_API NephScene *neph_scene_load(const char *path, unsigned threads, NephLogFunc log,
                                    void *log_data, GError **error);
/** @brief Receives the absolute path of a file, on the thread that called the library. */
typedef void (*NephFileFunc)(const char *path, void *data);
/** @brief Asked now and then, on the thread that called. @return false to stop. */
typedef bool (*NephGoOnFunc)(void *data);
/** @brief How to load a scene; zero-initialise. */
typedef struct NephLoadOptions {
    unsigned threads; /**< for the acceleration structure; 0: one per processor */
    bool lenient;     /**< what can not be rendered (hair, subsurface, measured, media of
                         other kinds than homogeneous) is replaced, and a warning says by
                         what */
    bool thin_glass;  /**< of glTF, OBJ and the like: glass that the file gives no volume
                         is a thin pane on closed meshes too, which are else solid */
    NephLogFunc log;  /**< may be NULL */
    void *log_data;
    NephFileFunc file; /**< told each file just before it is first opened, be it there or
                          not, also where reading then fails; may be NULL */
    void *file_data;
    NephGoOnFunc go_on; /**< asked again and again while the scene is read and made ready;
                           stopped, loading ends soon with NEPH_ERROR_CANCELLED; may be
                           NULL */
    void *go_on_data;
    bool at_time; /**< the scene as it is at a time: that many seconds later the shutter
                     opens, and animations of glTF are where they are then; else these
                     are left out */
    double time;  /**< s; means something with at_time */
} NephLoadOptions;

/** @brief The same by options. */
NEPH_SIZED NephScene *
neph_scene_load_with(const char *path, const NephLoadOptions *options, GError **error);
NEPH_API void neph_scene_free(NephScene *scene);
/** @brief The same scene with a size and a camera of its own, so that what renders it
 * need not wait for who looks at it otherwise. Cheap: all else is the given scene's,
 * which must outlive it. */
NEPH_API NephScene *neph_scene_share(const NephScene *scene);
/** @brief The settings that the file asks for (defaults where it does not); owned by
 * caller. */
NEPH_API NephSettings *neph_scene_settings(const NephScene *scene);
/** @brief Whether it may look otherwise at another time: something, or the camera, moves,
 * be it outside of the time that the shutter is open. */
NEPH_API bool neph_scene_is_animated(const NephScene *scene);
/** @brief Size of the picture, pixels. */
NEPH_API void neph_scene_size(const NephScene *scene, int *width, int *height);
/** @brief Another size, 1 to 65536 pixels a side, else NEPH_ERROR_USAGE; while nothing
 * renders the scene. */
NEPH_API bool neph_scene_resize(NephScene *scene, int width, int height, GError **error);
/** @brief The files that the scene was read from, its own first: what it includes,
 * meshes, images, spectra, buffers, materials; also those that it names, does without and
 * that are missing. Absolute paths, each once, NULL-terminated; the scene's. */
NEPH_API const char *const *neph_scene_files(const NephScene *scene);
/** @brief The output name in the file, without folders, since a scene is not to choose
 * what of the user's files it replaces; or NULL. Owned by the scene. */
NEPH_API const char *neph_scene_output(const NephScene *scene);
/** @brief Whether the scene's format says how its picture is exposed. Where it has no
 * words for that (glTF, OBJ ...), a picture that would be nearly black or white is best
 * shown as neph_image_exposure finds. */
NEPH_API bool neph_scene_says_exposure(const NephScene *scene);
/** @brief Writes a scene of any format as pbrt-v4 text (out ends in .pbrt), its meshes as
 * PLY and its images into a folder beside it, all at once in the end; a file that was
 * read is not replaced (NEPH_ERROR_USAGE). log may be NULL. */
NEPH_API bool neph_scene_convert(const char *in, const char *out, NephLogFunc log,
                                 void *log_data, GError **error);
/** @brief The same by options; threads have no effect. */
NEPH_SIZED bool neph_scene_convert_with(const char *in, const char *out,
                                        const NephLoadOptions *options, GError **error);
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
    const char *kind; /**< "perspective", "orthographic" or "spherical"; static. A NULL
                         is taken as the first */
} NephCamera;

/** @brief The present view. */
NEPH_SIZED void neph_scene_camera(const NephScene *scene, NephCamera *out);
/** @brief Looks from elsewhere; while nothing renders the scene. Everything but screen
 * and kind is taken over, and what moved stands still; NEPH_ERROR_USAGE if it is no view
 * (not finite, direction zero or parallel to up, fov or lens out of range), and the scene
 * is as it was. */
NEPH_SIZED bool neph_scene_set_camera(NephScene *scene, const NephCamera *camera,
                                      GError **error);
/** @brief Changes fov and with it screen. */
NEPH_SIZED void neph_camera_set_fov(NephCamera *camera, double degrees);
/** @brief What the middle of the lens sees at a place of the picture: x to the right and
 * y down, both 0..1. direction is unit. A spherical camera is taken as one of latitude
 * and longitude. */
NEPH_SIZED void neph_camera_ray(const NephCamera *camera, double x, double y,
                                double origin[3], double direction[3]);
/** @brief Where a point is in the picture, as above, also outside of it; false if it is
 * behind the camera. Of a spherical camera: where a perspective one would see it. */
NEPH_SIZED bool neph_camera_project(const NephCamera *camera, const double point[3],
                                    double *x, double *y);
/** @brief The view as pbrt directives: LookAt, after Scale if mirrored, and Camera if it
 * is a perspective one. Owned by caller. */
NEPH_SIZED char *neph_camera_text(const NephCamera *camera);
/** @brief Writes the view into a scene file: where its LookAt or Camera stands, the rest
 * as it was. The file is replaced only when whole. */
NEPH_SIZED bool neph_camera_save(const NephCamera *camera, const char *scene_path,
                                 GError **error);

/** @brief The box around all shapes; false if there are none. */
NEPH_API bool neph_scene_bounds(const NephScene *scene, double low[3], double high[3]);

/* ---- Images ---- */

/** @brief Pixels of named channels, float and linear. A rendered one has R, G and B in
 * the colour space of the scene's film (sRGB where it names none), then layers such as
 * "caustic.R"; docs/manual.md lists them. */
typedef struct NephImage NephImage;
NEPH_API void neph_image_free(NephImage *image);
/** @brief By the file's content: the formats written, TGA and BMP. Integer formats become
 * linear. NEPH_ERROR_INPUT; owned by caller. */
NEPH_API NephImage *neph_image_read(const char *path, GError **error);
/** @brief An image of R, G and B, three linear numbers a pixel, row 0 at the top; copied.
 * NEPH_ERROR_INPUT if it has no size or one beyond all. Owned by caller. */
NEPH_API NephImage *neph_image_new(int width, int height, const float *rgb,
                                   GError **error);
/** @brief By the name's extension: .exr (float, all layers), .png, .jpg, .hdr, .pfm.
 * Written to a temporary name and renamed. exposure: stops, for 8-bit formats; these show
 * the layer "denoised" where there is one. */
NEPH_API bool neph_image_write(const NephImage *image, const char *path, float exposure,
                               GError **error);
/** @brief The same, as long as go_on says so; else false with NEPH_ERROR_CANCELLED, and
 * what was there under that name still is. */
NEPH_API bool neph_image_write_while(const NephImage *image, const char *path,
                                     float exposure, NephGoOnFunc go_on, void *data,
                                     GError **error);
/** @brief R, G and B as a file of eight bits shows them, before it cuts what is above
 * `white` (INFINITY: nothing is): those of "denoised" where there is that, and edges of
 * lights that are brighter than white by how much of a pixel is lit ("lights"), which are
 * jagged otherwise. NEPH_ERROR_INPUT: it has no colours. Owned by caller. */
NEPH_API NephImage *neph_image_shown(const NephImage *image, float white, GError **error);
/** @brief How a picture comes out in eight bits. Pixels that no light reaches do not
 * count. */
typedef enum {
    NEPH_EXPOSURE_GOOD,
    NEPH_EXPOSURE_DARK,   /**< nearly black: nine tenths of it are below 1 % of white */
    NEPH_EXPOSURE_BRIGHT, /**< nearly white: three quarters of it are above white */
    NEPH_EXPOSURE_BLACK   /**< no light reaches any of it */
} NephExposure;
/** @brief Judges R, G and B at an exposure of so many stops.
 * @param better gets the stops that would show a dark or bright one; else `exposure` */
NEPH_API NephExposure neph_image_exposure(const NephImage *image, float exposure,
                                          float *better);
/** @brief Whether the name says a format and the place can be written; leaves no trace.
 */
NEPH_API bool neph_image_can_write(const char *path, GError **error);
NEPH_API void neph_image_size(const NephImage *image, int *width, int *height,
                              int *n_channels);
/** @brief "R", "caustic.G" ...; NULL if there is no such channel. The image's. */
NEPH_API const char *neph_image_channel_name(const NephImage *image, int channel);
/** @brief [(y * width + x) * n_channels + c], row 0 at the top, linear. Owned by the
 * image. */
NEPH_API const float *neph_image_pixels(const NephImage *image);

/** @brief All channels in another size, each pixel the mean over the area it covers.
 * Owned by caller. */
NEPH_API NephImage *neph_image_scale(const NephImage *image, int width, int height,
                                     GError **error);
/** @brief A contact sheet of R, G and B: n images row by row in so many columns (at least
 * 1), on dark grey. Owned by caller. */
NEPH_API NephImage *neph_image_sheet(const NephImage *const *images, size_t n,
                                     size_t columns, GError **error);

/** @brief One layer as an image of R, G and B: "caustic", "normal" (X, Y and Z), "depth"
 * (all three alike), "raw" (R, G and B as they were rendered) ... Owned by caller.
 * NEPH_ERROR_USAGE with the list of layers if there is none of that name. */
NEPH_API NephImage *neph_image_layer(const NephImage *image, const char *name,
                                     GError **error);
/** @brief Errors over R, G and B of an image a against its reference b. */
typedef struct NephImageDifference {
    double mean_a, mean_b; /**< mean luminance */
    double rmse;           /**< root of the mean of (a - b)² */
    double relmse;         /**< mean of (a - b)² / (b² + 0.01) */
    double psnr;           /**< dB, sRGB-encoded and clipped to 0..1; INFINITY if alike */
    double flip;           /**< mean error of FLIP (Andersson et al. 2020), 0..1, at 67
                              pixels a degree */
    size_t n_not_finite;   /**< pixels left out since one of them is not finite */
} NephImageDifference;
/** @brief Compares image with reference. NEPH_ERROR_INPUT if their sizes differ, R, G or
 * B is missing, or no pixel is finite in both. */
NEPH_SIZED bool neph_image_compare(const NephImage *image, const NephImage *reference,
                                   NephImageDifference *out, GError **error);
/** @brief Where the image is brighter (red, then white) or darker (blue, then white) than
 * the reference; the end of the scale is half of its luminance, or, in the dark, of a
 * tenth of its mean. Black: alike; green: not finite. Owned by caller. */
NEPH_API NephImage *neph_image_difference_map(const NephImage *image,
                                              const NephImage *reference, GError **error);
/** @brief A comparison as a table for people (json false) or for programs. Owned by
 * caller. */
NEPH_SIZED char *neph_image_difference_text(const NephImageDifference *difference,
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
    int64_t photons_wanted; /**< a pass by the settings, if fewer are sent since that is
                               worth more, or short_of_memory; else 0 */
    bool left_noisy; /**< noise was to be taken out (`denoise`), but for that there was no
                        time: there is no layer "denoised" */
    bool can_look;   /**< neph_render_image may be called now */
    double part; /**< so many of the pixels, 0..1, have samples of one pass more: of the
                    first while it is under way, and of the last if time ended it */
    NephStop stopped_by;
    bool short_of_memory; /**< fewer photons are sent a pass than wanted, since more would
                             not fit into the limit of memory */
} NephStatistics;

/** @brief Told after every pass and some times within one, on the thread that called
 *  neph_render_run. fraction: 0..1 of the whole render. Where statistics->can_look says
 * so it may call neph_render_image: once a pass is done, and before that whenever the
 * first one has the whole picture on a finer grid of pixels. @return false to stop. */
typedef bool (*NephProgressFunc)(double fraction, const NephStatistics *statistics,
                                 void *data);

typedef struct NephRender NephRender;
/** @brief Prepares a render of the scene, which must outlive it; the settings are copied.
 * NEPH_ERROR_FAILED if there is no memory for the picture. */
NEPH_API NephRender *neph_render_new(const NephScene *scene, const NephSettings *settings,
                                     GError **error);
NEPH_API void neph_render_free(NephRender *render);
/** @brief Renders the passes that are left. Stopped early (false, NEPH_ERROR_CANCELLED)
 * the image holds the passes finished, or the one begun if there is none; another call
 * goes on from there to the same image. */
NEPH_API bool neph_render_run(NephRender *render, NephProgressFunc progress, void *data,
                              GError **error);
/** @brief Before the run: of the setting `time`, so many seconds have gone by already,
 * and what it takes to write the picture to these files (neph_render_image,
 * neph_image_write) is kept for after it. @param paths NULL-terminated, copied */
NEPH_API void neph_render_set_time_around(NephRender *render, double before,
                                          const char *const *paths);
/** @brief The settings, "name=value", that with those asked for, but `time` and `noise`,
 * make a render give the very same picture: the passes done, and what was chosen to fit
 * into the time. NULL-terminated, freed with g_strfreev; NULL: no pass is done. */
NEPH_API char **neph_render_repeat(const NephRender *render);
/** @brief Writes what has been rendered, and all that another process needs to go on with
 * it, to a file, under another name until it is whole and on the disk. Where
 * neph_render_image may be called and a pass is done, else NEPH_ERROR_USAGE.
 * NEPH_ERROR_INPUT or NEPH_ERROR_FAILED if the file can not be written; then the old one
 * is still there. */
NEPH_API bool neph_render_save_checkpoint(NephRender *render, const char *path,
                                          GError **error);
/** @brief The same, as long as go_on says so; else false with NEPH_ERROR_CANCELLED, and
 * the old file is still there. */
NEPH_API bool neph_render_save_checkpoint_while(NephRender *render, const char *path,
                                                NephGoOnFunc go_on, void *data,
                                                GError **error);
/** @brief Before the run: takes over the passes of a checkpoint. What comes then is what
 * an unbroken render gives, bit for bit. Of its settings only `passes`, `time`, `noise`
 * and `threads` may be others; `time` counts from the beginning of the first process.
 * NEPH_ERROR_INPUT with the reason if the file is damaged, cut off, or of another
 * program, scene, camera, size or settings; the render is then as new. */
NEPH_API bool neph_render_resume(NephRender *render, const char *path, GError **error);
/** @brief The same, as long as go_on says so; else false with NEPH_ERROR_CANCELLED, and
 * the render is as new. */
NEPH_API bool neph_render_resume_while(NephRender *render, const char *path,
                                       NephGoOnFunc go_on, void *data, GError **error);
/** @brief The settings that a checkpoint's render was asked for, and the size of its
 * picture, which may be NULL. Owned by the caller; NULL with NEPH_ERROR_INPUT. */
NEPH_API NephSettings *neph_checkpoint_settings(const char *path, int *width, int *height,
                                                GError **error);
/** @brief Asks neph_render_run to stop soon. Any thread; also from a signal handler. */
NEPH_API void neph_render_cancel(NephRender *render);
/** @brief The mean of the passes so far, with layers; owned by the caller. In the
 * progress function of neph_render_run noise is taken out in a quarter of the windows, in
 * less than half of the time, unless the setting denoise_windows says otherwise.
 * NEPH_ERROR_FAILED if memory is refused. */
NEPH_API NephImage *neph_render_image(const NephRender *render, GError **error);
/** @brief The same, as long as go_on says so, which matters while noise is taken out;
 * else NULL with NEPH_ERROR_CANCELLED. neph_render_cancel does not end it. */
NEPH_API NephImage *neph_render_image_while(const NephRender *render, NephGoOnFunc go_on,
                                            void *data, GError **error);
NEPH_SIZED void neph_render_statistics(const NephRender *render, NephStatistics *out);
/** @brief The relative error of the image, as in NephStatistics, found now: also from the
 * progress function of a render that is not asked to keep it. */
NEPH_API double neph_render_noise(const NephRender *render);
/** @brief A technique that trials measured, per camera sample or photon: that with which
 * variance times rays is less is taken. */
typedef struct NephPlanTrial {
    const char *what; /**< static */
    double variance_without, rays_without, variance_with, rays_with;
    bool taken;
} NephPlanTrial;

enum { NEPH_MOST_PLAN_TRIALS = 4 };

/** @brief What a render decides before its first pass: of scene and settings alone, the
 * same with any number of threads, and what the photons of neph_photons_trace are sent
 * by. */
typedef struct NephPlan {
    const char *integrator;                  /**< static */
    uint64_t photons[NEPH_N_PHOTON_CLASSES]; /**< sent each pass; 0: none */
    double radius[NEPH_N_PHOTON_CLASSES];    /**< m, in the first pass: everywhere, or the
                                                median */
    bool radius_is_set;                      /**< by the settings; else it is measured */
    bool guided;            /**< some photons start where trial ones arrived from */
    double discs;           /**< m²: by discs π r² N over the camera's samples photons
                               share caustics with paths; 0: they do not share */
    double spots;           /**< probability of looking at bright spots from a surface */
    double blurred_gathers; /**< probability that caustics are gathered where they are
                               seen by way of a diffuse bounce */
    int time_slices;        /**< of the shutter's time, each with photons of its own */
    double work;            /**< asked for, in rays: a first guess; 0: unknown */
    double planning;        /**< rays that trials cost */
    NephPlanTrial trials[NEPH_MOST_PLAN_TRIALS];
    int n_trials;
    bool guided_classes[NEPH_N_PHOTON_CLASSES]; /**< which of them do */
} NephPlan;

/** @brief What the render will do, or does: planned now if it has not begun. Not while
 * neph_render_run runs, but from its progress function.
 * @return false: there is no plan yet, in a progress function called before there is, or
 * with an error, NEPH_ERROR_CANCELLED or NEPH_ERROR_FAILED */
NEPH_SIZED bool neph_render_plan(NephRender *render, NephPlan *out, GError **error);
/** @brief The plan in words, a table for people; owned by caller. */
NEPH_SIZED char *neph_plan_text(const NephPlan *plan);
/** @brief Statistics as JSON (json true) or a table for people; owned by caller. */
NEPH_SIZED char *neph_statistics_text(const NephStatistics *statistics, bool json);

/* ---- One picture by many processes ---- */

/* Each process loads the scene and makes a render of the same settings (`time` 0 but in
   the one that plans). One of them plans, the others take its plan, and all render passes
   that it deals out, each number once. Their sums are added up in that one. The picture
   is that of one process, but for the order in which sums are rounded. */

/** @brief The plan, made now if it was not, for neph_render_take_plan in other processes;
 * g_bytes_unref. NULL with an error, as neph_render_plan. */
NEPH_API GBytes *neph_render_plan_bytes(NephRender *render, GError **error);
/** @brief Before the first pass: takes over the plan of another process, and settings
 * that it chose, in place of making one. NEPH_ERROR_INPUT with the reason if it is
 * damaged or of another program, scene or integrator, NEPH_ERROR_FAILED if its photons do
 * not fit into memory, NEPH_ERROR_USAGE if there is a plan; the render is then as it was.
 */
NEPH_API bool neph_render_take_plan(NephRender *render, GBytes *plan, GError **error);

/** @brief Renders pass number index (from 0) onto the sums, whole, whatever `passes`,
 * `time` and `noise` say. Not to be mixed with neph_render_run. progress may be NULL; its
 * fraction means nothing. */
NEPH_API bool neph_render_pass(NephRender *render, uint32_t index,
                               NephProgressFunc progress, void *data, GError **error);
/** @brief How many numbers the sums over passes are. */
NEPH_API size_t neph_render_count_sums(const NephRender *render);
/** @brief Copies numbers [first, first + n) of them. */
NEPH_API void neph_render_get_sums(const NephRender *render, size_t first, size_t n,
                                   double *out);
/** @brief Adds to them those of another process ... */
NEPH_API void neph_render_add_sums(NephRender *render, size_t first, size_t n,
                                   const double *more);
/** @brief ... and, when all are added, its passes, rays and seconds. The sums are those
 * of passes 0 to their number again before neph_render_save_checkpoint. */
NEPH_SIZED void neph_render_add_statistics(NephRender *render,
                                           const NephStatistics *more);
/** @brief Forgets sums and counts, which another process has; what is planned stays. */
NEPH_API void neph_render_forget(NephRender *render);
/** @brief For who deals passes and keeps the setting `time`: once there is a plan, what a
 * pass is expected to take by the trial that it was made with, or else by one made now,
 * s; 0: unknown. */
NEPH_API double neph_render_pass_seconds(NephRender *render);
/** @brief And what comes after the last one, by what is known so far: to take the noise
 * out, unless that takes too much of `time` and is left (NephStatistics.left_noisy), and
 * to write to the files of neph_render_set_time_around, s. It is found with the plan, and
 * anew by neph_render_pass in the beginning and when half of the time is over. */
NEPH_API double neph_render_seconds_after(const NephRender *render);
/** @brief The settings that passes are rendered by: those asked for, or after
 * neph_render_plan what was chosen to fit into `time`. Owned by the caller. */
NEPH_API NephSettings *neph_render_settings(const NephRender *render);
/** @brief A text that is the same in processes whose passes belong together: of the same
 * program, scene and plan, which is made if it was not. Owned by the caller; NULL with an
 * error. */
NEPH_API char *neph_render_fingerprint(NephRender *render, GError **error);

/* ---- What a scene is made of ---- */

/** @brief A place on a surface. Strings are the scene's. */
typedef struct NephSurfacePoint {
    double position[3];
    double normal[3]; /**< geometric, on the side the ray came from, unit */
    double distance;  /**< along the ray, m */
    int shape;        /**< number in the scene */
    const char *shape_kind;
    int material;              /**< number in the scene; -1: none */
    const char *material_name; /**< its name, or kind; "" if none */
    const char *file;          /**< where the shape comes from; NULL: unknown */
    int line;
} NephSurfacePoint;

/** @brief The first surface that the eye sees along a ray; direction is unit. */
NEPH_SIZED bool neph_scene_pick(const NephScene *scene, const double origin[3],
                                const double direction[3], NephSurfacePoint *out);
/** @brief The edges of the scene's shapes as *n line segments, six floats each; edges
 * within a plane are left out, and if there are more than `most` an even choice is made.
 * Curved shapes show lines on their surface, and meshes for whose edges memory is short
 * nothing. Owned by the caller (g_free); NULL if there is no memory for it. */
NEPH_API float *neph_scene_wireframe(const NephScene *scene, size_t most, size_t *n);

NEPH_API size_t neph_scene_n_materials(const NephScene *scene);
/** @brief Its name, or its kind if it has none. The scene's. */
NEPH_API const char *neph_scene_material_name(const NephScene *scene, size_t i);
NEPH_API const char *neph_scene_material_kind(const NephScene *scene, size_t i);

/** @brief A direction that a mirror or a smooth boundary sends light into. */
typedef struct NephBsdfRay {
    double angle; /**< as in NephBsdfPlot */
    float rgb[3]; /**< share of the light */
} NephBsdfRay;

/**
 * @brief What a material makes of light that comes in at an angle, in the plane of
 * incidence: for a polar diagram.
 *
 * The light comes from the left of the normal. Angles of outgoing directions are counted
 * in degrees from the normal to the right: below 90 is reflection, beyond is
 * transmission, 270..360 is back to the light.
 */
typedef struct NephBsdfPlot {
    double incidence; /**< degrees from the normal, 0..89 */
    size_t n;         /**< directions, evenly spaced: direction i is at 360 i / n */
    float *rgb; /**< [n][3], sr⁻¹: the BSDF for red, green and blue, where a white
                   material has all three alike */
    NephBsdfRay rays[2]; /**< what is not spread: reflected, transmitted */
    size_t n_rays;
} NephBsdfPlot;

/** @brief n: at least 4. NEPH_ERROR_USAGE if there is no such material or angle. */
NEPH_API NephBsdfPlot *neph_bsdf_plot(const NephScene *scene, size_t material,
                                      double incidence, size_t n, GError **error);
NEPH_API void neph_bsdf_plot_free(NephBsdfPlot *plot);
/** @brief The diagram as SVG, with a title. Owned by caller. */
NEPH_API char *neph_bsdf_plot_svg(const NephBsdfPlot *plot, const char *title);

/* g_autoptr(NephScene) scene = neph_scene_load(...); frees itself. */
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephSettings, neph_settings_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephScene, neph_scene_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephImage, neph_image_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephRender, neph_render_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(NephBsdfPlot, neph_bsdf_plot_free)

#ifdef __cplusplus
}
#endif

#include <nephroid/photons.h>

#endif
