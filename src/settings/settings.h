/*
 * The settings and the one table they are described by.
 *
 * The pbrt Integrator's parameters, the command line, the manual, range checks and file
 * headers are all made from the table; adding a knob is adding a field and a row.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

enum { N_CLASSES = 3 }; /**< direct, indirect, caustic: see photon/photon.h */

typedef enum kernel_choice {
#define KERNEL(choice, word) KERNEL_##choice,
#include "settings/kernel.def"
#undef KERNEL
    N_KERNELS
} kernel_choice;
typedef enum map_choice {
#define MAP(choice, word) MAP_##choice,
#include "settings/map.def"
#undef MAP
    N_MAPS,
    MAP_AUTO = N_MAPS /**< the one that serves the settings best */
} map_choice;
/** How many windows the denoiser works in; by itself it takes fewer where time is short.
 */
typedef enum denoise_choice { WINDOWS_AUTO, WINDOWS_FINE, WINDOWS_COARSE } denoise_choice;
typedef enum roulette_choice { ROULETTE_MEAN, ROULETTE_MAX } roulette_choice;
typedef enum emission_choice {
    EMISSION_UNIFORM,
    EMISSION_GUIDED,
    EMISSION_SPECULAR_AREA /**< of caustics alone */
} emission_choice;
/** On what surfaces photons are stored: see photon/trace/trace.h. */
typedef enum photon_lobes_choice {
    PHOTON_LOBES_DIFFUSE,
    PHOTON_LOBES_NEEDED,
    PHOTON_LOBES_GLOSSY
} photon_lobes_choice;
typedef enum integrator_choice {
#define INTEGRATOR(choice, word) INTEGRATOR_##choice,
#include "settings/integrator.def"
#undef INTEGRATOR
    N_INTEGRATORS
} integrator_choice;
/** Which strategies vertex connection and merging uses: see transport/vcm/vcm.h. */
typedef enum vcm_choice { VCM_ALL, VCM_BPT, VCM_BPM, VCM_PPM, VCM_LIGHT } vcm_choice;

enum { MOST_TIME_SLICES = 64 };

/** @brief Every knob. Arrays are indexed by photon class. A plain value: copy it. */
typedef struct settings {
    int integrator;        /**< integrator_choice */
    double passes;         /**< 0: see settings_most_passes */
    double time;           /**< s; 0: no limit */
    double noise;          /**< relative error to stop at; 0: none */
    double planned_passes; /**< 0: see settings_planned_passes */
    int64_t spp;           /**< camera samples a pixel in each pass */
    int64_t first_spp;     /**< the same in the first pass; 0: spp */
    int64_t max_backward_bounces, max_forward_bounces; /**< -1: unlimited */
    bool final_gather;
    int64_t gather_rays;
    bool precompute_radiance;
    bool direct_illumination;
    bool shadow_rays;
    int64_t photons; /**< emitted a pass, shared among the classes left at 0; 0:
                        automatic, see settings_photons */
    int64_t class_photons[N_CLASSES]; /**< 0: a share of photons */
    bool photons_per_light;           /**< photons and class_photons are of each light */
    bool one_map;                     /**< see settings_one_map */
    int photon_lobes;                 /**< photon_lobes_choice */
    bool photon_survivors;            /**< stored after the roulette */
    int64_t class_nearest[N_CLASSES]; /**< 0: fixed radius */
    double radius;                    /**< m; 0: automatic */
    bool one_radius;                  /**< of a class: the same everywhere */
    int class_kernel[N_CLASSES];      /**< kernel_choice */
    double class_cone_k[N_CLASSES];
    int photon_map; /**< map_choice */
    double flatten; /**< height of the neighbourhood over its radius, 0..1; 1: a ball */
    bool edges;     /**< estimates are corrected at edges, corners and thin walls */
    bool gather_indirect;          /**< auto may take indirect light from photons */
    bool bright_spots;             /**< auto looks aside at brightly lit places */
    int64_t time_slices;           /**< of the shutter, where something moves */
    int roulette;                  /**< roulette_choice */
    int class_emission[N_CLASSES]; /**< emission_choice */
    bool multiple_samples;
    int vcm_strategies;  /**< vcm_choice */
    double alpha;        /**< Knaus & Zwicker 2011 */
    bool denoise;        /**< with a picture without noise beside */
    int denoise_windows; /**< denoise_choice */
    int64_t seed;
    int64_t camera_seed; /**< beside seed, of camera samples alone */
    int64_t threads;     /**< 0: one per processor */
    uint64_t given;      /**< bit i: row i of the table was set, by whatever name */
} settings;

typedef enum setting_type {
    SETTING_BOOL,
    SETTING_COUNT,
    SETTING_REAL,
    SETTING_CHOICE
} setting_type;

/** @brief One row. */
typedef struct setting_row {
    const char *name;
    setting_type type;
    size_t offset;             /**< in struct settings */
    const char *unit;          /**< "" if none */
    double low, high, initial; /**< inclusive; index for a choice, 0/1 for a bool. An
                                  initial value below low is allowed too: none */
    const char *const *words;  /**< NULL-terminated: those of a choice, behind that of
                                  `high` names of presets; of a number one, how its value
                                  below low is written; NULL: none */
    const char *aliases;       /**< other accepted names, blank-separated, "" if none */
    const char *users;         /**< which integrators read it */
    const char *doc;           /**< one sentence */
} setting_row;

/** @brief The table. */
const setting_row *settings_table(size_t *n);
/** @brief A row by name or alias (case-sensitive for names, not for aliases), or NULL. */
const setting_row *settings_find(const char *name);
/** @brief Whether the integrator that is set reads the row. */
bool settings_reads(const settings *s, const setting_row *row);
/** @brief "NAME is not read by INTEGRATOR, only by ...", owned by the caller; NULL: it
 * is.
 */
char *settings_unread_note(const settings *s, const setting_row *row);
/** @brief That of each row that was set in `given`; owned by the caller. */
GStrv settings_unread(const settings *s, const settings *given);
settings settings_default(void);
/** @brief Passes after which a render ends at the latest; of the last one may be wanted
 * only a part of the pixels. */
double settings_most_passes(const settings *s);
/** @brief Passes that decisions taken before the first one count on. It does not depend
 * on when `time` and `noise` end the render, so neither does what a pass renders. Less
 * than one where there is no time for a whole one. */
double settings_planned_passes(const settings *s);
/** Pixels lend one another half of a pass of so many samples at most
 * (render/film/film_halves.h). One pass of 1, 4, 8 and 16 has relMSE .24 .029 .013 .0053
 * and shown .082 .018 .015 .012 of print under a magnifier, .17 .032 .015 .0069 and .022
 * .0097 .0088 .0085 of papered walls. */
enum { MOST_LENT_SAMPLES = 4 };
/** @brief Whether noise is taken out of so many passes: two, or half a one that lends. */
bool settings_takes_noise_out(const settings *s, double passes);
/** Of so many planned samples a pixel noise is taken out of each light by itself; of less
 * of all as one, which takes three fifths of the time, and relMSE is 1.01 of that of
 * lights apart after one sample a pixel, but 1.08 after two and 1.12 (up to 1.6) after
 * four (18 scenes, 256 x 256). */
enum { SAMPLES_APART = 2 };
/** @brief Whether noise is taken out of all lights as one. */
bool settings_filters_together(const settings *s);
/** @brief Whether all photons go into one map, counted as indirect ones. */
bool settings_one_map(const settings *s);
/** @brief Photons emitted a pass, at most where that is automatic. */
int64_t settings_photons(const settings *s);
/** @brief Puts back what the integrator does not read. */
void settings_forget_unread(settings *s);
/** @brief Sets from text, checked against type and range. ERROR_USAGE naming setting,
 * what was expected and what was found. */
bool settings_set(settings *s, const char *name, const char *value, GError **error);
/** @brief The value as text that settings_set reads back to the same; owned by the
 * caller. */
char *settings_get(const settings *s, const setting_row *row);
/** @brief Reads a file of "name = value" lines, '#' comments. Errors name
 * FILE:LINE:COLUMN. */
bool settings_load(settings *s, const char *path, GError **error);
