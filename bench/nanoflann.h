/*
 * nanoflann behind a C face: the peer that map queries are measured against.
 */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct peer_tree peer_tree;

/** @brief A tree over n points, x y z interleaved; they must outlive it. */
peer_tree *peer_build(const float *xyz, size_t n);
void peer_free(peer_tree *tree);
/** @brief Number of points within radius of p; they are listed, unsorted. */
size_t peer_within(const peer_tree *tree, const float p[3], float radius);
/** @brief Finds the k nearest; returns their number. */
size_t peer_nearest(const peer_tree *tree, const float p[3], size_t k);

#ifdef __cplusplus
}
#endif
