/*
 * RGB spaces: matrices follow from the published chromaticities in double precision
 * (SMPTE RP 177-1993); white is exactly what the space's illuminant looks like.
 */
#include "color/space.h"

#include "color/observer.h"

#include <pthread.h>
#include <string.h>

#define D65 0.3127, 0.3290

/* IEC 61966-2-1; ITU-R BT.2020; SMPTE RP 431-2 primaries with D65; SMPTE ST 2065-1. */
static color_space spaces[N_COLOR_SPACES] = {
    {.name = "srgb", .xy = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, D65}},
    {.name = "rec2020", .xy = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, D65}},
    {.name = "dci-p3", .xy = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, D65}},
    {.name = "aces2065-1",
     .xy = {0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767}},
};

static matrix3 invert3(const matrix3 *a)
{
    matrix3 inverse;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
            inverse.m[i][j] = a->m[p][r] * a->m[q][s] - a->m[p][s] * a->m[q][r];
        }
    double determinant = a->m[0][0] * inverse.m[0][0] + a->m[0][1] * inverse.m[1][0] +
                         a->m[0][2] * inverse.m[2][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse.m[i][j] /= determinant;
    return inverse;
}

static void multiply3(const matrix3 *a, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a->m[i][0] * v[0] + a->m[i][1] * v[1] + a->m[i][2] * v[2];
}

/* Scales the primaries so that they add up to the white point. */
static void make_matrices(color_space *s)
{
    matrix3 primaries;
    double scale[3], x = s->xy[6], y = s->xy[7];
    const double white[3] = {x / y, 1.0, (1.0 - x - y) / y};
    for (int k = 0; k < 3; k++) {
        primaries.m[0][k] = s->xy[2 * k];
        primaries.m[1][k] = s->xy[2 * k + 1];
        primaries.m[2][k] = 1.0 - s->xy[2 * k] - s->xy[2 * k + 1];
    }
    matrix3 inverse = invert3(&primaries);
    multiply3(&inverse, white, scale);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            s->to_xyz.m[i][k] = primaries.m[i][k] * scale[k];
    s->from_xyz = invert3(&s->to_xyz);
}

/* Trapezoids of FIT_STEP nm, normalised so that reflectance 1 is exactly (1, 1, 1). */
static void make_fit(color_space *s)
{
    const observer *o = observer_get();
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (int i = 0; i < FIT_N; i++) {
            int nm = (int)LAMBDA_MIN - GRID_FIRST + i * FIT_STEP;
            double xyz[3], rgb[3], end = i == 0 || i == FIT_N - 1 ? 0.5 : 1.0;
            for (int j = 0; j < 3; j++)
                xyz[j] = end * (double)s->illuminant[nm] * (double)o->folded[j][nm];
            multiply3(&s->from_xyz, xyz, rgb);
            sum += s->fit[k][i] = rgb[k];
        }
        for (int i = 0; i < FIT_N; i++)
            s->fit[k][i] /= sum;
    }
}

static void make_spaces(void)
{
    const observer *o = observer_get();
    for (int i = 0; i < N_COLOR_SPACES; i++) {
        color_space *s = &spaces[i];
        s->index = i;
        s->illuminant = fabs(s->xy[6] - white_d65[0]) < 1e-6 ? o->d65 : o->d60;
        make_matrices(s);
        make_fit(s);
    }
}

const color_space *color_space_at(int index)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_spaces);
    return &spaces[index];
}

const color_space *color_space_find(const char *name)
{
    for (int i = 0; i < N_COLOR_SPACES; i++)
        if (strcmp(spaces[i].name, name) == 0)
            return color_space_at(i);
    return NULL;
}

const color_space *color_space_srgb(void)
{
    return color_space_at(0);
}

const char *color_space_name(const color_space *space)
{
    return space->name;
}

static void apply(const matrix3 *m, const float in[3], float out[3])
{
    const double v[3] = {(double)in[0], (double)in[1], (double)in[2]};
    double product[3];
    multiply3(m, v, product);
    for (int i = 0; i < 3; i++)
        out[i] = (float)product[i];
}

void color_space_from_xyz(const color_space *space, const float xyz[3], float rgb[3])
{
    apply(&space->from_xyz, xyz, rgb);
}

void color_space_to_xyz(const color_space *space, const float rgb[3], float xyz[3])
{
    apply(&space->to_xyz, rgb, xyz);
}

void color_space_chromaticities(const color_space *space, float xy[8])
{
    for (int i = 0; i < 8; i++)
        xy[i] = (float)space->xy[i];
}
