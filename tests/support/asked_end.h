/*
 * An end that is asked for while something is at work, and how long after that it comes.
 * Other programs may hold the machine up: what counts is the process' own time where that
 * is less.
 */
#pragma once

#include "cpu_time.h"

#include <glib.h>
#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>

typedef struct asked_end {
    gint64 after;          /* µs from the beginning to the asking */
    void (*ask)(void *of); /* NULL: it is asked for by asked_end_go_on alone */
    void *of;
    GThread *thread;
    gint64 at;  /* monotonic µs when it was asked for ... */
    double cpu; /* ... and s that the process had worked */
    atomic_bool is_asked;
} asked_end;

static inline gpointer asked_end_wait(gpointer data)
{
    asked_end *e = data;
    g_usleep((gulong)e->after);
    e->at = g_get_monotonic_time();
    e->cpu = cpu_seconds();
    atomic_store(&e->is_asked, true);
    if (e->ask)
        e->ask(e->of);
    return NULL;
}

static inline void asked_end_begin(asked_end *e)
{
    e->thread = g_thread_new("end", asked_end_wait, e);
}

/* A NephGoOnFunc. */
static inline bool asked_end_go_on(void *data)
{
    return !atomic_load(&((asked_end *)data)->is_asked);
}

/* Once what was at work has ended. @return s since the asking */
static inline double asked_end_took(asked_end *e)
{
    gint64 now = g_get_monotonic_time();
    double cpu = cpu_seconds();
    g_thread_join(e->thread);
    return fmin(1e-6 * (double)(now - e->at), cpu - e->cpu);
}
