/*
 * A render that outlives its process: what it is at the end of a pass goes into a
 * checkpoint and comes back from one. Passes are functions of the plan and their number,
 * and the plan is one of scene and settings, so that nothing else need be kept.
 */
#include "render/film/film_planes.h"
#include "render/kept/checkpoint.h"
#include "render/kept/same_settings.h"
#include "render/render_state.h"

#include <string.h>

/* What compiles to other instructions rounds otherwise. */
static const char built[] =
#ifdef __AVX512F__
    "avx512"
#elif defined __AVX2__
    "avx2"
#elif defined __AVX__
    "avx"
#else
    "baseline"
#endif
    ", compiler " __VERSION__;

/* Settings that decide when it ends and how fast it is, not what a pass is. */
static const char *const free_rows[] = {"passes", "time", "noise", "threads", NULL};

static char *program_of(const render_identity *who)
{
    return g_strdup_printf("%s %s", who->program, built);
}

bool render_save_checkpoint(const render *r, const render_identity *who, const char *path,
                            GError **error)
{
    if (r->passes_done == 0) {
        error_set(error, ERROR_USAGE, "cannot write %s: no pass is done", path);
        return false;
    }
    g_autofree char *program = program_of(who), *digest = render_digest(r);
    const checkpoint c = {.program = program,
                          .scene = who->scene,
                          .plan = digest,
                          .width = r->plan.view->film.width,
                          .height = r->plan.view->film.height,
                          .how = r->plan.how,
                          .asked = r->asked,
                          .statistics = r->statistics};
    return checkpoint_write(&c, &r->film, path, error);
}

/* Whether it is of this program, scene, picture and settings. */
static bool is_ours(const render *r, const checkpoint *c, const render_identity *who,
                    const char *path, GError **error)
{
    const film_settings *size = &r->plan.view->film;
    g_autofree char *program = program_of(who);
    if (strcmp(c->program, program) != 0)
        error_set(error, ERROR_INPUT, "%s: the checkpoint was written by %s, this is %s",
                  path, c->program, program);
    else if (c->width != size->width || c->height != size->height)
        error_set(error, ERROR_INPUT,
                  "%s: the checkpoint is of a picture of %dx%d pixels, not %dx%d", path,
                  c->width, c->height, size->width, size->height);
    else if (strcmp(c->scene, who->scene) != 0)
        error_set(error, ERROR_INPUT,
                  "%s: the checkpoint is of another scene, or of files that have changed",
                  path);
    else {
        const settings_question question = {&r->asked, &c->asked, free_rows, path};
        return same_settings(&question, "the checkpoint is of a render", error);
    }
    return false;
}

/* As the passes before were, but when it ends is said anew. */
static void take_settings(render *r, const settings *then)
{
    const settings *now = &r->asked;
    settings how = *then;
    how.passes = now->passes;
    how.time = now->time;
    how.noise = now->noise;
    how.threads = now->threads;
    if (settings_planned_passes(&how) != settings_planned_passes(then))
        how.planned_passes = settings_planned_passes(then);
    r->plan.how = how;
    r->film.coarse = how.denoise_windows == WINDOWS_COARSE;
}

static void take_statistics(render *r, const render_statistics *then)
{
    int64_t wanted = r->statistics.passes_wanted;
    r->statistics = *then;
    r->statistics.passes_wanted = wanted;
    r->statistics.can_look = true;
    r->statistics.left_noisy = false;
    r->passes_done = (uint32_t)then->passes;
    r->earlier = then->time_total;
}

bool render_resume(render *r, const render_identity *who, const char *path,
                   GError **error)
{
    g_auto(checkpoint) head = {0}, whole = {0};
    if (r->passes_done > 0 || r->prepared) {
        error_set(error, ERROR_USAGE, "cannot resume %s: the render has begun", path);
        return false;
    }
    /* The header first: what is of another render is said before what is damaged in it.
     */
    if (!checkpoint_read(&head, NULL, path, error) ||
        !is_ours(r, &head, who, path, error) ||
        !checkpoint_read(&whole, &r->film, path, error))
        return false;
    if (!is_ours(r, &whole, who, path, error)) { /* it was replaced in between */
        film_reset(&r->film);
        return false;
    }
    take_settings(r, &whole.how);
    take_statistics(r, &whole.statistics);
    r->paced = true;
    r->expected = g_strdup(whole.plan);
    return true;
}
