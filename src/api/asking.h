/*
 * A caller's answer to whether to go on, as long work hears it.
 */
#pragma once

#include "base/parallel.h"
#include "nephroid/nephroid.h"

/** @brief Must stay where it is while the work goes on: the flag points to it. */
typedef struct asking {
    cancel_flag cancel;
    NephGoOnFunc go_on;
    void *data;
} asking;

static inline void asking_progress(void *data)
{
    asking *a = data;
    if (!a->go_on(a->data))
        atomic_store(&a->cancel.set, true);
}

/** @param go_on NULL: the work is never stopped */
static inline const cancel_flag *asking_begin(asking *a, NephGoOnFunc go_on, void *data)
{
    *a = (asking){
        .cancel = {.progress = go_on ? asking_progress : NULL, .progress_data = a},
        .go_on = go_on,
        .data = data};
    return &a->cancel;
}
