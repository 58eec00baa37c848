/*
 * Views of fog whose radiance is known, from closed forms, quadrature and a naive twin
 * (fog_twin.h), and checks of whole renders against them. Most are so narrow that the
 * picture is one ray; in a furnace every ray is as good.
 */
#pragma once

#include "fog_scenes.h"
#include "fog_twin.h"

/* ---- What is expected ---- */

/* A view of one radiance. */
typedef struct fog_view {
    const char *name, *text;
    const char *more; /* settings */
    double (*expected)(const struct fog_view *v);
    twin twin;
    double eye[3], way[3]; /* for the twin; the way need not be unit */
    double value, depth;   /* for closed: what is seen, and the optical depth before it */
    double tolerance;      /* relative */
    const char *only;      /* the ways that can render it; NULL: all */
} fog_view;

static double closed(const fog_view *v)
{
    return v->value * exp(-v->depth);
}

static void unit_way(const fog_view *v, double out[3])
{
    double length = sqrt(twin_dot(v->way, v->way));
    for (int i = 0; i < 3; i++)
        out[i] = v->way[i] / length;
}

static double single(const fog_view *v)
{
    double way[3];
    unit_way(v, way);
    return twin_single(&v->twin, v->eye, way);
}

static double all_orders(const fog_view *v)
{
    double way[3];
    unit_way(v, way);
    twin_result r = twin_radiance(&v->twin, v->eye, way, 800000, 7);
    g_assert_cmpfloat(r.error / r.sum, <, 0.0025);
    return r.sum;
}

/* Midpoints over 0..1. */
static double mean_over_unit(double (*f)(double x))
{
    enum { N = 20000 };
    double sum = 0;
    for (int i = 0; i < N; i++)
        sum += f((i + 0.5) / N) / N;
    return sum;
}

/* White sky on a grey floor through a slab of depth 0.4. */
static double under_slab(double mu)
{
    return 0.5 * 2 * mu * exp(-0.4 / mu);
}

static double sky_under_slab(const fog_view *v)
{
    (void)v;
    return mean_over_unit(under_slab);
}

/* A disc of radius 1 that shines 1, a metre above a grey floor in fog of 0.5 / m. */
static double under_disc(double r)
{
    double d2 = 1 + r * r;
    return 0.5 * 2 * r / (d2 * d2) * exp(-0.5 * sqrt(d2));
}

static double disc_over_floor(const fog_view *v)
{
    (void)v;
    return mean_over_unit(under_disc) * exp(-0.5 * 0.5 * G_SQRT2);
}

/* The beam of a lamp of intensity 1, two metres above (0, 3, 0) and five degrees wide to
   either side: seen once scattered from the origin along y, in fog of .1 and .2 / m. */
static double across_beam(const fog_view *v)
{
    enum { N = 20000 };
    const double half = 2 * tan(G_PI / 36), step = 2 * half / N;
    double sum = 0;
    (void)v;
    for (int i = 0; i < N; i++) {
        double y = (i + 0.5) * step - half, square = 4 + y * y;
        sum += step / square * exp(-0.3 * (3 + y + sqrt(square)));
    }
    return 0.2 / (4 * G_PI) * sum;
}

/* ---- Views ---- */

#define ABSORBING FOG("f", ".5", "0", "0")
#define FLOOR GREY("Shape \"disk\" \"float radius\" 30")

/* Seen from below, z = 2 away. */
#define LAMP_ABOVE(radius)                                                               \
    LAMP("ReverseOrientation Translate 0 0 2 Shape \"disk\" \"float radius\" " radius)

/* A glass plate above the floor. */
#define PLATE                                                                            \
    "AttributeBegin Material \"dielectric\" " BOX("1.8", "1", "1.5") "AttributeEnd\n"

/* Transmittance of a plate of index 1.5, straight through: 2n / (n² + 1). */
#define PLATE_PASSES (3 / 3.25)

static const fog_view absorbing[] = {
    {.name = "lamp",
     .text = ABSORBING EYE("f", "0 -3 0  0 0 0") BETWEEN("f", "f")
         LAMP("Translate 0 2 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1"),
     .expected = closed,
     .value = 1,
     .depth = 2.5},
    {.name = "lamp-behind-box",
     .text = ABSORBING EYE("", "0 -.1 -3  0 0 0") BETWEEN("f", "") BOX("2", "0", "1")
         BETWEEN("", "") LAMP_ABOVE("9"),
     .expected = closed,
     .value = 1,
     .depth = 0.5 / 0.9994449 /* slanting a little */},
    {.name = "bubble",
     .text = ABSORBING EYE("", "0 -.1 -3  0 0 0") BETWEEN("f", "") BOX("2", "-1", "1")
         BETWEEN("", "f") BALL(".6") BETWEEN("", "") LAMP_ABOVE("9"),
     .expected = closed,
     .value = 1,
     .depth = 0.5 * (2 / 0.9994449 - 1.2)},
    {.name = "sky-behind-ball",
     .text = ABSORBING EYE("", "0 -3 0  0 0 0") SKY BETWEEN("f", "") BALL("1"),
     .expected = closed,
     .value = 1,
     .depth = 1},
    {.name = "ball-with-surface",
     .text = ABSORBING EYE("", "0 -3 0  0 0 0") SKY
         BETWEEN("f", "") "AttributeBegin Material \"dielectric\" \"float eta\" 1 " BALL(
             "1") "AttributeEnd\n",
     .expected = closed,
     .value = 1,
     .depth = 1},
    {.name = "sky-from-within",
     .text = ABSORBING EYE("f", "0 0 0  0 1 0") SKY BETWEEN("f", "") BALL("1"),
     .expected = closed,
     .value = 1,
     .depth = 0.5},
    {.name = "floor-by-point",
     .text = ABSORBING EYE("f", "0 -2 2  0 0 0") BETWEEN("f", "f") POINT("0 0 2") FLOOR,
     .expected = closed,
     .value = 0.5 / G_PI / 4,
     .depth = 0.5 * (2 + 2 * G_SQRT2)},
    {.name = "floor-by-beam",
     .text = ABSORBING EYE("", "0 -.3 .4  0 0 0") BETWEEN("f", "") BOX("30", ".5", "1.5")
         BETWEEN("", "") DISTANT("0 1 1") FLOOR,
     .expected = closed,
     .value = 0.5 / G_PI / G_SQRT2,
     .depth = 0.5 * G_SQRT2},
    /* Of what the floor sends back to the plate little returns: it is dark. */
    {.name = "floor-by-beam-through-glass",
     .text = ABSORBING WIDE_EYE("", "0 -.3 .4  0 0 0", "20") BETWEEN("f", "")
         BOX("2", ".5", "2") BETWEEN("", "f") PLATE BETWEEN("", "")
             DISTANT("0 0 1") "Material \"diffuse\" \"rgb reflectance\" [.1 .1 .1] Shape "
                              "\"disk\" \"float radius\" 1.2\n",
     .more = " photons=20000 passes=128",
     .expected = closed,
     .value = 0.1 / G_PI * PLATE_PASSES,
     .depth = 0.5,
     .tolerance = 0.03,
     .only = "photonmap auto sppm"},
    {.name = "floor-by-sky",
     .text = FOG("f", ".4", "0", "0") EYE("", "0 -.3 .4  0 0 0") BETWEEN("f", "")
         BOX("90", ".5", "1.5") BETWEEN("", "") SKY FLOOR,
     .expected = sky_under_slab},
    {.name = "floor-by-disc",
     .text = ABSORBING EYE("f", "0 -.5 .5  0 0 0") BETWEEN("f", "f") LAMP(
         "ReverseOrientation Translate 0 0 1 Shape \"disk\" \"float radius\" 1") FLOOR,
     .expected = disc_over_floor},
};

/* ---- Scattering: against the twin ---- */

/* A ball of radius 1 around the origin, seen from in front, lit from the side. */
#define BALL_OF(g, lamp)                                                                 \
    FOG("f", ".2", "1.8", g)                                                             \
    EYE("", "0 -4 .3  0 0 .3")                                                           \
    BETWEEN("", "") POINT(lamp) BETWEEN("f", "") BALL("1")

#define BALL_TWIN(mean, x, y)                                                            \
    .twin = {.sigma_a = 0.2,                                                             \
             .sigma_s = 1.8,                                                             \
             .g = mean,                                                                  \
             .radius = 1,                                                                \
             .lamp = {x, y, 0},                                                          \
             .strength = 1},                                                             \
    .eye = {0, -4, 0.3}, .way = {0, 1, 0}

/* A slab from z = 0 to 1, lit from above. */
#define SLAB_OF(look)                                                                    \
    FOG("f", ".2", "1.8", ".5")                                                          \
    EYE("", look) BETWEEN("", "") DISTANT("0 3 4") BETWEEN("f", "") BOX("5", "0", "1")

#define SLAB_TWIN                                                                        \
    .twin = {.sigma_a = 0.2,                                                             \
             .sigma_s = 1.8,                                                             \
             .g = 0.5,                                                                   \
             .thickness = 1,                                                             \
             .distant = true,                                                            \
             .lamp = {0, 0.6, 0.8},                                                      \
             .strength = 1}

/* The eye and a lamp in fog that ends where it hides everything. */
#define ENDLESS(g)                                                                       \
    FOG("f", ".1", ".2", g)                                                              \
    EYE("f", "0 0 0  0 1 0")                                                             \
    BETWEEN("f", "")                                                                     \
    BALL("99")                                                                           \
    BETWEEN("f", "f")                                                                    \
    POINT("1 3 "                                                                         \
          "0")

#define ENDLESS_TWIN(mean)                                                               \
    .twin = {.sigma_a = 0.1,                                                             \
             .sigma_s = 0.2,                                                             \
             .g = mean,                                                                  \
             .lamp = {1, 3, 0},                                                          \
             .strength = 1},                                                             \
    .eye = {0, 0, 0}, .way = {0, 1, 0}

/* The same fog, and a spot that shines down across it. */
#define BEAM                                                                             \
    FOG("f", ".1", ".2", "0")                                                            \
    EYE("f", "0 0 0  0 1 0")                                                             \
    BETWEEN("f", "")                                                                     \
    BALL("99")                                                                           \
    BETWEEN("f", "f")                                                                    \
    "LightSource \"spot\" \"rgb I\" [1 1 1] \"point3 from\" [0 3 2] \"point3 to\" [0 3 " \
    "0] "                                                                                \
    "\"float conedeltaangle\" 0 \"float coneangle\" 5\n"

#define ONCE .expected = single, .more = " max_backward_bounces=1", .only = "path auto"

static const fog_view scattering[] = {
    {.name = "once-0", .text = BALL_OF("0", "2 -1.5 0"), BALL_TWIN(0, 2, -1.5), ONCE},
    {.name = "once-forward",
     .text = BALL_OF(".8", "1 2.5 0"),
     BALL_TWIN(0.8, 1, 2.5),
     ONCE},
    {.name = "once-back",
     .text = BALL_OF("-.6", "2 -1.5 0"),
     BALL_TWIN(-0.6, 2, -1.5),
     ONCE},
    {.name = "once-endless-0", .text = ENDLESS("0"), ENDLESS_TWIN(0), ONCE},
    {.name = "once-endless-forward", .text = ENDLESS(".8"), ENDLESS_TWIN(0.8), ONCE},
    {.name = "once-endless-back", .text = ENDLESS("-.6"), ENDLESS_TWIN(-0.6), ONCE},
    {.name = "once-beam",
     .text = BEAM,
     .expected = across_beam,
     .more = " max_backward_bounces=1",
     .only = "path auto"},
    {.name = "ball-0",
     .text = BALL_OF("0", "2 -1.5 0"),
     BALL_TWIN(0, 2, -1.5),
     .expected = all_orders},
    {.name = "ball-forward",
     .text = BALL_OF(".8", "1 2.5 0"),
     BALL_TWIN(0.8, 1, 2.5),
     .expected = all_orders,
     .only = "path auto" /* few photons are turned straight to the eye */},
    {.name = "ball-back",
     .text = BALL_OF("-.6", "2 -1.5 0"),
     BALL_TWIN(-0.6, 2, -1.5),
     .expected = all_orders},
    {.name = "slab-reflects",
     .text = SLAB_OF("0 -4 5  0 0 1"),
     SLAB_TWIN,
     .eye = {0, -4, 5},
     .way = {0, 1, -1},
     .expected = all_orders},
    {.name = "slab-passes",
     .text = SLAB_OF("0 -4 -4  0 0 0"),
     SLAB_TWIN,
     .eye = {0, -4, -4},
     .way = {0, 1, 1},
     .expected = all_orders},
};

/* ---- Furnaces: 1 everywhere ---- */

#define WHITE_BALL(s, g, eye) FOG("f", "0", s, g) eye SKY BETWEEN("f", "") BALL("1")

#define BEFORE WIDE_EYE("", "0 -4 .3  0 0 .1", "25")
#define WITHIN WIDE_EYE("f", "0 .2 .3  0 1 1", "60")

/* A box of 2 x 2 x 2 m that shines 1/2 and reflects 1/2 on either side. */
#define FURNACE_BOX                                                                      \
    "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] "                \
    "AreaLightSource \"diffuse\" \"rgb L\" [.5 .5 .5] \"bool twosided\" true " BOX(      \
        "1", "-1", "1") "AttributeEnd\n"

static const fog_view furnaces[] = {
    {.name = "thin-0", .text = WHITE_BALL(".25", "0", BEFORE)},
    {.name = "thick-0", .text = WHITE_BALL("2.5", "0", BEFORE)},
    {.name = "thick-forward", .text = WHITE_BALL("2.5", ".8", BEFORE)},
    {.name = "thick-back", .text = WHITE_BALL("2.5", "-.6", BEFORE)},
    {.name = "within", .text = WHITE_BALL("2.5", ".3", WITHIN)},
    {.name = "lamp-in-fog", /* black, and shines as much as the sky */
     .text = FOG("f", "0", "1", "0") BEFORE SKY BETWEEN("f", "") BALL("1")
         BETWEEN("f", "f") LAMP("Translate .2 .1 -.1 " BALL(".3"))},
    {.name = "lamp-before-fog",
     .text = FOG("f", "0", "1", ".4") BEFORE SKY BETWEEN("f", "") BALL("1")
         BETWEEN("", "") LAMP("Translate 0 1.5 0 " BALL(".4"))},
    {.name = "bubble",
     .text = FOG("f", "0", "2", ".4") BEFORE SKY BETWEEN("f", "") BALL("1")
         BETWEEN("", "f") "Translate 0 0 .2 " BALL(".4")},
    {.name = "two-media",
     .text = FOG("f", "0", "2", ".4") FOG("h", "0", "5", "-.5") BEFORE SKY BETWEEN(
         "f", "") BALL("1") BETWEEN("h", "f") "Translate 0 0 .2 " BALL(".4")},
    {.name = "white-ball-in-fog",
     .text = FOG("f", "0", "2", ".4") BEFORE SKY BETWEEN("f", "") BALL("1") BETWEEN(
         "f", "f") "Material \"diffuse\" \"rgb reflectance\" [1 1 1] " BALL(".4")},
    {.name = "milk-in-glass",
     .text = FOG("f", "0", "3", ".4") BEFORE SKY BETWEEN(
         "f", "") "Material \"dielectric\" \"float eta\" 1.33 " BALL("1")},
    {.name = "glass-in-fog",
     .text = FOG("f", "0", "2", ".4") BEFORE SKY BETWEEN("f", "") BALL("1")
         BETWEEN("f", "f") "Material \"dielectric\" Translate .2 0 .1 " BALL(".4")},
    {.name = "box-0",
     .text = FOG("f", "0", ".5", "0") WITHIN BETWEEN("f", "") FURNACE_BOX},
    {.name = "box-forward",
     .text = FOG("f", "0", "2.5", ".8") WITHIN BETWEEN("f", "") FURNACE_BOX,
     .tolerance = 0.02,
     .only = "path auto photonmap" /* few directions, and narrow: noisy */},
    {.name = "ball-in-box",
     .text = FOG("f", "0", "5", "-.6") WIDE_EYE("", "0 -.9 .1  0 0 .1", "50")
         BETWEEN("", "") FURNACE_BOX BETWEEN("f", "") BALL(".5")},
};

/* ---- Ways to render them ---- */

typedef struct method {
    const char *name, *words;
    double more; /* than a view's tolerance: what photons blur */
} method;

typedef struct check {
    const fog_view *view;
    const method *way;
    double tolerance;
} check;

/* The twin takes its time: once for all ways. */
static double expected_of(const fog_view *v)
{
    static GHashTable *known;
    if (!known)
        known = g_hash_table_new_full(NULL, NULL, NULL, g_free);
    double *found = g_hash_table_lookup(known, v);
    if (!found) {
        found = g_new(double, 1);
        *found = v->expected ? v->expected(v) : 1;
        g_hash_table_insert(known, (void *)v, found);
    }
    return *found;
}

static void test_view(gconstpointer data)
{
    const check *c = data;
    g_autofree char *how =
        g_strconcat(c->way->words, c->view->more ? c->view->more : "", NULL);
    double expected = expected_of(c->view);
    g_autoptr(view) v = view_of(c->view->text);
    g_autoptr(image) img = render_with(v, how);
    double seen = mean_of(img, ""), most = c->tolerance + c->way->more;
    g_test_message("%.5f, expected %.5f: off by %.2f %%, allowed %.2f %%", seen, expected,
                   100 * (seen / expected - 1), 100 * most);
    g_assert_cmpfloat(fabs(seen / expected - 1), <, most);
}

static bool is_among(const char *words, const char *word)
{
    g_auto(GStrv) list = g_strsplit(words, " ", -1);
    return g_strv_contains((const char *const *)list, word);
}

/* Makes tests of a group of views, each in some ways. */
static void add_views(const char *group, const fog_view *list, size_t n, double tolerance,
                      const method *ways, size_t n_ways)
{
    for (size_t w = 0; w < n_ways; w++)
        for (size_t i = 0; i < n; i++) {
            if (list[i].only && !is_among(list[i].only, ways[w].name))
                continue;
            check *c = g_new(check, 1);
            *c = (check){&list[i], &ways[w],
                         list[i].tolerance > 0 ? list[i].tolerance : tolerance};
            g_autofree char *name =
                g_strdup_printf("/fog/%s/%s/%s", group, ways[w].name, list[i].name);
            g_test_add_data_func_full(name, c, test_view, g_free);
        }
}
