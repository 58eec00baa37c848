/*
 * What the importer's child tells its parent, in the bytes of the machine that both run
 * on: records of a head and a payload, each padded to eight bytes.
 *
 *   STREAM_MAGIC │ head payload │ head payload │ … │ head of STREAM_END
 *
 * A payload begins with the struct of its kind, if there is one; strings end with a zero.
 * The parent believes nothing of it (model.c); nothing here is kept in files, so that a
 * new version only needs another STREAM_MAGIC.
 */
#pragma once

#include <stdint.h>

#define STREAM_MAGIC "nephmdl1"

typedef enum stream_kind {
    STREAM_END,      /**< nothing: all is said */
    STREAM_ERROR,    /**< stream_error, text: there is no model */
    STREAM_NOTE,     /**< stream_note, text */
    STREAM_MATERIAL, /**< stream_material, name, names of N_STREAM_MAPS images */
    STREAM_IMAGE,    /**< stream_image, name, extension, bytes */
    STREAM_MESH,     /**< stream_mesh, positions, normals, uvs, indices */
    STREAM_INSTANCE, /**< stream_instance */
    STREAM_LIGHT,    /**< stream_light */
    STREAM_CAMERA,   /**< stream_camera */
    N_STREAM_KINDS
} stream_kind;

typedef struct stream_head {
    uint32_t kind, zero;
    uint64_t size; /**< of the payload, without padding */
} stream_head;

typedef enum stream_reason { STREAM_DAMAGED, STREAM_NO_MEMORY } stream_reason;

typedef struct stream_error {
    uint32_t reason, zero;
} stream_error;

/** @brief A remark for the developer, or a warning for the user. */
typedef enum stream_level { STREAM_DEBUG, STREAM_WARNING } stream_level;

typedef struct stream_note {
    uint32_t level, zero;
} stream_note;

typedef enum stream_map {
    STREAM_MAP_COLOR,
    STREAM_MAP_EMISSION,
    STREAM_MAP_OPACITY,
    STREAM_MAP_NORMALS,
    STREAM_MAP_HEIGHTS,
    N_STREAM_MAPS
} stream_map;

/** @brief Images are "*N", the N-th STREAM_IMAGE, or by the name of one, or files; ""
 * if there is none. */
typedef struct stream_material {
    float diffuse[3], specular[3], emission[3];
    float opacity, index, exponent;
    float metalness, roughness; /**< < 0: not given */
    float bump_strength;
    int32_t illum; /**< -1: not given */
} stream_material;

typedef struct stream_image {
    uint64_t n_bytes; /**< 0: of bare pixels, which are not told */
} stream_image;

enum { STREAM_HAS_NORMALS = 1, STREAM_HAS_UVS = 2 };

typedef struct stream_mesh {
    uint64_t n_vertices, n_triangles;
    uint32_t material, has;
} stream_mesh;

typedef struct stream_instance {
    double to_world[16]; /**< by rows; points are columns */
    uint32_t mesh, zero;
} stream_instance;

typedef enum stream_light_kind {
    STREAM_POINT,
    STREAM_SPOT,
    STREAM_DISTANT,
    N_STREAM_LIGHT_KINDS
} stream_light_kind;

typedef struct stream_light {
    double to_world[16];
    float position[3], direction[3], color[3];
    float inner_angle, outer_angle; /**< of a spot's whole cones, radians */
    uint32_t kind;
} stream_light;

typedef struct stream_camera {
    double to_world[16];
    float position[3], look_at[3], up[3]; /**< look_at: a direction */
    float aspect;                         /**< width over height; 0: not given */
    float fov;                            /**< across, radians */
    uint32_t zero;
} stream_camera;

_Static_assert(sizeof(stream_head) == 16 && sizeof(stream_material) == 64 &&
                   sizeof(stream_mesh) == 24 && sizeof(stream_instance) == 136 &&
                   sizeof(stream_light) == 176 && sizeof(stream_camera) == 176,
               "no holes");
