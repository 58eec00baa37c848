/*
 * nephroid view: becomes the program with the window, which lies beside this one, or in
 * gui/ next to cli/ where it was built, or on the path.
 */
#include "command.h"

#include "message.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static char *beside(const char *relative)
{
    g_autofree char *self = g_file_read_link("/proc/self/exe", NULL);
    if (!self)
        return NULL;
    g_autofree char *folder = g_path_get_dirname(self);
    g_autofree char *path = g_build_filename(folder, relative, NULL);
    return g_file_test(path, G_FILE_TEST_IS_EXECUTABLE) ? g_steal_pointer(&path) : NULL;
}

static char *find_viewer(void)
{
    char *path = beside("nephroid-view");
    if (!path)
        path = beside("../gui/nephroid-view");
    return path ? path : g_find_program_in_path("nephroid-view");
}

int command_view(int argc, char **argv)
{
    (void)argc;
    if (argv[1] && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0))
        return print_result(
            "%s",
            "Usage:\n  nephroid view [--memory SIZE] [SCENE]\n\nOpens a window on a "
            "scene: the picture as it is rendered, the photons, and\nevery "
            "setting. The same as nephroid-view.\n\nOptions:\n"
            "  --memory SIZE  Take at most so much memory, as 2G or 500M\n"
            "  -h, --help     Show this help\n"
            "  -V, --version  Show the version\n");
    if (argv[1] && (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0))
        return print_result("nephroid %s\n", neph_version());
    if (argv[1] && argv[1][0] == '-' && !g_str_has_prefix(argv[1], "--memory"))
        return usage_error("unknown option %s", argv[1]);
    g_autofree char *viewer = find_viewer();
    if (viewer) {
        argv[0] = viewer;
        execv(viewer, argv);
    }
    tell("error", "cannot start nephroid-view: %s",
         viewer ? g_strerror(errno) : "it is not here (it is built where GTK 4 is)");
    return EXIT_FAILED;
}
