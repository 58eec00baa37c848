/*
 * Scenes that must be refused.
 */
#pragma once

#include "scene_text.h"

/** Loads a text that must be refused; every "%s" of the message is the file's name. */
static inline void refuse(const char *text, const char *message)
{
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    g_assert_null(s);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_auto(GStrv) parts = g_strsplit(message, "%s", -1);
    g_autofree char *want = g_strjoinv(f.main, parts);
    if (strcmp(error->message, want) != 0)
        g_error("of\n%s\nexpected\n%s\nfound\n%s", text, want, error->message);
    folder_remove(&f);
}
