#include "verify.h"

enum { SIDE = 8 };

/* Chance that noise alone fails a comparison. */
#define FALSE_ALARM 1e-6

bool verify_is_long(void)
{
    return g_strcmp0(g_getenv("NEPHROID_VERIFY"), "long") == 0;
}

/* ---- Rendering ---- */

typedef struct recorder {
    const render *render;
    trial *trial;
    bool lamps;                   /* with what is seen of them directly */
    bool flip;                    /* left for right */
    int per_group;                /* passes */
    int64_t seen;                 /* passes that the last group ended with */
    double before[VERIFY_PIXELS]; /* luminance of pixels, sum over the passes seen */
} recorder;

static size_t block_of(const image *img, size_t pixel)
{
    size_t w = (size_t)img->width, h = (size_t)img->height;
    return pixel / w * SIDE / h * SIDE + pixel % w * SIDE / w;
}

static size_t mirrored(const image *img, size_t pixel)
{
    size_t w = (size_t)img->width;
    return pixel / w * w + w - 1 - pixel % w;
}

/* Luminance of pixels, with or without what the camera sees of lamps. */
static void measure(const image *img, bool lamps, double y[VERIFY_PIXELS])
{
    static const double share[3] = {0.2126, 0.7152, 0.0722};
    for (size_t i = 0; i < pixels_of(img); i++)
        y[i] = 0;
    for (size_t c = 0; c < 3; c++) {
        g_autofree char *all = g_strdup_printf("%c", "RGB"[c]);
        g_autofree char *seen = g_strdup_printf("emission.%c", "RGB"[c]);
        size_t a = channel_of(img, all), b = channel_of(img, seen);
        for (size_t i = 0; i < pixels_of(img); i++)
            y[i] += share[c] * (at(img, i, a) - (lamps ? 0 : at(img, i, b)));
    }
}

static bool record(double fraction, const render_statistics *st, void *data)
{
    (void)fraction;
    recorder *r = data;
    if (st->passes == r->seen || st->passes % r->per_group != 0)
        return true;
    g_autoptr(image) img = image_of(r->render);
    size_t group = (size_t)(st->passes / r->per_group - 1), n = pixels_of(img);
    double y[VERIFY_PIXELS];
    g_assert_cmpuint(n, <=, VERIFY_PIXELS);
    measure(img, r->lamps, y);
    r->trial->n_pixels = n;
    for (size_t i = 0; i < n; i++) {
        double sum = y[r->flip ? mirrored(img, i) : i] * (double)st->passes;
        double mean = (sum - r->before[i]) / r->per_group;
        r->trial->pixel[group][i] = (float)mean;
        r->trial->value[group][block_of(img, i)] += mean * VERIFY_BLOCKS / (double)n;
        r->before[i] = sum;
    }
    r->seen = st->passes;
    return true;
}

/* Mean over blocks of one group. */
static double group_total(const trial *t, size_t group)
{
    double sum = 0;
    for (size_t k = 0; k < VERIFY_BLOCKS; k++)
        sum += t->value[group][k];
    return sum / VERIFY_BLOCKS;
}

typedef struct moments {
    double mean, error; /* standard error of the mean */
    double third;       /* central moment */
} moments;

static moments moments_of(const double *x, size_t n)
{
    double sum = 0, square = 0, cube = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i];
    double mean = sum / (double)n;
    for (size_t i = 0; i < n; i++) {
        double off = x[i] - mean;
        square += off * off;
        cube += off * off * off;
    }
    return (moments){mean, sqrt(square / (double)(n * (n - 1))), cube / (double)n};
}

static void sum_up(trial *t)
{
    double totals[VERIFY_GROUPS];
    for (size_t g = 0; g < VERIFY_GROUPS; g++) {
        totals[g] = group_total(t, g);
        for (size_t k = 0; k < VERIFY_BLOCKS; k++)
            t->mean[k] += t->value[g][k] / VERIFY_GROUPS;
    }
    moments m = moments_of(totals, VERIFY_GROUPS);
    t->total = m.mean;
    t->error = m.error;
}

trial verify_render(const subject *of, int passes)
{
    trial t = {0};
    g_assert_cmpint(passes % VERIFY_GROUPS, ==, 0);
    g_autofree char *all = g_strdup_printf("%s passes=%d", of->words, passes);
    g_autoptr(render) r = render_of(of->view, all);
    g_autoptr(GError) error = NULL;
    recorder rec = {.render = r,
                    .trial = &t,
                    .lamps = of->lamps,
                    .flip = of->flip,
                    .per_group = passes / VERIFY_GROUPS};
    render_run(r, record, &rec, &error);
    g_assert_no_error(error);
    g_assert_cmpint(rec.seen, ==, passes);
    g_assert_cmpuint(render_get_statistics(r).n_not_finite, ==, 0);
    sum_up(&t);
    return t;
}

/* ---- Comparing ---- */

/* Probability that a normal deviate is beyond ±z. */
static double two_sided(double z)
{
    return erfc(z * G_SQRT2 / 2.0);
}

double verify_sidak(double alpha, size_t n)
{
    double each = -expm1(log1p(-alpha) / (double)n), low = 0, high = 30;
    for (int i = 0; i < 60; i++) {
        double z = 0.5 * (low + high);
        *(two_sided(z) > each ? &low : &high) = z;
    }
    return high;
}

double verify_normal_of_t(double t, double freedom)
{
    double c = (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0);
    return c * sqrt(freedom * log1p(t * t / freedom));
}

static double block_deviate(const trial *a, const trial *b, size_t block, double bias)
{
    double difference[VERIFY_GROUPS];
    for (size_t g = 0; g < VERIFY_GROUPS; g++)
        difference[g] = a->value[g][block] - b->value[g][block];
    moments m = moments_of(difference, VERIFY_GROUPS);
    double beyond = fabs(m.mean) - bias * fabs(b->mean[block]);
    /* Where both are dark there is nothing to tell apart. */
    if (beyond <= 1e-6 * fabs(b->total))
        return 0;
    return verify_normal_of_t(beyond / m.error, VERIFY_GROUPS - 1);
}

/* Johnson's t, of the third moment over 6 s² n and 3 s⁴, for error² = s² / n. */
static double skewed_t(const moments *m, size_t n)
{
    double variance = m->error * m->error * (double)n;
    double skew = m->third / variance;
    double shifted =
        m->mean + skew / (6 * (double)n) + skew * m->mean * m->mean / (3 * variance);
    return fabs(shifted) / m->error;
}

static double pixel_deviate(const trial *a, const trial *b, size_t pixel)
{
    double difference[VERIFY_GROUPS], least = 1e-6 * fabs(b->total);
    for (size_t g = 0; g < VERIFY_GROUPS; g++)
        difference[g] = (double)a->pixel[g][pixel] - (double)b->pixel[g][pixel];
    moments m = moments_of(difference, VERIFY_GROUPS);
    if (fabs(m.mean) <= least)
        return 0;
    m.error = fmax(m.error, least);
    return verify_normal_of_t(skewed_t(&m, VERIFY_GROUPS), VERIFY_GROUPS - 1);
}

agreement verify_compare(const trial *a, const trial *b, double bias)
{
    double difference[VERIFY_GROUPS];
    agreement found = {.limit = verify_sidak(FALSE_ALARM, VERIFY_BLOCKS),
                       .pixel_limit = verify_sidak(FALSE_ALARM, a->n_pixels)};
    for (size_t g = 0; g < VERIFY_GROUPS; g++)
        difference[g] = group_total(a, g) - group_total(b, g);
    moments m = moments_of(difference, VERIFY_GROUPS);
    found.off = m.mean / b->total;
    found.error = m.error / b->total;
    for (size_t k = 0; k < VERIFY_BLOCKS; k++)
        found.z = fmax(found.z, block_deviate(a, b, k, bias));
    for (size_t i = 0; i < a->n_pixels; i++)
        found.pixel_z = fmax(found.pixel_z, pixel_deviate(a, b, i));
    return found;
}

/* ---- The truth ---- */

static trial constant(double expected)
{
    trial t = {.total = expected};
    for (size_t k = 0; k < VERIFY_BLOCKS; k++) {
        t.mean[k] = expected;
        for (size_t g = 0; g < VERIFY_GROUPS; g++)
            t.value[g][k] = expected;
    }
    for (size_t g = 0; g < VERIFY_GROUPS; g++) {
        for (size_t i = 0; i < VERIFY_PIXELS; i++)
            t.pixel[g][i] = (float)expected;
    }
    return t;
}

/* What is true of so many passes. */
static const trial *rendered(yardstick *is, int level, int passes)
{
    if (!is->levels[level]) {
        is->levels[level] = g_new(trial, 1);
        *is->levels[level] =
            is->of.view ? verify_render(&is->of, passes) : constant(is->expected);
    }
    return is->levels[level];
}

void yardstick_clear(yardstick *is)
{
    for (int i = 0; i < VERIFY_LEVELS; i++)
        g_clear_pointer(&is->levels[i], g_free);
}

void verify_agree(const char *name, const subject *of, yardstick *is, int passes,
                  allowance allowed)
{
    double known = allowed.total * VERIFY_SHORT_LONG(3.0, 0.5);
    agreement found = {.error = INFINITY};
    for (int level = 0; level < VERIFY_SHORT_LONG(1, VERIFY_LEVELS); level++) {
        const trial *b = rendered(is, level, passes), a = verify_render(of, passes);
        found = verify_compare(&a, b, allowed.block);
        g_test_message("%s: %g and %g, %+.3f %% (+- %.3f), worst block z = %.1f of "
                       "%.1f, worst pixel %.1f of %.1f by %d passes",
                       name, a.total, b->total, 100 * found.off, 100 * found.error,
                       found.z, found.limit, found.pixel_z, found.pixel_limit, passes);
        if (found.error < known)
            break;
        passes *= 4;
    }
    g_assert_cmpfloat(found.error, <, known);
    g_assert_cmpfloat(fabs(found.off) - allowed.total, <,
                      found.error * verify_sidak(FALSE_ALARM, 1));
    g_assert_cmpfloat(found.z, <, found.limit);
    if (allowed.pixels)
        g_assert_cmpfloat(found.pixel_z, <, found.pixel_limit);
}

double verify_log_slope(const double *x, const double *y, size_t n)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0, count = (double)n;
    for (size_t i = 0; i < n; i++) {
        double u = log(x[i]), v = log(y[i]);
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}
