/*
 * Radii without guessing: a pilot pass of few photons tells how dense they lie, and from
 * that the radius that holds the wanted number of photons in a full pass follows by area,
 *
 *     r = r_k sqrt(wanted / k · N_pilot / N),
 *
 * r_k being the distance to the k-th nearest pilot photon; of light with edges a half or
 * a quarter of them tell where they lie clearly closer than all. It is kept for places all
 * over the scene: a caustic's focus gets a small radius, the faint light around it a large
 * one. Passes shrink all of them alike, so the estimate converges as with one radius
 * (Knaus & Zwicker 2011). Everything scales with the scene: in millimetres and in metres
 * it gets the same radius in pixels.
 *
 * Photons in a medium are counted in a ball, r = r_k (wanted / k · N_pilot / N)^(1/3); a
 * ray crosses the discs of more of them, all along its way.
 *
 * No radius is finer than a pixel, of the place that it is for: a table may stand at a
 * window, and most pixels be of a landscape where they are metres wide.
 */
#include "math/median.h"
#include "transport/photonmap/photonmap.h"
#include "transport/visible.h"
#include "transport/work.h"

/* Photons wanted within the radius: what decides between noise, which passes take away,
   and blur, which they hardly do. Of light with edges in each pass; of indirect light,
   which is smooth by nature, summed over all.

   Shared among all passes, too, 16 times as many and no fewer than 9 in one, caustics
   were blurred where passes are few and noisy where they are many: relMSE of water by
   auto with 1, 2, 8, 64 and 400 passes is .79, .87, .93, .98 and .99 of what it was, raw
   .79, .99, 1.06, .74, .80; of two boxes by photons in one map with 4 and 64 passes .73
   to 1.02, raw .53 to 1.12; in five other scenes .95 to 1.01 (with 17.3). With half as
   many of caustics, in water with 2, 8 and 16 passes, .85, 1.02, 1.08, raw up to 1.2 (128
   x 128, 24576 photons, one to three seeds). That of indirect light by photon mapping is
   the same with any of these, since its radii are the widest there may be. */
static const double photons_wanted[N_PHOTON_CLASSES] = {37.5, 12000.0, 18.75};

static bool is_smooth(const settings *how, photon_class c)
{
    return c == PHOTON_INDIRECT && !settings_one_map(how);
}

static double wanted_in_pass(const settings *how, photon_class c)
{
    if (c == PHOTON_CAUSTIC)
        return photons_wanted[c];
    if (!is_smooth(how, c))
        return photons_wanted[PHOTON_DIRECT];
    const double smooth = photons_wanted[PHOTON_INDIRECT];
    double passes = fmax(settings_planned_passes(how), 1.0);
    /* At least half of what chance alone adds to all or takes from them: fewer would end
       as noise. */
    return fmax(smooth / passes, 0.5 * sqrt(smooth));
}

/* In the ball around a photon in a medium: rays cross many. With a tenth, a third, three
   and ten times as many relMSE at equal time is 1.04, 1.02, 1.02 and 1.01 of what it is
   (sppm in six fogs, 128 x 128, .5 to 2 s; shown 1.01, .99, 1.02 and 1.00). */
static double wanted_in_ball(void)
{
    return 0.5 * photons_wanted[PHOTON_CAUSTIC];
}

/* Beside a bright spot, radii are as wide as it takes to reach the wanted photons in it:
   this is light that is not there, in proportion to their share of all. So of a caustic's
   photons in a map no more are wanted than this share, and at least one. With twice as
   much, and with no bound, relMSE x time is 1.2 times as much in scenes/ring by photon
   mapping, 0.99 to 1.06 in five other scenes and by auto; with half as much it is 0.9 to
   1.02, but 1.3 at a window by auto, where one seed of three turned the plan (128 x 128,
   8 passes). */
#define MOST_SHARE (1.0 / 200.0)

typedef struct pilot {
    transport_plan *plan;
    wavelengths w;
    point_set *sight; /* over the plan's */
} pilot;

/* A bound of a class' radii, what turns the pilot's distances into radii, and what stands
   for them where it tells of none. */
typedef struct radius_rule {
    double scale, largest, untold;
    bool has_edges;
    const pilot *pilot;
    const photon_map *map; /* of the class' photons */
} radius_rule;

/* The finest radius of use at p: what is finer than a pixel cannot be seen. */
static double least_radius(const radius_rule *rule, vec3 p, point_hits *hits)
{
    const pilot *by = rule->pilot;
    if (!point_set_nearest(by->sight, p, 1, INFINITY, hits) || hits->n == 0)
        return 0.0;
    return (double)by->plan->sight[hits->index[0]].pixel;
}

/* By the distance to the k-th nearest photon of the pilot; 0: there are none. */
static float radius_by(const void *data, vec3 p, float distance, point_hits *hits)
{
    const radius_rule *rule = data;
    if (!(distance > 0.0f))
        return (float)rule->largest;
    double least = least_radius(rule, p, hits);
    return (float)fmin(fmax(rule->scale * (double)distance, least), rule->largest);
}

static bool nearest_photons(const void *data, vec3 p, point_hits *hits)
{
    const radius_rule *rule = data;
    return photon_map_nearest(rule->map, p, RADIUS_NEAREST, INFINITY, NULL, hits);
}

/* Radii at some of the photons. */
static radius_cache *cache_radii(const radius_rule *rule, GError **error)
{
    const photon_store *store = photon_map_store(rule->map);
    size_t n = MIN(store->n, MOST_PLACES);
    vec3 *places = g_aligned_alloc0(MAX(n, 1), sizeof *places, 16);
    for (size_t i = 0; i < n; i++)
        places[i] = photon_store_get(store, radius_place(i, store->n)).p;
    const radius_source source = {nearest_photons, radius_by, rule, rule->has_edges,
                                  rule->pilot->plan->cancel};
    unsigned threads = (unsigned)rule->pilot->plan->how.threads;
    radius_cache *cache = radius_cache_build(places, n, &source, threads, error);
    g_aligned_free(places);
    return cache;
}

/* The median over the places where the camera looks or, for caustics and in media, where
   photons are. */
static bool typical_radius(const radius_rule *rule, const radius_cache *cache,
                           bool at_photons, double *typical, GError **error)
{
    const transport_plan *plan = rule->pilot->plan;
    const photon_store *store = photon_map_store(rule->map);
    size_t n = at_photons ? MIN(store->n, MOST_PLACES) : plan->n_sight;
    float untold = (float)rule->untold;
    float *radii = g_new0(float, n + 1);
    point_hits hits = {0};
    for (size_t i = 0; i < n; i++)
        radii[i] = at_photons
                       ? radius_cache_nth(cache, i)
                       : radius_cache_at(cache, plan->sight[i].p, untold, NULL, &hits);
    *typical = store->n > 1 && n > 0 ? (double)median(radii, n) : rule->untold;
    bool refused = hits.refused;
    point_hits_clear(&hits);
    g_free(radii);
    return !refused || point_hits_refuse(error);
}

/* The photons of the pilot, on surfaces and in media. */
typedef struct pilot_maps {
    photon_map *on_surfaces, *in_media;
    uint64_t n_emitted;
} pilot_maps;

static void pilot_maps_clear(pilot_maps *maps)
{
    photon_map_free(maps->on_surfaces);
    photon_map_free(maps->in_media);
}

static photon_map *map_of(photon_store *from, unsigned threads, GError **error)
{
    photon_store store = *from;
    *from = (photon_store){0};
    return photon_map_build(MAP_KDTREE, &store, 0.0f, (workers){.threads = threads},
                            error);
}

/* Of all classes that are sent; the nearest ones of each are asked for. With a quarter of
   these shares the shown squared error is 1.03 times as much in 22 scenes, 1.08 by sppm
   in twelve, 1.3 where few land: of small panes in the sun (256 x 256, 1.2 s, three
   seeds); with twice as many .99. */
static uint64_t n_pilots(const transport_plan *plan, photon_class c)
{
    int n_classes = 0;
    for (int i = 0; i < N_PHOTON_CLASSES; i++)
        n_classes += plan->n_photons[i] > 0;
    double each = plan_photon_rays(plan) + PHOTON_RAYS;
    uint32_t n = plan_trials_for(plan, 2.0, each * n_classes, MOST_PILOTS / 2);
    return MIN(plan->n_photons[c], n);
}

static bool send_pilot(const pilot *p, photon_class c, const cancel_flag *cancel,
                       pilot_maps *out, GError **error)
{
    transport_plan *plan = p->plan;
    unsigned threads = (unsigned)plan->how.threads;
    trace_task task = {
        .scene = plan->scene,
        .how = &plan->how,
        .w = p->w,
        .pass = plan_trial_pass(TRIAL_RADII),
        .photon_class = c,
        .casters = plan->casters,
        .guide = plan->guide[c],
        .mis = plan->uses_mis ? &plan->mis : NULL,
        .n_photons = n_pilots(plan, c),
        .cancel = cancel,
    };
    trace_result traced;
    *out = (pilot_maps){.n_emitted = task.n_photons};
    if (!photon_trace(&task, false, &traced, error))
        return false;
    plan_note_photons(plan, (double)task.n_photons, (double)traced.n_rays);
    out->on_surfaces = map_of(&traced.photons, threads, error);
    if (out->on_surfaces)
        out->in_media = map_of(&traced.in_media, threads, error);
    trace_result_clear(&traced);
    return out->in_media != NULL;
}

/* Of n in a map of a slice of time. */
static double wanted_in_reach(const transport_plan *plan, photon_class c, double n)
{
    double wanted = wanted_in_pass(&plan->how, c);
    return c == PHOTON_CAUSTIC ? fmin(wanted, fmax(MOST_SHARE * n, 1.0)) : wanted;
}

/* How much denser than those of the pilot photons lie in the maps of a pass. */
static double density_over_pilot(const pilot *p, photon_class c, const pilot_maps *maps)
{
    int n_slices = time_slices_of(p->plan->scene, &p->plan->how);
    return (double)p->plan->n_photons[c] / n_slices / (double)maps->n_emitted;
}

/* Where no two photons of a pilot landed nothing asks for width; but if with one more all
   in the map would still be fewer than are wanted in a disc, it is as wide as it may be.
 */
static double untold_radius(const transport_plan *plan, const photon_map *map,
                            double density, double wanted)
{
    double most = (double)(photon_map_store(map)->n + 1) * density;
    return most < wanted ? widest_radius(plan) : unknown_radius(plan);
}

static bool choose_on_surfaces(pilot *p, photon_class c, const pilot_maps *maps,
                               GError **error)
{
    transport_plan *plan = p->plan;
    const photon_map *map = maps->on_surfaces;
    double density = density_over_pilot(p, c, maps);
    double in_map = (double)photon_map_store(map)->n * density;
    double wanted = wanted_in_reach(plan, c, in_map);
    const radius_rule rule = {
        .scale = sqrt(wanted / RADIUS_NEAREST / density),
        .largest = widest_radius(plan),
        .untold = untold_radius(plan, map, density, wanted),
        .has_edges = !is_smooth(&plan->how, c),
        .pilot = p,
        .map = map,
    };
    plan->radius_cache[c] = cache_radii(&rule, error);
    if (!plan->radius_cache[c])
        return false;
    if (!typical_radius(&rule, plan->radius_cache[c], c == PHOTON_CAUSTIC,
                        &plan->radius[c], error))
        return false;
    if (plan->how.one_radius)
        g_clear_pointer(&plan->radius_cache[c], radius_cache_free);
    return true;
}

static bool choose_in_media(pilot *p, photon_class c, const pilot_maps *maps,
                            GError **error)
{
    transport_plan *plan = p->plan;
    const photon_map *map = maps->in_media;
    double density = density_over_pilot(p, c, maps);
    const radius_rule rule = {
        .scale = cbrt(wanted_in_ball() / RADIUS_NEAREST / density),
        .largest = widest_radius(plan),
        .untold = untold_radius(plan, map, density, wanted_in_ball()),
        .pilot = p,
        .map = map,
    };
    plan->radius_cache_in_media[c] = cache_radii(&rule, error);
    if (!plan->radius_cache_in_media[c])
        return false;
    return typical_radius(&rule, plan->radius_cache_in_media[c], true,
                          &plan->radius_in_media[c], error);
}

static bool choose_radius(pilot *p, photon_class c, const cancel_flag *cancel,
                          GError **error)
{
    pilot_maps maps = {0};
    bool ok = send_pilot(p, c, cancel, &maps, error) &&
              choose_on_surfaces(p, c, &maps, error) &&
              (!scene_has_media(p->plan->scene) || choose_in_media(p, c, &maps, error));
    pilot_maps_clear(&maps);
    return ok;
}

bool photonmap_choose_radii(transport_plan *plan, const cancel_flag *cancel,
                            GError **error)
{
    bool ok = true;
    pilot p = {.plan = plan, .w = scene_trial_wavelengths(plan->scene, 0)};
    if (!(plan->how.radius > 0.0)) {
        plan_look(plan);
        p.sight = visible_index(plan, error);
        ok = p.sight != NULL;
    }
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++) {
        plan->radius[c] = plan->radius_in_media[c] = plan->how.radius;
        if (!(plan->how.radius > 0.0) && plan->n_photons[c] > 0)
            ok = choose_radius(&p, (photon_class)c, cancel, error);
    }
    point_set_free(p.sight);
    return ok;
}
