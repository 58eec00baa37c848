/*
 * Each rank reads the scene; the root says by which settings and plan, deals out passes
 * and joins their sums, at checkpoints and in the end.
 */
#include "job.h"

#include "command.h"
#include "dealer.h"
#include "join.h"
#include "loading.h"
#include "message.h"
#include "progress.h"
#include "ranks.h"

#include <math.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

enum { USUAL_PASSES = 16, FIRST_NOISE_CHECK = 8 };

/* Of the time asked for so much is kept for writing the picture: s, and a share. */
static const double time_kept = 0.3, share_kept = 0.02;

typedef struct job {
    const options *options;
    double start; /* s, less what another job spent */
    NephScene *scene;
    NephRender *render;
    char **outputs; /* owned */
    int threads;    /* of this rank, unless others are asked for */

    /* The root's. */
    dealer dealer;
    double passes, time, noise; /* where it ends; 0: anywhere */
    double pass_start, pass_seconds;
    double last_join; /* s */
    int64_t noise_check;
    NephStop stopped_by;
    progress shown;
} job;

static double now(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}

/* ---- When ---- */

static double time_left(const job *j)
{
    return (1.0 - share_kept) * j->time - time_kept - (now() - j->start);
}

/* A pass that is dealt now is begun when the one under way ends. */
static bool join_is_due(void *data)
{
    const job *j = data;
    int64_t n = j->dealer.next;
    return (j->passes > 0.0 && (double)n >= j->passes) ||
           (j->noise > 0.0 && n >= j->noise_check) ||
           (j->time > 0.0 && n > 0 && time_left(j) < 2.0 * j->pass_seconds) ||
           (j->options->checkpoint &&
            now() - j->last_join > j->options->checkpoint_every);
}

/* The error falls as 1 / √passes. */
static void plan_noise_check(job *j, double noise)
{
    int64_t n = j->dealer.next;
    double ratio = noise / j->noise;
    double wanted = fmin((double)n * ratio * ratio, 2.0 * (double)n);
    j->noise_check = MAX((int64_t)ceil(wanted), n + 1);
}

/* Of sums that are joined: why to end, or NEPH_GOES_ON. */
static NephStop decide(job *j)
{
    int64_t n = j->dealer.next;
    double noise = j->noise > 0.0 ? neph_render_noise(j->render) : (double)INFINITY;
    if (j->passes > 0.0 && (double)n >= j->passes)
        return NEPH_PASSES_DONE;
    if (noise <= j->noise)
        return NEPH_NOISE_REACHED;
    if (j->time > 0.0 && time_left(j) < j->pass_seconds)
        return NEPH_TIME_UP;
    if (j->noise > 0.0)
        plan_noise_check(j, noise);
    return NEPH_GOES_ON;
}

/* ---- Passes ---- */

static bool look_on(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction;
    job *j = data;
    if (ranks_me() != ROOT)
        return true;
    dealer_serve(&j->dealer);
    NephStatistics all = *statistics;
    all.passes = j->dealer.next - 1;
    all.passes_wanted = (int64_t)j->passes;
    all.time_total = now() - j->start;
    double done = j->passes > 0.0 ? (double)all.passes / j->passes : 0.0;
    if (j->time > 0.0)
        done = fmax(done, all.time_total / j->time);
    return progress_show(done, &all, &j->shown);
}

static void render_pass(job *j, int64_t index)
{
    g_autoptr(GError) error = NULL;
    double start = now();
    if (!neph_render_pass(j->render, (uint32_t)index, look_on, j, &error))
        ranks_abort(error);
    j->pass_seconds = fmax(now() - start, 0.5 * j->pass_seconds);
}

/* Until the root says join. */
static void render_dealt(job *j)
{
    if (ranks_me() == ROOT) {
        for (order next; (next = dealer_deal(&j->dealer)).pass >= 0;) {
            render_pass(j, next.pass);
            dealer_serve(&j->dealer);
        }
        dealer_wait(&j->dealer);
        return;
    }
    order next = question_answer(question_ask());
    while (next.pass >= 0) {
        question *then = question_ask();
        render_pass(j, next.pass);
        next = question_answer(then);
    }
}

/* ---- When the job is ended from outside ---- */

static char farewell[512];

/* mpirun ends what is left so when a rank has died. */
static void on_end(int number)
{
    (void)number;
    ssize_t ignored = write(STDERR_FILENO, farewell, strlen(farewell));
    (void)ignored;
    neph_file_abandon_all();
    _exit(EXIT_FAILED);
}

static void say_farewell_with(const job *j, int64_t saved)
{
    if (saved > 0)
        g_snprintf(farewell, sizeof farewell,
                   "nephroid: the job is being ended; %" G_GINT64_FORMAT
                   " passes are kept, go on with --resume %s\n",
                   saved, j->options->checkpoint);
    else
        g_snprintf(farewell, sizeof farewell,
                   "nephroid: the job is being ended; no checkpoint was written\n");
}

static void save(const job *j)
{
    g_autoptr(GError) error = NULL;
    const char *path = j->options->checkpoint;
    if (!path)
        return;
    if (neph_render_save_checkpoint(j->render, path, &error))
        say_farewell_with(j, j->dealer.next);
    else
        report_error(error);
}

/* The root says it to all. */
static bool goes_on(job *j)
{
    int on = 1;
    if (ranks_me() == ROOT && j->dealer.next > 0) {
        j->stopped_by = decide(j);
        on = j->stopped_by == NEPH_GOES_ON;
    }
    MPI_Bcast(&on, 1, MPI_INT, ROOT, MPI_COMM_WORLD);
    return on;
}

static void render_all(job *j)
{
    while (goes_on(j)) {
        render_dealt(j);
        join_sums(j->render);
        if (ranks_me() == ROOT)
            save(j);
        j->last_join = now();
    }
}

/* ---- Before ---- */

static char *settings_text(const NephSettings *settings)
{
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    GString *out = g_string_new(NULL);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = neph_settings_get(settings, rows[i].name);
        g_string_append_printf(out, "%s=%s\n", rows[i].name, value);
    }
    return g_string_free(out, FALSE);
}

static double number_of(const NephSettings *settings, const char *name)
{
    g_autofree char *text = neph_settings_get(settings, name);
    return g_ascii_strtod(text, NULL);
}

/* The root: those asked for; where time is given, as large as passes are that fit. */
static NephSettings *choose_settings(job *j, GError **error)
{
    const options *o = j->options;
    int width = o->width, height = o->height;
    g_autoptr(NephSettings) asked =
        o->resume ? neph_checkpoint_settings(o->resume, o->width ? NULL : &width,
                                             o->width ? NULL : &height, error)
                  : neph_scene_settings(j->scene);
    if (!asked || !overrides_apply(&o->settings, asked, error) ||
        (width && !neph_scene_resize(j->scene, width, height, error)))
        return NULL;
    j->time = number_of(asked, "time");
    j->noise = number_of(asked, "noise");
    j->passes = floor(number_of(asked, "passes"));
    if (!(j->passes > 0.0) && !(j->time > 0.0) && !(j->noise > 0.0))
        j->passes = USUAL_PASSES;
    if (!(j->time > 0.0))
        return g_steal_pointer(&asked);
    NephPlan plan;
    g_autoptr(NephRender) trial = neph_render_new(j->scene, asked, error);
    if (!trial)
        return NULL;
    neph_render_set_time_around(trial, now() - j->start, NULL);
    if (!o->resume && !neph_render_plan(trial, &plan, error))
        return NULL;
    NephSettings *chosen = neph_render_settings(trial);
    neph_settings_set(chosen, "time", "0", NULL);
    return chosen;
}

static void set_threads(const job *j, NephSettings *settings)
{
    g_autofree char *threads = g_strdup_printf("%d", j->threads);
    if (!j->options->settings.threads)
        neph_settings_set(settings, "threads", threads, NULL);
}

/* What the root renders by, in every rank, with the size of its picture. Owned by the
   caller. */
static NephSettings *share_settings(const job *j)
{
    int size[2] = {0, 0};
    NephSettings *out = j->render ? neph_render_settings(j->render) : neph_settings_new();
    g_autofree char *text = j->render ? settings_text(out) : NULL;
    g_autofree char *all = ranks_share_text(text);
    g_auto(GStrv) lines = g_strsplit(all, "\n", -1);
    for (char **line = lines; *line; line++) {
        char *value = strchr(*line, '=');
        if (!value)
            continue;
        *value++ = '\0';
        neph_settings_set(out, *line, value, NULL);
    }
    neph_scene_size(j->scene, &size[0], &size[1]);
    MPI_Bcast(size, 2, MPI_INT, ROOT, MPI_COMM_WORLD);
    neph_scene_resize(j->scene, size[0], size[1], NULL);
    set_threads(j, out);
    return out;
}

/* The root plans, and the others have its plan. */
static bool share_plan(const job *j, GError **error)
{
    bool is_root = ranks_me() == ROOT;
    g_autoptr(GBytes) made = is_root ? neph_render_plan_bytes(j->render, error) : NULL;
    if (!ranks_agree(!is_root || made))
        return false;
    g_autoptr(GBytes) plan = ranks_share_bytes(made);
    return ranks_agree(is_root || neph_render_take_plan(j->render, plan, error));
}

static bool resume(job *j, GError **error)
{
    NephStatistics s;
    if (!j->options->resume)
        return true;
    if (!neph_render_resume(j->render, j->options->resume, error))
        return false;
    neph_render_statistics(j->render, &s);
    j->dealer.next = s.passes;
    j->start -= s.time_total;
    if (!j->options->quiet)
        tell("note", "going on after %" G_GINT64_FORMAT " passes", s.passes);
    return true;
}

static bool begin_root(job *j, GError **error)
{
    g_autoptr(NephSettings) settings = choose_settings(j, error);
    if (!settings)
        return false;
    set_threads(j, settings);
    j->render = neph_render_new(j->scene, settings, error);
    return j->render && resume(j, error);
}

static void choose_outputs(job *j)
{
    const options *o = j->options;
    j->outputs = g_strdupv(o->outputs);
    if (j->outputs)
        return;
    const char *named = neph_scene_output(j->scene);
    g_autofree char *name = g_path_get_basename(o->scene);
    char *dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = '\0';
    j->outputs = g_new0(char *, 2);
    j->outputs[0] = named ? g_strdup(named) : g_strconcat(name, ".exr", NULL);
}

static bool prepare(job *j, GError **error)
{
    const NephLoadOptions how =
        loading_options((unsigned)j->threads, j->options->quiet || ranks_me() != ROOT);
    j->scene = neph_scene_load_with(j->options->scene, &how, error);
    if (!ranks_agree(j->scene != NULL) ||
        !ranks_agree(ranks_me() != ROOT || begin_root(j, error)))
        return false;
    choose_outputs(j);
    g_autoptr(NephSettings) settings = share_settings(j);
    if (ranks_me() != ROOT)
        j->render = neph_render_new(j->scene, settings, error);
    return ranks_agree(j->render != NULL) && share_plan(j, error);
}

/* ---- After ---- */

static int write_all(const job *j)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephImage) image = neph_render_image(j->render, &error);
    if (!image)
        return report_error(error);
    for (char **path = j->outputs; *path; path++) {
        if (!neph_image_write(image, *path, 0.0f, &error))
            return report_error(error);
        if (!j->options->quiet)
            print_result("wrote %s\n", *path);
    }
    NephStatistics s;
    neph_render_statistics(j->render, &s);
    s.time_total = now() - j->start;
    s.stopped_by = j->stopped_by;
    if (s.short_of_memory && !j->options->quiet)
        tell("note", "fewer photons a pass were sent than asked for: more would not fit "
                     "into memory (--memory)");
    g_autofree char *table = neph_statistics_text(&s, false);
    g_autofree char *json = neph_statistics_text(&s, true);
    if (!j->options->quiet)
        print_result("ranks        %12d\n%s", ranks_count(), table);
    if (j->options->stats && !neph_file_write(j->options->stats, json, &error))
        return report_error(error);
    return EXIT_DONE;
}

int job_run(const options *o, double start)
{
    job j = {
        .options = o, .start = start, .last_join = now(), .threads = ranks_threads()};
    j.dealer = (dealer){.is_due = join_is_due, .data = &j};
    j.noise_check = MAX(FIRST_NOISE_CHECK, ranks_count());
    j.shown = progress_begin(o->quiet || ranks_me() != ROOT);
    g_autoptr(GError) error = NULL;
    int result = EXIT_DONE;
    if (!prepare(&j, &error)) {
        result = error ? report_error(error) : EXIT_FAILED;
    } else {
        say_farewell_with(&j, 0);
        if (ranks_me() == ROOT)
            sigaction(SIGTERM, &(struct sigaction){.sa_handler = on_end}, NULL);
        render_all(&j);
        progress_end(&j.shown);
        if (ranks_me() == ROOT)
            result = write_all(&j);
    }
    neph_render_free(j.render);
    neph_scene_free(j.scene);
    g_strfreev(j.outputs);
    MPI_Bcast(&result, 1, MPI_INT, ROOT, MPI_COMM_WORLD);
    return result;
}
