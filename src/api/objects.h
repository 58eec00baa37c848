/*
 * What the opaque objects of the installed header hold.
 */
#pragma once

#include "image/image.h"
#include "nephroid/nephroid.h"
#include "params/sources.h"
#include "scene/view.h"
#include "settings/settings.h"

struct NephSettings {
    settings values;
};

struct NephScene {
    view *view;                        /**< the first, or of another's scene ... */
    const scene *scene;                /**< ... which it sees */
    bool shares;                       /**< the files' list, too, is another's */
    scene_sources *sources;            /**< the files that it was read from */
    bool lenient, thin_glass, at_time; /**< as it was loaded */
    double time;
    NephLogFunc log; /**< the caller's, may be NULL; used while a scene is read */
    void *log_data;
};

struct NephImage {
    image *image;
};

/** @brief Wraps an image, which is taken; NULL gives NULL. */
NephImage *neph_image_wrap(image *img);
