#include "arguments.h"
#include "command.h"
#include "message.h"

static gboolean as_json, lenient, thin_glass;

static const GOptionEntry entries[] = {
    {"lenient", 0, 0, G_OPTION_ARG_NONE, &lenient,
     "Replace what can not be rendered, with a warning, instead of refusing the scene",
     NULL},
    {"thin-glass", 0, 0, G_OPTION_ARG_NONE, &thin_glass,
     "Read glass without a volume (glTF, OBJ) as thin panes, on closed meshes too", NULL},
    {"json", 0, 0, G_OPTION_ARG_NONE, &as_json, "For programs", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "info",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Says what is in a scene: shapes, lights and their power, materials and "
               "whether they\ncast caustics, camera, film, and settings that differ from "
               "the defaults.",
    .entries = entries};

int command_info(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    bool quiet = as_json;
    const NephLoadOptions options = {.lenient = lenient,
                                     .thin_glass = thin_glass,
                                     .log = log_to_stderr,
                                     .log_data = &quiet};
    g_autoptr(NephScene) scene = neph_scene_load_with(argv[1], &options, &error);
    if (!scene)
        return report_error(error);
    g_autofree char *text = neph_scene_describe(scene, as_json);
    return print_result("%s", text);
}
