/*
 * --layer NAME=FILE: layers of a picture as pictures of their own.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief Whether each word is NAME=FILE and the file can be written. @param words may be
 * NULL */
bool layers_check(char **words, GError **error);
/** @brief The file of a word: its end. */
const char *layer_file(const char *word);
/** @brief Whether the image has them; before the first pass, so that none is rendered in
 * vain: what only many passes have is taken to be there. */
bool layers_known(char **words, const NephImage *image, GError **error);
/** @brief A layer as a picture. In eight bits normals are halved and shifted to 0..1, and
 * depths are of the largest. Owned by the caller. */
NephImage *layer_picture(const NephImage *image, const char *name, const char *path,
                         GError **error);
/** @brief Writes all. @param stops for pictures of eight bits, but of normals and depths
 */
bool layers_write(char **words, const NephImage *image, float stops, GError **error);
