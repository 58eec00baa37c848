#include "transport/vcm/vcm.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "transport/photonmap/photonmap.h"
#include "transport/visible.h"
#include "transport/work.h"

/* The automatic radius over that of photon mapping's indirect light: merging is for what
   connections do not find, and that is sharp. With all of it a furnace is off by 0.1 %,
   with that of light with edges a pass through glass takes 1.4 times the work. */
#define RADIUS_SHARE 0.25

vcm_strategies vcm_strategies_of(int choice)
{
    static const vcm_strategies all[] = {
        [VCM_ALL] = {.connect = true, .merge = true, .splat = true},
        [VCM_BPT] = {.connect = true, .splat = true},
        [VCM_BPM] = {.merge = true},
        [VCM_PPM] = {.merge = true, .end_here = true},
        [VCM_LIGHT] = {.splat = true},
    };
    return all[choice];
}

/* ---- Planning ---- */

/* Where connections find smooth light a few pixels, but no more than photons ask for. */
static bool choose_radius(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    bool ok = photonmap_choose_radii(plan, cancel, error);
    double *radius = &plan->radius[PHOTON_INDIRECT];
    if (plan->how.radius > 0.0)
        return ok;
    *radius *= RADIUS_SHARE;
    if (vcm_strategies_of(plan->how.vcm_strategies).connect)
        *radius = fmin(*radius, sharp_radius(plan));
    return ok;
}

/* Where subpaths are connected, one for each of the camera's (Georgiev et al.); merging
   and light tracing alone live on many of them. */
static uint64_t count_light_paths(const transport_plan *plan)
{
    const settings *how = &plan->how;
    const film_settings *film = &plan->view->film;
    int64_t camera_paths = (int64_t)film->width * film->height * how->spp;
    int64_t n = settings_photons(how);
    if (how->photons == 0 && vcm_strategies_of(how->vcm_strategies).connect)
        n = MIN(n, camera_paths);
    return (uint64_t)MAX(n, 1);
}

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    if (scene_has_media(plan->scene)) {
        const medium *m = plan->scene->media->pdata[0];
        error_set(error, ERROR_INPUT,
                  "vcm does not see participating media, as medium \"%s\": expected "
                  "another integrator, such as auto",
                  m->name);
        return false;
    }
    plan->n_photons[PHOTON_INDIRECT] = count_light_paths(plan);
    plan_ask(plan, (double)plan->n_photons[PHOTON_INDIRECT]);
    if (plan->how.vcm_strategies == VCM_LIGHT && !camera_connects(&plan->view->camera)) {
        error_set(error, ERROR_INPUT,
                  "light can not be traced to camera \"%s\": expected other "
                  "vcm_strategies than light",
                  camera_kind_name(&plan->view->camera));
        return false;
    }
    vcm_strategies strategies = vcm_strategies_of(plan->how.vcm_strategies);
    if (!strategies.merge)
        return true;
    return choose_radius(plan, cancel, error) &&
           (strategies.end_here || vcm_keep_density(plan, cancel, error));
}

/* ---- A pass ---- */

/* What moves is kept where it is in the middle of its slice of time. */
photon vcm_photon(const vcm_pass *pass, const light_vertex *v)
{
    const surface_hit hit = scene_restore_hit(pass->scene, &v->hit);
    const vec3 wi = kept_hit_wo(&v->hit);
    bool behind = dot3(wi, hit.n_geom) < 0.0f;
    photon p = {.p = scene_hit_place(pass->scene, &hit),
                .wi = wi,
                .flux = v->flux / (float)pass->light.n,
                .flags = behind ? PHOTON_BEHIND : 0,
                .n = face_forward(hit.n_geom, wi),
                .tag = (uint32_t)scene_light_group(pass->scene, v->light),
                .home = scene_curve_of(pass->scene, &hit)};
    if (scene_hit_moves(pass->scene, &hit)) {
        transform by = vcm_motion_to_map(pass, &hit);
        p.p = transform_point(&by, p.p);
        p.wi = normalize3(transform_vector(&by, p.wi));
        p.n = normalize3(transform_normal(&by, p.n));
    }
    return p;
}

typedef struct vertex_loop {
    vcm_pass *pass;
    photon_store *store;
} vertex_loop;

static void store_vertices(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const vertex_loop *loop = data;
    for (size_t i = begin; i < end; i++) {
        photon p = vcm_photon(loop->pass, &loop->pass->light.vertices[i]);
        p.number = i;
        photon_store_set(loop->store, i, &p);
    }
}

static void merge_some(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    vcm_pass *pass = data;
    const photon_store *store = photon_map_store(pass->map);
    for (size_t i = begin; i < end; i++) {
        const light_vertex *v = &pass->light.vertices[store->number[i]];
        const vec3 wi = kept_hit_wo(&v->hit);
        pass->merged[i] = (merge_vertex){.flux = v->flux,
                                         .wi = {wi[0], wi[1], wi[2]},
                                         .weights = v->weights,
                                         .before = v->before,
                                         .light = v->light};
    }
}

/* Of all light vertices, in index order. */
static bool fill_store(vcm_pass *pass, photon_store *store, GError **error)
{
    size_t n = pass->light.n_vertices;
    if (!photon_store_reserve(store, n, error))
        return false;
    vertex_loop loop = {pass, store};
    store->n = n;
    parallel_for(n, ITEMS_AT_ONCE, (unsigned)pass->plan->how.threads, NULL,
                 store_vertices, &loop);
    return true;
}

static bool build_map(vcm_pass *pass, transport_counts *counts, GError **error)
{
    const settings *how = &pass->plan->how;
    const size_t n = pass->light.n_vertices;
    photon_store store = {
        .oriented = how->edges, .homed = pass->scene->camera_facing, .numbered = true};
    double start = clock_seconds();
    if (!fill_store(pass, &store, error))
        return false;
    pass->map = photon_map_build(photon_map_chosen((map_choice)how->photon_map, false),
                                 &store, pass->radius, plan_workers(pass->plan), error);
    if (pass->map)
        pass->merged = big_alloc(n, sizeof *pass->merged, "light vertices", error);
    if (!pass->merged)
        return false;
    if (!parallel_work(n, ITEMS_AT_ONCE, plan_workers(pass->plan), merge_some, pass,
                       error))
        return false;
    counts->time_build += clock_seconds() - start;
    counts->memory_photons += photon_map_bytes(pass->map) + n * sizeof *pass->merged;
    return true;
}

static bool trace_light(vcm_pass *pass, const cancel_flag *cancel,
                        transport_counts *counts, GError **error)
{
    double start = clock_seconds();
    if (!vcm_trace_light(pass, cancel, counts, error))
        return false;
    counts->time_trace += clock_seconds() - start;
    counts->emitted[PHOTON_INDIRECT] += pass->light.n;
    counts->stored[PHOTON_INDIRECT] += pass->light.n_vertices;
    counts->radius[PHOTON_INDIRECT] = (double)pass->radius;
    return true;
}

static bool make_light(vcm_pass *pass, const cancel_flag *cancel,
                       transport_counts *counts, GError **error)
{
    if (!trace_light(pass, cancel, counts, error))
        return false;
    counts->memory_photons += pass->light.n_vertices * sizeof *pass->light.vertices +
                              pass->light.n_splats * sizeof *pass->light.splats;
    return !pass->strategies.merge || build_map(pass, counts, error);
}

static void end_pass(void *data)
{
    vcm_pass *pass = data;
    photon_map_free(pass->map);
    big_free(pass->merged);
    light_paths_clear(&pass->light);
    g_aligned_free(pass);
}

/* A pass without its light subpaths. */
static void *open_pass(const transport_plan *plan, uint32_t index)
{
    vcm_pass *pass = g_aligned_alloc0(1, sizeof *pass, 64);
    const settings *how = &plan->how;
    double n = (double)plan->n_photons[PHOTON_INDIRECT];
    *pass = (vcm_pass){
        .plan = plan,
        .scene = plan->scene,
        .w = scene_wavelengths(plan->scene, how, index),
        .index = index,
        .strategies = vcm_strategies_of(how->vcm_strategies),
        .camera_per_light = (float)((double)how->spp / n),
        .light.n = plan->n_photons[PHOTON_INDIRECT],
    };
    double radius = photonmap_radius(plan->radius[PHOTON_INDIRECT], how->alpha, index);
    pass->n_slices = time_slices_of(plan->scene, how);
    double discs = G_PI * radius * radius * n / pass->n_slices;
    pass->radius = (float)radius;
    for (guint i = 0; i < plan->scene->shapes->len; i++)
        pass->camera_hides |=
            ((const shape *)plan->scene->shapes->pdata[i])->camera_hidden;
    pass->camera_facing_ends = pass->strategies.connect ||
                               (pass->strategies.merge && !pass->strategies.end_here);
    pass->strategies.splat &= camera_connects(&plan->view->camera);
    if (pass->strategies.merge)
        pass->ratios.merge = (float)discs;
    if (pass->strategies.connect && pass->strategies.merge)
        pass->ratios.connect = (float)(1.0 / discs);
    return pass;
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    vcm_pass *pass = open_pass(plan, index);
    if (make_light(pass, cancel, counts, error))
        return pass;
    end_pass(pass);
    return NULL;
}

/* ---- Its light vertices alone, as photons ---- */

/* They are all of one class, whatever they met before. */
static uint64_t count_photons(const void *data, photon_class c)
{
    return c == PHOTON_INDIRECT ? ((const vcm_pass *)data)->light.n : 0;
}

static bool keep_photons(const vcm_pass *pass, trace_result *result, GError **error)
{
    const light_paths *paths = &pass->light;
    result->photons = (photon_store){.tagged = pass->scene->n_light_groups > 0,
                                     .homed = pass->scene->camera_facing};
    if (!photon_store_reserve(&result->photons, paths->n_vertices, error))
        return false;
    for (size_t i = 0; i < paths->n_vertices; i++) {
        photon p = vcm_photon(pass, &paths->vertices[i]);
        photon_store_put(&result->photons, &p);
    }
    return true;
}

static bool trace_photons(const void *data, photon_class c, const cancel_flag *cancel,
                          transport_counts *counts, trace_result *result, GError **error)
{
    vcm_pass pass = *(const vcm_pass *)data;
    *result = (trace_result){0};
    bool ok = count_photons(data, c) == 0 || (trace_light(&pass, cancel, counts, error) &&
                                              keep_photons(&pass, result, error));
    light_paths_clear(&pass.light);
    return ok;
}

static void tell_photon(const void *data, photon_class c, uint64_t i,
                        photon_listener tell, void *told)
{
    (void)c;
    vcm_tell_light(data, i, tell, told);
}

static int once(const void *pass)
{
    (void)pass;
    return 1;
}

static const photon_sender vertices = {
    .open = open_pass,
    .count = count_photons,
    .trace = trace_photons,
    .tell = tell_photon,
    .n_wholes = once,
    .close = end_pass,
};

static const wavelengths *pass_wavelengths(const void *pass)
{
    return &((const vcm_pass *)pass)->w;
}

static splat_list splats(const void *data)
{
    const vcm_pass *pass = data;
    return (splat_list){pass->light.splats, pass->light.n_splats};
}

const transport_kind transport_vcm = {
    .name = "vcm",
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = vcm_radiance,
    .pass_wavelengths = pass_wavelengths,
    .splats = splats,
    .end_pass = end_pass,
    .photons = &vertices,
};
