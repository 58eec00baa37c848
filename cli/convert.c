#include "arguments.h"
#include "command.h"
#include "message.h"

static gboolean quiet, lenient, thin_glass;

static const GOptionEntry entries[] = {
    {"lenient", 0, 0, G_OPTION_ARG_NONE, &lenient,
     "Replace what can not be rendered, with a warning, instead of refusing the scene",
     NULL},
    {"thin-glass", 0, 0, G_OPTION_ARG_NONE, &thin_glass,
     "Read glass without a volume (glTF, OBJ) as thin panes, on closed meshes too", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &quiet, "Only warnings and errors", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "convert",
    .operands = "IN OUT.pbrt",
    .n_operands = 2,
    .summary = "Writes a scene of any format as pbrt-v4 text. Its meshes (as PLY) and "
               "images go into\nthe folder OUT-files beside it.",
    .entries = entries};

int command_convert(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    bool silent = quiet;
    const NephLoadOptions options = {.lenient = lenient,
                                     .thin_glass = thin_glass,
                                     .log = log_to_stderr,
                                     .log_data = &silent};
    if (!neph_scene_convert_with(argv[1], argv[2], &options, &error))
        return report_error(error);
    return EXIT_DONE;
}
