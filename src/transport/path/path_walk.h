/*
 * The parts of a camera path's walk that more than one file has a hand in: path.c follows
 * it, path_medium.c takes it through media, path_spots.c looks aside at bright spots.
 */
#pragma once

#include "scene/advance.h"
#include "transport/path/path.h"

/* A camera path on its way. */
typedef struct camera_path {
    path_segment at;
    unsigned bounces;
    unsigned n_before;  /* followed bounces, and points in media, before the first diffuse
                           surface */
    unsigned n_diffuse; /* diffuse bounces */
    unsigned n_after;   /* followed bounces since the last diffuse one */
    float eta2;         /* takes refraction's scale of radiance out of roulette */
    float pdf; /* pdf_solid_angle of the direction; 0: specular or from the camera */
    vec3 from;
    float pdf_scatter; /* of the direction, by the bsdf of all wavelengths; where photons
                          share */
    bool every_light;  /* how lights were sampled there */
    bool guided;       /* a surface that it came to guides the denoiser */
    bool lights_met;   /* all that are on its ray: it goes through a medium */
    float looked;      /* probability that bright spots were looked at from there ... */
    bool by_either;    /* ... and it has lobes both diffuse and glossy */
} camera_path;

/* What one camera ray's path is traced with. */
typedef struct path_walk {
    scene_traveller who; /* its path is the walk */
    camera_path path;
    const path_pass *pass;
    const scene *scene;
    const settings *how;
    sampler *random;
    transport_scratch *scratch;
    radiance_sample *out;
    vec3 eye; /* where the camera ray began */
} path_walk;

/** @brief Counts one more bounce by a lobe. */
void camera_path_count(camera_path *path, unsigned lobe);

/** @brief Counts that it is seen by way of a point in a medium, before the bounce there
 * counts as a diffuse one. Surfaces that it comes to guide nothing. */
void camera_path_count_medium(camera_path *path);

/** @brief True if so many more bounces are more than the settings allow. */
bool path_is_cut(const path_walk *walk, const camera_path *path, unsigned more);

/** @brief Adds what light sampling says of a surface that the path came to. */
void path_sample_lights(path_walk *walk, const camera_path *path, const surface_hit *hit,
                        const bsdf *b);

/** @brief Adds what the caustic map says of it, if there is one. */
void path_gather_caustics(path_walk *walk, const camera_path *path,
                          const surface_hit *hit, const bsdf *b);

/** @brief True where light comes by followed bounces from a light to a diffuse surface of
 * this path, or a point in a medium. */
bool path_is_caustic(const camera_path *path);

/** @brief True if a gather that is seen by way of a diffuse bounce is left out by chance;
 * else the path counts for those that are. @param p_blurred of making it */
bool path_skips_gather(path_walk *walk, camera_path *path, float p_blurred);

/** @brief True if photons carry a part of such light. */
bool path_photons_share(const path_walk *walk, const camera_path *path);

/** @brief True where each light is sampled: grain shows on what is seen straight or in a
 * mirror. */
bool path_samples_every_light(const camera_path *path);

/** @brief The bsdf whatever wavelength the path has kept: b, or made in room. */
const bsdf *path_all_wavelengths(const path_walk *walk, const camera_path *path,
                                 const surface_hit *hit, const bsdf *b, bsdf *room);

/** @brief Adds what came from one light. */
void path_add_from(path_walk *walk, const camera_path *path, spectrum radiance,
                   int light);

/** @brief Adds what photons brought, with its parts by light groups. */
void path_add_parts(path_walk *walk, const camera_path *path, spectrum radiance);

/** @brief In a medium: adds what the photons in it send along the path's ray, and draws
 * how far light comes freely.
 *  @param length m: how far the medium reaches on the ray
 *  @return true if the path is scattered before that: *hit is the point */
bool path_meets_medium(path_walk *walk, camera_path *path, float length,
                       surface_hit *hit);

/** @brief The probability that spots are looked at from this surface, to which the path
 * has come. */
float path_looks(const path_walk *walk, const camera_path *path, const bsdf *b);

/** @brief Adds what is seen of a bright spot that is in sight of the surface. */
void path_look_at_spots(path_walk *walk, const camera_path *path, const surface_hit *hit,
                        const bsdf *b);

/** @brief MIS weight of a path that came here by itself, beside looking at spots from the
 * surface before. */
float path_weight_beside_spots(path_walk *walk, const camera_path *path,
                               const surface_hit *hit, const bsdf *b);
