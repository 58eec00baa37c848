#include "math/median.h"

#include <stdlib.h>

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

float median(float *values, size_t n)
{
    qsort(values, n, sizeof *values, by_value);
    return values[n / 2];
}
