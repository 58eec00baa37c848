/*
 * What a process can no longer do in the cage: each way out is tried, in a process of its
 * own that ends with the number of the first that was open.
 */
#define _GNU_SOURCE
#include "format/model/child/cage.h"

#include <fcntl.h>
#include <glib.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

typedef bool (*attempt)(void);

static bool opens(void)
{
    return open("/etc/passwd", O_RDONLY) >= 0;
}

static bool writes_file(void)
{
    return open("/tmp/nephroid-cage", O_CREAT | O_WRONLY, 0600) >= 0;
}

static bool makes_socket(void)
{
    return socket(AF_INET, SOCK_STREAM, 0) >= 0;
}

static bool makes_pipe(void)
{
    int ends[2];
    return pipe(ends) == 0;
}

static bool doubles_file(void)
{
    return dup(STDOUT_FILENO) >= 0;
}

static bool raises_limit(void)
{
    struct rlimit more = {64, 64};
    return setrlimit(RLIMIT_NOFILE, &more) == 0;
}

static bool makes_folder(void)
{
    return mkdir("/tmp/nephroid-cage", 0700) == 0 && rmdir("/tmp/nephroid-cage") == 0;
}

static bool forks(void)
{
    pid_t child = fork();
    if (child == 0)
        _exit(0);
    return child > 0;
}

static bool executes(void)
{
    execl("/bin/true", "true", (char *)NULL);
    return false; /* it would have ended with 0, see below */
}

static bool signals_others(void)
{
    return kill(getppid(), 0) == 0;
}

static bool traces(void)
{
    return ptrace(PTRACE_TRACEME, 0, NULL, NULL) == 0;
}

static bool runs_memory(void)
{
    return mmap(NULL, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
}

static bool writes_errors(void)
{
    return write(STDERR_FILENO, "", 0) == 0;
}

/* Those that limits of resources close to everybody, and those that need the filter (or
 * not to be root). */
static const attempt limited[] = {opens, writes_file, makes_socket, makes_pipe,
                                  doubles_file};
static const attempt filtered[] = {raises_limit, makes_folder, forks,
                                   executes,     traces,       signals_others,
                                   runs_memory,  writes_errors};

enum { ALL_CLOSED = 100, NO_FILTER = 101 };

static int try_all(void)
{
    const cage limits = {.memory = 1u << 30, .seconds = 10};
    const char *missing = cage_close(&limits);
    for (size_t i = 0; i < G_N_ELEMENTS(limited); i++)
        if (limited[i]())
            return 1 + (int)i;
    for (size_t i = 0; i < G_N_ELEMENTS(filtered) && !missing; i++)
        if (filtered[i]())
            return 50 + (int)i;
    return missing ? NO_FILTER : ALL_CLOSED;
}

/* How a process ended that did this. */
static int status_of(int (*body)(void))
{
    int status = 0;
    pid_t child = fork();
    if (child == 0)
        _exit(body());
    g_assert_cmpint(child, >, 0);
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    return status;
}

static void test_ways_out(void)
{
    int status = status_of(try_all);
    g_assert_true(WIFEXITED(status));
    g_test_message("ended with %d", WEXITSTATUS(status));
    if (WEXITSTATUS(status) == NO_FILTER)
        g_test_skip("no filter of system calls here");
    else
        g_assert_cmpint(WEXITSTATUS(status), ==, ALL_CLOSED);
}

/* What it must still be able to do. */
static int work(void)
{
    const cage limits = {.memory = 1u << 30, .seconds = 10};
    cage_close(&limits);
    volatile char *big = malloc(100 << 20), *other = malloc(100);
    if (!big || !other)
        return 1;
    for (size_t i = 0; i < 100 << 20; i += 4096)
        big[i] = 1;
    char *grown = realloc((void *)big, 200 << 20);
    if (!grown || grown[4096] != 1)
        return 2;
    free(grown);
    free((void *)other);
    return write(STDOUT_FILENO, "", 0) == 0 ? 0 : 3;
}

static void test_work(void)
{
    int status = status_of(work);
    g_assert_true(WIFEXITED(status));
    g_assert_cmpint(WEXITSTATUS(status), ==, 0);
}

#ifdef SANITIZED
static void test_memory(void)
{
    g_test_skip("sanitizers need more addresses than there is memory");
}
#else
static int eat(void)
{
    const cage limits = {.memory = 1u << 30, .seconds = 10};
    cage_close(&limits);
    return malloc((size_t)1 << 30) == NULL ? 0 : 1;
}

static void test_memory(void)
{
    g_assert_cmpint(status_of(eat), ==, 0);
}
#endif

/* Some minutes, on any machine. */
static int spin(void)
{
    const cage limits = {.memory = 1u << 30, .seconds = 1};
    cage_close(&limits);
    for (volatile guint64 i = 0; i < (guint64)1 << 39; i++)
        ;
    return 1;
}

static void test_time(void)
{
    int status = status_of(spin);
    g_assert_true(WIFSIGNALED(status));
    g_assert_true(WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
}

static int crash(void)
{
    const cage limits = {.memory = 1u << 30, .seconds = 10};
    signal(SIGABRT, SIG_DFL);
    cage_close(&limits);
    abort();
}

/* A crash shows as what it is. */
static void test_crash(void)
{
    int status = status_of(crash);
    g_assert_true(WIFSIGNALED(status));
    g_assert_cmpint(WTERMSIG(status), ==, SIGABRT);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/cage/ways-out", test_ways_out);
    g_test_add_func("/cage/work", test_work);
    g_test_add_func("/cage/memory", test_memory);
    g_test_add_func("/cage/time", test_time);
    g_test_add_func("/cage/crash", test_crash);
    return g_test_run();
}
