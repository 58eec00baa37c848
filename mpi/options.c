#include "options.h"

#include "arguments.h"
#include "message.h"
#include "ranks.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static options given = {.checkpoint_every = 60.0};
static char *size_text;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME_ARRAY, &given.outputs,
     "Write the image there; may be given again", "FILE"},
    {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &given.settings.set,
     "Change a setting; may be given again", "NAME=VALUE"},
    {"settings", 0, 0, G_OPTION_ARG_FILENAME, &given.settings.file,
     "Read settings from lines of name = value", "FILE"},
    {"size", 0, 0, G_OPTION_ARG_STRING, &size_text, "Size of the image, pixels", "WxH"},
    {"spp", 0, 0, G_OPTION_ARG_STRING, &given.settings.spp,
     "Camera samples a pixel in each pass", "N"},
    {"passes", 0, 0, G_OPTION_ARG_STRING, &given.settings.passes, "Number of passes",
     "N"},
    {"time", 0, 0, G_OPTION_ARG_STRING, &given.settings.time,
     "End after so many seconds, all ranks together", "SECONDS"},
    {"noise", 0, 0, G_OPTION_ARG_STRING, &given.settings.noise,
     "Stop when the estimated relative error is below this", "X"},
    {"integrator", 0, 0, G_OPTION_ARG_STRING, &given.settings.integrator,
     "How light is followed", "NAME"},
    {"threads", 'j', 0, G_OPTION_ARG_STRING, &given.settings.threads,
     "Threads of each rank; 0: its share of its machine's processors", "N"},
    {"seed", 0, 0, G_OPTION_ARG_STRING, &given.settings.seed, "Seed of random numbers",
     "N"},
    {"stats", 0, 0, G_OPTION_ARG_FILENAME, &given.stats, "Write statistics as JSON",
     "FILE"},
    {"checkpoint", 0, 0, G_OPTION_ARG_FILENAME, &given.checkpoint,
     "Write there what another job needs to go on, with any number of ranks", "FILE"},
    {"checkpoint-every", 0, 0, G_OPTION_ARG_DOUBLE, &given.checkpoint_every,
     "Write it every so many seconds (60)", "SECONDS"},
    {"resume", 0, 0, G_OPTION_ARG_FILENAME, &given.resume, "Go on from such a file",
     "FILE"},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &given.quiet, "Only warnings and errors", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "render",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Renders a scene by all ranks of an MPI job: mpirun -n R nephroid-mpi "
               "render SCENE -o a.exr",
    .description = "Every rank reads the scene. The options are those of 'nephroid "
                   "render'; docs/scaling.md\nsays what to expect of many ranks.\n",
    .entries = entries,
    .loads_scene = true};

static bool parse(int argc, char **argv, int *exit_code)
{
    g_autoptr(GError) error = NULL;
    unsigned threads;
    if (argc < 2 || strcmp(argv[1], "render") != 0) {
        *exit_code =
            usage_error("expected render, found %s", argc < 2 ? "nothing" : argv[1]);
        return false;
    }
    argc--, argv++;
    if (!arguments_parse(&how, &argc, &argv, exit_code))
        return false;
    given.scene = argv[1];
    bool good = (!size_text || argument_size("--size", size_text, &given.width,
                                             &given.height, &error)) &&
                overrides_check(&given.settings, &threads, &error);
    for (char **path = given.outputs; good && path && *path; path++)
        good = neph_image_can_write(*path, &error);
    good = good && (!given.checkpoint || neph_file_can_write(given.checkpoint, &error));
    if (!good)
        *exit_code = report_error(error);
    return good;
}

/* While other ranks than the root say nothing. */
bool options_parse(options *o, int argc, char **argv, int *exit_code)
{
    int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    if (ranks_me() != ROOT) {
        int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    bool good = parse(argc, argv, exit_code);
    fflush(stdout);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    close(out);
    close(err);
    *o = given;
    return good;
}
