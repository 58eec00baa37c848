#include "transport/photonmap/photonmap.h"

#include "base/clock.h"
#include "base/memory.h"
#include "transport/photonmap/aim.h"
#include "transport/photonmap/photonmap_medium.h"
#include "transport/work.h"

/* ---- Planning: who gets how many photons ---- */

static bool needs_direct_map(const settings *how)
{
    return !how->direct_illumination || (how->final_gather && how->precompute_radiance);
}

static bool class_needed(const transport_plan *plan, photon_class c)
{
    if (!scene_is_lit(plan->scene))
        return false;
    if (settings_one_map(&plan->how))
        return c == PHOTON_INDIRECT &&
               (!plan->how.direct_illumination || plan->how.max_forward_bounces != 0);
    switch (c) {
    case PHOTON_DIRECT:
        return needs_direct_map(&plan->how);
    case PHOTON_CAUSTIC:
        return caustic_casters_are_lit(plan->casters);
    default:
        return plan->how.max_forward_bounces != 0;
    }
}

static bool class_shares(const transport_plan *plan, photon_class c)
{
    return class_needed(plan, c) && plan->how.class_photons[c] == 0;
}

/* What the photons of a class that shares them bring, over those of all: by the root of
   the mean square, since of an estimate that is the noise. 1 before trials have told. */
static double brings(const transport_plan *plan, photon_class c)
{
    double all = 0.0;
    for (int i = 0; i < N_PHOTON_CLASSES; i++) {
        bool shares = class_shares(plan, (photon_class)i);
        if (shares && plan->how.class_emission[i] != EMISSION_GUIDED)
            return 1.0;
        all += shares ? sqrt(plan->brought[i]) : 0.0;
    }
    return all > 0.0 ? sqrt(plan->brought[c]) / all : 1.0;
}

/* Classes that share photons get equal parts, for what brings little may be sharp; but
   what brings next to nothing as much less. With parts in proportion to what they bring
   photon mapping has 1.09 times the squared error, shown (.82 to 1.7, twelve scenes, 256
   x 256, 2 s, three seeds); with equal ones auto's maps have 1.4 times as much through a
   window, where no caustics are, and 1.1 in a long hall. */
static double weight_of(const transport_plan *plan, photon_class c)
{
    const double least = (double)DEFENSIVE_SHARE;
    return class_shares(plan, c) ? CLAMP(brings(plan, c) / least, least, 1.0) : 0.0;
}

void photonmap_share_photons(transport_plan *plan)
{
    uint64_t times = plan->how.photons_per_light ? plan->scene->lights->len : 1;
    double shared = (double)settings_photons(&plan->how), all = 0.0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        all += weight_of(plan, (photon_class)c);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        int64_t own = plan->how.class_photons[c];
        bool needed = class_needed(plan, (photon_class)c);
        double part = shared * weight_of(plan, (photon_class)c);
        int64_t n = own > 0 ? own : needed ? (int64_t)(part / all) : 0;
        plan->n_photons[c] = needed ? (uint64_t)MAX(n, 1) * times : 0;
    }
}

/* Trials of each class that is sent, by which photons are shared. */
static bool aim_all(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        if (plan->n_photons[c] > 0 && plan->how.class_emission[c] == EMISSION_GUIDED &&
            !aim_photons(plan, (photon_class)c, cancel, error))
            return false;
    photonmap_share_photons(plan);
    return true;
}

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    if (!transport_plan_find_casters(plan, error))
        return false;
    photonmap_share_photons(plan);
    double n_photons = 0.0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n_photons += (double)plan->n_photons[c];
    plan_ask(plan, n_photons);
    return (plan_is_tiny(plan) || aim_all(plan, cancel, error)) &&
           photonmap_choose_radii(plan, cancel, error);
}

/* ---- A pass ---- */

/* What one slice of a pass does for one class. */
typedef struct slice_task {
    const photonmap_pass *pass;
    int slice;
    photon_class c;
    uint64_t begin, end; /* of its photons; 0, 0: all */
} slice_task;

static double radius_of(const transport_plan *plan, photon_class c, uint32_t index)
{
    return photonmap_radius(plan->radius[c], plan->how.alpha, index);
}

static uint64_t n_in_slice(const photonmap_pass *pass, photon_class c)
{
    uint64_t n = pass->plan->n_photons[c];
    uint64_t n_slices = (uint64_t)pass->n_slices;
    uint64_t times = pass->how->photons_per_light ? pass->scene->lights->len : 1;
    return n > 0 ? MAX(n / times / n_slices, 1) * times : 0;
}

static trace_task trace_task_for(const slice_task *s, const cancel_flag *cancel)
{
    const photonmap_pass *pass = s->pass;
    uint64_t each = n_in_slice(pass, s->c);
    return (trace_task){
        .scene = pass->scene,
        .how = pass->how,
        .w = pass->w,
        .pass = pass->index,
        .photon_class = s->c,
        .casters = pass->plan->casters,
        .guide = pass->plan->guide[s->c],
        .mis = pass->plan->uses_mis ? &pass->mis : NULL,
        .n_photons = each,
        .first = each * (uint64_t)s->slice,
        .begin = s->begin,
        .end = s->end,
        .slice = s->slice,
        .n_slices = pass->n_slices,
        .cancel = cancel,
    };
}

static bool keeps_irradiance(const photonmap_pass *pass)
{
    return pass->how->final_gather && pass->how->precompute_radiance;
}

/* What a pass stores, and what it shows of itself where there is no picture. */
static bool trace_class(const slice_task *s, const cancel_flag *cancel,
                        trace_result *result, transport_counts *counts, GError **error)
{
    double start = clock_seconds();
    trace_task task = trace_task_for(s, cancel);
    const photon_supply *supply = s->pass->plan->supply;
    counts->radius[s->c] = radius_of(s->pass->plan, s->c, s->pass->index);
    bool oriented = s->pass->how->edges || keeps_irradiance(s->pass);
    if (supply ? !supply->take(supply->data, task.pass, s->c, s->slice, result, error)
               : !photon_trace(&task, oriented, result, error))
        return false;
    counts->time_trace += clock_seconds() - start;
    counts->photon_rays += result->n_rays;
    counts->n_not_finite += result->n_not_finite;
    counts->emitted[s->c] += s->end > 0 ? s->end - s->begin : task.n_photons;
    counts->stored[s->c] += result->photons.n + result->in_media.n;
    return true;
}

static bool build_class(photonmap_pass *pass, const slice_task *s, trace_result *result,
                        transport_counts *counts, GError **error)
{
    double start = clock_seconds();
    photon_map **map = &pass->maps[s->slice][s->c];
    float radius = pass->estimates[s->c].radius;
    photon_store store = result->photons;
    result->photons = (photon_store){0};
    bool radii_differ =
        pass->plan->radius_cache[s->c] && pass->estimates[s->c].nearest == 0;
    map_choice wanted = (map_choice)pass->how->photon_map;
    *map = photon_map_build(photon_map_chosen(wanted, radii_differ), &store,
                            isfinite(radius) ? radius : 0.0f, plan_workers(pass->plan),
                            error);
    bool ok =
        *map && photonmap_keep_in_media(pass, s->slice, s->c, &result->in_media, error);
    counts->time_build += clock_seconds() - start;
    const volume_map *in_media = pass->in_media[s->slice][s->c];
    if (ok)
        counts->memory_photons +=
            photon_map_bytes(*map) + (in_media ? volume_map_bytes(in_media) : 0);
    return ok;
}

/* One photon of so many is set apart: a map of three quarters is hardly noisier. With 2
   and 8 a Cornell box by final gathering has the same relMSE within 1 % in 0.7 and 1.3
   times the time (photonmap, 128 x 128, 4 passes, three seeds and one). */
enum { APART = 4 };

/* Some photons become places to keep irradiance at; the others make the map and
   carry the light of all. Places that were photons of the map would find themselves
   there, and the estimate be too bright by one photon in so many. What flat curves get
   depends on where one looks from, so it is kept nowhere on them. */
static bool set_points_apart(trace_result *from, trace_result *points, GError **error)
{
    photon_store *photons = &from->photons;
    size_t n = photons->n, n_points = n / APART;
    points->photons.oriented = true;
    if (!photon_store_reserve(&points->photons, n_points, error))
        return false;
    float share = (float)n / (float)MAX(n - n_points, 1);
    photons->n = 0;
    for (size_t i = 0; i < n; i++) {
        photon p = photon_store_get(photons, i);
        bool apart = i % APART == APART - 1;
        p.flux *= share;
        if (!apart)
            photon_store_put(photons, &p);
        else if (!p.home)
            photon_store_put(&points->photons, &p);
    }
    return true;
}

static bool make_map(photonmap_pass *pass, const slice_task *s, const cancel_flag *cancel,
                     trace_result *points, transport_counts *counts, GError **error)
{
    trace_result result = {0};
    bool ok = trace_class(s, cancel, &result, counts, error);
    if (ok && keeps_irradiance(pass) && s->c != PHOTON_CAUSTIC)
        ok = set_points_apart(&result, points, error);
    ok = ok && build_class(pass, s, &result, counts, error);
    trace_result_clear(&result);
    return ok;
}

/* The maps of one slice, and the irradiance at places that were photons of it. */
static bool make_slice(photonmap_pass *pass, int slice, const cancel_flag *cancel,
                       transport_counts *counts, GError **error)
{
    trace_result points[N_PHOTON_CLASSES] = {0};
    bool ok = true;
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++) {
        const slice_task s = {.pass = pass, .slice = slice, .c = (photon_class)c};
        if (pass->plan->n_photons[c] > 0)
            ok = make_map(pass, &s, cancel, &points[c], counts, error);
    }
    double start = clock_seconds();
    if (ok && keeps_irradiance(pass))
        ok = irradiance_cache_build(pass, slice, points, N_PHOTON_CLASSES, error);
    counts->time_build += clock_seconds() - start;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        trace_result_clear(&points[c]);
    return ok;
}

static bool make_maps(photonmap_pass *pass, const cancel_flag *cancel,
                      transport_counts *counts, GError **error)
{
    bool ok = true;
    for (int slice = 0; slice < pass->n_slices && ok; slice++)
        ok = make_slice(pass, slice, cancel, counts, error);
    return ok;
}

static void end_pass(void *data)
{
    photonmap_pass *pass = data;
    for (int i = 0; i < pass->n_slices; i++) {
        for (int c = 0; c < N_PHOTON_CLASSES; c++) {
            photon_map_free(pass->maps[i][c]);
            volume_map_free(pass->in_media[i][c]);
        }
        irradiance_cache_free(pass->irradiance[i]);
    }
    g_aligned_free(pass);
}

float caustic_discs(const transport_plan *plan, double radius)
{
    return (float)(G_PI * radius * radius * (double)plan->n_photons[PHOTON_CAUSTIC] /
                   (double)plan->how.spp);
}

/* A pass without its photons. */
static void *open_pass(const transport_plan *plan, uint32_t index)
{
    photonmap_pass *pass = g_aligned_alloc0(1, sizeof *pass, 64);
    pass->plan = plan;
    pass->index = index;
    pass->scene = plan->scene;
    pass->how = &plan->how;
    pass->w = scene_wavelengths(plan->scene, &plan->how, index);
    pass->options.deterministic = !plan->how.multiple_samples;
    pass->options.metal_is_followed = photon_follows_metals(&plan->how);
    pass->has_delta_lights = scene_has_delta_lights(plan->scene);
    pass->n_slices = time_slices_of(plan->scene, &plan->how);
    pass->followed = photon_followed_lobes(&plan->how);
    pass->gathered = photon_gathered_lobes(&plan->how);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        estimate_options *options = &pass->estimates[c];
        *options = photonmap_estimate_options(&plan->how, (photon_class)c,
                                              radius_of(plan, (photon_class)c, index));
        options->looked_share = plan->looked_share;
    }
    pass->mis = plan->mis;
    pass->mis.discs = caustic_discs(plan, radius_of(plan, PHOTON_CAUSTIC, index));
    return pass;
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    photonmap_pass *pass = open_pass(plan, index);
    if (make_maps(pass, cancel, counts, error))
        return pass;
    end_pass(pass);
    return NULL;
}

/* ---- The photons of a pass alone ---- */

static int n_slices(const void *pass)
{
    return ((const photonmap_pass *)pass)->n_slices;
}

static uint64_t count_photons(const void *pass, photon_class c)
{
    return n_in_slice(pass, c) * (uint64_t)n_slices(pass);
}

static bool trace_photons(const void *pass, photon_class c, const cancel_flag *cancel,
                          transport_counts *counts, trace_result *result, GError **error)
{
    bool ok = true;
    for (int slice = 0; slice < n_slices(pass) && ok; slice++) {
        const slice_task s = {.pass = pass, .slice = slice, .c = c};
        trace_result more = {0};
        ok = trace_class(&s, cancel, slice == 0 ? result : &more, counts, error) &&
             trace_result_append(result, &more, error);
        trace_result_clear(&more);
    }
    return ok;
}

static bool trace_part(const void *pass, const photon_part *part,
                       const cancel_flag *cancel, transport_counts *counts,
                       trace_result *result, GError **error)
{
    const slice_task s = {pass, part->slice, part->c, part->begin, part->end};
    return trace_class(&s, cancel, result, counts, error);
}

static void tell_photon(const void *pass, photon_class c, uint64_t i,
                        photon_listener tell, void *data)
{
    const uint64_t each = n_in_slice(pass, c);
    const slice_task s = {.pass = pass, .slice = each > 0 ? (int)(i / each) : 0, .c = c};
    const trace_task task = trace_task_for(&s, NULL);
    photon_tell(&task, i, tell, data);
}

const photon_sender photonmap_photons = {
    .open = open_pass,
    .count = count_photons,
    .trace = trace_photons,
    .trace_part = trace_part,
    .tell = tell_photon,
    .n_wholes = n_slices,
    .close = end_pass,
};

static const wavelengths *pass_wavelengths(const void *pass)
{
    return &((const photonmap_pass *)pass)->w;
}

const transport_kind transport_photonmap = {
    .name = "photonmap",
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = photonmap_radiance,
    .pass_wavelengths = pass_wavelengths,
    .end_pass = end_pass,
    .photons = &photonmap_photons,
};
