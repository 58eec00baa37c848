/*
 * A view of a scene: through which camera, onto which film.
 *
 *   scene_builder_view ─► the first view ─► view_share ─► view_resize, view_place_camera
 *
 * A camera that moves or a picture of another size is another view of the same scene, and
 * as cheap as a few rays. Queries are thread-safe while the view is not changed.
 */
#pragma once

#include "camera/camera.h"
#include "camera/filter.h"
#include "scene/scene.h"
#include "scene/scene_film.h"

typedef struct view {
    const scene *scene;
    camera camera; /**< with the media that it is in */
    film_settings film;
    pixel_filter filter;
    float pixel_width, pixel_spread; /**< m, and m a metre: how wide a pixel sees */
    scene *owned; /**< the scene, of the first view, to which filter and file name belong,
                     too; NULL: they are borrowed from it */
} view;

/** @brief Another view of the same scene, to be changed; what it borrows must outlive it.
 * @return owned by the caller */
view *view_share(const view *v);
/** @brief Of the first view, its scene too. */
void view_free(view *v);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(view, view_free)

/** @brief Another size of the picture. */
void view_resize(view *v, int width, int height);
/** @brief Lets the camera move so; times in seconds. To be called, too, after another
 * field of the camera was changed: finds how wide a pixel sees, and the media that it is
 * in. */
void view_place_camera(view *v, const motion *to_world);

/** @brief Nearest hit of a ray from the eye, as by scene_intersect: it passes shapes that
 * the camera does not see (camera_visible). */
bool view_see(const view *v, const ray *r, surface_hit *hit);
/** @brief What radiance is multiplied by on the film, as pbrt's sensor does it: iso / 100
 * times the seconds that the shutter is open. */
float view_imaging_ratio(const view *v);
