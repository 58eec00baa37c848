/*
 * Library objects that several threads hold: counted, freed with the last holder.
 *
 * The worker makes scenes, pictures and photons and hands them to the window; both may
 * look at them as long as they hold them. What is held is not changed any more: who wants
 * a scene in another size, or from elsewhere, shares it (neph_scene_share).
 */
#pragma once

#include "session/messages.h"

#include <nephroid/nephroid.h>
#include <stdatomic.h>

typedef struct held_scene {
    atomic_int holders;
    NephScene *scene;
    NephCamera camera; /**< as the file says */
    int width, height; /**< as the file says */
    scene_log *log;    /**< its own; freed after it */
} held_scene;

/** @brief One state of the picture. */
typedef struct held_picture {
    atomic_int holders;
    NephImage *image;
    int width, height; /**< of the picture it stands for; the image may be coarser */
    bool coarse;       /**< a quick look, not a pass */
} held_picture;

typedef struct held_photons {
    atomic_int holders;
    NephPhotons *photons;
    NephScene *seen;   /**< as they were traced for */
    held_scene *scene; /**< kept alive with them */
} held_photons;

/** @brief Each takes what it is given, and is held once. */
held_scene *held_scene_new(NephScene *scene, scene_log *log);
held_picture *held_picture_new(NephImage *image, int width, int height, bool coarse);
held_photons *held_photons_new(NephPhotons *photons, NephScene *seen, held_scene *scene);

/** @brief One holder more. NULL gives NULL. */
held_scene *held_scene_ref(held_scene *scene);
held_picture *held_picture_ref(held_picture *picture);
held_photons *held_photons_ref(held_photons *photons);

/** @brief One holder less. NULL is fine. */
void held_scene_unref(held_scene *scene);
void held_picture_unref(held_picture *picture);
void held_photons_unref(held_photons *photons);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(held_scene, held_scene_unref)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(held_picture, held_picture_unref)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(held_photons, held_photons_unref)
