/*
 * Scenes written in two ways, which must render alike.
 */
#pragma once

#include "rooms.h"

#include <math.h>

#define ALIKE_HOW "integrator=path passes=1 spp=4"

typedef struct pair {
    const char *name, *one, *other;
} pair;

/* By the same random numbers, and neither black. */
static inline void check_alike(const pair *p)
{
    g_autoptr(view) a = view_of(p->one), b = view_of(p->other);
    g_autoptr(image) x = render_with(a, ALIKE_HOW), y = render_with(b, ALIKE_HOW);
    g_assert_cmpint(x->width, ==, y->width);
    g_assert_cmpint(x->height, ==, y->height);
    size_t n = (size_t)x->width * (size_t)x->height * (size_t)x->n_channels;
    double off = 0, sum = 0;
    for (size_t i = 0; i < n; i++) {
        off += fabs((double)x->pixels[i] - (double)y->pixels[i]);
        sum += fabs((double)y->pixels[i]);
    }
    if (!(off <= 2e-4 * sum) || !(mean_of(x, "") > 0.0))
        g_error("%s: differs by %g of %g", p->name, off, sum);
}

static inline void check_all(const pair *pairs, size_t n)
{
    for (size_t i = 0; i < n; i++)
        check_alike(&pairs[i]);
}
