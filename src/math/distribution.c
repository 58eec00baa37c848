#include "math/distribution.h"

#include "base/memory.h"
#include "base/wanted.h"

/* The last index from low to high - 1 whose step begins at or before target; that of low
   does. */
static size_t find_step(const distribution *d, double target, size_t low, size_t high)
{
    while (high - low > 1) {
        /* Chosen, not branched on: a branch would be guessed wrong every other time. */
        size_t middle = low + (high - low) / 2;
        bool above = d->cumulative[middle] <= target;
        low = above ? middle : low;
        high = above ? high : middle;
    }
    return low;
}

/* At least one cut for every four weights. */
static bool make_cuts(distribution *d, GError **error)
{
    double total = distribution_total(d);
    d->n_cuts = 1;
    while (4 * d->n_cuts < d->n)
        d->n_cuts *= 2;
    d->cuts = big_alloc(d->n_cuts + 1, sizeof *d->cuts, "a sampling table", error);
    if (!d->cuts)
        return false;
    for (size_t i = 0; i < d->n_cuts && still_wanted_at(i, NULL); i++) {
        double target = (double)i / (double)d->n_cuts * total;
        d->cuts[i] = (uint32_t)find_step(d, target, i > 0 ? d->cuts[i - 1] : 0, d->n);
    }
    d->cuts[d->n_cuts] = (uint32_t)d->n - 1;
    return true;
}

bool distribution_init(distribution *d, const float *weights, size_t n, GError **error)
{
    *d = (distribution){.n = n};
    d->cumulative = big_alloc(n + 1, sizeof(double), "a sampling table", error);
    if (!d->cumulative)
        return false;
    for (size_t i = 0; i < n; i++)
        d->cumulative[i + 1] = d->cumulative[i] + (double)weights[i];
    if (n == 0 || make_cuts(d, error))
        return true;
    distribution_clear(d);
    return false;
}

void distribution_clear(distribution *d)
{
    big_free(d->cumulative);
    big_free(d->cuts);
    *d = (distribution){0};
}

double distribution_total(const distribution *d)
{
    return d->n ? d->cumulative[d->n] : 0.0;
}

float distribution_pdf(const distribution *d, size_t i)
{
    double total = distribution_total(d);
    return total > 0.0 ? (float)((d->cumulative[i + 1] - d->cumulative[i]) / total)
                       : 0.0f;
}

size_t distribution_sample(const distribution *d, float *u)
{
    if (d->n == 1 && distribution_total(d) > 0.0)
        return 0; /* *u over all of it is *u */
    double target = (double)*u * distribution_total(d);
    /* Exact, since n_cuts is a power of two. */
    size_t cut = MIN((size_t)(*u * (float)d->n_cuts), d->n_cuts - 1);
    size_t low = find_step(d, target, d->cuts[cut], (size_t)d->cuts[cut + 1] + 1);
    while (low > 0 && !(d->cumulative[low + 1] > d->cumulative[low]))
        low--;
    double step = d->cumulative[low + 1] - d->cumulative[low];
    double place = (target - d->cumulative[low]) / step;
    *u = (float)CLAMP(place, 0.0, 0x1.fffffep-1);
    return low;
}
