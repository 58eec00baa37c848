/*
 * Integrators and samplers as settings. Ours take the settings' own names. Those of pbrt
 * that trace paths from the eye become auto: many a file says "volpath" only because its
 * exporter always does, and auto is that path tracer where paths find the light. The
 * bidirectional ones become strategies of vcm.
 */
#include "format/pbrt/pbrt_parser.h"

#include <string.h>

enum { SPP_OF_PATHS = 4 };

/** What the sampler asks for; 0: nothing. */
typedef struct sampling {
    int pixel_samples;
    const param *where; /**< that said so */
} sampling;

/** pbrt's integrators of paths: what they become, and what else they accept. */
typedef struct path_integrator {
    const char *name;
    const char *integrator, *strategies; /**< settings; strategies NULL: not vcm */
    const char *hint;                    /**< behind the note */
    const char *idle;                    /**< blanks between; without meaning here */
} path_integrator;

#define PLAIN_PATHS "; paths alone: --integrator path"

static const path_integrator path_integrators[] = {
    {"path", "auto", NULL, PLAIN_PATHS, "regularize lightsampler"},
    {"volpath", "auto", NULL, PLAIN_PATHS, "regularize lightsampler"},
    {"simplepath", "auto", NULL, PLAIN_PATHS, "samplebsdf samplelights"},
    {"simplevolpath", "auto", NULL, PLAIN_PATHS, ""},
    {"randomwalk", "auto", NULL, PLAIN_PATHS, ""},
    {"lightpath", "vcm", "light", ", light paths alone", ""},
    {"bdpt", "vcm", "bpt", ", connections alone",
     "regularize lightsampler visualizestrategies visualizeweights"},
    {"mlt", "vcm", "all", ", without mutations",
     "regularize bootstrapsamples chains mutationsperpixel largestepprobability sigma"},
};

static const path_integrator *find_path_integrator(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(path_integrators); i++)
        if (strcmp(path_integrators[i].name, name) == 0)
            return &path_integrators[i];
    return NULL;
}

/** Number i of our own, which take every setting as a parameter: those whose names say
 * nothing else in pbrt. NULL behind the last. */
static const char *own_integrator(size_t i)
{
    const char *const *words = settings_find("integrator")->words;
    for (int k = 0; k < N_INTEGRATORS; k++)
        if (!find_path_integrator(words[k]) && i-- == 0)
            return words[k];
    return NULL;
}

static bool is_own(const char *name)
{
    const char *own;
    for (size_t i = 0; (own = own_integrator(i)); i++)
        if (strcmp(own, name) == 0)
            return true;
    return false;
}

static const directive_kind sppm = {
    "sppm", "maxdepth photonsperiteration radius iterations seed", "", NULL,
    "`photonmap` with `preset` `sppm`; a `radius` of 0, and none, is automatic"};

directive_kind pbrt_integrator_kind(size_t i)
{
    enum { N_PATHS = G_N_ELEMENTS(path_integrators) };
    if (i == N_PATHS)
        return sppm;
    if (i > N_PATHS)
        return (directive_kind){own_integrator(i - N_PATHS - 1), "", "", NULL,
                                "ours: every [setting](settings.md) is a parameter"};
    const path_integrator *of = &path_integrators[i];
    const char *becomes = of->strategies ? "becomes `vcm`" : "becomes `auto`";
    return (directive_kind){of->name, "maxdepth", of->idle, "approximated", becomes};
}

#define OUR_POINTS "approximated", "the points are Owen-scrambled Sobol' points"

static const directive_kind samplers[] = {
    {"halton", "pixelsamples seed", "randomization", OUR_POINTS},
    {"sobol", "pixelsamples seed", "randomization", OUR_POINTS},
    {"zsobol", "pixelsamples seed", "randomization", OUR_POINTS},
    {"paddedsobol", "pixelsamples seed", "randomization", OUR_POINTS},
    {"independent", "pixelsamples seed", "", OUR_POINTS},
    {"stratified", "xsamples ysamples seed", "jitter", OUR_POINTS},
    {"pmj02bn", "pixelsamples seed", "", OUR_POINTS},
};

directive_kind pbrt_sampler_kind(size_t i)
{
    return i < G_N_ELEMENTS(samplers) ? samplers[i] : (directive_kind){0};
}

static void note(const pbrt_parser *parser, source_place place, const char *format, ...)
    G_GNUC_PRINTF(3, 4);

static void note(const pbrt_parser *parser, source_place place, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    log_at(&parser->builder->build.log, LOG_NOTE, place, "%s", text);
}

/** Sets a setting; a refusal is reported at the place. */
static void set(pbrt_parser *parser, source_place place, const char *name,
                const char *value)
{
    g_autoptr(GError) error = NULL;
    if (!settings_set(&parser->builder->scene->settings, name, value, &error))
        pbrt_error(parser, place, "%s", error->message);
}

static void set_count(pbrt_parser *parser, source_place place, const char *name,
                      int64_t value)
{
    g_autofree char *text = g_strdup_printf("%" G_GINT64_FORMAT, value);
    set(parser, place, name, text);
}

/** The shortest decimal that is this float. */
static char *float_text(float value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    for (int digits = 6; digits <= 9; digits++) {
        char format[8];
        g_snprintf(format, sizeof format, "%%.%dg", digits);
        g_ascii_formatd(text, sizeof text, format, (double)value);
        float back = (float)g_ascii_strtod(text, NULL);
        if (memcmp(&back, &value, sizeof back) == 0)
            break;
    }
    return g_strdup(text);
}

/** A parameter's one value as text; NULL if it has another number of them or a type that
 * no setting has. */
static char *param_text(const param *q)
{
    if (q->n != 1)
        return NULL;
    if (q->type == PARAM_FLOAT)
        return float_text(q->numbers[0]);
    if (q->type == PARAM_INTEGER)
        return g_strdup_printf("%d", q->integers[0]);
    if (q->type == PARAM_BOOL)
        return g_strdup(q->integers[0] ? "true" : "false");
    return q->type == PARAM_STRING ? g_strdup(q->strings[0]) : NULL;
}

static void set_from_param(pbrt_parser *parser, const param *q)
{
    g_autofree char *text = param_text(q);
    if (text)
        set(parser, q->place, q->name, text);
    else
        pbrt_error(parser, q->place, "parameter '%s': expected one value, found %zu",
                   q->name, q->n);
}

static const param *integer_of(pbrt_parser *parser, const params *p, const char *name,
                               int *out)
{
    GError *error = NULL;
    if (!params_integer(p, name, out, &error)) {
        pbrt_report(parser, error);
        return NULL;
    }
    return params_find(p, name);
}

static void apply_seed(pbrt_parser *parser, const params *p)
{
    int seed;
    const param *q = integer_of(parser, p, "seed", &seed);
    if (q)
        set_from_param(parser, q);
}

/** Samples a pixel by rows and columns. */
static void read_stratified(pbrt_parser *parser, const params *p, sampling *out)
{
    int x = 4, y = 4;
    const param *across = integer_of(parser, p, "xsamples", &x);
    const param *down = integer_of(parser, p, "ysamples", &y);
    bool jitter;
    GError *error = NULL;
    if (!params_bool(p, "jitter", &jitter, &error))
        pbrt_report(parser, error);
    if ((across && x < 1) || (down && y < 1) || (int64_t)x * y > INT_MAX) {
        pbrt_error(parser, p->place, "expected xsamples and ysamples > 0, found %d, %d",
                   x, y);
        return;
    }
    out->pixel_samples = x * y;
    out->where = across ? across : down;
}

static void read_pixel_samples(pbrt_parser *parser, const params *p, sampling *out)
{
    int n = 0;
    const param *q = integer_of(parser, p, "pixelsamples", &n);
    if (q && n < 1) {
        pbrt_error(parser, q->place,
                   "parameter 'pixelsamples': expected a number > 0, "
                   "found %d",
                   n);
        return;
    }
    out->pixel_samples = n;
    out->where = q;
}

static const directive_kind *find_sampler(pbrt_parser *parser)
{
    const pending *sampler = &parser->sampler;
    g_autoptr(GString) known = g_string_new(NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(samplers); i++) {
        if (strcmp(samplers[i].name, sampler->kind) == 0)
            return &samplers[i];
        g_string_append_printf(known, "%s%s", i ? ", " : "", samplers[i].name);
    }
    pbrt_error(parser, sampler->place, "expected one of %s, found \"%s\"", known->str,
               sampler->kind);
    return NULL;
}

static void check_randomization(pbrt_parser *parser, const params *p)
{
    static const char *const ways[] = {"none", "permutedigits", "fastowen", "owen", NULL};
    int way;
    GError *error = NULL;
    if (!params_choice(p, "randomization", ways, &way, &error))
        pbrt_report(parser, error);
}

static sampling read_sampler(pbrt_parser *parser)
{
    sampling out = {0};
    const pending *sampler = &parser->sampler;
    const directive_kind *kind = sampler->kind ? find_sampler(parser) : NULL;
    if (!kind)
        return out;
    note(parser, sampler->place, "Sampler '%s': Owen-scrambled Sobol' points are used",
         sampler->kind);
    if (strcmp(sampler->kind, "stratified") == 0)
        read_stratified(parser, sampler->p, &out);
    else
        read_pixel_samples(parser, sampler->p, &out);
    if (strstr(kind->idle, "randomization"))
        check_randomization(parser, sampler->p);
    apply_seed(parser, sampler->p);
    pbrt_check_used(parser, sampler->p, "Sampler", sampler->kind);
    return out;
}

static void apply_own(pbrt_parser *parser, const sampling *samples)
{
    const params *p = parser->integrator.p;
    set(parser, parser->integrator.place, "integrator", parser->integrator.kind);
    if (samples->where)
        set_count(parser, samples->where->place, "spp", samples->pixel_samples);
    for (guint i = 0; i < p->list->len; i++) {
        const param *q = p->list->pdata[i];
        const setting_row *row = settings_find(q->name);
        if (!row)
            continue;
        set_from_param(parser, params_find(p, q->name));
        g_autofree char *unread =
            settings_unread_note(&parser->builder->scene->settings, row);
        if (unread)
            note(parser, q->place, "%s", unread);
    }
}

/** pbrt's maxdepth, 5 if not given. */
static int apply_depth(pbrt_parser *parser)
{
    const pending *in = &parser->integrator;
    int depth = 5;
    const param *q = integer_of(parser, in->p, "maxdepth", &depth);
    set_count(parser, q ? q->place : in->place, "maxdepth", depth);
    return depth;
}

/** Stochastic progressive photon mapping: an iteration is a pass of one sample a pixel.
 */
static void apply_sppm(pbrt_parser *parser, const sampling *samples)
{
    const pending *in = &parser->integrator;
    const film_settings *film = &parser->builder->film;
    int photons = -1;
    float radius = 0.0f; /* automatic, where pbrt would start from 1 */
    GError *error = NULL;
    set(parser, in->place, "integrator", "sppm");
    apply_depth(parser);
    integer_of(parser, in->p, "photonsperiteration", &photons);
    if (!params_float(in->p, "radius", &radius, &error))
        pbrt_report(parser, error);
    int iterations = 0; /* of pbrt-v3 */
    const param *given = integer_of(parser, in->p, "iterations", &iterations);
    g_autofree char *text = float_text(radius);
    int64_t pixels = (int64_t)film->width * film->height;
    set_count(parser, in->place, "photons", photons > 0 ? photons : MAX(pixels, 1));
    set(parser, in->place, "radius", text);
    if (given)
        set_count(parser, given->place, "passes", iterations);
    else if (samples->where)
        set_count(parser, samples->where->place, "passes", samples->pixel_samples);
    apply_seed(parser, in->p);
}

/** pixelsamples in all, a few a pass. */
static void apply_samples(pbrt_parser *parser, const sampling *samples)
{
    if (!samples->where)
        return;
    int passes = MAX(1, samples->pixel_samples / SPP_OF_PATHS);
    set_count(parser, samples->where->place, "passes", passes);
    set_count(parser, samples->where->place, "spp",
              MIN(samples->pixel_samples, SPP_OF_PATHS));
}

static void apply_path(pbrt_parser *parser, const path_integrator *kind,
                       const sampling *samples)
{
    const pending *in = &parser->integrator;
    const settings *s = &parser->builder->scene->settings;
    int depth = apply_depth(parser);
    set(parser, in->place, "integrator", kind->integrator);
    if (kind->strategies)
        set(parser, in->place, "vcm_strategies", kind->strategies);
    apply_samples(parser, samples);
    g_auto(GStrv) idle = g_strsplit(kind->idle, " ", -1);
    for (char **name = idle; *name; name++) {
        const param *q = params_find(in->p, *name);
        if (q)
            note(parser, q->place, "'%s' of integrator '%s' has no meaning here", q->name,
                 kind->name);
    }
    note(parser, in->place,
         "integrator '%s' becomes %s with %g passes of %" G_GINT64_FORMAT
         " samples a pixel and maxdepth %d%s",
         kind->name, kind->integrator, settings_most_passes(s), s->spp, depth,
         kind->hint);
}

/* pbrt's bidirectional paths scatter in media, vcm's do not. */
void pbrt_settle_integrator(pbrt_parser *parser)
{
    const pending *in = &parser->integrator;
    const path_integrator *of = in->kind ? find_path_integrator(in->kind) : NULL;
    const scene *made = parser->builder->scene;
    if (!of || !of->strategies || !scene_has_media(made) ||
        made->settings.integrator != INTEGRATOR_VCM)
        return;
    set(parser, in->place, "integrator", "auto");
    note(parser, in->place, "integrator '%s' becomes auto, which sees the scene's media",
         of->name);
}

static void refuse_integrator(pbrt_parser *parser)
{
    const pending *in = &parser->integrator;
    g_autoptr(GString) ours = g_string_new(NULL);
    g_autoptr(GString) theirs = g_string_new(sppm.name);
    const char *own;
    for (size_t i = 0; (own = own_integrator(i)); i++)
        g_string_append_printf(ours, "%s\"%s\"", i ? ", " : "", own);
    for (size_t i = 0; i < G_N_ELEMENTS(path_integrators); i++)
        g_string_append_printf(theirs, ", %s", path_integrators[i].name);
    pbrt_error(parser, in->place,
               "expected Integrator %s or one of pbrt's (%s), found \"%s\"", ours->str,
               theirs->str, in->kind);
}

void pbrt_apply_integrator(pbrt_parser *parser)
{
    const pending *in = &parser->integrator;
    sampling samples = read_sampler(parser);
    if (!in->kind) {
        apply_samples(parser, &samples);
        return;
    }
    const path_integrator *path = find_path_integrator(in->kind);
    if (is_own(in->kind)) {
        apply_own(parser, &samples);
    } else if (strcmp(in->kind, sppm.name) == 0) {
        apply_sppm(parser, &samples);
    } else if (path) {
        apply_path(parser, path, &samples);
    } else {
        refuse_integrator(parser);
        return;
    }
    pbrt_check_used(parser, in->p, "Integrator", in->kind);
}
