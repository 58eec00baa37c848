/*
 * The photon pass: emit, follow, store (Jensen 2001, §5).
 *
 * Each class of photon is traced apart with its own number of emissions N. What a photon
 * has done so far decides its class when it lands; it is stored if that is the class
 * being traced and the surface has a lobe that the map serves:
 *
 *   light ──────────────► D          direct
 *   light ─► (S|G)+ ────► D          caustic
 *   light ─► ... D ... ─► D          indirect
 *
 * (D, G, S: a diffuse, glossy, specular lobe; see bsdf/bsdf.h; a point in a medium where
 * light is scattered is as a D, and going straight through a thin pane is nothing). A
 * glossy lobe alone takes photons only from delta lights by way of S*: all else that it
 * reflects, camera paths find by following it. So every path of light is counted once. By
 * the setting photon_lobes it may take none, or all, and is then as a D. By one_map the
 * photons of all classes are traced and stored at once, as indirect ones: the direct ones
 * if lights are not sampled.
 *
 * Where something moves, every photon has a time of its own: the i-th of N in a slice of
 * the shutter's time that of the i-th N-th part of it, so that times, and the other
 * numbers within any stretch of time, are spread evenly. A photon that lands on something
 * that moves is kept where that will be in the middle of the slice.
 *
 * Russian roulette keeps photons of near equal power: survive with p = g(β Φ)/g(Φ), or
 * most_survival() if that is less, Φ ← Φ β / p, where g is the mean or the maximum over
 * wavelengths.
 */
#pragma once

#include "base/parallel.h"
#include "photon/photon.h"
#include "photon/trace/caustic_mis.h"
#include "photon/trace/emit.h"

/** Photons and paths from the eye end also among white walls and in a box of mirrors,
 * after about so many bounces: more than any picture shows. A closed room of which
 * nothing absorbs anything takes half and twice the time with half and twice as many; one
 * that reflects 0.99 is the same to a relMSE of 1.4e-6. */
#define LONG_PATH 500.0f

/** @brief The most that a path survives with that has had n bounces: all but one for the
 * first ones, so that clear glass brings no grain, and less and less on a long path. */
static inline float most_survival(int64_t n)
{
    float part = (float)n / LONG_PATH;
    return expf(-part * part / LONG_PATH);
}

/** @brief Lobes that a path from the eye and a caustic photon go on by. */
static inline unsigned photon_followed_lobes(const settings *how)
{
    bool gathers_all = how->photon_lobes == PHOTON_LOBES_GLOSSY;
    return gathers_all ? LOBE_SPECULAR | LOBE_ANY_SIDE : LOBE_FOLLOWED;
}

/** @brief Whether photons are kept off metal however rough, so that it is gone on from.
 */
static inline bool photon_follows_metals(const settings *how)
{
    return how->photon_lobes == PHOTON_LOBES_DIFFUSE;
}

/** @brief All others: light that they reflect is gathered, and what they scatter is
 * indirect. */
static inline unsigned photon_gathered_lobes(const settings *how)
{
    return (LOBE_ALL & ~photon_followed_lobes(how)) | LOBE_ANY_SIDE;
}

/** @brief What to trace. A plain value; the pass is a pure function of it. */
typedef struct trace_task {
    const scene *scene;
    const settings *how;
    wavelengths w;
    uint32_t pass;
    photon_class photon_class;      /**< of one map for all: PHOTON_INDIRECT */
    const caustic_casters *casters; /**< for caustics that are not EMISSION_UNIFORM */
    const emission_guide *guide;    /**< for EMISSION_GUIDED; NULL: uniform */
    const caustic_mis *mis; /**< of caustics: what they leave to paths from the eye;
                                   NULL: nothing. With it, photons that landed go on and
                                   land again where specular or glossy bounces take them
                                   next */
    uint64_t n_photons;     /**< that the light is shared among */
    uint64_t first;         /**< index of the first of them */
    uint64_t begin, end;    /**< those of them to emit: [begin, end); 0, 0: all */
    int slice, n_slices; /**< of the shutter's time, that they are emitted in; 0 of 0: all
                            of it */
    const cancel_flag *cancel; /**< may be NULL */
} trace_task;

/** @brief What came of it. */
typedef struct trace_result {
    photon_store photons; /**< in the order of emission; flux of each is its share of N */
    photon_store in_media; /**< the same of those that were scattered in media; their
                              homes are the media (medium_home) */
    uint64_t n_rays;
    uint64_t n_not_finite; /**< photons dropped since their flux was not finite */
} trace_result;

/**
 * @brief Traces in parallel; the result does not depend on the number of threads.
 * @param oriented photons keep their surfaces' normals
 * @return false with ERROR_FAILED (memory) or ERROR_CANCELLED; result is then empty
 */
bool photon_trace(const trace_task *task, bool oriented, trace_result *result,
                  GError **error);
void trace_result_clear(trace_result *result);

/** @brief The six numbers that photon `index` of the task starts from, and their density:
 * what the guide learns from. */
float photon_start_point(const trace_task *task, uint64_t index,
                         float u[EMISSION_DIMENSIONS]);

/** @brief What happened to a photon at one place. */
typedef enum photon_event_kind {
    PHOTON_EMITTED,
    PHOTON_STORED,
    PHOTON_SCATTERED,
    PHOTON_ABSORBED,
    PHOTON_ENDED, /**< no lobe left for its class, or the bounce limit */
    PHOTON_LEFT,  /**< the scene */
} photon_event_kind;

typedef struct photon_event {
    photon_event_kind kind;
    uint64_t index;         /**< of the photon, in order of emission */
    vec3 p, direction;      /**< where, and whither it goes on */
    const surface_hit *hit; /**< NULL for EMITTED and LEFT; in a medium on no shape */
    int light;
    unsigned lobe;    /**< of SCATTERED */
    spectrum flux;    /**< of the photon after the event, its share alone */
    float mis_weight; /**< see trace_task.mis */
} photon_event;

/** @brief Hears of each event. */
typedef void (*photon_listener)(const photon_event *event, void *data);

/** @brief Traces photon `index` of the task alone and tells each event. */
void photon_tell(const trace_task *task, uint64_t index, photon_listener tell,
                 void *data);

/** @brief Puts photons behind others of the same sort, which they leave. */
bool trace_result_append(trace_result *to, trace_result *from, GError **error);
