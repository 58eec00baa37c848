/*
 * nephroid-view: a window on a scene.
 */
#include "window/app.h"

int main(int argc, char **argv)
{
    g_autoptr(GtkApplication) app = app_new();
    return g_application_run(G_APPLICATION(app), argc, argv);
}
