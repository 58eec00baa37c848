#include "math/distribution.h"

#include "base/memory.h"

bool distribution_init(distribution *d, const float *weights, size_t n, GError **error)
{
    d->n = n;
    d->cumulative = big_alloc(n + 1, sizeof(double), "a sampling table", error);
    if (!d->cumulative)
        return false;
    for (size_t i = 0; i < n; i++)
        d->cumulative[i + 1] = d->cumulative[i] + (double)weights[i];
    return true;
}

void distribution_clear(distribution *d)
{
    big_free(d->cumulative);
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
    double target = (double)*u * distribution_total(d);
    size_t low = 0, high = d->n;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (d->cumulative[middle] <= target)
            low = middle;
        else
            high = middle;
    }
    while (low > 0 && !(d->cumulative[low + 1] > d->cumulative[low]))
        low--;
    double step = d->cumulative[low + 1] - d->cumulative[low];
    double place = (target - d->cumulative[low]) / step;
    *u = (float)CLAMP(place, 0.0, 0x1.fffffep-1);
    return low;
}
