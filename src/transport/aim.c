#include "transport/aim.h"

#include "base/memory.h"
#include "transport/visible.h"

enum {
    ROUNDS = 4,
    TRIALS = 1 << 14,     /* photons a round */
    MAX_TRIALS = 1 << 18, /* in the first round, if hardly any arrives */
    ENOUGH_ARRIVALS = 1000,
    VISIBLE_POINTS = 4096,
    CHUNK = 1024,
};

/* Trial photons are those of passes that no render reaches. */
#define TRIAL_PASS 0xfffffff0u

/* A photon that lands out of the camera's sight is worth this share of one in sight: it
   may still be seen by way of other surfaces. */
#define UNSEEN_VALUE 0.05f

/* Visible points stand for what lies between them: so many of their mean distances
 * around. */
#define SIGHT_REACH 2.0f

/* What the trials of a round share. */
typedef struct trials {
    trace_task task;
    photon_map *visible;      /* visible points; flux[0] is the reach of each */
    emission_record *records; /* one per trial, value 0 if it did not arrive */
    double *noise;            /* what each adds to it: see noise_of */
    size_t first;             /* index of the first trial of the round */
    size_t n_arrived;         /* records that arrived, of all rounds so far */
    aim_result *result;       /* NULL: not asked for */
} trials;

/* ---- Where the camera looks ---- */

static photon_map *visible_map(const transport_plan *plan, GError **error)
{
    visible_point *points =
        big_alloc(VISIBLE_POINTS, sizeof *points, "visible points", error);
    photon_store store = {0};
    if (!points || !photon_store_reserve(&store, VISIBLE_POINTS, error)) {
        big_free(points);
        return NULL;
    }
    size_t n = find_visible_points(plan, VISIBLE_POINTS, points);
    const film_settings *film = &plan->scene->film;
    float pixels_each = (float)film->width * (float)film->height / VISIBLE_POINTS;
    for (size_t i = 0; i < n; i++) {
        float reach = SIGHT_REACH * points[i].pixel * sqrtf(pixels_each);
        photon p = {.p = points[i].p, .wi = {0, 0, 1}, .flux = spectrum_fill(reach)};
        photon_store_put(&store, &p);
    }
    big_free(points);
    return photon_map_build(MAP_KDTREE, &store, 0.0f, 1, error);
}

/* Square of the reach of the visible point that p lies by; 0: out of sight. */
static float sight_at(const photon_map *visible, vec3 p, photon_hits *hits)
{
    if (!photon_map_nearest(visible, p, 1, INFINITY, NULL, hits) || hits->n == 0)
        return 0.0f;
    float reach = photon_map_store(visible)->flux[hits->index[0]][0];
    return hits->distance2[0] < reach * reach ? reach * reach : 0.0f;
}

/* ---- Trials ---- */

typedef struct trial {
    const photon_map *visible;
    photon_hits *hits;
    float value;
    double noise;
} trial;

/* A path from the eye that finds by itself what a photon of flux Φ and share w brings has
   a density of (1 - w) / w of that of merging with it. So in a pixel of area a its square
   adds Φ² w / (1 - w) / a, up to factors that are the same for all. Of photons with small
   shares, those that survive stand for the others. */
static double noise_of(const photon_event *event, float sight)
{
    double w = (double)event->share, left = fmax(1.0 - w, 1e-9);
    double survived = fmin(1.0, w / (double)PHOTON_LEAST_SHARE);
    double flux = (double)spectrum_mean(event->flux) * survived / w;
    return flux * flux * w / left / (survived * (double)sight);
}

static void note_arrival(const photon_event *event, void *data)
{
    trial *t = data;
    float flux = spectrum_mean(event->flux);
    if (event->kind != PHOTON_STORED || !isfinite(flux))
        return;
    float sight = sight_at(t->visible, event->p, t->hits);
    t->value += flux * (sight > 0.0f ? 1.0f : UNSEEN_VALUE);
    t->noise += sight > 0.0f ? noise_of(event, sight) : 0.0;
}

static void run_trials(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    trials *all = data;
    photon_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        emission_record *record = &all->records[i];
        trial t = {all->visible, &hits, 0.0f, 0.0};
        record->density = photon_start_point(&all->task, all->first + i, record->u);
        photon_tell(&all->task, all->first + i, note_arrival, &t);
        record->value = t.value;
        all->noise[i] = t.noise;
    }
    photon_hits_clear(&hits);
}

/* Moves the records that arrived to the front. @return how many. */
static size_t keep_arrivals(emission_record *records, double *noise, size_t n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (!(records[i].value > 0.0f))
            continue;
        noise[kept] = noise[i];
        records[kept++] = records[i];
    }
    return kept;
}

#define TYPICAL_ALBEDO 0.5

/* The noise by n_traced trials whose own parts sum up to `sum`. */
static double noise_of_all(const trials *all, double sum, size_t n_traced)
{
    const film_settings *film = &all->task.scene->film;
    double pixels = (double)film->width * (double)film->height;
    double pixels_each = pixels / VISIBLE_POINTS;
    double reflected = TYPICAL_ALBEDO / G_PI;
    double per_pixel = (double)(SIGHT_REACH * SIGHT_REACH) * pixels_each / pixels;
    return sum * per_pixel * reflected * reflected * TRIALS / (double)n_traced * TRIALS /
           (double)all->task.share->discs;
}

/* What the trials of the last round brought, and how much denser than uniform ones they
   were where it counts. */
static void note_result(const trials *all, size_t n_arrived, size_t n_traced)
{
    const scene *s = all->task.scene;
    guint n_lights = s->lights->len;
    g_autofree double *value = g_new0(double, n_lights);
    g_autofree double *dense = g_new0(double, n_lights);
    aim_result *out = all->result;
    double noise = 0.0;
    out->boost = g_new(float, n_lights);
    for (size_t i = 0; i < n_arrived; i++) {
        const emission_record *r = &all->records[all->n_arrived + i];
        float u_light = r->u[0];
        size_t from = distribution_sample(&s->caustic_power, &u_light);
        value[from] += (double)r->value;
        dense[from] += (double)(r->value * r->density);
        noise += all->noise[all->n_arrived + i];
    }
    out->noise = noise_of_all(all, noise, n_traced);
    for (guint i = 0; i < n_lights; i++)
        out->boost[i] = value[i] > 0.0 ? (float)(dense[i] / value[i]) : 1.0f;
}

/* Traces trial photons of one round until enough arrived, and teaches the guide by those
   of all rounds: what is rare is learned from the few that ever found it. */
static bool run_round(trials *all, emission_guide *guide, uint32_t round, GError **error)
{
    size_t kept = 0, limit = round == 0 ? MAX_TRIALS : TRIALS;
    emission_record *records = all->records;
    double *noise = all->noise;
    all->task.pass = TRIAL_PASS + round;
    for (all->first = 0; all->first < limit && kept < ENOUGH_ARRIVALS;
         all->first += TRIALS) {
        all->records = records + all->n_arrived + kept;
        all->noise = noise + all->n_arrived + kept;
        if (!parallel_for(TRIALS, CHUNK, (unsigned)all->task.how->threads,
                          all->task.cancel, run_trials, all)) {
            error_set(error, ERROR_CANCELLED, "cancelled");
            break;
        }
        kept += keep_arrivals(all->records, all->noise, TRIALS);
    }
    bool done = !cancelled(all->task.cancel);
    all->records = records;
    all->noise = noise;
    if (done && all->result && round == ROUNDS - 1)
        note_result(all, kept, all->first);
    all->n_arrived += kept;
    if (done)
        emission_guide_learn(guide, records, all->n_arrived);
    return done;
}

static bool learn(trials *all, emission_guide *guide, GError **error)
{
    const size_t room = ROUNDS * (TRIALS + ENOUGH_ARRIVALS);
    all->records = big_alloc(room, sizeof *all->records, "trial photons", error);
    all->noise =
        all->records ? big_alloc(room, sizeof *all->noise, "trial photons", error) : NULL;
    bool ok = all->noise != NULL;
    for (uint32_t round = 0; round < ROUNDS && ok; round++)
        ok = run_round(all, guide, round, error);
    big_free(all->records);
    big_free(all->noise);
    return ok;
}

bool aim_caustics(transport_plan *plan, aim_result *result, const cancel_flag *cancel,
                  GError **error)
{
    if (plan->how.caustic_emission != EMISSION_GUIDED ||
        plan->n_photons[PHOTON_CAUSTIC] == 0)
        return true;
    g_autoptr(photon_map) visible = visible_map(plan, error);
    if (!visible)
        return false;
    g_autoptr(emission_guide) guide = emission_guide_new();
    trials all = {
        .visible = visible,
        .result = result,
        .task =
            {
                .scene = plan->scene,
                .how = &plan->how,
                .w = wavelengths_at(0.5f),
                .photon_class = PHOTON_CAUSTIC,
                .guide = guide,
                .share = plan->shares ? &plan->share : NULL,
                .n_photons = TRIALS,
                .cancel = cancel,
            },
    };
    if (!learn(&all, guide, error))
        return false;
    plan->guide = g_steal_pointer(&guide);
    return true;
}
