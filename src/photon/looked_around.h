/*
 * Looks that are shared: the samples of a pixel mostly see one surface, closer together
 * than the radius of an estimate. What one of them found around its disc
 * (neighbourhood.h) is so of the others' discs too, as far as a small part of that
 * radius; which of them looks is chance, and their mean that of all. Photons everyone
 * finds by itself: light stays as sharp as it was.
 *
 * Without them /looked-around/same-light fails, where a third of the looks is saved.
 */
#pragma once

#include "photon/neighbourhood.h"

/** @brief A disc that was looked at. */
typedef struct looked_disc {
    neighbourhood hood;
    kernel kernel;
    bool whole;
    float coverage; /**< share of the kernel's area that is surface in sight; 1: whole */
} looked_disc;

enum { LOOKED_DISCS = 8 }; /* size: of a pixel; the oldest is forgotten first */

/** @brief What a thread has seen of a pixel; zeroed, nothing. */
typedef struct looked_around {
    looked_disc discs[LOOKED_DISCS];
    unsigned n; /**< so far; those before the last LOOKED_DISCS are forgotten */
} looked_around;

/** @brief Looks at a disc. */
looked_disc disc_look(const neighbourhood *disc, const kernel *k);

/** @brief Forgets all: another pixel comes. */
static inline void looked_around_forget(looked_around *looked)
{
    looked->n = 0;
}

/** @brief A disc as large, beside this one on the same surface and in its sight. NULL:
 * none was looked at. */
const looked_disc *looked_around_find(const looked_around *looked,
                                      const neighbourhood *disc, const kernel *k);

void looked_around_put(looked_around *looked, const looked_disc *disc);
