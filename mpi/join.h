/*
 * Sums of all ranks joined in the root's render; the others begin at nothing again.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief All ranks call it. The root's render has then what all have rendered. */
void join_sums(NephRender *render);
