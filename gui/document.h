/*
 * The scene file that is open: watched for changes, remembered among the recent ones.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

typedef struct document document;

/** @brief changed: the file has been written, a moment ago. */
document *document_new(void (*changed)(void *data), void *data);
void document_free(document *d);
/** @brief Another file: watches it. */
void document_set_path(document *d, const char *path);
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
