/*
 * Passes dealt out by the root, to whoever asks.
 *
 *   rank r ── ask ──► root     while it renders, the root looks now and then who asks
 *          ◄─ order ──         a pass, or: join
 *
 * Each rank asks for the next pass before it begins the one it has, so that nobody waits.
 * Passes are dealt in their order, and once the root says join nobody gets one before all
 * have joined: then those joined are all from 0 on, which is what a checkpoint is of.
 * Only where time is up passes are given up: that ends the job, without a checkpoint if
 * one is missing.
 */
#pragma once

#include <mpi.h>
#include <nephroid/nephroid.h>

/** @brief Next for a rank: a pass, or to join. */
typedef struct order {
    int64_t pass; /**< -1: join */
} order;

typedef struct dealer {
    int64_t next;                             /**< pass */
    bool joining;                             /**< nobody gets a pass any more */
    bool gave_up;                             /**< nor ends the one it has */
    int n_told;                               /**< ranks that know */
    bool (*is_due)(int n_before, void *data); /**< whether to join now: who asks has so
                                                 many passes to render first */
    void (*hear)(double seconds, void *data); /**< told what a rank's pass took */
    void *data;
} dealer;

/** @brief The root: what a rank does next that has n_before to render first. */
order dealer_deal(dealer *d, int n_before);
/** @brief The root: answers all who ask just now. */
void dealer_serve(dealer *d);
/** @brief The root, that is to join: whether all others know, too; waits a moment where
 * not.
 */
bool dealer_all_know(dealer *d);
/** @brief The root: all are to give up the passes that they have, and to join. */
void dealer_give_up(dealer *d);
/** @brief Another rank: whether the root has said so. */
bool dealer_says_give_up(void);
/** @brief All ranks, before they join. @return whether passes that were dealt may be
 * missing
 */
bool dealer_settle(dealer *d);

/** @brief What the root hears from who asks. */
typedef struct rank_news {
    int64_t n_before; /**< passes that it has to render first */
    double last_pass; /**< s that its last one took; 0: it has had none */
} rank_news;

/** @brief Another rank's question under way. */
typedef struct question {
    MPI_Request sent, answered;
    rank_news what;
    int64_t pass;
} question;

question *question_ask(int n_before, double last_pass);
/** @brief Waits for the answer, and frees. */
order question_answer(question *q);
