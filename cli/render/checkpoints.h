/*
 * When a render under way is written to its checkpoint: after so many seconds, at the end
 * of a pass, and at the end of all.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct checkpoints {
    const char *path;     /**< NULL: there are none */
    int64_t interval;     /**< µs */
    int64_t last_time;    /**< monotonic µs */
    int64_t saved_passes; /**< that are in the file */
    bool failed;          /**< the last one could not be written, and that was told */
} checkpoints;

/** @brief every: seconds, as 60 or 60s; NULL: as usual. */
bool checkpoints_init(checkpoints *c, const char *path, const char *every,
                      GError **error);
/** @brief Writes one if it is due. What can not be written is told once; the render goes
 * on. */
void checkpoints_show(checkpoints *c, NephRender *render, int64_t passes);
/** @brief Writes what is not yet in the file. @return an exit code */
int checkpoints_end(checkpoints *c, NephRender *render);
