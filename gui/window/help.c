#include "window/help.h"

#include <string.h>

/* One line: an accelerator as GTK writes it, or a gesture in words. */
typedef struct hint {
    const char *group, *title, *keys;
} hint;

static const hint hints[] = {
    {"Scene", "Open", "<Control>o"},
    {"Scene", "Read again", "<Control>r"},
    {"Scene", "Save the picture", "<Control>s"},
    {"Scene", "Close the window", "<Control>w"},
    {"Rendering", "Start or pause", "space"},
    {"Rendering", "Stop", "<Control>period"},
    {"Rendering", "Render anew", "F5"},
    {"Rendering", "Trace photons", "<Control>t"},
    {"Camera", "Go around (with shift: across)", "Left Right"},
    {"Camera", "Nearer, further", "Page_Up Page_Down"},
    {"Camera", "Fly", "w a s d"},
    {"Camera", "Rise and sink", "e q"},
    {"Camera", "Pick in the middle", "Return"},
    {"Camera", "Focus on what is clicked", "<Control>d"},
    {"Camera", "View of the scene file", "Home"},
    {"Camera", "Whole scene", "End"},
    {"Camera", "Copy the view", "<Control><Shift>c"},
    {"Camera", "Save the view in the scene", "<Control><Shift>s"},
    {"Picture", "Zoom in, out", "<Control>plus <Control>minus"},
    {"Picture", "Fit, pixel by pixel", "<Control>0 <Control>1"},
    {"Picture", "Brighter, darker", "<Control>Up <Control>Down"},
    {"Window", "Picture, photons, materials", "<Alt>1 <Alt>2 <Alt>3"},
    {"Window", "Settings, camera, inspect", "<Alt>s <Alt>c <Alt>i"},
    {"Window", "Photons, numbers, messages", "<Alt>p <Alt>n <Alt>m"},
    {"Window", "Search settings", "<Control>f"},
    {"Window", "Panels", "F9"},
    {"Window", "Full screen", "F11"},
    {"Window", "Menu", "F10"},
    {"Window", "This help", "<Control>question"},
};

/* Mouse: what is done, in words. */
static const char *const mouse[][2] = {
    {"Go around", "Drag"},
    {"Move across", "Shift and drag, or drag with the middle button"},
    {"Look around", "Drag with the right button"},
    {"Nearer, further", "Wheel, or two fingers"},
    {"Go around what is clicked", "Double click"},
    {"Zoom the picture, move it", "Ctrl and wheel, Ctrl and drag"},
    {"Pick a photon or a surface", "Click in the photon view"},
    {"Move the divider of a split picture", "Drag it"},
    {"Open a scene, compare with a picture", "Drop its file on the window"},
};

static void put(GString *out, const char *title, const char *property, const char *value)
{
    g_autofree char *line = g_markup_printf_escaped(
        "<child><object class=\"GtkShortcutsShortcut\">"
        "<property name=\"title\">%s</property><property name=\"%s\">%s</property>"
        "</object></child>",
        title, property, value);
    g_string_append(out, line);
}

static void open_group(GString *out, const char *title)
{
    g_string_append_printf(out,
                           "<child><object class=\"GtkShortcutsGroup\">"
                           "<property name=\"title\">%s</property>",
                           title);
}

static void open_section(GString *out, const char *name, const char *title)
{
    g_string_append_printf(out,
                           "<child><object class=\"GtkShortcutsSection\">"
                           "<property name=\"section-name\">%s</property>"
                           "<property name=\"title\">%s</property>"
                           "<property name=\"max-height\">12</property>",
                           name, title);
}

static const char end_object[] = "</object></child>";

/* The groups of keys from one to another. */
static void put_groups(GString *out, const char *const *groups)
{
    for (size_t g = 0; groups[g]; g++) {
        open_group(out, groups[g]);
        for (size_t i = 0; i < G_N_ELEMENTS(hints); i++)
            if (strcmp(hints[i].group, groups[g]) == 0)
                put(out, hints[i].title, "accelerator", hints[i].keys);
        g_string_append(out, end_object);
    }
}

static char *definition(void)
{
    static const char *const of_view[] = {"Camera", "Picture", NULL};
    static const char *const of_window[] = {"Scene", "Rendering", "Window", NULL};
    GString *out = g_string_new("<interface><object class=\"GtkShortcutsWindow\" "
                                "id=\"help\"><property name=\"modal\">1</property>"
                                "");
    open_section(out, "window", "Keys of the window");
    put_groups(out, of_window);
    g_string_append(out, end_object);
    open_section(out, "view", "Keys of the view");
    put_groups(out, of_view);
    g_string_append(out, end_object);
    open_section(out, "mouse", "Mouse and touch");
    open_group(out, "Mouse and touch");
    for (size_t i = 0; i < G_N_ELEMENTS(mouse); i++)
        put(out, mouse[i][0], "subtitle", mouse[i][1]);
    g_string_append(out, end_object);
    g_string_append(out, end_object);
    g_string_append(out, "</object></interface>");
    return g_string_free(out, FALSE);
}

GtkShortcutsWindow *help_make(void)
{
    g_autofree char *text = definition();
    g_autoptr(GtkBuilder) builder = gtk_builder_new_from_string(text, -1);
    GObject *help = gtk_builder_get_object(builder, "help");
    g_object_set(help, "section-name", "window", NULL);
    return g_object_ref(GTK_SHORTCUTS_WINDOW(help));
}
