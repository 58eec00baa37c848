/*
 * Kernels: the scalar forms, straight from the table in the header. A row a kernel.
 */
#include "photon/kernel.h"

#include "math/vec.h"

typedef struct kernel_form {
    float (*eval)(float t, float k); /* t = d²/r² */
    float (*area)(float k);          /* in units of π r² */
} kernel_form;

static float constant_eval(float t, float k)
{
    (void)t, (void)k;
    return 1.0f;
}

static float constant_area(float k)
{
    (void)k;
    return 1.0f;
}

static float cone_eval(float t, float k)
{
    return 1.0f - sqrtf(t) / k;
}

static float cone_area(float k)
{
    return 1.0f - 2.0f / (3.0f * k); /* math: of a cone */
}

static float gaussian_eval(float t, float k)
{
    (void)k;
    float fall = 1.0f - expf(-0.5f * GAUSSIAN_BETA * t);
    return GAUSSIAN_ALPHA * (1.0f - fall / GAUSSIAN_RANGE);
}

static float gaussian_area(float k)
{
    (void)k;
    float mean = 2.0f / GAUSSIAN_BETA * (1.0f - expf(-0.5f * GAUSSIAN_BETA));
    return GAUSSIAN_ALPHA * (1.0f - (1.0f - mean) / GAUSSIAN_RANGE);
}

static float epanechnikov_eval(float t, float k)
{
    (void)k;
    return 1.0f - t;
}

static float epanechnikov_area(float k)
{
    (void)k;
    return 0.5f;
}

static const kernel_form forms[] = {
#define KERNEL(choice, word) [KERNEL_##choice] = {word##_eval, word##_area},
#include "settings/kernel.def"
#undef KERNEL
};

float kernel_eval(const kernel *k, float d2, float r2)
{
    return forms[k->choice].eval(d2 / r2, k->cone_k);
}

float kernel_area(const kernel *k, float r2)
{
    return PI_F * r2 * forms[k->choice].area(k->cone_k);
}
