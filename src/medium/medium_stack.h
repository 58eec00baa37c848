/*
 * Which media a point is in.
 *
 * Solids nest and overlap: ice in a drink in a glass, whose liquid reaches into the glass
 * a little so that no gap shows. Where several are, light is absorbed by the smallest of
 * them: what lies within another displaces it. That the order in which a path entered
 * them does not matter makes the rule the same for photons and for paths from the eye.
 * (Schmidt & Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002, with sizes
 * for their priorities.)
 *
 * Beside the solids there is one participating medium at most. All are numbers that the
 * scene looks up (scene_solid_medium, scene_medium), so that a stack is 20 bytes of a ray
 * of 64.
 */
#pragma once

#include <stdint.h>

enum { SOLIDS_MOST = 4 };

/** @brief The media around a point. A plain value; all zero: none. */
typedef struct medium_stack {
    uint32_t
        solid[SOLIDS_MOST]; /**< ranks of solids, by size from 1, the smallest first;
                               0 behind the last. Of more the largest are forgotten */
    uint32_t participating; /**< index in scene->media + 1; 0: none. The home of photons
                               that scatter in it */
} medium_stack;

/** @brief The solids beyond the surface of one, when entering it; rank 0 is none. */
static inline medium_stack medium_stack_enter(medium_stack m, uint32_t solid)
{
    for (int i = 0; i < SOLIDS_MOST && solid; i++)
        if (!m.solid[i] || solid < m.solid[i]) {
            uint32_t next = m.solid[i];
            m.solid[i] = solid;
            solid = next;
        }
    return m;
}

/** @brief The same when leaving it; nothing changes if it was never entered. */
static inline medium_stack medium_stack_leave(medium_stack m, uint32_t solid)
{
    int i = 0;
    while (i < SOLIDS_MOST && m.solid[i] != solid)
        i++;
    for (; i < SOLIDS_MOST; i++)
        m.solid[i] = i + 1 < SOLIDS_MOST ? m.solid[i + 1] : 0;
    return m;
}
