/*
 * Settings from the command line, over those of the scene.
 *
 *   scene file < --preset NAME < --settings FILE < --set name=value in their order <
 * --spp and the like
 *
 * With --time or --noise the scene's own number of passes is no limit.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief The options as given; zero: none. */
typedef struct overrides {
    char *preset; /**< --preset */
    char *file;   /**< --settings */
    char **set;   /**< --set, "name=value" */
    char *integrator, *passes, *time, *noise, *spp, *threads,
        *seed, *denoise; /**< NULL: not given */
} overrides;

/** @brief Puts them over the settings. Errors name the option. */
bool overrides_apply(const overrides *o, NephSettings *settings, GError **error);
/** @brief Says which of them the integrator of the settings, which hold them, does not
 * read. */
void overrides_tell_unread(const overrides *o, const NephSettings *settings);
/** @brief Threads to load a scene with, before its own settings are known: 0 = all.
 *  Refuses what overrides_apply would refuse, so that no scene is loaded in vain. */
bool overrides_check(const overrides *o, unsigned *threads, GError **error);
