#include "stop.h"

#include <signal.h>

static const struct {
    int number;
    const char *name;
} signals[] = {{SIGINT, "an interrupt"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "a hang-up"}};

/* A signal handler knows nothing but what is global. */
static NephRender *volatile watched;
static volatile sig_atomic_t caught;

static void on_signal(int number)
{
    if (watched && !caught) {
        caught = number;
        neph_render_cancel(watched);
        return;
    }
    neph_file_abandon_all();
    signal(number, SIG_DFL);
    raise(number);
}

void stop_init(void)
{
    struct sigaction action = {.sa_handler = on_signal,
                               .sa_flags = SA_RESTART | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++) {
        struct sigaction before;
        sigaction(signals[i].number, NULL, &before);
        if (before.sa_handler != SIG_IGN)
            sigaction(signals[i].number, &action, NULL);
    }
}

void stop_watch(NephRender *render)
{
    watched = render;
    signal(SIGPIPE, SIG_IGN);
}

void stop_unwatch(void)
{
    signal(SIGPIPE, SIG_DFL);
    watched = NULL;
}

const char *stop_reason(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++)
        if (signals[i].number == caught)
            return signals[i].name;
    return NULL;
}
