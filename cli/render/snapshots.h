/*
 * Images written while the render goes on: every so many passes, or every so many seconds
 * once another pass is done.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct snapshots {
    int64_t passes;      /**< between two images, 0: not by passes */
    int64_t interval;    /**< µs between two, 0: not by time */
    int64_t last_passes; /**< of the last image */
    int64_t last_time;   /**< monotonic µs of the last image, or of the beginning */
} snapshots;

/** @brief Reads "N" or "Ns"; NULL: never. ERROR_USAGE naming the option. */
bool snapshots_init(snapshots *s, const char *text, GError **error);
/** @brief True if it is time for the next, which is then taken for written. */
bool snapshots_due(snapshots *s, int64_t passes_done);
