/*
 * The child is started by posix_spawn, since fork is not for programs with threads, and
 * is given open files, a pipe and numbers, no path. The bytes that it tells are all taken
 * before they are looked at: then each count in them can be held against what is there.
 */
#define _GNU_SOURCE
#include "format/model/importer.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/memory.h"
#include "importer_paths.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Measured of assimp 5.2: 10 to 30 bytes of address space for each of a file of 100,000
 * triangles in any of the formats, 200 where a million triangles have the same three
 * corners; and up to 0.14 s for each megabyte, on one core of 2023. */
enum { LEAST_MEMORY = 512 << 20, MEMORY_PER_BYTE = 250, LEAST_SECONDS = 20 };
static const double SECONDS_PER_BYTE = 4e-6, CLOCK_PER_SECOND = 4.0;

enum {
    PROGRESS_MS = 50,
    GRACE_MS = 50,
    FIRST_ROOM = 1 << 20,
    ABOVE_STANDARD = 10,
    FIRST_FILE = 3
};

import_limits import_limits_of(size_t file_size)
{
    size_t growing = MIN(file_size, G_MAXSIZE / 4 / MEMORY_PER_BYTE) * MEMORY_PER_BYTE;
    return (import_limits){MIN(LEAST_MEMORY + growing, memory_left()),
                           LEAST_SECONDS + SECONDS_PER_BYTE * (double)file_size};
}

/* ---- Where it is ---- */

/* The folder of the library, or of the program that it is part of. */
static char *own_folder(void)
{
    Dl_info info;
    if (dladdr(&SECONDS_PER_BYTE, &info) == 0 || !info.dli_fname)
        return NULL;
    g_autofree char *whole = g_canonicalize_filename(info.dli_fname, NULL);
    return g_path_get_dirname(whole);
}

static char *find_program(void)
{
    static const char *const places[] = {IMPORTER_FROM_LIBRARY, "nephroid-import"};
    const char *given = secure_getenv("NEPHROID_IMPORTER");
    g_autofree char *folder = own_folder();
    if (given && *given)
        return g_strdup(given);
    for (size_t i = 0; i < G_N_ELEMENTS(places) && folder; i++) {
        g_autofree char *path = g_canonicalize_filename(places[i], folder);
        if (g_file_test(path, G_FILE_TEST_IS_EXECUTABLE))
            return g_steal_pointer(&path);
    }
    return g_strdup(IMPORTER_INSTALLED);
}

/* ---- Starting it ---- */

typedef struct child {
    const import_job *job;
    import_limits limits;
    pid_t pid;
    int pipe;         /**< its end to read from */
    int64_t deadline; /**< µs */
} child;

/* The number is none of those that the child is to have: they are set one by one. */
static int open_file(const char *path, size_t *size)
{
    size_t own;
    int file = input_descriptor(path, &own, NULL);
    if (file < 0)
        return -1;
    int out = fcntl(file, F_DUPFD_CLOEXEC, ABOVE_STANDARD + MOST_IMPORT_FILES);
    close(file);
    if (out >= 0)
        *size += own;
    return out;
}

/* The model and the files that it names; those that are missing are left out. */
static GArray *open_files(const import_job *job, GPtrArray *arguments, size_t *size,
                          GError **error)
{
    GArray *files = g_array_new(FALSE, FALSE, sizeof(int));
    int file = open_file(job->path, size);
    if (file < 0)
        error_at(error, (source_place){intern(job->path), 0, 0},
                 "expected a file, found none");
    else
        g_array_append_val(files, file);
    for (size_t i = 0; i < job->n_files && i < MOST_IMPORT_FILES && file >= 0; i++) {
        int other = open_file(job->files[i].path, size);
        if (other < 0)
            continue;
        g_array_append_val(files, other);
        g_ptr_array_add(arguments, g_strdup(job->files[i].name));
    }
    return files;
}

static void close_all(GArray *files)
{
    for (guint i = 0; i < files->len; i++)
        close(g_array_index(files, int, i));
    g_array_unref(files);
}

/* What a program expects that is not this one. */
static void set_signals(posix_spawnattr_t *how)
{
    sigset_t set;
    sigemptyset(&set);
    posix_spawnattr_setsigmask(how, &set);
    sigfillset(&set);
    posix_spawnattr_setsigdefault(how, &set);
    posix_spawnattr_setflags(how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

static int spawn(child *c, const char *program, char **arguments, const GArray *files,
                 int pipe_end)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t how;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&how);
    set_signals(&how);
    posix_spawn_file_actions_adddup2(&actions, g_array_index(files, int, 0),
                                     STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, pipe_end, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    for (guint i = 1; i < files->len; i++)
        posix_spawn_file_actions_adddup2(&actions, g_array_index(files, int, i),
                                         FIRST_FILE + (int)i - 1);
    posix_spawn_file_actions_addclosefrom_np(&actions, FIRST_FILE + (int)files->len - 1);
    int fault = posix_spawn(&c->pid, program, &actions, &how, arguments, environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&actions);
    return fault;
}

static bool open_pipe(int ends[2], GError **error)
{
    int low[2];
    if (pipe2(low, O_CLOEXEC) == 0) {
        for (int i = 0; i < 2; i++) {
            ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, ABOVE_STANDARD + MOST_IMPORT_FILES);
            close(low[i]);
        }
        if (ends[0] >= 0 && ends[1] >= 0)
            return true;
        close(MAX(ends[0], ends[1]));
    }
    error_set(error, ERROR_FAILED, "cannot make a pipe: %s", g_strerror(errno));
    return false;
}

static bool start_with(child *c, const GArray *files, GPtrArray *arguments,
                       GError **error)
{
    int ends[2];
    if (!open_pipe(ends, error))
        return false;
    const char *program = arguments->pdata[0];
    int fault = spawn(c, program, (char **)arguments->pdata, files, ends[1]);
    close(ends[1]);
    c->pipe = ends[0];
    c->deadline = g_get_monotonic_time() +
                  (int64_t)(1e6 * MIN(CLOCK_PER_SECOND * c->limits.seconds, 1e9));
    if (fault) {
        close(ends[0]);
        error_set(error, ERROR_FAILED,
                  "cannot start %s, which reads models (NEPHROID_IMPORTER may say where "
                  "it is): %s",
                  program, g_strerror(fault));
    }
    return !fault;
}

static bool start(child *c, GError **error)
{
    const import_job *job = c->job;
    g_autoptr(GPtrArray) arguments = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
    size_t size = 0;
    GArray *files = open_files(job, names, &size, error);
    if (job->limits.memory == 0)
        c->limits = import_limits_of(size);
    g_ptr_array_add(arguments, find_program());
    g_ptr_array_add(arguments, g_strdup(job->extension));
    g_ptr_array_add(arguments, g_strdup_printf("%zu", c->limits.memory));
    g_ptr_array_add(arguments,
                    g_strdup_printf("%u", (unsigned)MIN(c->limits.seconds + 1.0, 1e9)));
    g_ptr_array_extend_and_steal(arguments, g_steal_pointer(&names));
    g_ptr_array_add(arguments, NULL);
    bool started = files->len > 0 && start_with(c, files, arguments, error);
    close_all(files);
    return started;
}

/* ---- Listening to it ---- */

typedef struct heard {
    unsigned char *bytes;
    size_t n, room;
} heard;

/** @brief Why nothing more is read. */
typedef enum stop { STOP_END, STOP_TIME, STOP_MEMORY, STOP_CANCEL, STOP_FAILED } stop;

static bool make_room(heard *h, GError **error)
{
    size_t more = h->room ? 2 * h->room : FIRST_ROOM;
    unsigned char *grown =
        h->n < h->room ? h->bytes : big_grow(h->bytes, h->n, more, 1, "a model", error);
    if (grown && grown != h->bytes)
        h->room = more;
    h->bytes = grown ? grown : h->bytes;
    return grown != NULL;
}

static stop listen_to(const child *c, heard *h, GError **error)
{
    for (;;) {
        struct pollfd ready = {.fd = c->pipe, .events = POLLIN};
        int n = poll(&ready, 1, PROGRESS_MS);
        if (cancel_tell_progress(c->job->cancel))
            return STOP_CANCEL;
        if (g_get_monotonic_time() > c->deadline)
            return STOP_TIME;
        if (n <= 0)
            continue;
        if (h->n > c->limits.memory)
            return STOP_MEMORY;
        if (!make_room(h, error))
            return STOP_FAILED;
        ssize_t got = read(c->pipe, h->bytes + h->n, h->room - h->n);
        if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN))
            return STOP_END;
        h->n += got > 0 ? (size_t)got : 0;
    }
}

/* Whoever has closed the pipe has nothing more to say: that it ends by itself is not
 * waited for, and what it ended by is not changed by this. A number that is no child's
 * any more, since the program that we are in waits for all, may be another's.
 * @param grace_ms before it is killed: what is dying has closed its pipe a little before
 * @return as waitpid has it; 0 if that is not known, or by us */
static int end(const child *c, int grace_ms)
{
    int status = 0;
    pid_t ended = waitpid(c->pid, &status, WNOHANG);
    for (; ended == 0 && grace_ms > 0; grace_ms--) {
        g_usleep(1000);
        ended = waitpid(c->pid, &status, WNOHANG);
    }
    close(c->pipe);
    if (ended != 0)
        return status;
    kill(c->pid, SIGKILL);
    while (waitpid(c->pid, &status, 0) < 0 && errno == EINTR)
        ;
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL ? 0 : status;
}

/* ---- What went wrong ---- */

static void blame_file(const child *c, GError **error, const char *format, ...)
    G_GNUC_PRINTF(3, 4);

static void blame_file(const child *c, GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *what = g_strdup_vprintf(format, args);
    va_end(args);
    error_at(error, (source_place){intern(c->job->path), 0, 0}, "the importer for %s %s",
             c->job->format, what);
}

/* @return whether all went well */
static bool judge(const child *c, stop why, int status, GError **error)
{
    bool killed = WIFSIGNALED(status);
    int signal_is = killed ? WTERMSIG(status) : 0;
    if (why == STOP_CANCEL)
        error_set(error, ERROR_CANCELLED, "cancelled");
    else if (why == STOP_TIME || (why == STOP_END && signal_is == SIGXCPU))
        blame_file(
            c, error, "was stopped after %.0f s: the file is damaged, or too much for it",
            why == STOP_TIME ? CLOCK_PER_SECOND * c->limits.seconds : c->limits.seconds);
    else if (why == STOP_MEMORY)
        blame_file(c, error, "tells more than %zu MB of it: the file is damaged",
                   c->limits.memory >> 20);
    else if (why == STOP_END && signal_is == SIGKILL)
        blame_file(c, error, "was killed from outside, as is done where memory is short");
    else if (why == STOP_END && killed)
        blame_file(c, error, "crashed (signal %d): the file is damaged", signal_is);
    else if (why == STOP_END && WIFEXITED(status) && WEXITSTATUS(status) != 0)
        blame_file(c, error, "crashed (status %d): the file is damaged",
                   WEXITSTATUS(status));
    else
        return why == STOP_END;
    return false;
}

void *importer_run(const import_job *job, size_t *size, GError **error)
{
    child c = {.job = job, .limits = job->limits};
    heard h = {0};
    if (!start(&c, error))
        return NULL;
    stop why = listen_to(&c, &h, error);
    int status = end(&c, why == STOP_END ? GRACE_MS : 0);
    if (!judge(&c, why, status, error))
        g_clear_pointer(&h.bytes, big_free);
    *size = h.n;
    return h.bytes;
}
