/*
 * Whether the desktop is light or dark, followed while it runs.
 *
 * GTK 4 itself does not ask the desktop portal, which is where GNOME, KDE and the others
 * say it (org.freedesktop.portal.Settings, org.freedesktop.appearance color-scheme).
 */
#pragma once

typedef enum appearance_scheme {
    SCHEME_UNKNOWN, /**< no portal, or no preference */
    SCHEME_DARK,
    SCHEME_LIGHT
} appearance_scheme;

typedef struct appearance appearance;

/** @brief Asks the session bus; changed is called on the main context of the thread that
 * made it when the answer comes and at each change, until appearance_free. Without a bus
 * or a portal it is never called. */
appearance *appearance_new(void (*changed)(appearance_scheme scheme, void *data),
                           void *data);
void appearance_free(appearance *a);
/** @brief As last heard. */
appearance_scheme appearance_get(const appearance *a);
