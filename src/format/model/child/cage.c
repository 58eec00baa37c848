/*
 * Resource limits do most of it, everywhere: where no file can be numbered, none can be
 * opened. The filter of system calls (libseccomp) does it once more and keeps the kernel
 * itself out of reach: what is not in the list fails with EPERM.
 */
#include "format/model/child/cage.h"

#include <errno.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef HAVE_SECCOMP
#include <seccomp.h>
#endif

/* Deep enough for any scene that a person has made: a level of nodes takes its parsers
   less than a kilobyte. */
enum { STACK = 16 << 20 };

static bool limit(int resource, rlim_t most)
{
    struct rlimit now;
    if (getrlimit((__rlimit_resource_t)resource, &now) != 0)
        return false;
    if (now.rlim_max != RLIM_INFINITY && now.rlim_max < most)
        most = now.rlim_max;
    now = (struct rlimit){most, most};
    return setrlimit((__rlimit_resource_t)resource, &now) == 0;
}

static bool limit_resources(const cage *c)
{
    bool done = limit(RLIMIT_CORE, 0) && limit(RLIMIT_FSIZE, 0) &&
                limit(RLIMIT_NOFILE, 0) && limit(RLIMIT_NPROC, 0) &&
                limit(RLIMIT_MEMLOCK, 0) && limit(RLIMIT_STACK, STACK) &&
                limit(RLIMIT_CPU, c->seconds);
#ifndef SANITIZED /* whose shadow takes terabytes of addresses, though no memory */
    done = done && limit(RLIMIT_AS, c->memory);
#endif
    return done;
}

#ifdef HAVE_SECCOMP
/* What malloc, the end, a crash and the sanitizers need. */
static const int calls[] = {
    SCMP_SYS(brk),         SCMP_SYS(munmap),        SCMP_SYS(mremap),
    SCMP_SYS(madvise),     SCMP_SYS(futex),         SCMP_SYS(exit),
    SCMP_SYS(exit_group),  SCMP_SYS(rt_sigreturn),  SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(getpid),      SCMP_SYS(gettid),        SCMP_SYS(sched_yield),
    SCMP_SYS(getrandom),   SCMP_SYS(clock_gettime), SCMP_SYS(gettimeofday),
    SCMP_SYS(sigaltstack),
};

static bool allow(scmp_filter_ctx filter)
{
    bool done = true;
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++)
        done = done && seccomp_rule_add(filter, SCMP_ACT_ALLOW, calls[i], 0) == 0;
    const struct scmp_arg_cmp not_run = SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    const struct scmp_arg_cmp no_file =
        SCMP_A3(SCMP_CMP_MASKED_EQ, MAP_ANONYMOUS, MAP_ANONYMOUS);
    const struct scmp_arg_cmp to_pipe = {.op = SCMP_CMP_EQ, .datum_a = STDOUT_FILENO};
    const struct scmp_arg_cmp self = {.op = SCMP_CMP_EQ,
                                      .datum_a = (scmp_datum_t)getpid()};
    return done &&
           seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mmap), 2, not_run,
                            no_file) == 0 &&
           seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mprotect), 1, not_run) ==
               0 &&
           seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(write), 1, to_pipe) == 0 &&
           seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1, self) == 0;
}

static bool filter_calls(void)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    bool done = filter && allow(filter) && seccomp_load(filter) == 0;
    seccomp_release(filter);
    return done;
}
#endif

const char *cage_close(const cage *c)
{
    prctl(PR_SET_DUMPABLE, 0);
    if (!limit_resources(c))
        return "the system does not let it limit its resources";
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return "the system does not let it give up privileges";
#ifdef HAVE_SECCOMP
    return filter_calls() ? NULL : "the system does not let it filter its calls";
#else
    return "it was built without libseccomp";
#endif
}
