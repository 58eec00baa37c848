/*
 * What the window remembers from one start to the next.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>

typedef enum window_theme {
    THEME_SYSTEM,
    THEME_LIGHT,
    THEME_DARK,
    N_THEMES
} window_theme;

extern const char *const theme_words[]; /**< "system", "light", "dark", NULL */

typedef struct window_state {
    int width, height;
    bool maximized, sidebar;
    int sidebar_width;
    window_theme theme;
} window_state;

/** @brief As saved, or the usual. */
window_state window_state_load(void);
/** @brief Saves; a state that cannot be saved is lost without a word. */
void window_state_save(const window_state *state);
