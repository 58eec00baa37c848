/*
 * How bright a picture of eight bits is made, and what is said where it would show
 * nothing.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief What the exposure of a picture follows. */
typedef struct exposure_wish {
    float stops;  /**< as asked for; 0 */
    bool is_free; /**< nobody asked, and the scene's format has no words for it: what
                     would be nearly black or white is exposed as it needs, with a note */
    bool no_notes;
} exposure_wish;

/** @brief The stops to write an image with. Tells of a picture that is nearly black or
 * white, and which exposure shows it.
 * @param silent says nothing: it is not the last one */
float exposure_of(const NephImage *image, const exposure_wish *wish, bool silent);

/** @brief Whether a file of this name has eight bits a colour: it has an exposure, and
 * shows the denoised layer. */
bool has_eight_bits(const char *path);
