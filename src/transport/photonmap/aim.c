#include "transport/photonmap/aim.h"

#include "base/memory.h"
#include "scene/advance.h"
#include "transport/visible.h"
#include "transport/work.h"

#include <float.h>

/* What a trial photon adds to the noise that paths would have, and to what they and the
   photons have of it with shares of all photons. */
typedef struct trial_noise {
    double of_paths, left[N_SHARES], alike[N_SHARES];
    double seen, unseen; /* flux that landed in the camera's sight, and out of it */
    uint32_t rays, landings;
} trial_noise;

/* The trials of a round as they were and, weighed, as they had been without the guide:
   sums of value, squared, of rays, and how often they landed. */
typedef struct guide_trial {
    double n, square, rays, landings, square_without, rays_without, landings_without;
} guide_trial;

/* What the trials of a round share. */
typedef struct trials {
    trace_task task;
    transport_plan *plan;
    point_set *visible;       /* over plan->sight */
    float most_reach;         /* of all of them, m */
    double pixels_each;       /* that a visible point stands for */
    emission_record *records; /* one per trial, value 0 if it did not arrive */
    trial_noise *noise;       /* one per trial of the round */
    size_t n_known;           /* records of earlier rounds ... */
    size_t n_arrived;         /* ... and behind them of this one */
    size_t each;              /* trials of a round */
    emission_guide *guide;    /* by the rounds so far; NULL: none */
    double grant, spent;      /* rays, of all rounds */
    guide_trial round;
    double tried, brought; /* photons of all rounds, and what they brought, squared */
    aim_result *result;    /* NULL: not asked for */
    atomic_bool refused;   /* memory was */
} trials;

static bool is_guided(const transport_plan *plan, photon_class c)
{
    return plan->how.class_emission[c] == EMISSION_GUIDED;
}

/* ---- Where the camera looks ---- */

static double pixels_each(const transport_plan *plan)
{
    const film_settings *film = &plan->view->film;
    return (double)film->width * (double)film->height / (double)MAX(plan->n_sight, 1);
}

/* How far around a visible point all is in sight, m: the mean distance of its neighbours,
   which leaves a gap of a few per cent. */
static float reach_of(const transport_plan *plan, const visible_point *seen)
{
    return seen->pixel * sqrtf((float)pixels_each(plan));
}

static float most_reach(const transport_plan *plan)
{
    float most = 0.0f;
    for (size_t i = 0; i < plan->n_sight; i++)
        most = maxf(most, reach_of(plan, &plan->sight[i]));
    return most;
}

/* Where the camera sees a photon land. */
typedef struct landing {
    float area;      /* of what shows it, m²; 0: out of sight */
    float reflected; /* of its light, toward the camera, sr⁻¹ */
    vec2 raster;
} landing;

/* By the visible point that p lies by. */
static landing land_at(const trials *all, vec3 p, point_hits *hits)
{
    if (!point_set_nearest(all->visible, p, 1, all->most_reach, hits) || hits->n == 0)
        return (landing){0};
    const visible_point *seen = &all->plan->sight[hits->index[0]];
    float reach = reach_of(all->plan, seen);
    if (!(hits->distance2[0] < reach * reach))
        return (landing){0};
    return (landing){reach * reach, seen->albedo / (float)G_PI, seen->raster};
}

/* The same of a point in a medium, which is in sight if nothing stands before it and
   light comes from there to the eye; scattered alike to all sides. */
static landing land_in_medium(const trials *all, const surface_hit *hit)
{
    const trace_task *task = &all->task;
    const film_settings *film = &all->plan->view->film;
    const camera *c = &all->plan->view->camera;
    camera_connection eye;
    if (!camera_connects(c) ||
        !camera_connect(c, hit->p, (vec2){0.5f, 0.5f}, hit->time, &eye) ||
        !(eye.raster.x >= 0.0f && eye.raster.x < (float)film->width) ||
        !(eye.raster.y >= 0.0f && eye.raster.y < (float)film->height))
        return (landing){0};
    ray r = hit_ray_to(hit, eye.direction, eye.distance);
    static const bsdf_options options = {0};
    const scene_look look = {task->scene, &task->w, &options, -1};
    spectrum share;
    if (!scene_sees(&look, &r, &share))
        return (landing){0};
    float transmittance = spectrum_mean(share);
    float pixels = (float)all->pixels_each;
    if (transmittance < DEFENSIVE_SHARE)
        return (landing){0};
    return (landing){pixels * camera_pixel_area(c, eye.distance),
                     phase_henyey_greenstein(0.0f, 0.0f), eye.raster};
}

/* ---- Trials ---- */

typedef struct trial {
    const trials *all;
    point_hits *hits;
    float value;
    trial_noise noise;
} trial;

/* A path from the eye that finds by itself what a photon of flux Φ and share w brings has
   a density of (1 - w) / w of that of merging with it. So in a pixel of area a its square
   adds Φ² w / (1 - w) / a, up to factors that are the same for all. The w-th part of
   photons survives with all of Φ, and each stands for 1 / w of them. Where photons help,
   with m times the density, all of them together leave the 1 / (1 + m)-th part: of that
   another 1 / (1 + m)-th to paths. */
static void add_noise(trial_noise *sum, const photon_event *event, const landing *at,
                      double weight)
{
    double w = (double)event->mis_weight, odds = w / fmax(1.0 - w, (double)FLT_EPSILON);
    double seen = (double)(spectrum_mean(event->flux) * at->reflected);
    double noise =
        weight * seen * seen / (fmax(1.0 - w, (double)FLT_EPSILON) * (double)at->area);
    sum->of_paths += noise;
    for (int i = 0; i < N_SHARES; i++) {
        double m = plan_share(i) * odds, left = noise / (1.0 + m);
        sum->left[i] += left / (1.0 + m);
        sum->alike[i] += left * m / (1.0 + m);
    }
}

/* A caustic is worth what the camera sees of it. */
static void note_caustic(const photon_event *event, float flux, trial *t)
{
    landing at = event->hit->shape == NO_INDEX ? land_in_medium(t->all, event->hit)
                                               : land_at(t->all, event->p, t->hits);
    bool seen = at.area > 0.0f;
    const sketch *s = t->all->plan->sketch;
    t->value += flux * (seen ? 1.0f : DEFENSIVE_SHARE);
    if (seen && s)
        add_noise(&t->noise, event, &at, sketch_weight(s, at.raster, SIZE_MAX, t->hits));
    *(seen ? &t->noise.seen : &t->noise.unseen) += (double)flux;
}

static void note_arrival(const photon_event *event, void *data)
{
    trial *t = data;
    t->noise.rays += event->kind == PHOTON_EMITTED || event->kind == PHOTON_SCATTERED;
    float flux = spectrum_mean(event->flux);
    if (event->kind != PHOTON_STORED || !isfinite(flux))
        return;
    t->noise.landings++;
    if (t->all->task.photon_class == PHOTON_CAUSTIC)
        note_caustic(event, flux, t);
    else
        t->value += flux;
}

static void run_trials(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    trials *all = data;
    point_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        emission_record *record = &all->records[all->n_known + i];
        trial t = {.all = all, .hits = &hits};
        record->density = photon_start_point(&all->task, i, record->u);
        photon_tell(&all->task, i, note_arrival, &t);
        record->value = t.value;
        all->noise[i] = t.noise;
    }
    if (hits.refused)
        atomic_store(&all->refused, true);
    point_hits_clear(&hits);
}

/* A photon that is drawn with density d instead of uniformly brings 1/d of it. */
static void add_round(guide_trial *sum, const emission_record *record,
                      const trial_noise *of)
{
    double v = (double)record->value, d = (double)record->density;
    sum->n++;
    sum->square += v * v;
    sum->rays += of->rays;
    sum->landings += of->landings;
    sum->square_without += v * v * d;
    sum->rays_without += of->rays / d;
    sum->landings_without += of->landings / d;
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

/* What the sum of all trials' parts is to be multiplied with to be a camera sample's. */
static double noise_scale(const trials *all)
{
    const film_settings *film = &all->plan->view->film;
    double pixels = (double)film->width * (double)film->height;
    return all->pixels_each / pixels * (double)all->task.n_photons /
           (double)all->task.mis->discs;
}

/* The loudest photon counts no more than the next: one that a path finds by a rare way
   may be louder than all others together, and tells nothing of them (half of the noise of
   a coffee maker's caustics, of a hundred that came in sight). */
static void hush_loudest(trial_noise *noise, size_t n)
{
    size_t loudest = 0;
    double second = 0.0;
    for (size_t i = 1; i < n; i++) {
        bool louder = noise[i].of_paths > noise[loudest].of_paths;
        second = fmax(second, noise[louder ? loudest : i].of_paths);
        loudest = louder ? i : loudest;
    }
    if (n == 0 || !(noise[loudest].of_paths > second))
        return;
    double by = second / noise[loudest].of_paths;
    noise[loudest].of_paths = second;
    for (int k = 0; k < N_SHARES; k++) {
        noise[loudest].left[k] *= by;
        noise[loudest].alike[k] *= by;
    }
}

static void sum_noise(const trials *all)
{
    aim_result *out = all->result;
    double scale = noise_scale(all), seen = 0.0, unseen = 0.0;
    const trial_noise *noise = all->noise;
    hush_loudest(all->noise, all->n_arrived);
    *out = (aim_result){.boost = out->boost};
    for (size_t i = 0; i < all->n_arrived; i++) {
        out->noise += noise[i].of_paths * scale;
        seen += noise[i].seen;
        unseen += noise[i].unseen;
        for (int k = 0; k < N_SHARES; k++) {
            out->left[k] += noise[i].left[k] * scale;
            out->alike[k] += noise[i].alike[k] * scale;
        }
    }
    out->rays = all->round.rays / fmax(all->round.n, 1.0);
    out->unseen = unseen > 0.0 ? unseen / (seen + unseen) : 0.0;
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
        size_t from = distribution_sample(&all->task.casters->power, &u_light);
        value[from] += (double)r->value;
        dense[from] += (double)(r->value * r->density);
    }
    sum_noise(all);
    for (guint i = 0; i < n_lights; i++)
        out->boost[i] = value[i] > 0.0 ? (float)(dense[i] / value[i]) : 1.0f;
}

/* Traces the trial photons of one round, and teaches a new guide by those of all rounds:
   what is rare is learned from the few that ever found it. */
static bool run_round(trials *all, uint32_t round, GError **error)
{
    emission_record *records = all->records + all->n_known;
    all->task.n_photons = all->each;
    all->task.guide = all->guide;
    all->task.pass = plan_trial_pass(TRIAL_GUIDE + round);
    all->task.w = scene_trial_wavelengths(all->task.scene, round);
    all->round = (guide_trial){0};
    const workers by = {(unsigned)all->task.how->threads, all->task.cancel};
    if (!parallel_work(all->each, RAYS_AT_ONCE, by, run_trials, all, error))
        return false;
    if (atomic_load(&all->refused) && !point_hits_refuse(error))
        return false;
    for (size_t i = 0; i < all->each; i++)
        add_round(&all->round, &records[i], &all->noise[i]);
    /* Of one photon, not of its share of all. */
    double alone = (double)all->each * (double)all->each;
    all->tried += (double)all->each;
    all->brought += all->round.square_without * alone;
    all->n_arrived = keep_arrivals(records, all->noise, all->each);
    plan_note_photons(all->plan, all->round.n, all->round.rays);
    all->spent += all->round.rays + all->round.n;
    if (all->result)
        note_result(all);
    all->n_known += all->n_arrived;
    if (is_guided(all->plan, all->task.photon_class)) {
        emission_guide_free(all->guide);
        all->guide = emission_guide_learn(all->records, all->n_known);
    }
    return true;
}

/* Photons of the next round: no more than before, and as many as the grant still allows
   by what the last ones cost; light that is led into glass takes more rays than any. */
static size_t count_trials(const trials *all)
{
    double each = 1.0 + all->round.rays / fmax(all->round.n, 1.0);
    double n = (all->grant - all->spent) / each;
    return (size_t)CLAMP(n, (double)LEAST_TRIALS, (double)all->each);
}

/* Uniform photons teach the guide, and as many drawn with it tell what it is worth. */
static bool learn(trials *all, GError **error)
{
    all->records = big_alloc(2 * all->each, sizeof *all->records, "trial photons", error);
    all->noise = all->records
                     ? big_alloc(all->each, sizeof *all->noise, "trial photons", error)
                     : NULL;
    bool ok = all->noise != NULL;
    if (ok && is_guided(all->plan, all->task.photon_class)) {
        ok = run_round(all, 0, error);
        all->each = count_trials(all);
    }
    ok = ok && run_round(all, 1, error);
    big_free(all->records);
    big_free(all->noise);
    return ok;
}

/* By the last round's photons: whether those that are drawn with the guide are clearly
   less noisy for their rays than uniform ones; of caustics, which are sharp, if they are
   so at all: clearly there, too, water by auto has 1.2 times the error (256 x 256, 1 and
   3 s, three seeds). An estimate has of each photon the square of its flux. */
static bool guide_pays(const trials *all)
{
    const bool of_caustics = all->task.photon_class == PHOTON_CAUSTIC;
    const guide_trial *round = &all->round;
    double n = fmax(round->n, 1.0);
    plan_cost with = {round->square / n, round->rays / n};
    plan_cost without = {round->square_without / n, round->rays_without / n};
    double least = of_caustics ? 1.0 : CLEARLY_BETTER;
    bool pays = with.variance * with.rays < least * without.variance * without.rays;
    if (of_caustics)
        plan_note(all->plan, "guided emission", without, with, pays);
    return pays;
}

/* A round has up to four times the pilots. With as many as them the variance of caustics
   is 1.22 times as much in scenes/ring, and twice as much at the foot of its wall, where
   few arrive (640 x 480, 12 passes, five seeds). */
static trials trials_of(transport_plan *plan, photon_class c, const cancel_flag *cancel)
{
    /* A caustic's photon ends at the first diffuse surface, others go as far as paths. */
    double rays = c == PHOTON_CAUSTIC ? PHOTON_RAYS : 1.0 + SAMPLE_RAYS;
    return (trials){
        .plan = plan,
        .each = plan_trials_for(plan, 2.0, 2.0 * rays, 2 * MOST_PILOTS),
        .grant = plan_grant(plan, 2.0),
        .task =
            {
                .scene = plan->scene,
                .how = &plan->how,
                .photon_class = c,
                .casters = plan->casters,
                .mis = plan->uses_mis ? &plan->mis : NULL,
                .cancel = cancel,
            },
    };
}

/* What a photon takes, in rays: it is sent and traced, and wherever it lands it is kept
   and weighed. Weighing all that landed took 2.0 to 3.8 rays for each of them, the last
   pass of twelve scenes where few were caustic ones (256 x 256, spp 1), as many as a
   camera sample. */
static double price_of(double rays, double landings)
{
    return rays + 1.0 + SAMPLE_RAYS * landings;
}

/* What was learned goes to the plan, the guide if it pays. */
static void keep_what_pays(trials *all)
{
    const photon_class c = all->task.photon_class;
    const guide_trial *round = &all->round;
    transport_plan *plan = all->plan;
    double n = fmax(round->n, 1.0);
    bool pays = is_guided(plan, c) && guide_pays(all);
    plan->brought[c] = all->brought / fmax(all->tried, 1.0);
    plan->price[c] = pays
                         ? price_of(round->rays / n, round->landings / n)
                         : price_of(round->rays_without / n, round->landings_without / n);
    if (pays) {
        plan->brought[c] *= round->square / round->square_without;
        plan->guide[c] = g_steal_pointer(&all->guide);
    } else if (all->result) {
        g_clear_pointer(&all->result->boost, g_free);
    }
}

static bool aim(trials *all, GError **error)
{
    bool ok = learn(all, error);
    if (ok)
        keep_what_pays(all);
    emission_guide_free(all->guide);
    return ok;
}

bool aim_photons(transport_plan *plan, photon_class c, const cancel_flag *cancel,
                 GError **error)
{
    if (c == PHOTON_CAUSTIC)
        return aim_caustics(plan, NULL, cancel, error);
    trials all = trials_of(plan, c, cancel);
    return aim(&all, error);
}

bool aim_caustics(transport_plan *plan, aim_result *result, const cancel_flag *cancel,
                  GError **error)
{
    const photon_class c = PHOTON_CAUSTIC;
    if (plan->n_photons[c] == 0 || !(is_guided(plan, c) || result))
        return true;
    if (!transport_plan_find_casters(plan, error))
        return false;
    plan_look(plan);
    g_autoptr(point_set) visible = visible_index(plan, error);
    if (!visible)
        return false;
    trials all = trials_of(plan, c, cancel);
    all.visible = visible;
    all.most_reach = most_reach(plan);
    all.pixels_each = pixels_each(plan);
    all.result = result;
    return aim(&all, error);
}
