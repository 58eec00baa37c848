#include "loading.h"

#include "message.h"

static gboolean lenient, thin_glass;
static bool is_quiet;

const GOptionEntry loading_entries[] = {
    {"lenient", 0, 0, G_OPTION_ARG_NONE, &lenient,
     "Replace what can not be rendered, with a warning, instead of refusing the scene",
     NULL},
    {"thin-glass", 0, 0, G_OPTION_ARG_NONE, &thin_glass,
     "Read glass without a volume (glTF, OBJ) as thin panes, on closed meshes too", NULL},
    G_OPTION_ENTRY_NULL};

NephLoadOptions loading_options(unsigned threads, bool quiet)
{
    is_quiet = quiet;
    return (NephLoadOptions){.threads = threads,
                             .lenient = lenient,
                             .thin_glass = thin_glass,
                             .log = log_to_stderr,
                             .log_data = &is_quiet};
}
