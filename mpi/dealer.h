/*
 * Passes dealt out by the root, to whoever asks.
 *
 *   rank r ── ask ──► root     while it renders, the root looks now and then who asks
 *          ◄─ order ──         a pass, or: join
 *
 * Each rank asks for the next pass before it begins the one it has, so that nobody waits.
 * Passes are dealt in their order, and once the root says join nobody gets one before all
 * have joined: then those joined are all from 0 on, which is what a checkpoint is of.
 */
#pragma once

#include <mpi.h>
#include <nephroid/nephroid.h>

/** @brief Next for a rank: a pass, or to join. */
typedef struct order {
    int64_t pass; /**< -1: join */
} order;

typedef struct dealer {
    int64_t next;               /**< pass */
    bool joining;               /**< nobody gets a pass any more */
    int n_told;                 /**< ranks that know */
    bool (*is_due)(void *data); /**< whether to join now */
    void *data;
} dealer;

/** @brief The root: what a rank does next. */
order dealer_deal(dealer *d);
/** @brief The root: answers all who ask just now. */
void dealer_serve(dealer *d);
/** @brief The root, that is to join: waits until all others know, too. */
void dealer_wait(dealer *d);

/** @brief Another rank's question under way. */
typedef struct question {
    MPI_Request sent, answered;
    int64_t nothing, pass;
} question;

question *question_ask(void);
/** @brief Waits for the answer, and frees. */
order question_answer(question *q);
