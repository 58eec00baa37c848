/*
 * Shapes of pbrt-v3 in pbrt-v4's words: heightfields and NURBS become meshes, as they do
 * there.
 *
 * Piegl & Tiller, "The NURBS Book", 2nd edition, 1997, chapters 2 and 4.
 */
#include "format/pbrt/pbrt_v3_words.h"

#include "base/memory.h"
#include "math/vec.h"

#include <math.h>

enum { MOST = 32768 };

/* Of the unit square, two triangles a cell. */
typedef struct grid {
    size_t nu, nv;
    float *points, *uv, *normals; /* normals: NULL, or as many */
    int *indices;
} grid;

static size_t n_corners(const grid *g)
{
    return 6 * (g->nu - 1) * (g->nv - 1);
}

static bool has_arrays(grid *g, bool with_normals, GError **error)
{
    size_t n = g->nu * g->nv;
    g->points = big_alloc(n, 3 * sizeof(float), "a mesh", error);
    if (g->points)
        g->uv = big_alloc(n, 2 * sizeof(float), "a mesh", error);
    if (g->uv && with_normals)
        g->normals = big_alloc(n, 3 * sizeof(float), "a mesh", error);
    if (g->uv && (g->normals || !with_normals))
        g->indices = big_alloc(n_corners(g), sizeof(int), "a mesh", error);
    return g->indices != NULL;
}

static void free_grid(grid *g)
{
    big_free(g->points);
    big_free(g->uv);
    big_free(g->normals);
    big_free(g->indices);
}

static void fill_indices(grid *g)
{
    int *corner = g->indices;
    for (size_t y = 0; y + 1 < g->nv; y++)
        for (size_t x = 0; x + 1 < g->nu; x++) {
            size_t i = y * g->nu + x, up = i + g->nu;
            const size_t cell[] = {i, i + 1, up + 1, i, up + 1, up};
            for (int k = 0; k < 6; k++)
                *corner++ = (int)cell[k];
        }
}

static void fill_heights(grid *g, const float *z)
{
    for (size_t y = 0; y < g->nv; y++)
        for (size_t x = 0; x < g->nu; x++) {
            size_t i = y * g->nu + x;
            g->points[3 * i] = g->uv[2 * i] = (float)x / (float)(g->nu - 1);
            g->points[3 * i + 1] = g->uv[2 * i + 1] = (float)y / (float)(g->nv - 1);
            g->points[3 * i + 2] = z[i];
        }
}

/* In place of the parameters that it is made of. */
static bool add_grid(const translation *t, grid *g, const char *const *made_of)
{
    size_t n = g->nu * g->nv;
    source_place at = t->p->place;
    for (; *made_of; made_of++)
        drop(t, *made_of);
    fill_indices(g);
    set_kind(t, "trianglemesh");
    return params_add_numbers(t->p, at, PARAM_POINT3, "P", g->points, 3 * n, t->error) &&
           params_add_numbers(t->p, at, PARAM_POINT2, "uv", g->uv, 2 * n, t->error) &&
           (!g->normals || params_add_numbers(t->p, at, PARAM_NORMAL, "N", g->normals,
                                              3 * n, t->error)) &&
           params_add_integers(t->p, at, PARAM_INTEGER, "indices", g->indices,
                               n_corners(g), t->error);
}

static int count_of(const translation *t, const char *name)
{
    const param *q = find(t, name);
    return q && q->type == PARAM_INTEGER && q->n == 1 ? q->integers[0] : 0;
}

/* What does not fit stays as it is, to be refused. */
static void translate_heightfield(const translation *t)
{
    static const char *const made_of[] = {"nu", "nv", "Pz", NULL};
    const param *z = find(t, "Pz");
    int nu = count_of(t, "nu"), nv = count_of(t, "nv");
    if (nu < 2 || nv < 2 || nu > MOST || nv > MOST || !z || z->type != PARAM_FLOAT ||
        z->n != (size_t)nu * (size_t)nv)
        return;
    grid g = {.nu = (size_t)nu, .nv = (size_t)nv};
    if (has_arrays(&g, false, t->error)) {
        fill_heights(&g, z->numbers);
        add_grid(t, &g, made_of);
    }
    free_grid(&g);
}

/* ---- NURBS ---- */

enum { MOST_ORDER = 32 };

/* pbrt-v3's: points along each side of the mesh. */
enum { DICE = 30 };

/* One of the two directions. */
typedef struct axis {
    int n, order;
    const float *knots; /* n + order of them */
    double from, to;
} axis;

typedef struct nurbs {
    axis u, v;
    const float *points;
    int width; /* 3, or 4 with a weight */
} nurbs;

/* Basis functions that are not zero at a place: `order` of them. */
typedef struct basis {
    int first;
    double value[MOST_ORDER], slope[MOST_ORDER];
} basis;

static bool read_axis(const translation *t, const char *const names[5], axis *a)
{
    const param *knots = find(t, names[2]);
    *a = (axis){.n = count_of(t, names[0]), .order = count_of(t, names[1])};
    if (a->order < 2 || a->order > MOST_ORDER || a->n < a->order || a->n > MOST ||
        !knots || knots->type != PARAM_FLOAT ||
        knots->n != (size_t)a->n + (size_t)a->order)
        return false;
    a->knots = knots->numbers;
    for (size_t i = 1; i < knots->n; i++)
        if (!(a->knots[i] >= a->knots[i - 1]))
            return false;
    double first = (double)a->knots[a->order - 1], last = (double)a->knots[a->n];
    a->from = CLAMP(number(t, names[3], first), first, last);
    a->to = CLAMP(number(t, names[4], last), first, last);
    return last > first;
}

/* The interval of knots that x lies in, which is not empty. */
static int span_of(const axis *a, double x)
{
    int span = a->order - 1;
    while (span + 1 < a->n && x >= (double)a->knots[span + 1])
        span++;
    while (!(a->knots[span + 1] > a->knots[span]))
        span--;
    return span;
}

/* From those of a degree to those of the next, Cox and de Boor. */
static void raise_degree(const float *knots, int span, int degree, double x,
                         double *value)
{
    double carried = 0.0;
    for (int r = 0; r < degree; r++) {
        double below = (double)knots[span + 1 - degree + r];
        double above = (double)knots[span + 1 + r];
        double share = value[r] / (above - below);
        value[r] = carried + (above - x) * share;
        carried = (x - below) * share;
    }
    value[degree] = carried;
}

static void basis_at(const axis *a, double x, basis *b)
{
    int span = span_of(a, x), degree = a->order - 1;
    double lower[MOST_ORDER] = {0};
    b->first = span - degree;
    b->value[0] = 1.0;
    for (int d = 1; d <= degree; d++) {
        memcpy(lower, b->value, (size_t)d * sizeof lower[0]);
        raise_degree(a->knots, span, d, x, b->value);
    }
    for (int r = 0; r <= degree; r++) {
        const float *k = a->knots + b->first + r;
        double rise = r > 0 ? lower[r - 1] / (double)(k[degree] - k[0]) : 0.0;
        double fall = r < degree ? lower[r] / (double)(k[degree + 1] - k[1]) : 0.0;
        b->slope[r] = degree * (rise - fall);
    }
}

/* What a control point adds to the sums. */
static void add_point(const nurbs *s, size_t i, const double weights[3], double sum[3][4])
{
    const float *from = s->points + i * (size_t)s->width;
    for (int c = 0; c < 4; c++) {
        double x = c < s->width ? (double)from[c] : 1.0;
        for (int k = 0; k < 3; k++)
            sum[k][c] += weights[k] * x;
    }
}

/* A slope of the point whose sums are `at`. */
static vec3 slope_of(const double sum[4], const double at[4])
{
    float slope[3];
    for (int c = 0; c < 3; c++)
        slope[c] = (float)((sum[c] - at[c] / at[3] * sum[3]) / at[3]);
    return vec3_make(slope[0], slope[1], slope[2]);
}

/* @return the normal, of any length */
static vec3 surface_at(const nurbs *s, double u, double v, float p[3])
{
    basis across, along;
    double sum[3][4] = {{0}};
    basis_at(&s->u, u, &across);
    basis_at(&s->v, v, &along);
    for (int j = 0; j < s->v.order; j++)
        for (int i = 0; i < s->u.order; i++) {
            const double weights[] = {across.value[i] * along.value[j],
                                      across.slope[i] * along.value[j],
                                      across.value[i] * along.slope[j]};
            size_t row = (size_t)(along.first + j) * (size_t)s->u.n;
            add_point(s, row + (size_t)(across.first + i), weights, sum);
        }
    for (int c = 0; c < 3; c++)
        p[c] = (float)(sum[0][c] / sum[0][3]);
    return cross3(slope_of(sum[1], sum[0]), slope_of(sum[2], sum[0]));
}

/* At a pole, where it has no length, that of a place beside it. */
static vec3 normal_at(const nurbs *s, double u, double v, float p[3])
{
    const double inward = 1e-3;
    vec3 n = surface_at(s, u, v, p);
    float beside[3];
    if (length3_2(n) > 0.0f)
        return n / length3(n);
    u += inward * (0.5 * (s->u.from + s->u.to) - u);
    v += inward * (0.5 * (s->v.from + s->v.to) - v);
    n = surface_at(s, u, v, beside);
    return length3_2(n) > 0.0f ? n / length3(n) : vec3_make(0.0f, 0.0f, 1.0f);
}

static void fill_surface(grid *g, const nurbs *s)
{
    for (int y = 0; y < DICE; y++)
        for (int x = 0; x < DICE; x++) {
            size_t i = (size_t)y * DICE + (size_t)x;
            double u = s->u.from + (s->u.to - s->u.from) * x / (DICE - 1);
            double v = s->v.from + (s->v.to - s->v.from) * y / (DICE - 1);
            vec3 n = normal_at(s, u, v, g->points + 3 * i);
            for (size_t c = 0; c < 3; c++)
                g->normals[3 * i + c] = n[c];
            g->uv[2 * i] = (float)u;
            g->uv[2 * i + 1] = (float)v;
        }
}

/* What does not fit stays as it is, to be refused. */
static void translate_nurbs(const translation *t)
{
    static const char *const u[] = {"nu", "uorder", "uknots", "u0", "u1"};
    static const char *const v[] = {"nv", "vorder", "vknots", "v0", "v1"};
    static const char *const made_of[] = {"nu", "uorder", "uknots", "u0", "u1",
                                          "nv", "vorder", "vknots", "v0", "v1",
                                          "P",  "Pw",     NULL};
    const param *plain = find(t, "P"), *weighted = find(t, "Pw");
    const param *points = plain ? plain : weighted;
    nurbs s = {.width = plain ? 3 : 4};
    if (!points || points->type != (plain ? PARAM_POINT3 : PARAM_FLOAT) ||
        !read_axis(t, u, &s.u) || !read_axis(t, v, &s.v) ||
        points->n != (size_t)s.u.n * (size_t)s.v.n * (size_t)s.width)
        return;
    s.points = points->numbers;
    grid g = {.nu = DICE, .nv = DICE};
    if (has_arrays(&g, true, t->error)) {
        fill_surface(&g, &s);
        drop(t, "N");
        drop(t, "uv");
        drop(t, "indices");
        add_grid(t, &g, made_of);
    }
    free_grid(&g);
}

void pbrt_v3_shape(const translation *t)
{
    param *uv = find(t, "uv");
    if (!uv)
        uv = find(t, "st");
    if (uv && (uv->type == PARAM_FLOAT || uv->type == PARAM_POINT2)) {
        uv->name = intern("uv");
        uv->type = PARAM_POINT2;
    }
    if (strcmp(*t->kind, "heightfield") == 0)
        translate_heightfield(t);
    if (strcmp(*t->kind, "nurbs") == 0)
        translate_nurbs(t);
    if (strcmp(*t->kind, "loopsubdiv") == 0)
        rename_to(t, "nlevels", "levels");
    drop(t, "discarddegenerateUVs");
    drop_noted(t, "shadowalpha",
               "'shadowalpha' is left out: shadows are cut out by 'alpha'");
}
