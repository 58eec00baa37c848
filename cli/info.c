/*
 * nephroid info: what is in a scene, told before a long render.
 */
#include "arguments.h"
#include "command.h"
#include "loading.h"
#include "message.h"

static gboolean as_json;

static const GOptionEntry entries[] = {
    {"json", 0, 0, G_OPTION_ARG_NONE, &as_json, "For programs", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "info",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Says what is in a scene: shapes, lights and their power, materials and "
               "whether they\ncast caustics, camera, film, and settings that differ from "
               "the defaults.",
    .entries = entries,
    .loads_scene = true};

int command_info(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    const NephLoadOptions options = loading_options(0, as_json);
    g_autoptr(NephScene) scene = neph_scene_load_with(argv[1], &options, &error);
    if (!scene)
        return report_error(error);
    g_autofree char *text = neph_scene_describe(scene, as_json);
    return print_result("%s", text);
}
