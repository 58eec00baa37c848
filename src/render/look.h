/*
 * The camera's half of a pass: rays from the eye through every pixel, whose sums go onto
 * the film.
 *
 *   look_open ─► look_cells(0 .. 16), look_cells(16 .. FILM_CELLS) ... ─► look_close
 *
 * A pass may be looked at in parts, cells of the film's pattern, so that the whole
 * picture is seen soon and a pass can end in time. A pixel is the same in whatever part
 * it comes.
 */
#pragma once

#include "render/film/film.h"
#include "transport/transport.h"

/** @brief What a look is of; what is pointed to must outlive it. */
typedef struct look_task {
    const transport_plan *plan;
    const transport_kind *transport;
    const void *pass;
    uint32_t index; /**< the pass' number */
    film *film;
    const cancel_flag *cancel; /**< once set, samples end as they are; its progress is
                                  told within large pixels, too */
} look_task;

typedef struct look look;

/** @brief Ready to render, with memory for all threads; NULL: it is refused. */
look *look_open(const look_task *task, GError **error);
/** @brief Renders the pixels of cells [first, end) of every tile.
 * @return false: cancelled, and not all of them are */
bool look_cells(look *l, int first, int end);
/** @brief Share of the pass' pixels that are rendered. */
double look_fraction(const look *l);
/** @brief Seconds spent in look_cells. */
double look_seconds(const look *l);
/** @brief Frees it; what it did is added to the counts.
 * @return false with an error: samples lacked memory, and the pass is worth nothing */
bool look_close(look *l, transport_counts *counts, GError **error);
