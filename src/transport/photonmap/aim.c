#include "transport/photonmap/aim.h"

#include "base/memory.h"
#include "scene/advance.h"
#include "transport/visible.h"
#include "transport/work.h"

#include <float.h>

/* What a trial photon adds to the noise that paths would have, and how much denser
   photons are where it goes than paths that find the same. */
typedef struct trial_noise {
    double of_paths, odds;
    double seen, unseen; /* flux that landed in the camera's sight, and out of it */
    double alone;        /* flux that no path finds */
    float shown;         /* of it that came back where it was brightest ... */
    int at;              /* ... of visible points */
    uint32_t rays, landings;
} trial_noise;

/* The trials of a round as they were and, weighed, as they had been without the guide:
   sums of value, squared, of rays, and how often they landed. */
typedef struct guide_trial {
    double n, square, rays, landings, square_without, rays_without, landings_without;
} guide_trial;

/* Rounds of trial photons, each with random numbers and wavelengths of its own: few come
   first, uniform ones next. */
enum { ROUND_UNIFORM, ROUND_LAST, ROUND_FEW };

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
    return (double)film->width * (double)film->height / (double)MAX(plan->n_looks, 1);
}

/* How far around a visible point all is in sight, m: the mean distance of its neighbours,
   which leaves a gap of a few per cent. */
static float reach_of(const transport_plan *plan, const visible_point *seen)
{
    return sqrtf(seen->area * (float)pixels_each(plan));
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
    int at; /* visible point; NO_INDEX: in a medium */
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
    return (landing){reach * reach, seen->albedo / (float)G_PI, seen->raster,
                     (int)hits->index[0]};
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
                     phase_henyey_greenstein(0.0f, 0.0f), eye.raster, NO_INDEX};
}

/* ---- Trials ---- */

typedef struct trial {
    const trials *all;
    point_hits *hits;
    float density, value;
    trial_noise noise;
} trial;

/* A path from the eye that finds by itself what a photon of flux Φ and share w brings has
   a density of (1 - w) / w of that of merging with it. So in a pixel of area a its square
   adds Φ² w / (1 - w) / a, up to factors that are the same for all. The w-th part of
   photons survives with all of Φ, and each stands for 1 / w of them; where they are d
   times as dense as w knows of, they carry a d-th and the odds are d times as high. */
static void add_noise(trial_noise *sum, const photon_event *event, const landing *at,
                      float density, double weight)
{
    double w = (double)event->mis_weight, others = fmax(1.0 - w, (double)FLT_EPSILON);
    double seen = (double)(spectrum_mean(event->flux) * at->reflected);
    sum->odds = w / others;
    sum->of_paths += weight * (double)density * seen * seen / (others * (double)at->area);
}

/* What a pixel shows of all light whose share w came with the photon. */
static void note_light(trial_noise *sum, const photon_event *event, const landing *at)
{
    float seen = spectrum_mean(event->flux) * at->reflected;
    float shown = seen / (at->area * event->mis_weight);
    if (at->at == NO_INDEX || !(shown > sum->shown))
        return;
    sum->shown = shown;
    sum->at = at->at;
}

/* A caustic is worth what the camera sees of it. */
static void note_caustic(const photon_event *event, float flux, trial *t)
{
    landing at = event->hit->shape == NO_INDEX ? land_in_medium(t->all, event->hit)
                                               : land_at(t->all, event->p, t->hits);
    bool seen = at.area > 0.0f;
    const sketch *s = t->all->plan->sketch;
    t->value += flux * (seen ? 1.0f : DEFENSIVE_SHARE);
    if (seen && s) {
        add_noise(&t->noise, event, &at, t->density,
                  sketch_weight(s, at.raster, SIZE_MAX, t->hits));
        note_light(&t->noise, event, &at);
    }
    *(seen ? &t->noise.seen : &t->noise.unseen) += (double)flux;
    if (event->mis_weight == 1.0f &&
        scene_light(t->all->task.scene, event->light)->is_delta)
        t->noise.alone += (double)flux;
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
        t.density = record->density = photon_start_point(&all->task, i, record->u);
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

/* What photons of the last round have with the guide, and uniform ones. An estimate has
   of each photon the square of its flux. */
static plan_cost with_guide(const trials *all)
{
    double n = fmax(all->round.n, 1.0);
    return (plan_cost){all->round.square / n, all->round.rays / n};
}

static plan_cost without_guide(const trials *all)
{
    double n = fmax(all->round.n, 1.0);
    return (plan_cost){all->round.square_without / n, all->round.rays_without / n};
}

/* Whether the first are clearly less noisy for their rays; of caustics, which are sharp,
   if they are so at all: clearly there, too, water by auto has 1.2 times the error (256 x
   256, 1 and 3 s, three seeds). */
static bool guide_pays(const trials *all)
{
    const plan_cost with = with_guide(all), without = without_guide(all);
    const photon_class c = all->task.photon_class;
    double least = c == PHOTON_CAUSTIC ? 1.0 : CLEARLY_BETTER;
    return is_guided(all->plan, c) &&
           with.variance * with.rays < least * without.variance * without.rays;
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
    if (n > 0)
        noise[loudest].of_paths = second;
}

/* Where photons help, with m times the density of paths, all of them together leave the
   1 / (1 + m)-th part of the noise: of that another 1 / (1 + m)-th to paths. */
static void add_left(aim_result *to, double noise, double odds)
{
    for (int k = 0; k < N_SHARES; k++) {
        double m = plan_share(k) * odds, left = noise / (1.0 + m);
        to->left[k] += left / (1.0 + m);
        to->alike[k] += left * m / (1.0 + m);
    }
}

static void sum_noise(const trials *all, bool guided)
{
    aim_result *out = all->result;
    double scale = noise_scale(all), seen = 0.0, unseen = 0.0;
    hush_loudest(all->noise, all->n_arrived);
    *out = (aim_result){.boost = out->boost};
    for (size_t i = 0; i < all->n_arrived; i++) {
        const trial_noise *of = &all->noise[i];
        double density = guided ? (double)all->records[all->n_known + i].density : 1.0;
        out->noise += of->of_paths * scale;
        out->alone += of->alone;
        seen += of->seen;
        unseen += of->unseen;
        add_left(out, of->of_paths * scale, of->odds * density);
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
    sum_noise(all, guide_pays(all));
    for (guint i = 0; i < n_lights; i++)
        out->boost[i] = value[i] > 0.0 ? (float)(dense[i] / value[i]) : 1.0f;
}

/* Traces the trial photons of one round. */
static bool trace_round(trials *all, uint32_t round, GError **error)
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
    plan_note_photons(all->plan, all->round.n, all->round.rays);
    all->spent += all->round.rays + all->round.n;
    return true;
}

/* The picture's sketch gets the caustics of a round. */
static bool sketch_caustics(const trials *all, GError **error)
{
    const transport_plan *plan = all->plan;
    if (!plan->sketch || plan->n_sight == 0)
        return true;
    g_autofree vec2 *places = g_new(vec2, plan->n_sight);
    g_autofree float *shown = g_new0(float, plan->n_sight);
    for (size_t i = 0; i < plan->n_sight; i++)
        places[i] = plan->sight[i].raster;
    for (size_t i = 0; i < all->each; i++)
        shown[all->noise[i].at] += all->noise[i].shown;
    return sketch_add_caustics(plan->sketch, places, shown, plan->n_sight, plan->n_looks,
                               error);
}

/* What a round found; a new guide learns from those of all rounds: what is rare is known
   from the few that ever found it. */
static void learn_from_round(trials *all)
{
    /* Of one photon, not of its share of all. */
    double alone = (double)all->each * (double)all->each;
    all->tried += (double)all->each;
    all->brought += all->round.square_without * alone;
    all->n_arrived = keep_arrivals(all->records + all->n_known, all->noise, all->each);
    if (all->result)
        note_result(all);
    all->n_known += all->n_arrived;
    if (is_guided(all->plan, all->task.photon_class)) {
        emission_guide_free(all->guide);
        all->guide = emission_guide_learn(all->records, all->n_known);
    }
}

/* Photons of each round that is to come: no more than before, and as many as the grant
   still allows by what the last ones cost. */
static size_t count_trials(const trials *all, double rounds)
{
    double each = 1.0 + all->round.rays / fmax(all->round.n, 1.0);
    double n = (all->grant - all->spent) / (each * rounds);
    return (size_t)CLAMP(n, (double)LEAST_TRIALS, (double)all->each);
}

/* What a photon costs is told by few: of a lamp in a globe each takes as many rays as it
   is led through glass, and the last round had what the first one left. */
static bool count_rays(trials *all, GError **error)
{
    const size_t most = all->each;
    all->each = MAX(most / LEAST_TRIALS, LEAST_TRIALS);
    bool ok = trace_round(all, ROUND_FEW, error);
    all->each = most;
    all->each = count_trials(all, 2.0);
    return ok;
}

/* Uniform photons teach the guide, and the sketch, */
static bool learn_uniform(trials *all, GError **error)
{
    if (!count_rays(all, error) || !trace_round(all, ROUND_UNIFORM, error) ||
        (all->result && !sketch_caustics(all, error)))
        return false;
    learn_from_round(all);
    all->each = count_trials(all, 1.0);
    return true;
}

/* and as many drawn with the guide tell what it is worth, and photons are. */
static bool learn(trials *all, GError **error)
{
    all->records = big_alloc(2 * all->each, sizeof *all->records, "trial photons", error);
    all->noise = all->records
                     ? big_alloc(all->each, sizeof *all->noise, "trial photons", error)
                     : NULL;
    bool ok = all->noise != NULL;
    if (ok && (all->result || is_guided(all->plan, all->task.photon_class)))
        ok = learn_uniform(all, error);
    ok = ok && trace_round(all, ROUND_LAST, error);
    if (ok)
        learn_from_round(all);
    big_free(all->records);
    big_free(all->noise);
    return ok;
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
    bool pays = guide_pays(all);
    if (c == PHOTON_CAUSTIC && is_guided(plan, c))
        plan_note(plan, "guided emission", without_guide(all), with_guide(all), pays);
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
