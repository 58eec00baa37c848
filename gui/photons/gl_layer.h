/*
 * Points and lines by OpenGL: one program, some buffers. All calls with the context
 * current.
 */
#pragma once

#include "photons/photon_cloud.h"

/** @brief One buffer of vertices. Zero: not made yet. */
typedef struct gl_layer {
    unsigned array, buffer;
    size_t n;
} gl_layer;

typedef struct gl_painter {
    unsigned program;
    int matrix, point_size, fade, shift;
    float pixel[2]; /**< one of the window's, in clip space */
} gl_painter;

/** @brief Compiles. false with a message in *error. es: for OpenGL ES. */
bool gl_painter_init(gl_painter *p, bool es, GError **error);
void gl_painter_clear(gl_painter *p);
/** @brief Begins to draw on so many pixels. column-major matrix to clip space. */
void gl_painter_begin(gl_painter *p, const float matrix[16], const int pixels[2]);
/** @brief Wipes what is there, also the depths. */
void gl_painter_clear_picture(const float background[3]);

/** @brief Replaces the vertices. */
void gl_layer_set(gl_layer *layer, const cloud_vertex *vertices, size_t n);
void gl_layer_clear(gl_layer *layer);
/** @brief The vertices as lines of a width in pixels, colours multiplied by fade (with
 * alpha). */
void gl_layer_lines(const gl_painter *p, const gl_layer *layer, float fade, int width);
/** @brief Points first .. first + n. */
typedef struct gl_points {
    size_t first, n;
    float size; /**< pixels */
    float fade; /**< as for lines */
} gl_points;

void gl_layer_points(const gl_painter *p, const gl_layer *layer, const gl_points *points);
