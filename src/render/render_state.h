/*
 * What a render is made of, for the files that are its parts: render.c, which runs it,
 * and resume.c, which lets another process go on with it.
 */
#pragma once

#include "render/look.h"
#include "render/render.h"

struct render {
    transport_plan plan;       /* by settings that may be paced */
    transport_plan first_plan; /* of the first pass: borrows from plan */
    settings asked;
    const transport_kind *transport;
    film film;
    bool paced, prepared;
    bool given_up;  /* the pass under way, since the time is over */
    double before;  /* see render_set_time_around */
    double earlier; /* s that another process spent: render_resume */
    char *expected; /* render_plan_digest of that; NULL: any plan will do */
    char **paths;
    double after;    /* s that writing to these takes */
    double timed_at; /* s: when it was asked last */
    uint32_t passes_done;
    render_statistics statistics;
    cancel_flag cancel;
    unsigned n_threads;

    /* Of the call under way. */
    render_progress progress;
    void *progress_data;
    double start;         /* clock when it would have begun without pauses */
    double last_progress; /* clock */

    /* Of the pass under way: how far it is. */
    double pass_start;   /* clock */
    double last_pass;    /* s that the last one took, or would have if it were as large */
    double photon_share; /* of it, before the camera looked */
    look *look;          /* NULL: the camera does not look yet */
};
