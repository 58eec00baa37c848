/*
 * Kernels of the density estimate: κ(d/r), and the area ∫∫ κ(s) s ds dθ that normalises
 * it.
 */
#pragma once

#include "scene/settings.h"

/** @brief A kernel with its parameter. */
typedef struct kernel {
    kernel_choice choice;
    float cone_k; /**< >= 1, of the cone (Jensen 1996): κ = 1 - d/(k r) */
} kernel;

/** @brief κ at squared distance d2 <= r2. */
float kernel_eval(const kernel *k, float d2, float r2);
/** @brief ∫∫ κ(s) s ds dθ over the disc of squared radius r2, m². */
float kernel_area(const kernel *k, float r2);
