/*
 * What NephRender is, for the files of the API that are about it.
 */
#pragma once

#include "api/objects.h"
#include "render/render.h"

struct NephRender {
    render *render;
    const NephScene *scene;
    char *fingerprint;         /**< of the scene; NULL: not asked for yet */
    NephProgressFunc progress; /**< of the run under way */
    void *progress_data;
};

/** @brief A render_progress that tells the caller's; data: NephRender. */
bool render_forward_progress(double fraction, const render_statistics *so_far,
                             void *data);
