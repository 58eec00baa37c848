/*
 * The one step that every path takes, of photons and from the eye: from where it is to
 * its next event, through interfaces, nested media and cut-outs. And whether one point
 * sees another, through these and thin panes.
 *
 *        ray                 interface          ray goes on          surface
 *   ─────────────► · · · · ►│· · · · · · · · · · · · · · · · · · · ►█ EVENT_SURFACE
 *                  medium    \ meet_light, if it shines
 *                  └ cross_medium: EVENT_MEDIUM where the path scatters in it
 *
 * What a path does at an event is its own; how it gets there is here.
 */
#pragma once

#include "bsdf/bsdf.h"
#include "scene/view.h"

/** @brief What a path comes to. */
typedef enum scene_event {
    EVENT_NONE,    /**< of cross_medium: nothing happened on the way through */
    EVENT_ESCAPE,  /**< it leaves the scene */
    EVENT_SURFACE, /**< that has a material */
    EVENT_MEDIUM,  /**< a point where it scatters in a participating medium */
    EVENT_END      /**< it ends on the way */
} scene_event;

/** @brief A path at its head: where it goes, and what it carries. */
typedef struct path_segment {
    ray ray;
    spectrum throughput; /**< of a photon: its flux, W nm⁻¹ */
    int wavelength;      /**< the wavelength that is left of it, or ALL_WAVELENGTHS */
    const view *eye;     /**< it has not scattered on its way from there: shapes that the
                            camera does not see let it pass. NULL: it has, or never was */
    bool mirrors_only; /**< it comes from the eye, and has left by no lobe but SPECULAR */
    bool certain;      /**< likewise, and no chance has chosen its way */
} path_segment;

/** @brief A path that starts at the eye. */
static inline path_segment path_segment_from_eye(const view *eye, const ray *r)
{
    return (path_segment){*r, spectrum_fill(1.0f), ALL_WAVELENGTHS, eye, true, true};
}

/** @brief A path from the eye leaves a surface by a direction that was sampled there.
 * @param probability with which these lobes were sampled at all: 1 where both sides are
 * followed */
static inline void path_segment_leave(path_segment *at, const surface_hit *hit,
                                      const bsdf_sample *next, float probability)
{
    at->throughput *= next->weight / probability;
    at->wavelength = next->wavelength;
    at->ray = hit_ray(hit, next->wi);
    at->eye = NULL;
    at->mirrors_only = at->mirrors_only && (next->lobe & LOBE_SPECULAR);
    at->certain = at->certain && at->mirrors_only && next->pdf * probability >= 1.0f &&
                  next->wavelength == ALL_WAVELENGTHS;
}

/** @brief Who travels. Functions may be NULL. */
typedef struct scene_traveller {
    const scene *scene;
    const wavelengths *w;
    uint64_t *n_rays; /**< traced; increased */
    void *path;       /**< given to the functions */
    /** The path in its participating medium, which reaches length metres on its ray. It
     * weakens the throughput, and says where in it the path scatters, if it does. NULL:
     * it goes through, weakened. @param behind the surface at the end; NULL: there is
     * none. @param at where it is scattered, of EVENT_MEDIUM @return EVENT_NONE: it goes
     * through */
    scene_event (*cross_medium)(void *path, float length, const surface_hit *behind,
                                surface_hit *at);
    /** It came to a surface that shines. */
    void (*meet_light)(void *path, const surface_hit *hit);
    /** It looks for lights: straight through panes, weakened. How their bsdfs are made;
     * NULL: it stops there. */
    const bsdf_options *through_panes;
} scene_traveller;

/** @brief Takes a path to its next event.
 *  @param hit set where that is a surface or a point in a medium */
scene_event scene_advance(const scene_traveller *who, path_segment *path,
                          surface_hit *hit);

/** @brief What scatters there. @return false where nothing does */
bool scene_scatterer(const scene *s, const surface_hit *hit, const wavelengths *w,
                     int wavelength, const bsdf_options *options, bsdf *out);

/** @brief The nearest surface that has a material: a ray goes through interfaces.
 *  @param hit hit->t is measured from where r starts, m */
bool scene_meet_surface(const scene *s, const ray *r, surface_hit *hit);

/** @brief The nearest surface with a material behind the one that the ray met.
 *  @param hit that one; hit->t is measured from where r starts, m; hit->shape is NO_INDEX
 *  where there is none */
bool scene_meet_behind(const scene *s, const ray *r, surface_hit *hit);

/** @brief scene_meet_surface of the rays of a packet (accel_intersect_packet). */
void scene_meet_surfaces(const scene *s, const ray *rays, int n, surface_hit *hits);

/** @brief Takes a ray behind the next surface on it, cut-outs taken as solid; t_max
 * shrinks by the way made. @return false: it meets none */
bool scene_cross(const scene *s, ray *r, surface_hit *hit);

/** @brief A way crosses no more surfaces than this: a guard against endless loops on
 * degenerate geometry only. */
enum { MOST_CROSSINGS = 10000 };

/** @brief How far the participating medium that a ray starts in reaches on it. One that
 * no surface bounds ends where the ray leaves a sphere twice as large as scene and camera
 * need, so that light of the environment comes to them (pbrt-v4 too has lights beyond all
 * shine from there).
 *  @param length m: to the surface that the ray meets; INFINITY: it meets none */
float scene_medium_end(const scene *s, const ray *r, float length);

/** @brief Share of light that media leave on a ray, whatever surfaces stand on it. */
spectrum scene_transmittance(const scene *s, const ray *r, const wavelengths *w);

/** @brief How something is looked for. */
typedef struct scene_look {
    const scene *scene;
    const wavelengths *w;
    const bsdf_options *options; /**< for panes */
    int64_t most_panes;          /**< to look through; negative: any number */
} scene_look;

/** @brief Share of light that comes along a ray: media and thin panes weaken it, all
 * other surfaces but interfaces stop it. @return false: none comes */
bool scene_sees(const scene_look *look, const ray *r, spectrum *share);

/** @brief The same from a hit (hit_ray_to). @param distance m; INFINITY: beyond the scene
 */
bool scene_sees_from(const scene_look *look, const surface_hit *from, vec3 direction,
                     float distance, spectrum *share);
