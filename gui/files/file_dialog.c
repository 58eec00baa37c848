#include "files/file_dialog.h"

typedef struct waiting {
    void (*chosen)(const char *path, void *data);
    void *data;
} waiting;

static void answered(GtkNativeDialog *dialog, int response, waiting *w)
{
    if (response == GTK_RESPONSE_ACCEPT) {
        g_autoptr(GFile) file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        g_autofree char *path = file ? g_file_get_path(file) : NULL;
        if (path)
            w->chosen(path, w->data);
    }
    g_object_unref(dialog);
}

static void free_waiting(void *data, GClosure *closure)
{
    (void)closure;
    g_free(data);
}

static void add_filter(GtkFileChooser *chooser, const char *name,
                       const char *const *patterns)
{
    g_autoptr(GtkFileFilter) filter = gtk_file_filter_new();
    gtk_file_filter_set_name(filter, name);
    for (size_t i = 0; patterns[i]; i++)
        gtk_file_filter_add_pattern(filter, patterns[i]);
    gtk_file_chooser_add_filter(chooser, filter);
}

void file_dialog_ask(GtkWindow *parent, const file_question *question,
                     void (*chosen)(const char *path, void *data), void *data)
{
    static const char *const all[] = {"*", NULL};
    GtkFileChooserNative *dialog = gtk_file_chooser_native_new(
        question->title, parent,
        question->save ? GTK_FILE_CHOOSER_ACTION_SAVE : GTK_FILE_CHOOSER_ACTION_OPEN,
        question->save ? "_Save" : "_Open", "_Cancel");
    GtkFileChooser *chooser = GTK_FILE_CHOOSER(dialog);
    add_filter(chooser, question->filter, question->patterns);
    if (!question->save)
        add_filter(chooser, "All files", all);
    if (question->folder) {
        g_autoptr(GFile) folder = g_file_new_for_path(question->folder);
        gtk_file_chooser_set_current_folder(chooser, folder, NULL);
    }
    if (question->suggested)
        gtk_file_chooser_set_current_name(chooser, question->suggested);
    waiting *w = g_new(waiting, 1);
    *w = (waiting){chosen, data};
    gtk_native_dialog_set_modal(GTK_NATIVE_DIALOG(dialog), TRUE);
    g_signal_connect_data(dialog, "response", G_CALLBACK(answered), w, free_waiting, 0);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

char **file_patterns(const char *const *extensions)
{
    g_autoptr(GStrvBuilder) patterns = g_strv_builder_new();
    for (const char *const *e = extensions; *e; e++) {
        g_autofree char *pattern = g_strconcat("*", *e, NULL);
        g_strv_builder_add(patterns, pattern);
    }
    return g_strv_builder_end(patterns);
}
