/*
 * How far from the truth a picture is after so much processor time, algorithm by
 * algorithm: a table of points for equal_time.py, which makes curves and ratios of them.
 *
 *   scene ─► two long renders of algorithms that share no weakness, weighed by their
 * noise ─► reference, its floor ─► each algorithm, 1, 2, 4 ... passes, some seeds ─►
 * seconds, relMSE, FLIP
 *
 * Each picture is measured as it was rendered, and under its algorithm's name with a "+"
 * as it is shown: without its noise, with the seconds that taking it out took. The
 * default plans for what is shown: as rendered it is asked with denoise off.
 *
 * Of the scene's own words on how to render none counts: all settings are the default's
 * but the algorithm and the passes: a sample a pixel and three photons for two, as a
 * render with `time` chooses them where time is short, and each point a whole render with
 * so many. One thread, its processor seconds, planning included. Errors are of R, G and B
 * cut at CUT, for single pixels of a lamp would outweigh the picture.
 *
 * With `--by time` points are what one gets who gives so many seconds, a quarter of
 * one and then twice as many each time: the setting `time` and nothing else, all threads,
 * seconds of the clock until the picture is there; as rendered is without denoising.
 *
 *   equal_time [--by passes|time] [--size WxH] [--seconds S] [--longest TIMES]
 *              [--seeds N] [--cache DIR] [--kind NAME]... SCENE...
 */
#include <math.h>
#include <nephroid/nephroid.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Twice white: what is brighter is white in the picture as well. */
#define CUT 2.0f

static const char *const beauty[3] = {"R", "G", "B"};
static const char *const shown[3] = {"denoised.R", "denoised.G", "denoised.B"};
static const char *const caustic[3] = {"caustic.R", "caustic.G", "caustic.B"};

enum { MOST_KINDS = 8, FIRST_SEED = 1 };

/* Passes of a first try; and of a picture over those of the one before. Errors between
   two pictures are read off a line, on which there is none if noise is taken out of the
   second alone: with steps of 4 it promised pictures of three passes' time. */
enum { FEW = 4, STEP = 2 };

#define SHORTEST 0.25 /* s, by time */

/* What is compared: a name, and the settings that make it, in their order. */
typedef struct kind {
    const char *name, *settings;
} kind;

static const kind all_kinds[] = {
    {"auto", "integrator=auto"},
    {"path", "integrator=path"},
    {"sppm", "integrator=sppm"},
    {"vcm", "integrator=vcm"},
    {"final", "integrator=photonmap final_gather=true"},
};

enum { AUTO, PATH, SPPM, VCM }; /* of them, by place */

typedef struct options {
    int width, height, seeds;
    double seconds; /* of a render, until which passes are added */
    double longest; /* of a reference, as many times that */
    bool by_time;
    const char *cache;
    kind kinds[MOST_KINDS];
    int n_kinds; /* 0: all */
} options;

/* How much is rendered: so many passes on one thread, or what all do in some time. */
typedef struct amount {
    int64_t passes;
    double time; /* s; 0: passes */
} amount;

/* Of the processor, or of the clock where time is given. */
static double seconds_so_far(const amount *of)
{
    struct timespec t;
    clock_gettime(of->time > 0.0 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void fail(const char *what, GError *error)
{
    fprintf(stderr, "equal_time: %s%s%s\n", what, error ? ": " : "",
            error ? error->message : "");
    exit(3);
}

static void set(NephSettings *how, const char *name, const char *value)
{
    GError *error = NULL;
    if (!neph_settings_set(how, name, value, &error))
        fail("setting", error);
}

static void set_number(NephSettings *how, const char *name, int64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%lld", (long long)value);
    set(how, name, text);
}

static void set_all(NephSettings *how, const char *settings)
{
    char **words = g_strsplit(settings, " ", -1);
    for (char **word = words; *word; word++) {
        char **pair = g_strsplit(*word, "=", 2);
        set(how, pair[0], pair[1] ? pair[1] : "");
        g_strfreev(pair);
    }
    g_strfreev(words);
}

static int64_t n_pixels(const NephScene *scene)
{
    int width, height;
    neph_scene_size(scene, &width, &height);
    return (int64_t)width * height;
}

/* What a render takes: its picture as rendered, and with the one without noise. */
typedef struct seconds {
    double raw, shown;
} seconds;

static void set_amount(NephSettings *how, const NephScene *scene, const amount *of)
{
    char text[32];
    if (of->time > 0.0) {
        snprintf(text, sizeof text, "%.3f", of->time);
        set(how, "time", text);
        return;
    }
    set_number(how, "threads", 1);
    set_number(how, "spp", 1);
    set_number(how, "photons", n_pixels(scene) * 3 / 2);
    set_number(how, "passes", of->passes);
}

/* One whole render. @return NULL: the algorithm refuses the scene */
static NephImage *shot(const NephScene *scene, const kind *k, amount of, int seed,
                       bool denoise, seconds *took)
{
    GError *error = NULL;
    NephSettings *how = neph_settings_new();
    set_amount(how, scene, &of);
    set_number(how, "seed", seed);
    set(how, "denoise", denoise ? "on" : "off");
    set_all(how, k->settings);
    double start = seconds_so_far(&of);
    NephRender *render = neph_render_new(scene, how, &error);
    bool done = render && neph_render_run(render, NULL, NULL, &error);
    took->raw = seconds_so_far(&of) - start;
    NephImage *image = done ? neph_render_image(render, &error) : NULL;
    took->shown = seconds_so_far(&of) - start;
    if (!image)
        fprintf(stderr, "equal_time: %s: %s\n", k->name, error->message);
    g_clear_error(&error);
    neph_render_free(render);
    neph_settings_free(how);
    return image;
}

/* Where the values of a channel begin. */
static const float *channel(const NephImage *image, const char *name)
{
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    for (int c = 0; c < n; c++)
        if (strcmp(neph_image_channel_name(image, c), name) == 0)
            return neph_image_pixels(image) + c;
    return NULL;
}

/* Three numbers a pixel, cut. The caller frees them. */
static float *colours(const NephImage *from, const char *const names[3])
{
    int width, height, n_channels;
    neph_image_size(from, &width, &height, &n_channels);
    size_t n = (size_t)width * (size_t)height;
    float *rgb = g_new0(float, 3 * n);
    for (size_t c = 0; c < 3; c++) {
        const float *values = channel(from, names[c]);
        for (size_t i = 0; values && i < n; i++) {
            float v = values[i * (size_t)n_channels];
            rgb[3 * i + c] = isfinite(v) ? fminf(v, CUT) : 0.0f;
        }
    }
    return rgb;
}

/* What pictures are measured against: two long renders, and how much of each. */
typedef struct truth {
    NephImage *by[2], *light;
    float share[2];
} truth;

/* relMSE that a render's noise is, by its passes' scatter; what is cut has none. */
static double noise_of(const NephImage *image)
{
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    const float *variance = channel(image, "variance.Y");
    float *rgb = colours(image, beauty);
    double sum = 0.0;
    for (int i = 0; i < width * height; i++) {
        const float *c = rgb + 3 * i;
        float y = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        sum += y < CUT ? (double)(variance[i * n] / (y * y + 0.01f)) : 0.0;
    }
    g_free(rgb);
    return sum / (width * height);
}

/* The mean of both that has the least noise: each by what the other has. One share for
   all pixels, so that a pixel's share knows nothing of its light. */
static void weigh(truth *of)
{
    GError *error = NULL;
    int width, height, n_channels;
    neph_image_size(of->by[0], &width, &height, &n_channels);
    double noise[2] = {noise_of(of->by[0]), noise_of(of->by[1])};
    of->share[0] = (float)(noise[1] / (noise[0] + noise[1]));
    of->share[1] = 1.0f - of->share[0];
    float *a = colours(of->by[0], beauty), *b = colours(of->by[1], beauty);
    for (int i = 0; i < 3 * width * height; i++)
        a[i] = of->share[0] * a[i] + of->share[1] * b[i];
    if (!(of->light = neph_image_new(width, height, a, &error)))
        fail("no memory", error);
    g_free(a);
    g_free(b);
}

static void truth_clear(truth *of)
{
    for (int k = 0; k < 2; k++)
        neph_image_free(of->by[k]);
    neph_image_free(of->light);
}

static NephImage *cut(const NephImage *from, const char *const names[3])
{
    GError *error = NULL;
    int width, height, n_channels;
    neph_image_size(from, &width, &height, &n_channels);
    float *rgb = colours(from, names);
    NephImage *out = neph_image_new(width, height, rgb, &error);
    if (!out)
        fail("no memory", error);
    g_free(rgb);
    return out;
}

static NephImageDifference compare(const NephImage *image, const char *const names[3],
                                   const NephImage *reference)
{
    GError *error = NULL;
    NephImageDifference out;
    NephImage *a = cut(image, names), *b = cut(reference, beauty);
    if (!neph_image_compare(a, b, &out, &error))
        fail("comparing", error);
    neph_image_free(a);
    neph_image_free(b);
    return out;
}

/* relMSE over what caustics light: a fifth of it and more, by the first render's layers.
   NAN: nothing is. */
static double caustic_error(const NephImage *image, const char *const names[3],
                            const truth *reference)
{
    int width, height, n_channels;
    neph_image_size(image, &width, &height, &n_channels);
    float *is = colours(image, names), *should = colours(reference->light, beauty);
    float *all = colours(reference->by[0], beauty);
    float *lit = colours(reference->by[0], caustic);
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < width * height; i++) {
        const float *a = is + 3 * i, *b = should + 3 * i;
        const float *l = lit + 3 * i, *of = all + 3 * i;
        if (!(l[0] + l[1] + l[2] > 0.2f * (of[0] + of[1] + of[2])))
            continue;
        for (int c = 0; c < 3; c++)
            sum += (double)((a[c] - b[c]) * (a[c] - b[c]) / (b[c] * b[c] + 0.01f));
        n += 3;
    }
    g_free(is);
    g_free(should);
    g_free(all);
    g_free(lit);
    return n > 0.01 * width * height ? sum / n : (double)NAN;
}

/* Passes of about so many seconds, by what a few take; no fewer than tell noise. */
static int64_t passes_for(const NephScene *scene, const kind *k, double wanted)
{
    seconds few;
    neph_image_free(shot(scene, k, (amount){FEW, 0.0}, 99, false, &few));
    return (int64_t)fmax(FEW * wanted / few.raw, 2.0);
}

static bool is_file(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (f)
        fclose(f);
    return f;
}

/* A long render of one algorithm, kept in the cache. */
static NephImage *long_shot(const NephScene *scene, const char *name, const kind *k,
                            const options *o)
{
    char path[1024];
    double wanted = o->longest * o->seconds;
    GError *error = NULL;
    snprintf(path, sizeof path, "%s/%s-%s-%dx%d-%.0fs.exr", o->cache, name, k->name,
             o->width, o->height, wanted);
    if (is_file(path)) {
        NephImage *kept = neph_image_read(path, &error);
        if (!kept)
            fail(path, error);
        return kept;
    }
    fprintf(stderr, "equal_time: %s by %s for %.0f s\n", name, k->name, wanted);
    seconds spent;
    const amount much = {passes_for(scene, k, wanted), 0.0};
    NephImage *made = shot(scene, k, much, 4711, false, &spent);
    if (!made || !neph_image_write(made, path, 0.0f, &error))
        fail(path, error);
    return made;
}

/* @param names of the picture's channels */
static void print_point(const NephImage *image, const char *const names[3],
                        const truth *reference, double took)
{
    NephImageDifference d = compare(image, names, reference->light);
    printf("\t%.4f\t%.6f\t%.5f\t%.6f\n", took, d.relmse, d.flip,
           caustic_error(image, names, reference));
    fflush(stdout);
}

/* A point of a picture as rendered, or as it is shown. */
static void print_one(const NephImage *image, const char *name, const kind *k, amount of,
                      int seed, const truth *reference, bool as_shown,
                      const seconds *took)
{
    bool denoised = as_shown && channel(image, shown[0]);
    long long much = of.time > 0.0 ? llrint(1e3 * of.time) : (long long)of.passes;
    printf("%s\t%s%s\t%d\t%lld", name, k->name, as_shown ? "+" : "", seed, much);
    print_point(image, denoised ? shown : beauty, reference,
                as_shown ? took->shown : took->raw);
}

/* Both points, of one render or of two that go another way.
   @return seconds of the first; negative: the scene is refused */
static double measure(const NephScene *scene, const char *name, const kind *k, amount of,
                      int seed, const truth *reference)
{
    seconds raw, shown_too;
    bool apart = of.time > 0.0 || strstr(k->settings, "integrator=auto");
    NephImage *image = shot(scene, k, of, seed, !apart, &raw);
    if (!image)
        return -1.0;
    print_one(image, name, k, of, seed, reference, false, &raw);
    if (apart) {
        neph_image_free(image);
        image = shot(scene, k, of, seed, true, &shown_too);
        if (!image)
            return -1.0;
    }
    print_one(image, name, k, of, seed, reference, true, apart ? &shown_too : &raw);
    neph_image_free(image);
    return raw.raw;
}

/* One algorithm with one seed: twice as much each time. */
static void measure_kind(const NephScene *scene, const char *name, const kind *k,
                         int seed, const truth *reference, const options *o)
{
    double took = 0.0;
    amount of = {1, o->by_time ? SHORTEST : 0.0};
    while (o->by_time ? of.time <= o->seconds : took * STEP < 1.5 * o->seconds) {
        took = measure(scene, name, k, of, seed, reference);
        if (took < 0.0)
            return;
        of.passes *= STEP;
        of.time *= STEP;
    }
}

/* The algorithms take turns, so that all have of what the machine does beside them, and
   with each seed another is first: what it finds of memory depends on who was before. */
static void measure_all(const NephScene *scene, const char *name, const truth *reference,
                        bool media, const options *o)
{
    for (int seed = FIRST_SEED; seed < FIRST_SEED + o->seeds; seed++)
        for (int i = 0; i < o->n_kinds; i++) {
            const kind *k = &o->kinds[(i + seed) % o->n_kinds];
            if (!media || strcmp(k->name, "vcm") != 0)
                measure_kind(scene, name, k, seed, reference, o);
        }
}

/* Of a name, or of a name and settings in one word, as "few indirect_photons=1000". */
static bool add_kind(const char *text, options *o)
{
    if (o->n_kinds == MOST_KINDS)
        return false;
    kind *k = &o->kinds[o->n_kinds++];
    for (size_t i = 0; i < G_N_ELEMENTS(all_kinds); i++)
        if (strcmp(text, all_kinds[i].name) == 0)
            *k = all_kinds[i];
    if (k->name)
        return true;
    char **parts = g_strsplit(text, " ", 2); /* kept to the end */
    *k = (kind){parts[0], parts[1]};
    return k->settings != NULL;
}

/* "cornell" of ".../cornell.pbrt", "coffee" of ".../coffee/scene-v4.pbrt" */
static void name_of(const char *path, char *out, size_t n)
{
    char *copy = g_strdup(path), *base = g_path_get_basename(copy);
    if (strcmp(base, "scene-v4.pbrt") == 0) {
        char *folder = g_path_get_dirname(copy);
        g_free(base);
        base = g_path_get_basename(folder);
        g_free(folder);
    }
    snprintf(out, n, "%.*s", (int)strcspn(base, "."), base);
    g_free(base);
    g_free(copy);
}

/* What both differ by, and first the relMSE that is left in their mean: of variances that
   add up to the difference, as noise has them. */
static void print_floor(const char *name, const truth *of)
{
    NephImageDifference apart = compare(of->by[1], beauty, of->by[0]);
    double left = (double)(of->share[0] * of->share[1]) * apart.relmse;
    printf("%s\tfloor\t0\t0\t%.6f\t%.6f\t%.5f\n", name, left, apart.relmse, apart.flip);
    fflush(stdout);
}

static void measure_scene(const char *path, const options *o)
{
    GError *error = NULL;
    char name[128];
    name_of(path, name, sizeof name);
    NephScene *scene = neph_scene_load(path, 1, NULL, NULL, &error);
    if (!scene || !neph_scene_resize(scene, o->width, o->height, &error))
        fail(path, error);
    seconds spent;
    NephImage *tried = shot(scene, &all_kinds[VCM], (amount){1, 0.0}, 1, false, &spent);
    bool media = !tried;
    neph_image_free(tried);
    /* vcm has the least noise where anything is hard, and sppm in media, where vcm is
       not; their bias goes with the passes. */
    const kind *by[2] = {&all_kinds[media ? SPPM : VCM], &all_kinds[media ? PATH : SPPM]};
    truth reference = {
        .by = {long_shot(scene, name, by[0], o), long_shot(scene, name, by[1], o)}};
    weigh(&reference);
    print_floor(name, &reference);
    measure_all(scene, name, &reference, media, o);
    truth_clear(&reference);
    neph_scene_free(scene);
}

static bool read_option(const char *name, const char *value, options *o)
{
    if (strcmp(name, "--by") == 0) {
        o->by_time = strcmp(value, "time") == 0;
        return o->by_time || strcmp(value, "passes") == 0;
    }
    if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d", &o->width, &o->height) == 2;
    if (strcmp(name, "--seconds") == 0)
        return (o->seconds = strtod(value, NULL)) > 0.0;
    if (strcmp(name, "--longest") == 0)
        return (o->longest = strtod(value, NULL)) > 0.0;
    if (strcmp(name, "--seeds") == 0)
        return (o->seeds = atoi(value)) > 0;
    if (strcmp(name, "--cache") == 0)
        return (o->cache = value) != NULL;
    if (strcmp(name, "--kind") == 0)
        return add_kind(value, o);
    return false;
}

int main(int argc, char **argv)
{
    options o = {.width = 256,
                 .height = 256,
                 .seeds = 5,
                 .seconds = 16.0,
                 .longest = 100.0,
                 .cache = "."};
    int i = 1;
    for (; i + 1 < argc && strncmp(argv[i], "--", 2) == 0; i += 2)
        if (!read_option(argv[i], argv[i + 1], &o))
            fail("usage: equal_time [--by passes|time] [--size WxH] [--seconds S] "
                 "[--longest TIMES] [--seeds N] [--cache DIR] "
                 "[--kind 'NAME [SETTING=VALUE...]']... SCENE...",
                 NULL);
    bool all = o.n_kinds == 0;
    for (size_t k = 0; all && k < G_N_ELEMENTS(all_kinds); k++)
        add_kind(all_kinds[k].name, &o);
    for (; i < argc; i++)
        measure_scene(argv[i], &o);
    return 0;
}
