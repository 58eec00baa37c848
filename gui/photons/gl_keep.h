/*
 * A picture that stays with the graphics from frame to frame, so that what takes long is
 * drawn into it part by part. All calls with the context current.
 */
#pragma once

#include <stdbool.h>

/** @brief Colours and depths. Zero: not made yet. */
typedef struct gl_keep {
    unsigned frame, color, depth;
    int width, height;
} gl_keep;

/** @brief Everything drawn from now on goes into it. Returns false if nothing has been
 * drawn in this size yet. */
bool gl_keep_begin(gl_keep *keep, int width, int height);
/** @brief Copies it to the frame that the area gave, where drawing goes on. */
void gl_keep_show(const gl_keep *keep, unsigned frame);
void gl_keep_clear(gl_keep *keep);
