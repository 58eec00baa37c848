#include "image/flip.h"

#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <stdint.h>

enum { MAX_RADIUS = 16, ROWS_AT_ONCE = 16 };

/* Constants of the paper: section 4.1.4 (colour), 4.2 (features), 4.3. */
static const double exponent_color = 0.7;   /* q_c */
static const double knee_in = 0.4;          /* p_c */
static const double knee_out = 0.95;        /* p_t */
static const double feature_width = 0.082;  /* w, degrees */
static const double exponent_feature = 0.5; /* q_f */

/* A Gaussian of the contrast sensitivity: a sqrt(pi/b) exp(-pi² x² / b), x in degrees. */
typedef struct gauss {
    double a, b;
} gauss;

static const gauss sensitivity[3][2] = {
    {{1.0, 0.0047}, {0.0, 1e-5}},  /* black-white */
    {{1.0, 0.0053}, {0.0, 1e-5}},  /* red-green */
    {{34.1, 0.04}, {13.5, 0.025}}, /* blue-yellow */
};

typedef struct matrix3 {
    double m[3][3];
} matrix3;

/* From sRGB's primaries and white, xy = (0.3127, 0.3290) (IEC 61966-2-1). */
static const matrix3 rgb_to_xyz = {{
    {0.41239079926595934, 0.357584339383878, 0.1804807884018343},
    {0.21263900587151027, 0.715168678767756, 0.07219231536073371},
    {0.01933081871559182, 0.11919477979462598, 0.9505321522496607},
}};

/* An odd number of taps, weight[radius] in the middle. */
typedef struct kernel {
    int radius;
    double weight[2 * MAX_RADIUS + 1];
} kernel;

typedef struct size2 {
    int width, height;
    size_t n; /* width * height */
} size2;

/* All planes of one comparison, n numbers each. */
typedef struct workspace {
    size2 size;
    double *block;
    double *opponent[3];       /* Y, Cx, Cz of the image at hand */
    double *lab[2][3];         /* filtered, Hunt-adjusted, of both images */
    double *edges[2];          /* lengths of gradients */
    double *points[2];         /* lengths of second derivatives */
    double *across;            /* half-way through a separable filter */
    double *along_x, *along_y; /* derivatives */
} workspace;

/* ---- colour spaces ---- */

static void multiply(const matrix3 *a, const double v[3], double out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = a->m[r][0] * v[0] + a->m[r][1] * v[1] + a->m[r][2] * v[2];
}

/* X, Y or Z of white. */
static double white(int row)
{
    const double *m = rgb_to_xyz.m[row];
    return m[0] + m[1] + m[2];
}

/* XYZ relative to white: (1, 1, 1) for linear RGB (1, 1, 1). */
static void relative_xyz(const double rgb[3], double out[3])
{
    multiply(&rgb_to_xyz, rgb, out);
    for (int i = 0; i < 3; i++)
        out[i] /= white(i);
}

static void opponent_of_xyz(const double xyz[3], double out[3])
{
    out[0] = 116.0 * xyz[1] - 16.0;
    out[1] = 500.0 * (xyz[0] - xyz[1]);
    out[2] = 200.0 * (xyz[1] - xyz[2]);
}

static void xyz_of_opponent(const double ycc[3], double out[3])
{
    out[1] = (ycc[0] + 16.0) / 116.0;
    out[0] = out[1] + ycc[1] / 500.0;
    out[2] = out[1] - ycc[2] / 200.0;
}

static matrix3 inverse(const matrix3 *a)
{
    const double(*m)[3] = a->m;
    matrix3 adjugate;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            adjugate.m[c][r] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    double det = 0;
    for (int c = 0; c < 3; c++)
        det += m[0][c] * adjugate.m[c][0];
    for (int i = 0; i < 9; i++)
        adjugate.m[i / 3][i % 3] /= det;
    return adjugate;
}

static double lab_curve(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

/* CIE L*a*b* with a* and b* scaled by lightness (Hunt's effect). */
static void hunt_lab(const double rgb[3], double out[3])
{
    double xyz[3], f[3];
    relative_xyz(rgb, xyz);
    for (int i = 0; i < 3; i++)
        f[i] = lab_curve(xyz[i]);
    out[0] = 116.0 * f[1] - 16.0;
    out[1] = 0.01 * out[0] * 500.0 * (f[0] - f[1]);
    out[2] = 0.01 * out[0] * 200.0 * (f[1] - f[2]);
}

/* Distance of two colours: city block in lightness, Euclidean in hue, to the power q_c.
 */
static double hyab(const double a[3], const double b[3])
{
    double distance = fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
    return pow(distance, exponent_color);
}

/* The largest distance there is: between green and blue. */
static double largest_hyab(void)
{
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double lab_green[3], lab_blue[3];
    hunt_lab(green, lab_green);
    hunt_lab(blue, lab_blue);
    return hyab(lab_green, lab_blue);
}

/* Spreads the distances: the lower p_c of them to 0..p_t, the rest above. */
static double redistribute(double distance, double largest)
{
    double knee = knee_in * largest;
    if (distance < knee)
        return distance * knee_out / knee;
    return knee_out + (distance - knee) / (largest - knee) * (1.0 - knee_out);
}

/* ---- filters ---- */

typedef struct pass {
    size2 size;
    const double *in;
    double *out;
    const kernel *k;
    double scale; /* out += scale * in filtered by k */
    bool down;    /* along columns instead of rows */
} pass;

static int clamp_index(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* out[x] += weight * in[x + shift], the ends of in going on for ever. */
static void add_shifted(const double *in, int n, int shift, double weight, double *out)
{
    int begin = clamp_index(-shift, n + 1), end = clamp_index(n - shift, n + 1);
    for (int x = 0; x < begin; x++)
        out[x] += weight * in[0];
    for (int x = begin; x < end; x++)
        out[x] += weight * in[x + shift];
    for (int x = end; x < n; x++)
        out[x] += weight * in[n - 1];
}

static void filter_rows(size_t begin, size_t end, unsigned thread, void *data)
{
    const pass *p = data;
    (void)thread;
    size_t width = (size_t)p->size.width;
    for (size_t y = begin; y < end; y++)
        for (int i = -p->k->radius; i <= p->k->radius; i++) {
            double weight = p->scale * p->k->weight[i + p->k->radius];
            int row = p->down ? clamp_index((int)y + i, p->size.height) : (int)y;
            add_shifted(p->in + (size_t)row * width, p->size.width, p->down ? 0 : i,
                        weight, p->out + y * width);
        }
}

static void clear(const workspace *w, double *plane)
{
    for (size_t i = 0; i < w->size.n; i++)
        plane[i] = 0;
}

/* out += scale * (in filtered by kx along rows and ky along columns). */
static void add_filtered(workspace *w, const double *in, const kernel *kx,
                         const kernel *ky, double scale, double *out)
{
    size_t n_rows = (size_t)w->size.height;
    clear(w, w->across);
    pass rows = {w->size, in, w->across, kx, 1.0, false};
    parallel_for(n_rows, ROWS_AT_ONCE, 0, NULL, filter_rows, &rows);
    pass columns = {w->size, w->across, out, ky, scale, true};
    parallel_for(n_rows, ROWS_AT_ONCE, 0, NULL, filter_rows, &columns);
}

static int sensitivity_radius(void)
{
    const double widest = 0.04; /* of all b */
    return (int)ceil(3.0 * sqrt(widest / (2.0 * G_PI * G_PI)) * FLIP_PIXELS_PER_DEGREE);
}

/* @return the sum of the taps before they were made to sum to one. */
static double gauss_kernel(kernel *k, double b)
{
    double sum = 0;
    k->radius = sensitivity_radius();
    for (int i = -k->radius; i <= k->radius; i++) {
        double x = i / FLIP_PIXELS_PER_DEGREE;
        sum += k->weight[i + k->radius] = exp(-G_PI * G_PI * x * x / b);
    }
    for (int i = 0; i <= 2 * k->radius; i++)
        k->weight[i] /= sum;
    return sum;
}

/* One opponent plane as the eye resolves it: the two Gaussians' sum, normalised. */
static void blur(workspace *w, int plane, double *out)
{
    kernel k[2];
    double share[2];
    for (int i = 0; i < 2; i++) {
        const gauss *g = &sensitivity[plane][i];
        double sum = gauss_kernel(&k[i], g->b);
        share[i] = g->a * sqrt(G_PI / g->b) * sum * sum;
    }
    clear(w, out);
    for (int i = 0; i < 2; i++)
        if (share[i] > 0.0)
            add_filtered(w, w->opponent[plane], &k[i], &k[i],
                         share[i] / (share[0] + share[1]), out);
}

/* Positive taps made to sum to 1, negative ones to -1. */
static void balance(kernel *k)
{
    double positive = 0, negative = 0;
    for (int i = 0; i <= 2 * k->radius; i++)
        if (k->weight[i] > 0.0)
            positive += k->weight[i];
        else
            negative -= k->weight[i];
    for (int i = 0; i <= 2 * k->radius; i++)
        k->weight[i] /= k->weight[i] > 0.0 ? positive : negative;
}

/* First (edges) and second (points) derivative of a Gaussian, and the Gaussian. */
static void feature_kernels(kernel *edge, kernel *point, kernel *smooth)
{
    double sigma = 0.5 * feature_width * FLIP_PIXELS_PER_DEGREE, sum = 0;
    int radius = (int)ceil(3.0 * sigma);
    edge->radius = point->radius = smooth->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        double x = i / sigma, g = exp(-0.5 * x * x);
        edge->weight[i + radius] = -x * g;
        point->weight[i + radius] = (x * x - 1.0) * g;
        smooth->weight[i + radius] = g;
        sum += g;
    }
    for (int i = 0; i <= 2 * radius; i++)
        smooth->weight[i] /= sum;
    balance(edge);
    balance(point);
}

/* ---- the two pipelines ---- */

/* Length of (derivative along x, derivative along y) of Y in 0..1. */
static void derivative_length(workspace *w, const kernel *derivative,
                              const kernel *smooth, double *out)
{
    clear(w, w->along_x);
    clear(w, w->along_y);
    add_filtered(w, w->opponent[0], derivative, smooth, 1.0 / 116.0, w->along_x);
    add_filtered(w, w->opponent[0], smooth, derivative, 1.0 / 116.0, w->along_y);
    for (size_t i = 0; i < w->size.n; i++)
        out[i] = hypot(w->along_x[i], w->along_y[i]);
}

static void find_features(workspace *w, int which)
{
    kernel edge, point, smooth;
    feature_kernels(&edge, &point, &smooth);
    derivative_length(w, &edge, &smooth, w->edges[which]);
    derivative_length(w, &point, &smooth, w->points[which]);
}

static void find_colors(workspace *w, int which)
{
    matrix3 xyz_to_rgb = inverse(&rgb_to_xyz);
    double *const *lab = w->lab[which];
    for (int plane = 0; plane < 3; plane++)
        blur(w, plane, lab[plane]);
    for (size_t i = 0; i < w->size.n; i++) {
        double ycc[3] = {lab[0][i], lab[1][i], lab[2][i]}, xyz[3], rgb[3], out[3];
        xyz_of_opponent(ycc, xyz);
        for (int c = 0; c < 3; c++)
            xyz[c] *= white(c);
        multiply(&xyz_to_rgb, xyz, rgb);
        for (int c = 0; c < 3; c++)
            rgb[c] = fmin(fmax(rgb[c], 0.0), 1.0);
        hunt_lab(rgb, out);
        for (int c = 0; c < 3; c++)
            lab[c][i] = out[c];
    }
}

static void analyse(workspace *w, const double *rgb, int which)
{
    for (size_t i = 0; i < w->size.n; i++) {
        double xyz[3], ycc[3];
        relative_xyz(rgb + 3 * i, xyz);
        opponent_of_xyz(xyz, ycc);
        for (int c = 0; c < 3; c++)
            w->opponent[c][i] = ycc[c];
    }
    find_features(w, which);
    find_colors(w, which);
}

static void combine(const workspace *w, double *out)
{
    double largest = largest_hyab();
    for (size_t i = 0; i < w->size.n; i++) {
        const double a[3] = {w->lab[0][0][i], w->lab[0][1][i], w->lab[0][2][i]};
        const double b[3] = {w->lab[1][0][i], w->lab[1][1][i], w->lab[1][2][i]};
        double color = redistribute(hyab(a, b), largest);
        double edge = fabs(w->edges[0][i] - w->edges[1][i]);
        double point = fabs(w->points[0][i] - w->points[1][i]);
        double feature = pow(fmax(edge, point) / sqrt(2.0), exponent_feature);
        out[i] = pow(color, 1.0 - feature);
    }
}

static bool workspace_init(workspace *w, int width, int height, GError **error)
{
    double **planes[] = {
        &w->opponent[0], &w->opponent[1], &w->opponent[2], &w->lab[0][0],
        &w->lab[0][1],   &w->lab[0][2],   &w->lab[1][0],   &w->lab[1][1],
        &w->lab[1][2],   &w->edges[0],    &w->edges[1],    &w->points[0],
        &w->points[1],   &w->across,      &w->along_x,     &w->along_y,
    };
    w->size = (size2){width, height, (size_t)width * (size_t)height};
    w->block = big_alloc(w->size.n, G_N_ELEMENTS(planes) * sizeof(double),
                         "image comparison", error);
    for (size_t i = 0; w->block && i < G_N_ELEMENTS(planes); i++)
        *planes[i] = w->block + i * w->size.n;
    return w->block != NULL;
}

bool flip_error(const double *a, const double *b, int width, int height, double *out,
                GError **error)
{
    workspace w;
    if (!workspace_init(&w, width, height, error))
        return false;
    analyse(&w, a, 0);
    analyse(&w, b, 1);
    combine(&w, out);
    big_free(w.block);
    return true;
}
