/*
 * Quick looks: what is rendered while the view moves, and before the first pass is done.
 *
 * A quick look is a small picture with few photons, stretched over the large one. How
 * small is learned: the pixels that the last one made a second, times the time allowed.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief How fast quick looks are. Zero to begin. */
typedef struct preview_pace {
    double pixels_per_second; /**< of the last one; 0: none yet */
} preview_pace;

/** @brief The user's settings with all that takes long left out; owned by the caller.
 * extent: the diagonal of the scene, m. */
NephSettings *preview_settings(const NephSettings *wanted, double extent);
/** @brief Size of a quick look that takes about so many seconds, at most the whole. */
void preview_size(const preview_pace *pace, double seconds, const int whole[2],
                  int size[2]);
/** @brief Learns from one that took so long. */
void preview_note(preview_pace *pace, const int size[2], double seconds);
