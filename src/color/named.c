/*
 * Named spectra: one row per name, pbrt's names first where it has one.
 *
 * The plain glass names are pbrt's and stand, as there, for SCHOTT's lead-free N- types.
 * A name whose figures we do not hold is unknown, never filled with something similar.
 */
#include "color/curve_make.h"
#include "color/data/tables.h"
#include "color/observer.h"

#include <pthread.h>
#include <string.h>

typedef struct named_row named_row;

struct named_row {
    const char *name;
    curve *(*make)(const named_row *row);
    const char *source; /**< a name in the tables of measured figures, or NULL */
    int index;          /**< of a table's row, or degrees Kelvin */
};

/* Illuminants have the photometric integral of equal energy, as in pbrt. */
static curve *illuminant(float grid[GRID_N])
{
    observer_normalize(observer_get(), grid);
    return curve_from_grid(grid);
}

/* CIE 15:2004, 3.1: the temperature stands for Planck's second constant of 1931. */
static curve *make_a(const named_row *row)
{
    (void)row;
    float grid[GRID_N];
    for (int i = 0; i < GRID_N; i++) {
        double nm = GRID_FIRST + i;
        grid[i] =
            (float)(100.0 * pow(560.0 / nm, 5.0) * expm1(1.435e7 / (2848.0 * 560.0)) /
                    expm1(1.435e7 / (2848.0 * nm)));
    }
    return illuminant(grid);
}

static curve *make_daylight(const named_row *row)
{
    float grid[GRID_N];
    /* the locus is defined with c2 = 1.4388e-2, the names with the older 1.4380e-2 */
    observer_daylight(row->index * 1.4388 / 1.4380, grid);
    return illuminant(grid);
}

static curve *make_d65(const named_row *row)
{
    (void)row;
    return curve_from_grid(observer_get()->d65);
}

static curve *make_d60(const named_row *row)
{
    (void)row;
    return curve_from_grid(observer_get()->d60);
}

static curve *make_fluorescent(const named_row *row)
{
    float grid[GRID_N];
    grid_from_table(cie_fluorescent[row->index - 1], CIE_LAMP_N, CIE_LAMP_FIRST, CIE_STEP,
                    grid);
    return illuminant(grid);
}

static curve *make_paint(const named_row *row)
{
    float grid[GRID_N];
    grid_from_table(cornell_paints[row->index], CORNELL_N, CORNELL_FIRST, CORNELL_STEP,
                    grid);
    return curve_from_grid(grid);
}

static curve *make_cornell_light(const named_row *row)
{
    (void)row;
    const float radiance[4] = {0.0f, 8.0f, 15.6f, 18.4f}; /* 400, 500, 600, 700 nm */
    float grid[GRID_N];
    grid_from_table(radiance, 4, 400, 100, grid);
    return curve_from_grid(grid);
}

static curve *make_glass(const named_row *row)
{
    for (const glass_formula *g = measured_glasses; g->name; g++)
        if (strcmp(g->name, row->source) == 0)
            return curve_sellmeier_terms(g->b, g->c, GLASS_TERMS);
    return NULL;
}

static double oxide(double nm, const void *data)
{
    const oxide_formula *o = data;
    double square = nm * nm * 1e-6;
    return sqrt(o->a + o->b / (square - o->c) + square * (o->d + square * o->e));
}

static curve *make_oxide_eta(const named_row *row)
{
    for (const oxide_formula *o = measured_oxides; o->name; o++)
        if (strcmp(o->name, row->source) == 0)
            return curve_from_function(oxide, o);
    return NULL;
}

static curve *make_oxide_k(const named_row *row)
{
    (void)row;
    return curve_constant(0.0f);
}

static double metal_eta(const metal_point *p)
{
    return (double)p->eta;
}

static double metal_k(const metal_point *p)
{
    return (double)p->k;
}

static curve *make_metal(const named_row *row, double (*part)(const metal_point *))
{
    const metal_table *m = measured_metals;
    while (m->name && strcmp(m->name, row->source) != 0)
        m++;
    if (!m->name)
        return NULL;
    float grid[GRID_N];
    for (int i = 0, cell = 0; i < GRID_N; i++) {
        double nm = GRID_FIRST + i;
        while (cell < m->n - 2 && (double)m->points[cell + 1].nm < nm)
            cell++;
        const metal_point *a = &m->points[cell], *b = a + 1;
        double t = (nm - (double)a->nm) / (double)(b->nm - a->nm);
        grid[i] = (float)((1.0 - t) * part(a) + t * part(b));
    }
    return curve_from_grid(grid);
}

static curve *make_eta(const named_row *row)
{
    return make_metal(row, metal_eta);
}

static curve *make_k(const named_row *row)
{
    return make_metal(row, metal_k);
}

#define METAL(symbol)                                                                    \
    {"metal-" symbol "-eta", make_eta, symbol, 0},                                       \
    {                                                                                    \
        "metal-" symbol "-k", make_k, symbol, 0                                          \
    }
#define OXIDE(formula)                                                                   \
    {"metal-" formula "-eta", make_oxide_eta, formula, 0},                               \
    {                                                                                    \
        "metal-" formula "-k", make_oxide_k, formula, 0                                  \
    }
#define FLUORESCENT(number)                                                              \
    {                                                                                    \
        "stdillum-F" #number, make_fluorescent, NULL, number                             \
    }

static const named_row rows[] = {
    {"stdillum-A", make_a, NULL, 0},
    {"stdillum-D50", make_daylight, NULL, 5000},
    {"stdillum-D65", make_d65, NULL, 0},
    {"illum-acesD60", make_d60, NULL, 0},
    FLUORESCENT(1),
    FLUORESCENT(2),
    FLUORESCENT(3),
    FLUORESCENT(4),
    FLUORESCENT(5),
    FLUORESCENT(6),
    FLUORESCENT(7),
    FLUORESCENT(8),
    FLUORESCENT(9),
    FLUORESCENT(10),
    FLUORESCENT(11),
    FLUORESCENT(12),
    METAL("Ag"),
    METAL("Al"),
    METAL("Au"),
    METAL("Cr"),
    METAL("Cu"),
    METAL("CuZn"),
    METAL("Fe"),
    METAL("Ni"),
    METAL("Pt"),
    METAL("Ti"),
    OXIDE("MgO"),
    OXIDE("TiO2"),
    {"glass-BK7", make_glass, "N-BK7", 0},
    {"glass-BAF10", make_glass, "N-BAF10", 0},
    {"glass-FK51A", make_glass, "N-FK51A", 0},
    {"glass-LASF9", make_glass, "N-LASF9", 0},
    {"glass-F5", make_glass, "N-SF5", 0},
    {"glass-F10", make_glass, "N-SF10", 0},
    {"glass-F11", make_glass, "N-SF11", 0},
    {"glass-N-BK7", make_glass, "N-BK7", 0},
    {"glass-N-BAF10", make_glass, "N-BAF10", 0},
    {"glass-N-FK51A", make_glass, "N-FK51A", 0},
    {"glass-N-LAK8", make_glass, "N-LAK8", 0},
    {"glass-N-LASF9", make_glass, "N-LASF9", 0},
    {"glass-N-SF5", make_glass, "N-SF5", 0},
    {"glass-N-SF6", make_glass, "N-SF6", 0},
    {"glass-N-SF10", make_glass, "N-SF10", 0},
    {"glass-N-SF11", make_glass, "N-SF11", 0},
    {"glass-N-SF66", make_glass, "N-SF66", 0},
    {"glass-SiO2", make_glass, "SiO2", 0},
    {"glass-water", make_glass, "water", 0},
    {"glass-diamond", make_glass, "diamond", 0},
    {"cornell-white", make_paint, NULL, 0},
    {"cornell-red", make_paint, NULL, 1},
    {"cornell-green", make_paint, NULL, 2},
    {"cornell-light", make_cornell_light, NULL, 0},
};

enum { N_ROWS = sizeof rows / sizeof *rows };

curve *curve_named(const char *name)
{
    for (int i = 0; i < N_ROWS; i++)
        if (strcmp(rows[i].name, name) == 0)
            return rows[i].make(&rows[i]);
    return NULL;
}

static const char *names[N_ROWS + 1];

static void list_names(void)
{
    for (int i = 0; i < N_ROWS; i++)
        names[i] = rows[i].name;
}

const char *const *curve_names(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, list_names);
    return names;
}
