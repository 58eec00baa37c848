#include "options.h"

#include "arguments.h"

static render_options given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME_ARRAY, &given.outputs,
     "Write the image there: FORMATS; may be given again", "FILE"},
    {"layer", 0, 0, G_OPTION_ARG_FILENAME_ARRAY, &given.layers,
     "Write a layer of it there, such as caustic=caustic.png; may be given again",
     "NAME=FILE"},
    {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &given.settings.set,
     "Change a setting; may be given again", "NAME=VALUE"},
    {"preset", 0, 0, G_OPTION_ARG_STRING, &given.settings.preset,
     "Settings as a text on photon mapping describes them; settings --presets lists them",
     "NAME"},
    {"settings", 0, 0, G_OPTION_ARG_FILENAME, &given.settings.file,
     "Read settings from lines of name = value", "FILE"},
    {"size", 0, 0, G_OPTION_ARG_STRING, &given.size, "Size of the image, pixels", "WxH"},
    {"spp", 0, 0, G_OPTION_ARG_STRING, &given.settings.spp,
     "Camera samples a pixel in each pass", "N"},
    {"passes", 0, 0, G_OPTION_ARG_STRING, &given.settings.passes, "Number of passes",
     "N"},
    {"time", 0, 0, G_OPTION_ARG_STRING, &given.settings.time,
     "End after so many seconds (30s or 30), with a picture", "SECONDS"},
    {"noise", 0, 0, G_OPTION_ARG_STRING, &given.settings.noise,
     "Stop when the estimated relative error is below this", "X"},
    {"every", 0, 0, G_OPTION_ARG_STRING, &given.every,
     "Write the image every N passes, or as 30s every so many seconds", "N|Ns"},
    {"checkpoint", 0, 0, G_OPTION_ARG_FILENAME, &given.checkpoint,
     "Write there what another process needs to go on with the render", "FILE"},
    {"checkpoint-every", 0, 0, G_OPTION_ARG_STRING, &given.checkpoint_every,
     "Write it every so many seconds, after a pass (60)", "SECONDS"},
    {"resume", 0, 0, G_OPTION_ARG_FILENAME, &given.resume,
     "Go on from such a file, with its settings and size", "FILE"},
    {"photons", 0, 0, G_OPTION_ARG_FILENAME, &given.photons,
     "Use the photons that 'photons --save' has kept there, with their settings", "FILE"},
    {"frame", 0, 0, G_OPTION_ARG_STRING, &given.frame,
     "Render frames A to B of an animation, each to its own file", "A-B"},
    {"fps", 0, 0, G_OPTION_ARG_STRING, &given.fps, "Frames a second (24)", "N"},
    {"camera", 0, 0, G_OPTION_ARG_FILENAME, &given.camera,
     "Move the camera: line N of the file, LookAt and nine numbers, is of frame N",
     "FILE"},
    {"grain", 0, 0, G_OPTION_ARG_STRING, &given.grain,
     "Whether frames have the same pattern of grain; fixed if not given",
     "fixed|varying"},
    {"integrator", 0, 0, G_OPTION_ARG_STRING, &given.settings.integrator,
     "How light is followed; settings has them all", "NAME"},
    {"threads", 'j', 0, G_OPTION_ARG_STRING, &given.settings.threads,
     "Threads; 0: one per processor", "N"},
    {"seed", 0, 0, G_OPTION_ARG_STRING, &given.settings.seed, "Seed of random numbers",
     "N"},
    {"denoise", 0, 0, G_OPTION_ARG_STRING, &given.settings.denoise,
     "Whether the noise is taken out of what 8-bit images show; on if not given",
     "on|off"},
    {"exposure", 0, 0, G_OPTION_ARG_STRING, &given.exposure,
     "Brighten 8-bit images by so many stops", "STOPS"},
    {"stats", 0, 0, G_OPTION_ARG_FILENAME, &given.stats, "Write statistics as JSON",
     "FILE"},
    {"explain", 0, 0, G_OPTION_ARG_NONE, &given.explain,
     "Tell first what is decided before the first pass, and why", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &given.quiet,
     "Only warnings and errors; no progress, no table", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "render",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Renders a scene (pbrt, glTF, OBJ, STL, PLY) by photon mapping.",
    .description =
        "Without -o the image goes to the name in the scene's Film, without its folders, "
        "else to\nthe scene's name with .exr; both in the current folder.\n\n"
        "Settings: the scene's are overridden by --preset, these by --settings, these by "
        "--set in the "
        "order given,\nthese by --spp, --passes, --time, --noise, --integrator, "
        "--threads, "
        "--denoise and --seed.\n'nephroid settings' lists them all. With --time or "
        "--noise the "
        "scene's own number of\npasses is no limit; --passes N is.\n\n"
        "Ctrl-C (SIGTERM, SIGHUP) writes the passes that are done and exits with 3; "
        "before the\nfirst is done it writes nothing. A second one ends at once.\n\n"
        "--resume takes the settings of the checkpoint in place of the scene's; only "
        "passes, time,\nnoise and threads may be changed. Time counts from the first "
        "start.\n\n"
        "--photons takes the settings that the photons were sent by in place of the "
        "scene's; only\npasses, time, noise, threads, denoise and kernels may be "
        "changed, and the camera and the size.\n\n"
        "With --frame or --camera a run of # in the name of -o becomes the frame's "
        "number, "
        "as in\na.####.png; frames whose files are there are skipped. Frame N is at N / "
        "fps seconds.\n",
    .entries = entries,
    .loads_scene = true};

const render_options *render_options_parse(int *argc, char ***argv, int *exit_code)
{
    return arguments_parse(&how, argc, argv, exit_code) ? &given : NULL;
}
