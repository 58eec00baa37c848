/*
 * Each rank reads the scene; the root says by which settings and plan, deals out passes
 * and joins their sums, at checkpoints and in the end.
 */
#include "job.h"

#include "clock.h"
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

typedef struct job {
    const options *options;
    NephScene *scene;
    NephRender *render;
    char **outputs; /* owned */
    int threads;    /* of this rank, unless others are asked for */

    /* The root's. */
    dealer dealer;
    job_clock clock;
    double spent_before;  /* s: by the job that it goes on from */
    bool has_pass;        /* a rank has rendered one */
    bool has_gap;         /* not all passes before the last one were rendered */
    double passes, noise; /* where it ends; 0: anywhere */
    double last_join;     /* s */
    bool has_kept;        /* a checkpoint was written, and said to be there */
    int64_t noise_check;
    NephStop stopped_by;
    progress shown;
} job;

/* ---- When ---- */

static bool join_is_due(int n_before, void *data)
{
    const job *j = data;
    int64_t n = j->dealer.next;
    return (j->passes > 0.0 && (double)n >= j->passes) ||
           (j->noise > 0.0 && n >= j->noise_check) ||
           (n > 0 && clock_is_over(&j->clock, j->render, n_before)) ||
           (j->options->checkpoint &&
            clock_now() - j->last_join > j->options->checkpoint_every);
}

static void hear_pass(double seconds, void *data)
{
    job *j = data;
    j->has_pass = true;
    clock_note_pass(&j->clock, seconds);
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
    if (clock_is_over(&j->clock, j->render, 0))
        return NEPH_TIME_UP;
    if (j->noise > 0.0)
        plan_noise_check(j, noise);
    return NEPH_GOES_ON;
}

/* ---- Passes ---- */

/* The root: where time is up, once there is a picture. */
static bool has_to_give_up(job *j)
{
    if (j->has_pass && clock_is_up(&j->clock, j->render))
        dealer_give_up(&j->dealer);
    return j->dealer.gave_up;
}

static bool look_on(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction;
    job *j = data;
    const job_clock *c = &j->clock;
    if (ranks_me() != ROOT)
        return !dealer_says_give_up();
    dealer_serve(&j->dealer);
    if (has_to_give_up(j))
        return false;
    NephStatistics all = *statistics;
    all.passes = j->dealer.next - 1;
    all.passes_wanted = (int64_t)j->passes;
    all.time_total = clock_now() - c->start;
    double done = j->passes > 0.0 ? (double)all.passes / j->passes : 0.0;
    if (c->time > 0.0)
        done = fmax(done, all.time_total / c->time);
    return progress_show(done, &all, &j->shown);
}

/* @return s that it took; 0: it was given up */
static double render_pass(job *j, int64_t index)
{
    g_autoptr(GError) error = NULL;
    double start = clock_now();
    if (neph_render_pass(j->render, (uint32_t)index, look_on, j, &error))
        return clock_now() - start;
    if (!g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED))
        ranks_abort(error);
    return 0.0;
}

static void render_as_told(job *j)
{
    double took = 0.0;
    order next = question_answer(question_ask(0, took));
    while (next.pass >= 0) {
        question *then = question_ask(1, took);
        if (!dealer_says_give_up())
            took = render_pass(j, next.pass);
        next = question_answer(then);
    }
}

/* Until the root says join. */
static void render_dealt(job *j)
{
    if (ranks_me() != ROOT) {
        render_as_told(j);
        return;
    }
    for (order next; (next = dealer_deal(&j->dealer, 0)).pass >= 0;) {
        double took = render_pass(j, next.pass);
        if (took > 0.0)
            hear_pass(took, j);
        dealer_serve(&j->dealer);
    }
    while (!dealer_all_know(&j->dealer))
        has_to_give_up(j);
}

/* ---- When the job is ended from outside ---- */

static char farewell[512];

/* mpirun ends what is left so when a rank has died; on a busy machine it may not wait for
   this to be said. */
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

static void save(job *j)
{
    g_autoptr(GError) error = NULL;
    const char *path = j->options->checkpoint;
    if (!path)
        return;
    if (j->has_gap) {
        tell("note", "%s is not written: time was up before all passes were done", path);
        return;
    }
    if (!neph_render_save_checkpoint(j->render, path, &error)) {
        report_error(error);
        return;
    }
    if (!j->has_kept)
        tell("note",
             "passes are kept from now on: if the job ends, go on with --resume %s",
             path);
    j->has_kept = true;
    say_farewell_with(j, j->dealer.next);
}

/* The root says it to all. */
static bool goes_on(job *j)
{
    int on = 1;
    if (ranks_me() == ROOT && j->dealer.next > 0) {
        if (j->stopped_by == NEPH_GOES_ON)
            j->stopped_by = decide(j);
        on = j->stopped_by == NEPH_GOES_ON;
    }
    ranks_share(&on, 1, MPI_INT);
    return on;
}

/* Of passes that were given up. */
static void note_missing(job *j)
{
    NephStatistics s;
    neph_render_statistics(j->render, &s);
    j->has_gap = s.passes < j->dealer.next;
    j->dealer.next = s.passes;
    j->stopped_by = NEPH_TIME_UP;
}

static void join(job *j)
{
    bool gave_up = dealer_settle(&j->dealer);
    double start = clock_now();
    join_sums(j->render);
    if (gave_up && ranks_me() == ROOT)
        note_missing(j);
    j->last_join = clock_now();
    j->clock.join = fmax(j->clock.join, j->last_join - start);
}

static void render_all(job *j)
{
    while (goes_on(j)) {
        render_dealt(j);
        join(j);
        if (ranks_me() == ROOT)
            save(j);
    }
}

/* To the render: what this job has spent so far. */
static void tell_time(const job *j)
{
    double spent = clock_now() - j->clock.start - j->spent_before;
    neph_render_set_time_around(j->render, spent, (const char *const *)j->outputs);
}

/* As "nephroid render" does, which ends in time by showing parts of a pass. */
static bool look_on_alone(double fraction, const NephStatistics *statistics, void *data)
{
    return progress_show(fraction, statistics, &((job *)data)->shown);
}

static void render_alone(job *j)
{
    g_autoptr(GError) error = NULL;
    NephStatistics s;
    if (ranks_me() != ROOT)
        return;
    tell_time(j);
    if (!neph_render_run(j->render, look_on_alone, j, &error))
        ranks_abort(error);
    neph_render_statistics(j->render, &s);
    j->dealer.next = s.passes;
    j->stopped_by = s.stopped_by;
    if (s.passes > 0)
        save(j);
    if (ranks_count() > 1 && !j->options->quiet)
        tell("note",
             "time is too short for a pass of each rank: one of them has rendered");
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

/* The root: those asked for. */
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
    j->clock.time = number_of(asked, "time");
    j->noise = number_of(asked, "noise");
    j->passes = floor(number_of(asked, "passes"));
    if (!(j->passes > 0.0) && !(j->clock.time > 0.0) && !(j->noise > 0.0))
        j->passes = USUAL_PASSES;
    return g_steal_pointer(&asked);
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
    neph_settings_set(out, "time", "0", NULL); /* of it the root knows */
    neph_scene_size(j->scene, &size[0], &size[1]);
    ranks_share(size, 2, MPI_INT);
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
    j->clock.start -= j->spent_before = s.time_total;
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
    if (!j->render)
        return false;
    tell_time(j);
    return resume(j, error);
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
    if (!ranks_agree(j->scene != NULL))
        return false;
    choose_outputs(j);
    if (!ranks_agree(ranks_me() != ROOT || begin_root(j, error)))
        return false;
    g_autoptr(NephSettings) settings = share_settings(j);
    if (ranks_me() != ROOT)
        j->render = neph_render_new(j->scene, settings, error);
    return ranks_agree(j->render != NULL) && share_plan(j, error);
}

/* The root says it to all, which has planned. */
static bool time_is_short(job *j)
{
    j->clock.join = join_seconds(j->render);
    g_autoptr(NephSettings) settings = neph_render_settings(j->render);
    double crowd = ranks_crowd(number_of(settings, "threads"));
    if (j->clock.time > 0.0)
        j->clock.pass = neph_render_pass_seconds(j->render) * crowd;
    int is_short = clock_is_short(&j->clock, j->render);
    ranks_share(&is_short, 1, MPI_INT);
    return is_short;
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
    s.time_total = clock_now() - j->clock.start;
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
    job j = {.options = o,
             .clock.start = start,
             .last_join = clock_now(),
             .threads = ranks_threads()};
    j.dealer = (dealer){.is_due = join_is_due, .hear = hear_pass, .data = &j};
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
        time_is_short(&j) ? render_alone(&j) : render_all(&j);
        progress_end(&j.shown);
        if (ranks_me() == ROOT)
            result = write_all(&j);
    }
    neph_render_free(j.render);
    neph_scene_free(j.scene);
    g_strfreev(j.outputs);
    ranks_share(&result, 1, MPI_INT);
    return result;
}
