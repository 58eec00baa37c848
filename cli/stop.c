#include "stop.h"

#include <signal.h>

/* A signal handler knows nothing but what is global. */
static NephRender *volatile watched;
static volatile sig_atomic_t caught;

static const int signals[] = {SIGINT, SIGTERM};

static void restore_defaults(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++)
        signal(signals[i], SIG_DFL);
}

static void on_signal(int number)
{
    caught = number;
    restore_defaults();
    neph_render_cancel(watched);
}

void stop_watch(NephRender *render)
{
    watched = render;
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++)
        sigaction(signals[i], &action, NULL);
}

void stop_unwatch(void)
{
    restore_defaults();
    watched = NULL;
}

const char *stop_reason(void)
{
    return caught == 0 ? NULL : caught == SIGINT ? "an interrupt" : "SIGTERM";
}
