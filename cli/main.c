/*
 * nephroid: the command line. Picks the subcommand; the library does the work.
 */
#include "command.h"

#include "message.h"
#include "stop.h"

#include <locale.h>
#include <nephroid/nephroid.h>
#include <string.h>

static const command commands[] = {
    {"render", "render a scene to an image", command_render},
    {"photons", "trace photons only: count them, save them, print their event log",
     command_photons},
    {"info", "say what is in a scene", command_info},
    {"convert", "write any scene as pbrt-v4 text with its meshes and images",
     command_convert},
    {"compare", "measure how far an image is from a reference", command_compare},
    {"image", "write images in another format or size, or side by side", command_image},
    {"settings", "list all settings", command_settings},
    {"features", "list what of pbrt-v4 is read", command_features},
    {"bsdf", "draw how a material scatters light", command_bsdf},
    {"view", "open a window on a scene", command_view},
};

int64_t program_start;

static char *help_text(void)
{
    GString *out = g_string_new("Usage:\n  nephroid COMMAND [OPTION…] [FILE…]\n\n"
                                "Renders scenes by photon mapping.\n\nCommands:\n");
    for (size_t i = 0; i < G_N_ELEMENTS(commands); i++)
        g_string_append_printf(out, "  %-10s %s\n", commands[i].name,
                               commands[i].summary);
    g_string_append(out, "\nOptions:\n"
                         "  -h, --help     show this help; also after a command\n"
                         "  -V, --version  show the version\n\n"
                         "Exit codes: 0 done, 1 bad input, 2 bad usage, 3 failed, or a "
                         "render was stopped.\n");
    return g_string_free(out, FALSE);
}

static int run_command(int argc, char **argv)
{
    for (size_t i = 0; i < G_N_ELEMENTS(commands); i++)
        if (strcmp(argv[0], commands[i].name) == 0)
            return commands[i].run(argc, argv);
    return usage_error("unknown command '%s'", argv[0]);
}

int main(int argc, char **argv)
{
    program_start = g_get_monotonic_time();
    setlocale(LC_CTYPE, ""); /* file names; numbers stay with the point */
    g_set_prgname("nephroid");
    stop_init();
    g_autofree char *help = help_text();
    if (argc < 2)
        return usage_error("no command given");
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
        return print_result("%s", help);
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0)
        return print_result("nephroid %s\n", neph_version());
    return run_command(argc - 1, argv + 1);
}
