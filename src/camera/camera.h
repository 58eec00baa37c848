/*
 * The camera: from a place on the film to a ray.
 *
 * Raster coordinates: x to the right, y down, pixel (i, j) covers [i, i+1) x [j, j+1).
 */
#pragma once

#include "math/motion.h"
#include "medium/hit.h"
#include "params/params.h"

typedef struct camera_kind camera_kind;

/** @brief A camera. Plain values, immutable in a committed scene. */
typedef struct camera {
    const camera_kind *kind;
    transform to_world;   /**< camera space (x right, y up, z forward) to world; where it
                             does not move */
    motion path;          /**< where it moves; times in seconds */
    float screen[4];      /**< x_min, x_max, y_min, y_max at z = 1; of an orthographic
                             camera in metres */
    float lens_radius;    /**< m; 0 = pinhole */
    float focal_distance; /**< m */
    float shutter_open, shutter_close; /**< s, from the beginning of ... */
    double begin;      /**< ... the picture: 0, or that of a frame of an animation, s */
    int width, height; /**< of the film, pixels */

    float half_screen;     /**< tan(fov / 2): half the shorter side of the screen */
    float aspect;          /**< frameaspectratio; 0 = the film's */
    bool has_window;       /**< a screenwindow is given, and the film's shape ignored */
    float window[4];       /**< x_min, x_max, y_min, y_max in half_screens */
    medium_stack media;    /**< that it is in; found by the scene */
    vec3 medium_at;        /**< a place in medium_there, where the scene put it */
    uint32_t medium_there; /**< a participating medium, as in a medium_stack */
    bool equal_area; /**< a spherical camera's mapping; else latitude and longitude */
} camera;

/** @brief By kind ("perspective", "orthographic", "spherical") from pbrt's parameters:
 * fov or halffov, mapping, screenwindow, frameaspectratio, lensradius, focaldistance,
 * shutteropen, shutterclose. */
bool camera_init(camera *c, const char *kind, const params *p, const transform *to_world,
                 int width, int height, GError **error);
/** @brief "perspective" ... */
const char *camera_kind_name(const camera *c);
/** @brief Name of kind number i of the table; NULL behind the last. */
const char *camera_kind_at(size_t i);
/** @brief What it may be given, blank-separated; NULL as above. */
const char *camera_kind_parameters(size_t i);
/** @brief Changes the film's size, keeping the field of view as pbrt would for that size.
 */
void camera_resize(camera *c, int width, int height);
/** @brief Where it is at a time of the shutter, 0..1. */
transform camera_at(const camera *c, float time);
/** @brief The ray through a place on the film: u_lens uniform in the unit square chooses
 * the place on the lens, u_time the time between the shutter's opening and closing. */
ray camera_ray(const camera *c, vec2 raster, vec2 u_lens, float u_time);
/** @brief Area on a plane facing the camera, at distance z along its axis, that one pixel
 * covers; of a spherical camera on average. */
float camera_pixel_area(const camera *c, float z);
/** @brief Raster position of a world point when the shutter opens; false if behind the
 * camera. */
bool camera_project(const camera *c, vec3 p, vec2 *raster);

/** @brief Places that camera_repeats may find. */
#define MOST_REPEATS 8

/** @brief Where else, beyond the film's borders, camera_ray sees what it sees at `raster`
 * on the film: what a spherical camera sees goes on there. Filters reach that far.
 * @return how many of out it has filled */
int camera_repeats(const camera *c, vec2 raster, vec2 out[MOST_REPEATS]);

/** @brief A point seen by the camera: what connects light to the eye. */
typedef struct camera_connection {
    vec3 direction; /**< from the point to the place on the lens, unit */
    float distance; /**< m */
    vec2 raster;    /**< where the film sees it, also outside the film */
    float pdf;      /**< as camera_pdf_direction */
} camera_connection;

/** @brief True if light can be connected to it: not to an orthographic camera, whose rays
 * start from no one place. */
bool camera_connects(const camera *c);
/** @brief Connects a point to the place on the lens that u_lens chooses, as camera_ray
 * does; false if it is behind the camera. @param time of the shutter, 0..1 */
bool camera_connect(const camera *c, vec3 p, vec2 u_lens, float time,
                    camera_connection *out);
/** @brief Pixels per solid angle around a ray's direction (world, unit), from any place
 * on the lens; 0 behind the camera. With places on the film chosen uniformly, one a
 * pixel, it is the pdf_solid_angle of camera_ray. */
float camera_pdf_direction(const camera *c, vec3 direction, float time);
