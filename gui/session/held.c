#include "session/held.h"

/* Every object begins with its count. C's own atomics, which the thread sanitizer sees.
 */

static void *hold(void *object)
{
    if (object)
        atomic_fetch_add((atomic_int *)object, 1);
    return object;
}

/* True if that was the last holder. */
static bool let_go(void *object)
{
    return object && atomic_fetch_sub((atomic_int *)object, 1) == 1;
}

held_scene *held_scene_new(NephScene *scene, scene_log *log)
{
    held_scene *held = g_new0(held_scene, 1);
    atomic_init(&held->holders, 1);
    held->scene = scene;
    held->log = log;
    neph_scene_camera(scene, &held->camera);
    neph_scene_size(scene, &held->width, &held->height);
    return held;
}

held_picture *held_picture_new(NephImage *image, int width, int height, bool coarse)
{
    held_picture *held = g_new0(held_picture, 1);
    atomic_init(&held->holders, 1);
    held->image = image;
    held->width = width;
    held->height = height;
    held->coarse = coarse;
    return held;
}

held_photons *held_photons_new(NephPhotons *photons, NephScene *seen, held_scene *scene)
{
    held_photons *held = g_new0(held_photons, 1);
    atomic_init(&held->holders, 1);
    held->photons = photons;
    held->seen = seen;
    held->scene = held_scene_ref(scene);
    return held;
}

held_scene *held_scene_ref(held_scene *scene)
{
    return hold(scene);
}

held_picture *held_picture_ref(held_picture *picture)
{
    return hold(picture);
}

held_photons *held_photons_ref(held_photons *photons)
{
    return hold(photons);
}

void held_scene_unref(held_scene *scene)
{
    if (!let_go(scene))
        return;
    neph_scene_free(scene->scene);
    scene_log_free(scene->log);
    g_free(scene);
}

void held_picture_unref(held_picture *picture)
{
    if (!let_go(picture))
        return;
    neph_image_free(picture->image);
    g_free(picture);
}

void held_photons_unref(held_photons *photons)
{
    if (!let_go(photons))
        return;
    neph_photons_free(photons->photons);
    neph_scene_free(photons->seen);
    held_scene_unref(photons->scene);
    g_free(photons);
}
