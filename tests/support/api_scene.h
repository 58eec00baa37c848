/*
 * A scene of the installed header, written to a folder of its own.
 */
#pragma once

#include "nephroid/nephroid.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

static char *folder;

/** A lamp in a ball, and another of glass. */
static const char world[] =
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 16\n"
    "Integrator \"photonmap\" \"integer passes\" 1 \"integer photons\" 3000\n"
    "    \"string caustic_emission\" \"uniform\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1.8 0]\n"
    "MakeNamedMaterial \"walls\" \"string type\" \"diffuse\"\n"
    "    \"rgb reflectance\" [0.7 0.5 0.3]\n"
    "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
    "NamedMaterial \"walls\"\n"
    "Shape \"sphere\" \"float radius\" 3\n"
    "NamedMaterial \"glass\"\n"
    "Shape \"sphere\" \"float radius\" 0.4\n";

/** A scene file of that name, of what its head says and the world. */
static inline char *write_scene(const char *name, const char *head)
{
    char *path = g_build_filename(folder, name, NULL);
    g_autofree char *text = g_strconcat(head, world, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

static inline NephScene *load(const char *path)
{
    g_autoptr(GError) error = NULL;
    NephScene *scene = neph_scene_load(path, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    return scene;
}

static inline NephScene *make_scene(const char *head)
{
    g_autofree char *path = write_scene("scene.pbrt", head);
    return load(path);
}

static inline void open_folder(void)
{
    folder = g_dir_make_tmp("nephroid-api-XXXXXX", NULL);
}

/** With all that is in it. */
static inline void remove_folder(void)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        g_remove(path);
    }
    g_rmdir(folder);
    g_free(folder);
}
