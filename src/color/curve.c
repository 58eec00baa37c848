/*
 * Curves: one small struct, one row of functions per kind.
 *
 *   constant   a value
 *   grid       471 values, 1 nm apart: formulas, named spectra, tables on whole nm
 *   tabulated  any other table: bisection
 *   smooth     scale * sigmoid of a quadratic (* illuminant): RGB triples
 *
 * Workload: made once per scene, evaluated at a pass' wavelengths at every hit.
 */
#include "color/curve.h"

#include "color/curve_make.h"
#include "color/fit.h"
#include "color/observer.h"

#include <float.h>
#include <math.h>
#include <string.h>

typedef struct shape_curve {
    float (*at)(const curve *c, float nm);
    spectrum (*eval)(const curve *c, const wavelengths *w);
} shape_curve;

struct curve {
    const shape_curve *kind;
    gatomicrefcount references;
    bool is_constant;        /**< over LAMBDA_MIN..LAMBDA_MAX */
    float factor;            /**< constant, smooth */
    float coefficients[3];   /**< smooth */
    const float *illuminant; /**< smooth: NULL unless the curve is a light */
    int n;                   /**< tabulated: points */
    float data[];            /**< grid: values; tabulated: n wavelengths, n values */
};

static curve *curve_new(const shape_curve *kind, size_t n_data)
{
    curve *c = g_malloc0(sizeof *c + n_data * sizeof(float));
    c->kind = kind;
    g_atomic_ref_count_init(&c->references);
    return c;
}

curve *curve_ref(const curve *c)
{
    curve *shared = (curve *)c;
    g_atomic_ref_count_inc(&shared->references);
    return shared;
}

void curve_unref(curve *c)
{
    if (!c || !g_atomic_ref_count_dec(&c->references))
        return;
    g_free(c);
}

float curve_at(const curve *c, float nm)
{
    return c->kind->at(c, nm);
}

spectrum curve_eval(const curve *c, const wavelengths *w)
{
    return c->kind->eval(c, w);
}

bool curve_is_constant(const curve *c)
{
    return c->is_constant;
}

/* Constant */

static float constant_at(const curve *c, float nm)
{
    (void)nm;
    return c->factor;
}

static spectrum constant_eval(const curve *c, const wavelengths *w)
{
    (void)w;
    return spectrum_fill(c->factor);
}

static const shape_curve constant_kind = {constant_at, constant_eval};

curve *curve_constant(float value)
{
    curve *c = curve_new(&constant_kind, 0);
    c->factor = value;
    c->is_constant = true;
    return c;
}

/* Grid */

static float at_grid(const curve *c, float nm)
{
    return grid_at(c->data, nm);
}

static spectrum eval_grid(const curve *c, const wavelengths *w)
{
    return grid_eval(c->data, w->lambda);
}

static const shape_curve grid_kind = {at_grid, eval_grid};

static bool same(float a, float b)
{
    return !(a < b) && !(a > b);
}

curve *curve_from_grid(const float grid[GRID_N])
{
    const int first = (int)LAMBDA_MIN - GRID_FIRST, last = (int)LAMBDA_MAX - GRID_FIRST;
    curve *c = curve_new(&grid_kind, GRID_N);
    memcpy(c->data, grid, GRID_N * sizeof *grid);
    c->is_constant = true;
    for (int i = first; i <= last; i++)
        c->is_constant = c->is_constant && same(grid[i], grid[first]);
    return c;
}

curve *curve_from_function(curve_function f, const void *data)
{
    float grid[GRID_N];
    for (int i = 0; i < GRID_N; i++) {
        int nm = GRID_FIRST + i;
        double value = f(nm, data);
        bool good = isfinite(value) && value >= 0.0;
        if (!good && nm >= (int)LAMBDA_MIN && nm <= (int)LAMBDA_MAX)
            return NULL;
        grid[i] = good ? (float)value : 0.0f;
    }
    return curve_from_grid(grid);
}

/* Tabulated */

static float at_table(const curve *c, float nm)
{
    const float *x = c->data, *y = c->data + c->n;
    if (!(nm >= x[0] && nm <= x[c->n - 1]))
        return 0.0f;
    int low = 0, high = c->n - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (x[middle] <= nm)
            low = middle;
        else
            high = middle;
    }
    float t = low == high ? 0.0f : (nm - x[low]) / (x[high] - x[low]);
    return (1.0f - t) * y[low] + t * y[high];
}

static spectrum eval_table(const curve *c, const wavelengths *w)
{
    spectrum s;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        s[i] = at_table(c, w->lambda[i]);
    return s;
}

static const shape_curve table_kind = {at_table, eval_table};

static bool check_table(const float *nm, const float *values, int n, GError **error)
{
    if (n < 1) {
        error_set(error, ERROR_INPUT, "a spectrum needs at least one wavelength");
        return false;
    }
    for (int i = 0; i < n; i++) {
        if (!isfinite(nm[i]) || !isfinite(values[i])) {
            error_set(error, ERROR_INPUT, "spectrum: point %d is not a finite number",
                      i + 1);
            return false;
        }
        if (i > 0 && nm[i] <= nm[i - 1]) {
            error_set(error, ERROR_INPUT,
                      "spectrum: wavelengths must ascend, but %g nm follows %g nm",
                      (double)nm[i], (double)nm[i - 1]);
            return false;
        }
    }
    return true;
}

/* True if the grid holds the table without loss: every bend is on a whole nanometre. */
static bool fits_grid(const curve *table)
{
    const float *x = table->data;
    if (x[0] > (float)GRID_FIRST || x[table->n - 1] < (float)GRID_LAST)
        return false;
    for (int i = 1; i < table->n - 1; i++)
        if (x[i] > (float)GRID_FIRST && x[i] < (float)GRID_LAST &&
            !same(x[i], rintf(x[i])))
            return false;
    return true;
}

static bool is_flat(const curve *table)
{
    const float *x = table->data, *y = table->data + table->n;
    if (x[0] > LAMBDA_MIN || x[table->n - 1] < LAMBDA_MAX)
        return false;
    for (int i = 0; i + 1 < table->n; i++)
        if (x[i + 1] > LAMBDA_MIN && x[i] < LAMBDA_MAX && !same(y[i], y[i + 1]))
            return false;
    return true;
}

curve *curve_tabulated(const float *nm, const float *values, int n, GError **error)
{
    if (!check_table(nm, values, n, error))
        return NULL;
    curve *c = curve_new(&table_kind, 2 * (size_t)n);
    c->n = n;
    memcpy(c->data, nm, (size_t)n * sizeof *nm);
    memcpy(c->data + n, values, (size_t)n * sizeof *values);
    c->is_constant = is_flat(c);
    if (c->is_constant || !fits_grid(c))
        return c;
    float grid[GRID_N];
    for (int i = 0; i < GRID_N; i++)
        grid[i] = at_table(c, (float)(GRID_FIRST + i));
    curve_unref(c);
    return curve_from_grid(grid);
}

/* Smooth */

static float at_smooth(const curve *c, float nm)
{
    const float *k = c->coefficients;
    float t = (nm - SMOOTH_CENTER) / SMOOTH_HALF;
    float p = (k[0] * t + k[1]) * t + k[2];
    float value = c->factor * (0.5f + 0.5f * p / sqrtf(1.0f + p * p));
    return c->illuminant ? value * grid_at(c->illuminant, nm) : value;
}

static spectrum eval_smooth(const curve *c, const wavelengths *w)
{
    spectrum value = c->factor * smooth_eval(c->coefficients, w);
    return c->illuminant ? value * grid_eval(c->illuminant, w->lambda) : value;
}

static const shape_curve smooth_kind = {at_smooth, eval_smooth};

static bool check_rgb(const float rgb[3], curve_role role, GError **error)
{
    /* an albedo of one that rounding has lifted a little is still one */
    const float limit = role == CURVE_ALBEDO ? 1.0001f : 0.25f * FLT_MAX;
    for (int i = 0; i < 3; i++)
        if (!(rgb[i] >= 0.0f && rgb[i] <= limit)) {
            error_set(error, ERROR_INPUT, "rgb (%g, %g, %g): components must be %s",
                      (double)rgb[0], (double)rgb[1], (double)rgb[2],
                      role == CURVE_ALBEDO ? "in 0..1" : "finite and not negative");
            return false;
        }
    return true;
}

curve *curve_rgb(const color_space *space, const float rgb[3], curve_role role,
                 GError **error)
{
    if (!check_rgb(rgb, role, error))
        return NULL;
    float largest = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    curve *c = curve_new(&smooth_kind, 0);
    c->factor = role == CURVE_ALBEDO ? 1.0f : 2.0f * largest;
    c->illuminant = role == CURVE_EMISSION ? space->illuminant : NULL;
    if (largest > 0.0f) {
        const float scaled[3] = {rgb[0] / c->factor, rgb[1] / c->factor,
                                 rgb[2] / c->factor};
        smooth_solve(space, scaled, c->coefficients);
    } else {
        c->factor = 0.0f;
    }
    c->is_constant = !c->illuminant && same(c->coefficients[0], 0.0f) &&
                     same(c->coefficients[1], 0.0f);
    return c;
}

/* Integrals */

/* A table times a grid, exactly: Simpson's rule between neighbouring bends of either. */
static double integrate_table(const curve *c, const float weight[GRID_N])
{
    const float *x = c->data;
    double sum = 0.0;
    for (int i = 0; i + 1 < c->n; i++) {
        float end = fminf(x[i + 1], (float)GRID_LAST);
        float a = fmaxf(x[i], (float)GRID_FIRST);
        while (a < end) {
            float b = fminf(floorf(a) + 1.0f, end), m = 0.5f * (a + b);
            double fa = (double)(at_table(c, a) * grid_at(weight, a));
            double fm = (double)(at_table(c, m) * grid_at(weight, m));
            double fb = (double)(at_table(c, b) * grid_at(weight, b));
            sum += (double)(b - a) * (fa + 4.0 * fm + fb) / 6.0;
            a = b;
        }
    }
    return sum;
}

static double integrate(const curve *c, const float weight[GRID_N])
{
    if (c->kind == &table_kind)
        return integrate_table(c, weight);
    float grid[GRID_N];
    for (int i = 0; i < GRID_N; i++)
        grid[i] = curve_at(c, (float)(GRID_FIRST + i));
    return grid_integrate(grid, weight, GRID_FIRST, GRID_LAST);
}

float curve_photometric(const curve *c)
{
    const observer *o = observer_get();
    if (c->illuminant)
        return (float)grid_integrate(c->illuminant, o->xyz[1], GRID_FIRST, GRID_LAST);
    return (float)integrate(c, o->xyz[1]);
}
