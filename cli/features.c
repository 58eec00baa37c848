/*
 * nephroid features: what of pbrt-v4 and glTF 2.0 is read.
 */
#include "arguments.h"
#include "command.h"
#include "message.h"

static const GOptionEntry entries[] = {G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "features",
    .summary =
        "Lists what of pbrt-v4's language is rendered, approximated or refused, as "
        "a table of\na manual.",
    .entries = entries};

int command_features(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autofree char *text = neph_features_describe();
    return print_result("%s", text);
}
