#include "held.h"

held_scene *held_scene_new(NephScene *scene)
{
    held_scene *held = g_atomic_rc_box_new(held_scene);
    held->scene = scene;
    neph_scene_camera(scene, &held->camera);
    neph_scene_size(scene, &held->width, &held->height);
    return held;
}

held_picture *held_picture_new(NephImage *image, int width, int height, bool coarse)
{
    held_picture *held = g_atomic_rc_box_new(held_picture);
    *held = (held_picture){image, width, height, coarse};
    return held;
}

held_photons *held_photons_new(NephPhotons *photons, held_scene *scene)
{
    held_photons *held = g_atomic_rc_box_new(held_photons);
    *held = (held_photons){photons, held_scene_ref(scene)};
    return held;
}

held_scene *held_scene_ref(held_scene *scene)
{
    return scene ? g_atomic_rc_box_acquire(scene) : NULL;
}

held_picture *held_picture_ref(held_picture *picture)
{
    return picture ? g_atomic_rc_box_acquire(picture) : NULL;
}

held_photons *held_photons_ref(held_photons *photons)
{
    return photons ? g_atomic_rc_box_acquire(photons) : NULL;
}

static void clear_scene(void *data)
{
    held_scene *held = data;
    neph_scene_free(held->scene);
}

static void clear_picture(void *data)
{
    held_picture *held = data;
    neph_image_free(held->image);
}

static void clear_photons(void *data)
{
    held_photons *held = data;
    neph_photons_free(held->photons);
    held_scene_unref(held->scene);
}

void held_scene_unref(held_scene *scene)
{
    if (scene)
        g_atomic_rc_box_release_full(scene, clear_scene);
}

void held_picture_unref(held_picture *picture)
{
    if (picture)
        g_atomic_rc_box_release_full(picture, clear_picture);
}

void held_photons_unref(held_photons *photons)
{
    if (photons)
        g_atomic_rc_box_release_full(photons, clear_photons);
}
