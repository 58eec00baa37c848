/*
 * What a render is made of, for the files that are its parts: render.c, which runs it,
 * and kept/resume.c, which lets another process go on with it.
 */
#pragma once

#include "render/look.h"
#include "render/render.h"
#include "render/stop.h"

typedef struct photon_file photon_file; /* kept/photon_file.h */

struct render {
    transport_plan plan;       /* by settings that may be paced */
    transport_plan first_plan; /* of the first pass: borrows from plan */
    settings asked;
    const transport_kind *transport;
    film film;
    bool paced, prepared;
    bool is_dealt;        /* passes are told from outside, which knows of the time */
    bool given_up;        /* the pass under way, since the time is over */
    double before;        /* see render_set_time_around */
    double earlier;       /* s that another process spent: render_resume */
    char *expected;       /* render_digest of that; NULL: any plan will do */
    photon_file *photons; /* that passes use; NULL: they send their own */
    photon_supply supply; /* from there */
    void *kept_pass;      /* of a file of one pass: that of all; NULL: not made yet */
    char **paths;
    double writing;       /* s that it takes to these */
    double denoising;     /* s that it takes before; 0: there will be none */
    double denoise_unit;  /* the same of a unit of film_denoise_work, */
    double least_unit;    /* and the least that it was told to be */
    double expected_pass; /* s that one takes, by a trial; 0: there was none */
    double timed_at;      /* s: when that was tried last */
    double timing;        /* s that trying took; 0: it was not tried */
    uint32_t passes_done;
    render_statistics statistics;
    cancel_flag cancel;
    unsigned n_threads;
    size_t beside; /* bytes of the process, the film's with them, without photons */

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
    double cell; /* s that one of the last cells took: the first touch new memory */
};

/* ---- pass.c ---- */

/** @brief Renders pass number index onto the film: so many cells of it, or fewer if time
 * is over; then stopped_by says so. */
bool render_run_pass(render *r, uint32_t index, int wanted, GError **error);
/** @brief So many cells of the pass under way are part of the picture. */
void render_set_part(render *r, int n_cells);
/** @brief What the rules look at. @param pass_fraction done of the pass under way */
stop_state render_state_now(const render *r, double pass_fraction);
/** @brief Tells the caller how far it is. */
void render_tell(render *r, double pass_fraction);
/** @brief cancel_flag.progress: comes from all parallel work, on the thread that called.
 */
void render_on_progress(void *data);
/** @brief Finds out how long denoising and writing take, if that is due. */
void render_time_writing(render *r);
/** @brief Tells how long denoising takes of what there is to denoise now. */
void render_tell_denoising(render *r);
/** @brief Leaves the noise in the picture, since there is no time to take it out. */
void render_leave_noise(render *r);

/* ---- kept/render_photons.c ---- */

/** @brief Begins a pass: with its own photons, or those of the file. */
void *render_begin_pass(render *r, const transport_plan *plan, uint32_t index,
                        transport_counts *counts, GError **error);
void render_end_pass(const render *r, void *pass);
/** @brief Plans by the file of photons. */
bool render_plan_by_file(render *r, GError **error);
/** @brief What passes depend on beside settings: the plan, and whose photons they have.
 * Owned by the caller. */
char *render_digest(const render *r);
/** @brief Lets go of the file. */
void render_forget_photons(render *r);

/* ---- render.c ---- */

/** @brief Its clock goes on: what was done before, in this process or another, counts. */
void render_start_clock(render *r);
/** @brief Decides all that is decided before the first pass, if it is not. */
bool render_prepare(render *r, GError **error);
