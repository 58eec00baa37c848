/*
 * Which solids a point is in.
 *
 * Solids nest and overlap: ice in a drink in a glass, whose liquid reaches into the glass
 * a little so that no gap shows. Where several are, light is absorbed by the smallest of
 * them: what lies within another displaces it. That the order in which a path entered
 * them does not matter makes the rule the same for photons and for paths from the eye.
 *
 * (Schmidt & Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002, with sizes
 * for their priorities.)
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct medium;

/** @brief What a solid of one material is filled with. */
typedef struct interior {
    const struct medium *medium; /**< NULL: clear */
    float size;                  /**< m: diagonal of the largest such solid */
} interior;

enum { SOLIDS_MOST = 4 };

/** @brief The solids around a point, the smallest first; NULL behind the last. Of more
 * than SOLIDS_MOST the largest are forgotten. A plain value. */
typedef struct solids {
    const interior *of[SOLIDS_MOST];
} solids;

/** @brief The order in which solids stand. */
static inline bool solids_before(const interior *a, const interior *b)
{
    if (a->size < b->size || b->size < a->size)
        return a->size < b->size;
    return a < b;
}

/** @brief The solids beyond the surface of one, when entering it. */
static inline solids solids_enter(solids m, const interior *in)
{
    for (int i = 0; i < SOLIDS_MOST && in; i++)
        if (!m.of[i] || solids_before(in, m.of[i])) {
            const interior *next = m.of[i];
            m.of[i] = in;
            in = next;
        }
    return m;
}

/** @brief The same when leaving it; nothing changes if it was never entered. */
static inline solids solids_leave(solids m, const interior *in)
{
    int i = 0;
    while (i < SOLIDS_MOST && m.of[i] != in)
        i++;
    for (; i < SOLIDS_MOST; i++)
        m.of[i] = i + 1 < SOLIDS_MOST ? m.of[i + 1] : NULL;
    return m;
}
