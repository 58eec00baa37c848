/*
 * free path: how far light goes in a medium. Both samplers draw from one number u, so
 * their means are integrals over u, taken here by midpoints: no noise, and a bound on the
 * error. Per wavelength they must be those of σs exp(-σt t) and exp(-σt t_max).
 *
 * A wavelength that a path does not carry may get any weight; hence everything is
 * weighed by what is carried, which also bounds it: no draw may make its sum grow.
 */
#include "medium/medium_sample.h"

#include <float.h>
#include <glib.h>

enum { N_DRAWS = 1 << 15, N_BINS = 12 };

/* Coefficients by lane, in m⁻¹. */
typedef struct fog {
    const char *name;
    spectrum absorption, scattering;
} fog;

#define ALIKE(x)                                                                         \
    {                                                                                    \
        x, x, x, x, x, x, x, x                                                           \
    }

static const fog fogs[] = {
    {"grey", ALIKE(0.3f), ALIKE(0.7f)},
    {"white", ALIKE(0), ALIKE(2)},
    {"coloured", {4, 2, 1, 0.5f, 0.2f, 0.1f, 0.05f, 0}, {0.1f, 0.3f, 1, 2, 4, 8, 16, 30}},
    {"clear lanes", {0, 0, 0, 0, 1, 2, 0, 0}, {1, 0, 2, 0, 3, 0, 0, 0.2f}},
    {"one lane", ALIKE(0), {0, 0, 0, 0, 0, 0, 0, 3}},
    {"absorbs more", {9, 8, 7, 6, 5, 4, 3, 2}, {1, 1, 0.1f, 0, 0, 0.1f, 1, 1}},
    {"thin", ALIKE(1e-6f), {1e-7f, 2e-7f, 3e-7f, 1e-6f, 1e-5f, 1e-6f, 1e-6f, 0}},
    {"thick", {3e5f, 0, 1e5f, 1e6f, 1e6f, 0, 0, 1}, ALIKE(1e6f)},
};

static const spectrum carries[] = {
    ALIKE(1),
    {1, 2, 4, 8, 16, 32, 64, 100},
    {0.5f, 0.01f, 0.2f, 0.01f, 0.1f, 0.02f, 0.3f, 0.001f},
    {0, 0, 1, 0, 0, 0, 0, 0},
    {0, 7, 0, 0, 0, 0, 7, 0},
    {1e-20f, 1e-20f, 2e-20f, 1e-20f, 5e-20f, 1e-20f, 1e-20f, 1e-20f},
};

/* Over the reach of the lane that is extinguished most. */
static const float reaches[] = {1e-3f, 0.3f, 2.0f, 20.0f, INFINITY};

/* Two thirds of the coefficients come from the scale. */
static medium medium_of(const fog *f, const wavelengths *w)
{
    float nm[N_WAVELENGTHS], a[N_WAVELENGTHS], s[N_WAVELENGTHS];
    bool scatters = false;
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        nm[i] = w->lambda[i];
        a[i] = f->absorption[i] / 3.0f, s[i] = f->scattering[i] / 3.0f;
        scatters = scatters || s[i] > 0;
    }
    medium m = {.scale = 3.0f};
    m.absorption = curve_tabulated(nm, a, N_WAVELENGTHS, NULL);
    m.scattering = scatters ? curve_tabulated(nm, s, N_WAVELENGTHS, NULL) : NULL;
    return m;
}

static void release(medium *m)
{
    curve_unref(m->absorption);
    curve_unref(m->scattering);
    curve_unref(m->color);
}

typedef medium_sample (*draw_path)(const medium *m, const wavelengths *w,
                                   spectrum throughput, float t_max, float u);

/* What is checked in one place. */
typedef struct subject {
    const fog *fog;
    draw_path draw;
    spectrum throughput;
    float t_max;
    double edge[N_BINS + 1]; /* of the bins of t; the last is t_max */
} subject;

/* Means over u of weight × carried over what all lanes carry. */
typedef struct means {
    double bin[N_BINS][N_WAVELENGTHS], on[N_WAVELENGTHS];
    double most[N_WAVELENGTHS]; /* the largest value of all */
} means;

/* Where a lamp is, over t_max (1 m if there is none): t and distance of the pivot, and
   what it lights. */
static const float pivots[][4] = {{0.3f, 0.05f, 0, 1},       {0.7f, 2, 0, 1},
                                  {-0.5f, 0.1f, 0, 1},       {1.5f, 0.3f, 0, 1},
                                  {0.3f, 0.05f, 0.2f, 0.5f}, {0.7f, 2, 0.9f, 1}};
static const float *pivot_now;

static medium_pivot pivot_within(float t_max)
{
    float unit = isfinite(t_max) ? t_max : 1.0f;
    float end = pivot_now[3] < 1 ? pivot_now[3] * unit : t_max;
    return (medium_pivot){
        pivot_now[0] * unit, pivot_now[1] * unit, {pivot_now[2] * unit, end}};
}

static medium_sample free_near(const medium *m, const wavelengths *w, spectrum throughput,
                               float t_max, float u)
{
    const medium_pivot pivot = pivot_within(t_max);
    return medium_sample_free_near(m, w, throughput, t_max, &pivot, u);
}

static medium_sample within_near(const medium *m, const wavelengths *w,
                                 spectrum throughput, float t_max, float u)
{
    const medium_pivot pivot = pivot_within(t_max);
    return medium_sample_within_near(m, w, throughput, t_max, &pivot, u);
}

static bool is_within(draw_path draw)
{
    return draw == medium_sample_within || draw == within_near;
}

/* What a draw may make of all that is carried: near a pivot, half of the draws are not by
   free paths. */
static double most_growth(draw_path draw)
{
    return draw == free_near || draw == within_near ? 2 : 1;
}

static double throughput_sum(spectrum throughput)
{
    double sum = 0;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        sum += (double)throughput[i];
    return sum;
}

static int bin_of(const subject *is, double t)
{
    int k = 0;
    while (k < N_BINS - 1 && t >= is->edge[k + 1])
        k++;
    return k;
}

static void check_draw(const subject *is, const medium_sample *d, float u)
{
    double after = 0, before = throughput_sum(is->throughput);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        after += (double)(is->throughput[i] * d->weight[i]);
    bool at_end = !d->scatters && d->t == is->t_max;
    bool never = is_within(is->draw) && spectrum_is_black(d->weight);
    if (!spectrum_is_finite(d->weight) ||
        !(after <= before * most_growth(is->draw) * (1 + 1e-5)) || !(d->t >= 0) ||
        !(at_end || never || (d->scatters && d->t < is->t_max)))
        g_error("%s, u = %.9g, t_max = %g: t = %g (%s), carried %g of %g", is->fog->name,
                (double)u, (double)is->t_max, (double)d->t,
                d->scatters ? "scatters" : "does not", after, before);
}

static means mean_over_u(const subject *is, const medium *m, const wavelengths *w)
{
    means out = {0};
    double sum = throughput_sum(is->throughput);
    for (int k = 0; k < N_DRAWS; k++) {
        float u = ((float)k + 0.5f) / N_DRAWS;
        medium_sample d = is->draw(m, w, is->throughput, is->t_max, u);
        check_draw(is, &d, u);
        double *to = d.scatters ? out.bin[bin_of(is, (double)d.t)] : out.on;
        for (int i = 0; i < N_WAVELENGTHS; i++) {
            double value = (double)d.weight[i] * (double)is->throughput[i] / sum;
            to[i] += value / N_DRAWS;
            out.most[i] = fmax(out.most[i], value);
        }
    }
    return out;
}

/* ∫ σs exp(-σt t) dt */
static double scattered(const fog *f, int wavelength, double from, double to)
{
    double s = (double)f->scattering[wavelength],
           t = s + (double)f->absorption[wavelength];
    return s > 0 ? s / t * (exp(-t * from) - exp(-t * to)) : 0;
}

static double left_of(const fog *f, int wavelength, double t_max)
{
    double sigma = (double)f->scattering[wavelength] + (double)f->absorption[wavelength];
    return sigma > 0 ? exp(-sigma * t_max) : 1;
}

static void check(const subject *is, const means *found, int wavelength, int bin,
                  double expected)
{
    /* A weight falls smoothly in u but for eight seams, where the mixture goes on to the
       next lane, and the bins' edges in each. */
    double share = (double)is->throughput[wavelength] / throughput_sum(is->throughput);
    double allowed = 32.0 / N_DRAWS * found->most[wavelength] + share * 1e-5;
    double mean = bin < N_BINS ? found->bin[bin][wavelength] : found->on[wavelength];
    if (!(fabs(mean - expected * share) <= allowed))
        g_error("%s, carried %g of %g, t_max %g, lane %d, bin %d: %.6f, expected %.6f",
                is->fog->name, (double)is->throughput[wavelength],
                throughput_sum(is->throughput), (double)is->t_max, wavelength, bin, mean,
                expected * share);
}

static void check_means(const subject *is)
{
    const wavelengths w = wavelengths_at(0.5f);
    medium m = medium_of(is->fog, &w);
    const means found = mean_over_u(is, &m, &w);
    for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
        for (int k = 0; k < N_BINS; k++)
            check(is, &found, wavelength, k,
                  scattered(is->fog, wavelength, is->edge[k], is->edge[k + 1]));
        if (!is_within(is->draw))
            check(is, &found, wavelength, N_BINS,
                  left_of(is->fog, wavelength, (double)is->t_max));
    }
    release(&m);
}

/* Edges stand evenly in the share that a lane scatters, of each lane by turns. */
static void set_edges(subject *is, float sigma_max)
{
    for (int k = 0; k <= N_BINS; k++) {
        double x = (double)k / N_BINS;
        is->edge[k] = isinf(is->t_max) ? 3.0 * x / (1 - x) / (double)sigma_max
                                       : (double)is->t_max * x * x;
    }
}

/* Every stride-th of all that may come together. */
static void check_all(draw_path draw, size_t stride)
{
    enum { N_REACHES = G_N_ELEMENTS(reaches), N_CARRIES = G_N_ELEMENTS(carries) };
    for (size_t i = 0; i < G_N_ELEMENTS(fogs) * N_CARRIES * N_REACHES; i += stride) {
        const fog *f = &fogs[i / N_REACHES / N_CARRIES];
        float most = spectrum_max(f->absorption + f->scattering);
        subject is = {f,
                      draw,
                      carries[i / N_REACHES % N_CARRIES],
                      reaches[i % N_REACHES] / most,
                      {0}};
        set_edges(&is, most);
        check_means(&is);
    }
}

static void test_free(void)
{
    check_all(medium_sample_free, 1);
}

static void test_within(void)
{
    check_all(medium_sample_within, 1);
}

static void test_near(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(pivots); i++) {
        pivot_now = pivots[i];
        check_all(free_near, 7);
        check_all(within_near, 7);
    }
}

/* ---- Ends of all ranges ---- */

static const float sizes[] = {0, 1e-12f, 1e-3f, 1, 1e3f, 1e12f};

static void check_corner(const subject *is, const medium *m, const wavelengths *w)
{
    static const float us[] = {0, 0x1p-24f, 0.5f, 0.999999f, 0x1.fffffep-1f};
    for (size_t i = 0; i < G_N_ELEMENTS(us); i++) {
        medium_sample d = is->draw(m, w, is->throughput, is->t_max, us[i]);
        check_draw(is, &d, us[i]);
    }
}

static void test_corners(void)
{
    static const float ends[] = {0,    1e-20f, 1e-12f, 1e-3f,   0.7f,
                                 1e3f, 1e12f,  1e30f,  FLT_MAX, INFINITY};
    const spectrum throughput[] = {ALIKE(1),
                                   ALIKE(0),
                                   ALIKE(1e30f),
                                   ALIKE(1e-36f),
                                   {0, 0, 0, 1, 0, 0, 0, 0},
                                   {1e10f, 1, 1e-10f, 1e-20f, 0, 0, 0, 1e-30f}};
    const wavelengths w = wavelengths_at(0.5f);
    for (int i = 0; i < 36; i++) {
        fog f = {"corner", ALIKE(0), ALIKE(0)};
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
            f.absorption[wavelength] = sizes[(i / 6 + wavelength) % 6];
            f.scattering[wavelength] =
                sizes[i % 6] > 0 ? sizes[(i % 6 + wavelength) % 6] : sizes[2];
        }
        medium m = medium_of(&f, &w);
        for (size_t k = 0; k < G_N_ELEMENTS(ends) * G_N_ELEMENTS(throughput); k++) {
            subject is = {&f,
                          medium_sample_free,
                          throughput[k / G_N_ELEMENTS(ends)],
                          ends[k % G_N_ELEMENTS(ends)],
                          {0}};
            check_corner(&is, &m, &w);
            is.draw = medium_sample_within;
            check_corner(&is, &m, &w);
        }
        release(&m);
    }
}

/* Throughput that is broken already must not break more than the path. */
static void test_broken(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    medium m = medium_of(&fogs[2], &w);
    const float bad[] = {NAN, INFINITY, FLT_MAX};
    const draw_path draws[] = {medium_sample_free, medium_sample_within};
    for (size_t i = 0; i < 3; i++)
        for (int k = 0; k < 2 * 2; k++) {
            spectrum throughput = spectrum_fill(k & 1 ? bad[i] : 1.0f);
            throughput[3] = bad[i];
            medium_sample d = draws[k / 2](&m, &w, throughput, 1.0f, 0.4f);
            g_assert_true(spectrum_is_finite(d.weight));
            g_assert_true(d.t >= 0 && d.t <= 1);
        }
    release(&m);
}

/* Rounding takes no draw to the end, where a path is that must be within. */
static void test_always_within(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    const fog f = {"grey", ALIKE(0.25f), ALIKE(0.75f)};
    medium m = medium_of(&f, &w);
    for (int i = 1; i < 400; i++)
        for (int k = 1; k < 20; k++) {
            float t_max = powf(10.0f, (float)i / 100.0f - 3.0f);
            medium_sample d = medium_sample_within(&m, &w, spectrum_fill(1), t_max,
                                                   1.0f - (float)k * 0x1p-24f);
            if (!d.scatters || !(d.t < t_max))
                g_error("t_max = %.9g, u = 1 - %d * 2^-24: t = %.9g, %s", (double)t_max,
                        k, (double)d.t, d.scatters ? "scatters" : "does not");
        }
    release(&m);
}

/* ---- Transmittance ---- */

static void test_transmittance(void)
{
    static const float lengths[] = {0, 1e-6f, 0.1f, 1, 7, 1e8f, INFINITY};
    const wavelengths w = wavelengths_at(0.5f);
    for (size_t f = 0; f < G_N_ELEMENTS(fogs); f++) {
        medium m = medium_of(&fogs[f], &w);
        for (size_t k = 0; k < G_N_ELEMENTS(lengths); k++) {
            spectrum t = medium_transmittance(&m, lengths[k], &w);
            for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
                double expected = left_of(&fogs[f], wavelength, (double)lengths[k]);
                g_assert_cmpfloat(fabs((double)t[wavelength] - expected), <=,
                                  expected * 2e-5 + 1e-30);
            }
        }
        release(&m);
    }
}

/* With a colour: color^(t / distance), and on top of it what is absorbed. */
static void test_coloured_transmittance(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    const fog f = {"coloured glass", {0, 0, 1, 1, 0, 0, 0, 0}, ALIKE(0)};
    const float color[N_WAVELENGTHS] = {1, 0.25f, 1, 0.25f, 0, 0.5f, 0.9f, 1};
    float nm[N_WAVELENGTHS];
    for (int i = 0; i < N_WAVELENGTHS; i++)
        nm[i] = w.lambda[i];
    medium m = medium_of(&f, &w);
    m.distance = 0.5f;
    m.color = curve_tabulated(nm, color, N_WAVELENGTHS, NULL);
    static const float lengths[] = {0, 0.25f, 1, INFINITY};
    for (size_t k = 0; k < G_N_ELEMENTS(lengths); k++) {
        spectrum t = medium_transmittance(&m, lengths[k], &w);
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
            double expected = left_of(&f, wavelength, (double)lengths[k]) *
                              pow((double)color[wavelength], (double)lengths[k] / 0.5);
            g_assert_cmpfloat(fabs((double)t[wavelength] - expected), <, 1e-5);
        }
    }
    release(&m);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/free-path/free", test_free);
    g_test_add_func("/free-path/within", test_within);
    g_test_add_func("/free-path/near", test_near);
    g_test_add_func("/free-path/corners", test_corners);
    g_test_add_func("/free-path/broken", test_broken);
    g_test_add_func("/free-path/always-within", test_always_within);
    g_test_add_func("/free-path/transmittance", test_transmittance);
    g_test_add_func("/free-path/coloured-transmittance", test_coloured_transmittance);
    return g_test_run();
}
