/*
 * Many pictures of one scene: which frames, at what times, from where, and what their
 * files are called.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief A view of a camera path. */
typedef struct frame_look {
    double eye[3], at[3], up[3];
} frame_look;

typedef struct frames {
    bool are_asked; /**< else there is one picture */
    int first, last;
    double per_second;
    bool varies;   /**< grain, from frame to frame */
    GArray *looks; /**< of frame_look, the first for frame 1; NULL: the scene's camera */
} frames;

/** @brief Reads the options, of which any may be NULL; a camera path alone asks for all
 * its frames.
 * @param range "A-B" or "A" @param camera a file of lines LookAt and nine numbers */
bool frames_init(frames *f, const char *range, const char *per_second, const char *camera,
                 const char *grain, GError **error);
void frames_clear(frames *f);

/** @brief The name of a frame's file: a run of # becomes its number, with so many digits
 * or more; without any its number stands before the ending. Owned by the caller. */
char *frame_name(const char *pattern, int frame);
/** @brief s, from the beginning. */
double frame_time(const frames *f, int frame);
/** @brief Puts the camera where it is at a frame. @param read the scene's own, that is
 * like it in all else */
bool frame_place(const frames *f, int frame, const NephCamera *read, NephScene *scene,
                 GError **error);
