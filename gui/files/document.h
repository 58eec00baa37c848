/*
 * The scene file that is open: it and the files it is made of are watched for changes; it
 * is remembered among the recent ones.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

typedef struct document document;

/** @brief changed: one of the files has been written, a moment ago. */
document *document_new(void (*changed)(void *data), void *data);
void document_free(document *d);
/** @brief Another file, or the same anew: watches it and no other. */
void document_set_path(document *d, const char *path);
/** @brief Watches these too, be they there or not; NULL-terminated, absolute. */
void document_watch(document *d, const char *const *paths);
/** @brief NULL: none. */
const char *document_path(const document *d);
/** @brief Where its file lies; NULL: there is none. Owned by the caller. */
char *document_folder(const document *d);
/** @brief To be called when the file could be read: it goes to the recent ones. */
void document_remember(document *d);

/** @brief Paths of scenes opened lately, newest first; NULL-terminated, owned by the
 * caller. */
char **document_recent(void);
/** @brief Paths of the scenes that come with the program; as above. */
char **document_examples(void);
