#include "view_run.h"

#include "sanitizers.h"
#include "window/app.h"

#include <glib/gstdio.h>
#include <string.h>

/* s */
#define PATIENCE 30.0

const char view_scene[] =
    "LookAt 0 0 -2  0 0 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" 50\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
    "Integrator \"photonmap\" \"integer passes\" 2 \"integer photons\" 2000\n"
    "    \"integer spp\" 1 \"string caustic_emission\" \"uniform\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1.8 0]\n"
    "MakeNamedMaterial \"walls\" \"string type\" \"diffuse\"\n"
    "    \"rgb reflectance\" [0.7 0.5 0.3]\n"
    "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
    "NamedMaterial \"walls\"\n"
    "Shape \"sphere\" \"float radius\" 3\n"
    "NamedMaterial \"glass\"\n"
    "Shape \"sphere\" \"float radius\" 0.4\n";

static char *folder;
static GtkApplication *app;

static void make_folder(void)
{
    folder = g_dir_make_tmp("nephroid-view-XXXXXX", NULL);
    g_assert_nonnull(folder);
    static const char *const variables[] = {"XDG_CONFIG_HOME", "XDG_DATA_HOME",
                                            "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"};
    for (size_t i = 0; i < G_N_ELEMENTS(variables); i++)
        g_setenv(variables[i], folder, TRUE);
}

/* What GTK and the drivers keep from their start is not ours to free. */
extern void __lsan_disable(void) __attribute__((weak));
extern void __lsan_enable(void) __attribute__((weak));

static bool start_gtk(void)
{
    if (__lsan_disable)
        __lsan_disable();
    bool started = gtk_init_check();
    if (__lsan_enable)
        __lsan_enable();
    return started;
}

bool view_init(int *argc, char ***argv)
{
    make_folder();
    g_setenv("GTK_A11Y", "test", TRUE);
    g_setenv("GSETTINGS_BACKEND", "memory", TRUE);
    g_setenv("LIBGL_ALWAYS_SOFTWARE", "1", TRUE);
    g_setenv("GSK_RENDERER", "cairo", FALSE);
    g_test_init(argc, argv, NULL);
    if (THREADS_ARE_WATCHED || !start_gtk())
        return false;
    g_log_set_always_fatal(G_LOG_LEVEL_CRITICAL | G_LOG_FATAL_MASK);
    app = app_new();
    g_assert_true(g_application_register(G_APPLICATION(app), NULL, NULL));
    return true;
}

static void skip(void)
{
    g_test_skip(THREADS_ARE_WATCHED
                    ? "GTK's threads are not instrumented; see test_session"
                    : "no display");
}

void view_add_test(const char *path, void (*test)(void))
{
    g_test_add_func(path, app ? test : skip);
}

static void remove_all(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *inner = g_build_filename(path, name, NULL);
        remove_all(inner);
    }
    g_remove(path);
}

int view_run(void)
{
    int result = g_test_run();
    g_clear_object(&app);
    remove_all(folder);
    g_clear_pointer(&folder, g_free);
    return result;
}

const char *view_folder(void)
{
    return folder;
}

char *view_write(const char *name, const char *text)
{
    char *path = g_build_filename(folder, name, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

void view_settle(void)
{
    while (g_main_context_iteration(NULL, FALSE))
        ;
}

window *view_window(void)
{
    window *w = window_new(app);
    gtk_window_present(window_gtk(w));
    view_settle();
    return w;
}

void view_close(window *w)
{
    gtk_window_destroy(window_gtk(w));
    view_settle();
}

static gboolean wake(void *data)
{
    (void)data;
    return G_SOURCE_CONTINUE;
}

void view_wait(bool (*done)(window *w), window *w)
{
    gint64 limit = g_get_monotonic_time() + (gint64)(PATIENCE * 1e6);
    guint source = g_timeout_add(5, wake, NULL);
    while (!done(w)) {
        g_assert_cmpint(g_get_monotonic_time(), <, limit);
        g_main_context_iteration(NULL, TRUE);
    }
    g_source_remove(source);
}

bool view_is_done(window *w)
{
    return w->scene && w->state == SESSION_DONE;
}

bool view_is_rendering(window *w)
{
    return w->scene && w->state == SESSION_RENDERING;
}

static held_picture *shown_before;

static bool is_other(window *w)
{
    return view_is_done(w) && canvas_picture(w->canvas) != shown_before;
}

void view_wait_for_other(window *w)
{
    held_picture *now = canvas_picture(w->canvas);
    shown_before = now ? held_picture_ref(now) : NULL;
    view_wait(is_other, w);
    g_clear_pointer(&shown_before, held_picture_unref);
}

void view_activate(window *w, const char *action)
{
    g_assert_true(gtk_widget_activate_action(GTK_WIDGET(window_gtk(w)), action, NULL));
}

static GtkLabel *said(window *w)
{
    return GTK_LABEL(gtk_revealer_get_child(GTK_REVEALER(w->toast)));
}

const char *view_said(window *w)
{
    return gtk_label_get_text(said(w));
}

static const char *awaited;

static bool is_said(window *w)
{
    return strstr(view_said(w), awaited) != NULL;
}

void view_wait_for_word(window *w, const char *word)
{
    awaited = word;
    view_wait(is_said, w);
    gtk_label_set_text(said(w), "");
}
