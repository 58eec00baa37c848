#include "session/messages.h"

#include <stdatomic.h>

struct scene_log {
    GPtrArray *list; /* NULL once closed; the reading thread's */
    atomic_bool closed;
};

static void free_message(void *data)
{
    message *m = data;
    g_free(m->text);
    g_free(m);
}

GPtrArray *messages_new(void)
{
    return g_ptr_array_new_with_free_func(free_message);
}

void messages_add(GPtrArray *list, message_kind kind, const char *text)
{
    message *m = g_new(message, 1);
    *m = (message){kind, g_utf8_make_valid(text, -1)};
    g_ptr_array_add(list, m);
}

guint messages_count(const GPtrArray *list, message_kind kind)
{
    guint n = 0;
    for (guint i = 0; i < list->len; i++)
        n += ((const message *)list->pdata[i])->kind == kind;
    return n;
}

char *messages_summary(const GPtrArray *list)
{
    static const char *const words[] = {[MESSAGE_NOTE] = "note",
                                        [MESSAGE_WARNING] = "warning",
                                        [MESSAGE_ERROR] = "error"};
    GString *out = g_string_new(NULL);
    for (int kind = MESSAGE_ERROR; kind >= MESSAGE_NOTE; kind--) {
        guint n = messages_count(list, (message_kind)kind);
        if (n > 0)
            g_string_append_printf(out, "%s%u %s%s", out->len ? ", " : "", n, words[kind],
                                   n == 1 ? "" : "s");
    }
    return g_string_free(out, out->len == 0);
}

scene_log *scene_log_new(void)
{
    scene_log *log = g_new0(scene_log, 1);
    log->list = messages_new();
    atomic_init(&log->closed, false);
    return log;
}

void scene_log_free(scene_log *log)
{
    if (!log)
        return;
    g_clear_pointer(&log->list, g_ptr_array_unref);
    g_free(log);
}

void scene_log_write(NephLogLevel level, const char *text, void *data)
{
    scene_log *log = data;
    if (!atomic_load(&log->closed))
        messages_add(log->list,
                     level == NEPH_LOG_WARNING ? MESSAGE_WARNING : MESSAGE_NOTE, text);
}

GPtrArray *scene_log_close(scene_log *log)
{
    atomic_store(&log->closed, true);
    return g_steal_pointer(&log->list);
}
