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
