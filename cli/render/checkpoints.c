#include "checkpoints.h"

#include "arguments.h"
#include "command.h"
#include "message.h"

#include <string.h>

static const double usual_interval = 60.0;

bool checkpoints_init(checkpoints *c, const char *path, const char *every, GError **error)
{
    double seconds = usual_interval;
    *c = (checkpoints){.path = path, .last_time = g_get_monotonic_time()};
    if (every && !path) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--checkpoint-every: expected --checkpoint FILE too");
        return false;
    }
    g_autofree char *number = g_strdup(every ? every : "");
    if (g_str_has_suffix(number, "s"))
        number[strlen(number) - 1] = '\0';
    if (every &&
        !argument_between("--checkpoint-every", number, 0.0, 1e9, &seconds, error))
        return false;
    c->interval = (int64_t)(seconds * G_USEC_PER_SEC);
    return !path || neph_file_can_write(path, error);
}

static int save(checkpoints *c, NephRender *render, int64_t passes)
{
    g_autoptr(GError) error = NULL;
    bool done = neph_render_save_checkpoint(render, c->path, &error);
    int code = done || c->failed ? EXIT_DONE : report_error(error);
    c->failed = !done;
    c->last_time = g_get_monotonic_time();
    if (done)
        c->saved_passes = passes;
    return code;
}

void checkpoints_show(checkpoints *c, NephRender *render, int64_t passes)
{
    if (c->path && passes > c->saved_passes &&
        g_get_monotonic_time() >= c->last_time + c->interval)
        save(c, render, passes);
}

int checkpoints_end(checkpoints *c, NephRender *render)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    if (!c->path || s.passes <= c->saved_passes)
        return EXIT_DONE;
    c->failed = false;
    return save(c, render, s.passes);
}
