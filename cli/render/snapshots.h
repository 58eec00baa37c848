/*
 * Images written while the render goes on: every so many passes, or where so many seconds
 * are over when a pass is done. Between passes, when there are no photons in memory:
 * image and photons together would be more than `info` tells.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct snapshots {
    int64_t passes;      /**< between two images, 0: not by passes */
    int64_t interval;    /**< µs between two, 0: not by time */
    int64_t last_passes; /**< of the last image */
    int64_t seen_passes; /**< when it was last asked for */
    int64_t last_time;   /**< monotonic µs of the last image, or of the beginning */
} snapshots;

/** @brief Reads "N" or "Ns"; NULL: never. ERROR_USAGE naming the option. */
bool snapshots_init(snapshots *s, const char *text, GError **error);
/** @brief True if it is time for the next, which is then taken for written; when it is
 * first asked with so many passes. */
bool snapshots_due(snapshots *s, int64_t passes_done);
