/*
 * Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek, "Light
 * Transport Simulation with Vertex Connection and Merging", 2012): bidirectional path
 * tracing and photon mapping as one set of strategies, weighted against one another.
 *
 *   light y0 ── y1 ── ... ── ys        light subpaths, N a pass, kept as vertices
 *                            ┆  connect (a ray), or merge (yes within r of zt)
 *   eye  z0 ── z1 ── ... ── zt        a camera subpath; it connects to one light subpath
 *
 *   strategy                      vcm  bpt  bpm  ppm  light
 *   camera path meets the light     x    x    a    a    b
 *   camera vertex to the light      x    x
 *   camera vertex to light vertex  x    x
 *   light vertex to the eye        x    x              x
 *   merging                        x         x    c
 *
 * a: where the camera path has met mirrors and glass only; c: at its first vertex that
 * scatters otherwise, where it ends; b: lights seen directly. `light` therefore does not
 * see what stands in a mirror; the others are complete. Where several strategies find a
 * path they share it by the balance heuristic, so that their weights sum to one.
 *
 * A thin pane that light goes straight through is no vertex, and is connected through;
 * but not to the eye, to which it is as a mirror.
 *
 * To an orthographic camera light vertices are not connected; the other strategies then
 * share its paths.
 *
 * A flat curve turns to face every ray, so that light and eye see two surfaces there.
 * What it scatters is defined by rays from the eye. So light subpaths end at it, to be
 * merged with; what goes on from there is found from the eye alone. Vertices of one curve
 * merge as far as they lie along its axis, over the area that it shows across it. If
 * only light subpaths went on /flat-curves/room/vcm would fail, if only they were
 * connected to the eye from there /flat-curves/sky/vcm; without all of it an
 * environment's light on a curve is 0.4 % too bright.
 *
 * How the weights are known without looking back along a path: vcm_weights.h.
 *
 * Where something moves all vertices of a path must be of one time: light subpath i has
 * the i-th N-th part of the shutter's time, and a camera path connects to the one of its
 * own time. Merging, which joins two times, does so within a slice of time; vertices on
 * what moves are in the map where that is in the middle of the slice.
 *
 * A path that glass dispersed keeps one wavelength of the spectrum; if both subpaths did,
 * they meet only in the wavelength they share, by the zeros of the others. Densities for
 * weights are those of the bsdf of all wavelengths whatever a path has kept, for two
 * strategies that find the same path in the same wavelength must agree about its weights.
 */
#pragma once

#include "scene/advance.h"
#include "scene/kept_hit.h"
#include "transport/transport.h"
#include "transport/vcm/vcm_weights.h"

/** @brief Which strategies run (setting vcm_strategies). */
typedef struct vcm_strategies {
    bool connect;  /**< camera vertices to the light and to light vertices */
    bool merge;    /**< camera vertices with light vertices nearby */
    bool splat;    /**< light vertices to the eye */
    bool end_here; /**< merge at the first vertex, unweighted, and end there */
} vcm_strategies;

/** @brief What scattered on a subpath, in the order from the eye. */
typedef struct scattering_counts {
    unsigned n : 12,
        n_diffuse : 12,     /**< roulette ends paths long before these are full */
        n_panes : 7;        /**< gone straight through, besides */
    bool first_diffuse : 1; /**< of a camera subpath: the first was a diffuse lobe */
} scattering_counts;

/** @brief Where light arrived at a surface that scatters not only as a mirror. The hit is
 * restored where it is asked for: passes hold millions of these. */
typedef struct light_vertex {
    spectrum flux; /**< that arrived; one of N */
    kept_hit hit;  /**< light came to it along kept_hit_wo */
    partial_weights weights;
    scattering_counts before; /**< what scattered between light and here */
    int light;                /**< that it left */
    float alone;              /**< see vcm_weights.h */
} light_vertex;

_Static_assert(sizeof(light_vertex) <= 128, "a light vertex is at most two cache lines");

/** @brief What merging asks of a light vertex, in one cache line: kept in the order of
 * the map, so that what is near in space is near in memory. */
typedef struct merge_vertex {
    spectrum flux;
    float wi[3]; /**< to where light came from */
    partial_weights weights;
    scattering_counts before;
    int light;
} merge_vertex;

_Static_assert(sizeof(merge_vertex) == 64, "a merge reads one cache line");

/** @brief The light subpaths of a pass. */
typedef struct light_paths {
    size_t n;               /**< N */
    light_vertex *vertices; /**< path after path, owned */
    size_t n_vertices;
    size_t *end;   /**< of path i: its vertices end before end[i]; owned */
    splat *splats; /**< of light vertices connected to the eye, owned */
    size_t n_splats;
} light_paths;

/** @brief One pass: light subpaths traced and put in a map. Const while the camera looks.
 */
typedef struct vcm_pass {
    const transport_plan *plan;
    const scene *scene;
    wavelengths w;
    uint32_t index;
    vcm_strategies strategies;
    strategy_ratios ratios;
    float radius;            /**< of merging, m */
    int n_slices;            /**< of the shutter's time, that merge apart */
    bool camera_hides;       /**< some shape is not seen by the camera */
    bool camera_facing_ends; /**< light subpaths end at what turns to face rays */
    float camera_per_light; /**< camera samples of a pixel over light subpaths, spp / N */
    light_paths light;
    photon_map *map;      /**< of light vertices by number; NULL: no merging */
    merge_vertex *merged; /**< of each photon of the map; owned */
} vcm_pass;

/** @brief Where a vertex on what moves lies in the map; others where they are. */
static inline transform vcm_motion_to_map(const vcm_pass *pass, const surface_hit *hit)
{
    int slice = time_slice(hit->time, pass->n_slices);
    return scene_motion_to(pass->scene, hit, time_of_slice(slice, pass->n_slices));
}

/** @brief True if light subpaths go no further than the hit. */
static inline bool vcm_ends_light(const vcm_pass *pass, const surface_hit *hit)
{
    return hit->camera_facing && pass->camera_facing_ends;
}

/** @brief Traces a few light subpaths and keeps in plan->vertex_radii how close they lie.
 */
bool vcm_keep_density(transport_plan *plan, const cancel_flag *cancel, GError **error);

/** @brief Of a vertex that chance has led to: one over one more than the light
 * vertices that merging finds there. @param hits scratch */
float vcm_alone_at(const vcm_pass *pass, const surface_hit *hit, point_hits *hits);

/** @brief The strategies of a vcm_choice. */
vcm_strategies vcm_strategies_of(int choice);

/** @brief A light vertex as a photon; its flux, one of N, is its share of the lights'. */
photon vcm_photon(const vcm_pass *pass, const light_vertex *v);

/** @brief Tells each event of light subpath i (photon_sender.tell). */
void vcm_tell_light(const vcm_pass *pass, uint64_t i, photon_listener tell, void *data);

/** @brief Traces pass->light and connects it to the eye. */
bool vcm_trace_light(vcm_pass *pass, const cancel_flag *cancel, transport_counts *counts,
                     GError **error);
void light_paths_clear(light_paths *paths);

/** @brief A surface point of a subpath, with what scatters there. */
typedef struct vcm_vertex {
    const surface_hit *hit;
    bsdf bsdf;   /**< of all wavelengths: evaluates, and tells densities */
    vec3 wo;     /**< to where the subpath came from */
    float alone; /**< see vcm_weights.h */
} vcm_vertex;

/** @brief The two classes of lobes that are evaluated, apart, for the layers. */
typedef struct lobe_pair {
    spectrum value[2]; /**< LOBE_DIFFUSE, LOBE_GLOSSY */
} lobe_pair;

/** @brief f(wo, wi) |cosθ_i| with the shading normal's cosine. */
lobe_pair vcm_scatter(const vcm_vertex *v, vec3 wi, transport_mode mode);

static inline bool lobe_pair_is_black(const lobe_pair *f)
{
    return spectrum_is_black(f->value[0]) && spectrum_is_black(f->value[1]);
}

/** @brief pdf_solid_angle of the subpath going on to wi. */
static inline float vcm_pdf(const vcm_vertex *v, vec3 wi, transport_mode mode)
{
    return bsdf_pdf(&v->bsdf, v->wo, wi, LOBE_ALL, mode);
}

/** @brief pdf_solid_angle with which the other kind of subpath, arriving from wi, goes on
 * to where this one came from. @param mode of this subpath */
static inline float vcm_pdf_reverse(const vcm_vertex *v, vec3 wi, transport_mode mode)
{
    transport_mode other =
        mode == TRANSPORT_RADIANCE ? TRANSPORT_IMPORTANCE : TRANSPORT_RADIANCE;
    return bsdf_pdf(&v->bsdf, wi, v->wo, LOBE_ALL, other);
}

/** @brief Lists in scratch->hits the light vertices that v merges with: those in the map
 * within reach that are on its surface. @param first the eye sees v: edges are minded
 * @return the kernel's area that they are a density over, m²; 0: none, or no memory */
float vcm_find_vertices(const vcm_pass *pass, const vcm_vertex *v, const kernel *kappa,
                        bool first, estimate_scratch *scratch);

/** @brief A subpath on its way. */
typedef struct vcm_walk {
    path_segment at;
    vec3 from;  /**< where it scattered last, or started */
    float eta2; /**< takes refraction's scale of radiance out of roulette */
    partial_weights weights, before; /**< there, and before it came there */
    scattering_counts counts;
    unsigned lobe; /**< that it left its last vertex by */
    bool straight; /**< it left through a pane, which is no vertex */
    transport_mode mode;
} vcm_walk;

/** @brief Goes on from v by one of the lobes, roulette apart. @return false: absorbed.
 * @param probability with which these are followed: path_segment_leave */
bool vcm_bounce(const vcm_pass *pass, vcm_walk *walk, const vcm_vertex *v, unsigned lobes,
                float probability, sampler *random);

/** @brief The layer that a path of these scattering events from the eye to the light
 * belongs to. */
radiance_layer vcm_layer(scattering_counts counts);

/** @brief Counts one more event behind those from the eye. */
scattering_counts vcm_count(scattering_counts from_eye, bool diffuse);

/** @brief Counts from the eye, then those of a light subpath. */
static inline scattering_counts vcm_join(scattering_counts eye, scattering_counts source)
{
    eye.n += source.n;
    eye.n_diffuse += source.n_diffuse;
    eye.n_panes += source.n_panes;
    return eye;
}

/** @brief How many events more than these, and so many more, a path may have; negative:
 * it would be longer than asked for. */
static inline int64_t vcm_events_left(const vcm_pass *pass, scattering_counts counts,
                                      unsigned more)
{
    int64_t limit = pass->plan->how.max_backward_bounces;
    return (limit < 0 ? INT64_MAX : limit) - counts.n - counts.n_panes - more;
}

/** @brief True if a path of so many events, and so many more, is not longer than asked
 * for. */
static inline bool vcm_length_allowed(const vcm_pass *pass, scattering_counts counts,
                                      unsigned more)
{
    return vcm_events_left(pass, counts, more) >= 0;
}

/** @brief Share of light that comes from a point at distance in direction to a hit.
 * @param most_panes that may stand between them @return false: none does */
bool vcm_visible(const vcm_pass *pass, const surface_hit *from, vec3 direction,
                 float distance, int64_t most_panes, spectrum *transmittance);

/** @brief Follows a camera ray (transport_kind.radiance). */
void vcm_radiance(const void *pass, const ray *r, sampler *random,
                  transport_scratch *scratch, radiance_sample *out);
