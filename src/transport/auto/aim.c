#include "transport/auto/aim.h"

#include "base/memory.h"
#include "scene/advance.h"
#include "transport/visible.h"

enum {
    ROUNDS = 4,
    TRIALS = 1 << 14,     /* photons a round */
    MAX_TRIALS = 1 << 18, /* in the first round, if hardly any arrives */
    LEAST_TRIALS = 1 << 12,
    BATCHES = 4,            /* of a round's trials: what is worthless may show early */
    SAMPLES_PER_TRIAL = 64, /* of the camera, planned, for each trial of a round ... */
    SAMPLES_PER_FIRST_TRIAL = 16, /* ... and of the first, if hardly any arrives */
    TELLING_ARRIVALS = 32,        /* so many show that photons bring next to nothing */
    ENOUGH_ARRIVALS = 1000,
    VISIBLE_POINTS = 4096,
    CHUNK = 256,
};

/* Trial photons are those of passes that no render reaches. */
#define TRIAL_PASS 0xfffffff0u

/* A photon that lands out of the camera's sight is worth this share of one in sight: it
   may still be seen by way of other surfaces. */
#define UNSEEN_VALUE 0.05f

/* Less light than this from a point in a medium is none. */
#define LEAST_SEEN 0.05f

/* Visible points stand for what lies between them: so many of their mean distances
 * around. */
#define SIGHT_REACH 2.0f

/* What a trial photon adds to the noise that paths would have, and to what is left of it
   with shares of all photons. */
typedef struct trial_noise {
    double of_paths, left[AIM_SHARES];
    double seen, unseen; /* flux that landed in the camera's sight, and out of it */
} trial_noise;

/* What the trials of a round share. */
typedef struct trials {
    trace_task task;
    photon_map *visible;      /* visible points; flux[0] is the reach of each */
    float most_reach;         /* of all of them, m */
    emission_record *records; /* one per trial, value 0 if it did not arrive */
    trial_noise *noise;       /* one per trial */
    size_t first;             /* trials of the round before this batch */
    size_t n_known;           /* records of earlier rounds ... */
    size_t n_arrived;         /* ... and behind them of this one */
    size_t each;              /* trials of a round */
    size_t most;              /* of the first round, if hardly any arrives */
    double least_noise;       /* see aim_effort */
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

static float most_reach(const photon_map *visible)
{
    const photon_store *points = photon_map_store(visible);
    float most = 0.0f;
    for (size_t i = 0; i < points->n; i++)
        most = maxf(most, points->flux[i][0]);
    return most;
}

/* Square of the reach of the visible point that p lies by; 0: out of sight. */
static float sight_at(const trials *all, vec3 p, photon_hits *hits)
{
    const photon_map *visible = all->visible;
    if (!photon_map_nearest(visible, p, 1, all->most_reach, NULL, hits) || hits->n == 0)
        return 0.0f;
    float reach = photon_map_store(visible)->flux[hits->index[0]][0];
    return hits->distance2[0] < reach * reach ? reach * reach : 0.0f;
}

/* The same of a point in a medium, which is in sight if nothing stands before it and
   light comes from there to the eye. */
static float sight_in_medium(const trials *all, const surface_hit *hit)
{
    const trace_task *task = &all->task;
    const film_settings *film = &task->scene->film;
    const camera *c = &task->scene->camera;
    camera_connection eye;
    if (!camera_connects(c) ||
        !camera_connect(c, hit->p, (vec2){0.5f, 0.5f}, hit->time, &eye) ||
        !(eye.raster.x >= 0.0f && eye.raster.x < (float)film->width) ||
        !(eye.raster.y >= 0.0f && eye.raster.y < (float)film->height))
        return 0.0f;
    ray r = hit_ray_to(hit, eye.direction, eye.distance);
    if (scene_occluded(task->scene, &r))
        return 0.0f;
    float left = spectrum_mean(scene_transmittance(task->scene, &r, &task->w));
    float pixels = (float)film->width * (float)film->height / VISIBLE_POINTS;
    return left < LEAST_SEEN
               ? 0.0f
               : SIGHT_REACH * SIGHT_REACH * pixels * camera_pixel_area(c, eye.distance);
}

/* ---- Trials ---- */

typedef struct trial {
    const trials *all;
    photon_hits *hits;
    float value;
    trial_noise noise;
} trial;

/* A path from the eye that finds by itself what a photon of flux Φ and share w brings has
   a density of (1 - w) / w of that of merging with it. So in a pixel of area a its square
   adds Φ² w / (1 - w) / a, up to factors that are the same for all. Of photons with small
   shares, those that survive stand for the others. Where photons help, with m times the
   density, all of them together leave the 1 / (1 + m)-th part. */
static void add_noise(trial_noise *sum, const photon_event *event, float sight)
{
    double w = (double)event->share, odds = w / fmax(1.0 - w, 1e-9);
    double survived = fmin(1.0, w / (double)PHOTON_LEAST_SHARE);
    double flux = (double)spectrum_mean(event->flux) * survived / w;
    double noise = flux * flux * odds / (survived * (double)sight);
    sum->of_paths += noise;
    for (int i = 0; i < AIM_SHARES; i++)
        sum->left[i] += noise / (1.0 + aim_share(i) * odds);
}

static void note_arrival(const photon_event *event, void *data)
{
    trial *t = data;
    float flux = spectrum_mean(event->flux);
    if (event->kind != PHOTON_STORED || !isfinite(flux))
        return;
    float sight = event->hit->shape == NO_INDEX ? sight_in_medium(t->all, event->hit)
                                                : sight_at(t->all, event->p, t->hits);
    t->value += flux * (sight > 0.0f ? 1.0f : UNSEEN_VALUE);
    if (sight > 0.0f)
        add_noise(&t->noise, event, sight);
    *(sight > 0.0f ? &t->noise.seen : &t->noise.unseen) += (double)flux;
}

static void run_trials(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    trials *all = data;
    photon_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        emission_record *record = &all->records[i];
        trial t = {.all = all, .hits = &hits};
        record->density = photon_start_point(&all->task, all->first + i, record->u);
        photon_tell(&all->task, all->first + i, note_arrival, &t);
        record->value = t.value;
        all->noise[i] = t.noise;
    }
    photon_hits_clear(&hits);
}

/* Moves the records that arrived to the front. @return how many. */
static size_t keep_arrivals(emission_record *records, trial_noise *noise, size_t n)
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

/* What the sum of all trials' parts is to be multiplied with to be a camera sample's. */
static double noise_scale(const trials *all)
{
    const film_settings *film = &all->task.scene->film;
    double pixels = (double)film->width * (double)film->height;
    double pixels_each = pixels / VISIBLE_POINTS;
    double reflected = TYPICAL_ALBEDO / G_PI;
    double per_pixel = (double)(SIGHT_REACH * SIGHT_REACH) * pixels_each / pixels;
    double of_all = (double)all->task.n_photons / (double)all->first;
    return per_pixel * reflected * reflected * of_all * (double)all->task.n_photons /
           (double)all->task.share->discs;
}

static void sum_noise(const trials *all)
{
    aim_result *out = all->result;
    double scale = noise_scale(all);
    trial_noise sum = {0};
    for (size_t i = 0; i < all->n_arrived; i++) {
        const trial_noise *noise = &all->noise[all->n_known + i];
        sum.of_paths += noise->of_paths;
        sum.seen += noise->seen;
        sum.unseen += noise->unseen;
        for (int k = 0; k < AIM_SHARES; k++)
            sum.left[k] += noise->left[k];
    }
    out->noise = sum.of_paths * scale;
    out->unseen = sum.unseen > 0.0 ? sum.unseen / (sum.seen + sum.unseen) : 0.0;
    for (int k = 0; k < AIM_SHARES; k++)
        out->left[k] = sum.left[k] * scale;
}

/* What the trials of a round brought, and how much denser than uniform ones they
   were where it counts. */
static void note_result(const trials *all)
{
    const scene *s = all->task.scene;
    guint n_lights = s->lights->len;
    g_autofree double *value = g_new0(double, n_lights);
    g_autofree double *dense = g_new0(double, n_lights);
    aim_result *out = all->result;
    g_free(out->boost);
    out->boost = g_new(float, n_lights);
    for (size_t i = 0; i < all->n_arrived; i++) {
        const emission_record *r = &all->records[all->n_known + i];
        float u_light = r->u[0];
        size_t from = distribution_sample(&s->caustic_power, &u_light);
        value[from] += (double)r->value;
        dense[from] += (double)(r->value * r->density);
    }
    sum_noise(all);
    for (guint i = 0; i < n_lights; i++)
        out->boost[i] = value[i] > 0.0 ? (float)(dense[i] / value[i]) : 1.0f;
}

/* Photons without a guide tell less well what they are worth: before the guide is given
   up on, they must fall short by so much. */
#define CLEARLY 0.25

static bool is_worthless(const trials *all)
{
    return all->result && all->n_arrived >= TELLING_ARRIVALS &&
           all->result->noise < CLEARLY * all->least_noise;
}

static bool run_batch(trials *all, GError **error)
{
    trials batch = *all;
    batch.records += all->n_known + all->n_arrived;
    batch.noise += all->n_known + all->n_arrived;
    const size_t n = all->each / BATCHES;
    if (!parallel_for(n, CHUNK, (unsigned)all->task.how->threads, all->task.cancel,
                      run_trials, &batch)) {
        error_set(error, ERROR_CANCELLED, "cancelled");
        return false;
    }
    all->n_arrived += keep_arrivals(batch.records, batch.noise, n);
    all->first += n;
    if (all->result)
        note_result(all);
    return true;
}

/* Traces trial photons of one round until enough arrived, and teaches the guide by those
   of all rounds: what is rare is learned from the few that ever found it. */
static bool run_round(trials *all, emission_guide *guide, uint32_t round, GError **error)
{
    size_t limit = round == 0 ? all->most : all->each;
    all->task.pass = TRIAL_PASS + round;
    all->task.w = scene_trial_wavelengths(all->task.scene, round);
    all->first = all->n_arrived = 0;
    do {
        if (!run_batch(all, error))
            return false;
    } while (!is_worthless(all) &&
             (all->first < all->each ||
              (all->first < limit && all->n_arrived < ENOUGH_ARRIVALS)));
    all->n_known += all->n_arrived;
    emission_guide_learn(guide, all->records, all->n_known);
    return true;
}

static bool learn(trials *all, emission_guide *guide, GError **error)
{
    size_t n = ROUNDS * all->each + ENOUGH_ARRIVALS;
    all->records = big_alloc(n, sizeof *all->records, "trial photons", error);
    all->noise =
        all->records ? big_alloc(n, sizeof *all->noise, "trial photons", error) : NULL;
    bool ok = all->noise != NULL;
    for (uint32_t round = 0; round < ROUNDS && ok && !is_worthless(all); round++)
        ok = run_round(all, guide, round, error);
    big_free(all->records);
    big_free(all->noise);
    return ok;
}

/* Trials of a round, and of the first one if hardly any arrives. */
static void set_effort(trials *all, const aim_effort *effort)
{
    double wanted = effort ? effort->samples / SAMPLES_PER_TRIAL : (double)INFINITY;
    all->each = (size_t)CLAMP(wanted, LEAST_TRIALS, TRIALS);
    wanted *= (double)SAMPLES_PER_TRIAL / SAMPLES_PER_FIRST_TRIAL;
    all->most = (size_t)CLAMP(wanted, LEAST_TRIALS, MAX_TRIALS);
    all->least_noise = effort ? effort->least_noise : 0.0;
    all->task.n_photons = all->each;
}

bool aim_caustics(transport_plan *plan, const aim_effort *effort, aim_result *result,
                  const cancel_flag *cancel, GError **error)
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
                .photon_class = PHOTON_CAUSTIC,
                .guide = guide,
                .share = plan->shares ? &plan->share : NULL,
                .cancel = cancel,
            },
    };
    all.most_reach = most_reach(visible);
    set_effort(&all, effort);
    if (!learn(&all, guide, error))
        return false;
    plan->guide = g_steal_pointer(&guide);
    return true;
}
