/*
 * nephroid convert: a scene of any format as pbrt-v4 text.
 */
#include "arguments.h"
#include "command.h"
#include "loading.h"
#include "message.h"

static gboolean quiet;

static const GOptionEntry entries[] = {
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &quiet, "Only warnings and errors", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "convert",
    .operands = "IN OUT.pbrt",
    .n_operands = 2,
    .summary = "Writes a scene of any format as pbrt-v4 text. Its meshes (as PLY) and "
               "images go into\nthe folder OUT-files beside it.",
    .entries = entries,
    .loads_scene = true};

int command_convert(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    const NephLoadOptions options = loading_options(0, quiet);
    if (!neph_scene_convert_with(argv[1], argv[2], &options, &error))
        return report_error(error);
    return EXIT_DONE;
}
