/*
 * Sums of all ranks joined in the root's render; the others begin at nothing again.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief All ranks call it. The root's render has then what all have rendered. */
void join_sums(NephRender *render);
/** @brief About how long that takes, s: joins a few pieces of nothing. All ranks call it
 * before their first pass. */
double join_seconds(NephRender *render);
