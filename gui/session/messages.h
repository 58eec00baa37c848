/*
 * What is said about a scene: notes and warnings while it is read, errors. Lists of it,
 * and what collects them on the worker's thread. Needs no display.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef enum message_kind { MESSAGE_NOTE, MESSAGE_WARNING, MESSAGE_ERROR } message_kind;

typedef struct message {
    message_kind kind;
    char *text; /**< owned */
} message;

/** @brief An empty list of message*. A holder each of the array's references. */
GPtrArray *messages_new(void);
/** @brief Appends; the text is copied, valid or made so. */
void messages_add(GPtrArray *list, message_kind kind, const char *text);
guint messages_count(const GPtrArray *list, message_kind kind);
/** @brief "2 warnings, 1 note"; NULL if the list is empty. Owned by the caller. */
char *messages_summary(const GPtrArray *list);

/** @brief Where a scene's messages go; must outlive the scene, which may write to the end
 * of its life. */
typedef struct scene_log scene_log;
scene_log *scene_log_new(void);
void scene_log_free(scene_log *log);
/** @brief A NephLogFunc; data is the log. */
void scene_log_write(NephLogLevel level, const char *text, void *data);
/** @brief The messages, given to the caller. What is written later is dropped. */
GPtrArray *scene_log_close(scene_log *log);
