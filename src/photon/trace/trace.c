#include "photon/trace/trace.h"

#include "base/memory.h"
#include "medium/medium_sample.h"
#include "photon/trace/trace_chunk.h"
#include "scene/advance.h"

/* size: photons emitted per parallel piece of work */
enum { CHUNK = 4096 };

/* Ways through media that each leave a photon, before fewer do. */
enum { WAYS_KEPT = 8 };

/* One photon on its way. */
typedef struct photon_path {
    const trace_task *task;
    uint64_t index;
    sampler random;
    path_segment at;
    int light;
    float mis_weight; /* of its light that it carries */
    caustic_end end;  /* the light's end of its way, as far as is known: for the share */
    uint32_t primitive;  /* of the light */
    bool from_delta;     /* the light cannot be hit by a ray */
    bool specular_only;  /* no lobe but SPECULAR so far */
    unsigned n_followed; /* specular or glossy bounces */
    unsigned n_diffuse;
    unsigned n_after;    /* followed bounces since the last diffuse one */
    unsigned n_in_media; /* scatterings in media */
    trace_chunk *out;    /* NULL when telling */
    void (*tell)(const photon_event *event, void *data);
    void *tell_data;
} photon_path;

/* Of a photon of some flux, the path's or its own. */
static void tell_flux(const photon_path *path, photon_event_kind kind,
                      const surface_hit *hit, unsigned lobe, spectrum flux)
{
    if (!path->tell)
        return;
    photon_event event = {
        .kind = kind,
        .index = path->index,
        .p = hit ? hit->p : path->at.ray.origin,
        .direction = path->at.ray.direction,
        .hit = hit,
        .light = path->light,
        .lobe = lobe,
        .flux = flux,
        .mis_weight = path->mis_weight,
    };
    path->tell(&event, path->tell_data);
}

static void tell(const photon_path *path, photon_event_kind kind, const surface_hit *hit,
                 unsigned lobe)
{
    tell_flux(path, kind, hit, lobe, path->at.throughput);
}

static uint64_t stream_key(const trace_task *task)
{
    uint64_t key = hash_mix((uint64_t)task->how->seed, task->pass);
    return hash_mix(key, 0x70686f746f6eu + (uint64_t)task->photon_class);
}

/* The guide serves the caustic photons that it was made for. */
static const emission_guide *guide_of(const trace_task *task)
{
    bool guided = task->photon_class == PHOTON_CAUSTIC &&
                  task->how->caustic_emission == EMISSION_GUIDED;
    return guided ? task->guide : NULL;
}

float photon_start_point(const trace_task *task, uint64_t index,
                         float u[EMISSION_DIMENSIONS])
{
    sampler random = sampler_make(stream_key(task), index);
    return emission_guide_draw(guide_of(task), &random, u);
}

static bool start(const trace_task *task, sampler *random, photon_start *out)
{
    if (task->photon_class != PHOTON_CAUSTIC ||
        task->how->caustic_emission == EMISSION_UNIFORM)
        return photon_emit(task->scene, &task->w, random, out);
    if (task->how->caustic_emission == EMISSION_SPECULAR_AREA)
        return photon_emit_aimed(task->casters, &task->w, random, out);
    return photon_emit_caustic(task->casters, &task->w, guide_of(task), random, out);
}

/* The time of a photon, 0 where nothing moves. */
static float time_of(const trace_task *task, uint64_t index)
{
    if (!task->scene->moves)
        return 0.0f;
    uint64_t h = hash_mix(stream_key(task) ^ 0x74696d65u, index);
    double jitter = (double)(h >> 11) * 0x1p-53;
    double part = ((double)(index - task->first) + jitter) / (double)task->n_photons;
    double slice = (double)task->slice + part - floor(part);
    return minf((float)(slice / MAX(task->n_slices, 1)), 0x1.fffffep-1f);
}

/* Of the task's photons each light gets as many as the next. */
static void give_light(const trace_task *task, uint64_t index, photon_start *at)
{
    uint64_t n_lights = task->scene->lights->len;
    uint64_t i = (index - task->first) % task->n_photons;
    at->light_is_given = true;
    at->light = (int)((double)i * (double)n_lights / (double)task->n_photons);
    at->p_light = 1.0f / (float)n_lights;
}

static bool emit(photon_path *path)
{
    const trace_task *task = path->task;
    photon_start at = {.ray.time = time_of(task, path->index)};
    if (task->how->photons_per_light && !guide_of(task))
        give_light(task, path->index, &at);
    if (!start(task, &path->random, &at))
        return false;
    path->at.ray = at.ray;
    scene_leave_light(task->scene, at.light, at.n, &path->at.ray);
    path->at.throughput = at.flux / (float)task->n_photons;
    path->light = at.light;
    path->at.wavelength = ALL_WAVELENGTHS;
    path->from_delta = scene_light(task->scene, at.light)->is_delta;
    path->specular_only = true;
    path->mis_weight = 1.0f;
    path->primitive = at.primitive;
    path->end = (caustic_end){
        .light = at.light, .p = at.ray.origin, .n = at.n, .direction = at.ray.direction};
    return true;
}

/* Caustics that are shared with paths go on: the light of a bright spot that glass throws
   elsewhere is a caustic too. */
static bool goes_on(const trace_task *task)
{
    return task->photon_class == PHOTON_CAUSTIC && task->mis;
}

static photon_class class_here(const photon_path *path)
{
    if (goes_on(path->task) && path->n_after > 0)
        return PHOTON_CAUSTIC;
    if (path->n_diffuse > 0)
        return PHOTON_INDIRECT;
    return path->n_followed > 0 ? PHOTON_CAUSTIC : PHOTON_DIRECT;
}

/* Of the middle of a task's slice of time. */
static float middle_of(const trace_task *task)
{
    return time_of_slice(task->slice, MAX(task->n_slices, 1));
}

/* Takes a photon on something that moves to where that will be: directions turn with it,
   and where the surface grows the photon counts for more of it. */
static void keep_for_slice(const trace_task *task, const surface_hit *hit, photon *p)
{
    transform by = scene_motion_to(task->scene, hit, middle_of(task));
    p->n = normalize3(transform_normal(&by, p->n));
    p->p = transform_point(&by, p->p);
    p->wi = normalize3(transform_vector(&by, p->wi));
    p->flux *= (float)scene_area_change(task->scene, hit, middle_of(task));
}

static void store(photon_path *path, const surface_hit *hit, unsigned flags)
{
    trace_chunk *out = path->out;
    tell(path, PHOTON_STORED, hit, 0);
    if (!out)
        return;
    if (dot3(path->at.ray.direction, hit->n_geom) > 0.0f)
        flags |= PHOTON_BEHIND;
    const scene *s = path->task->scene;
    photon p = {.p = scene_hit_place(s, hit),
                .wi = -path->at.ray.direction,
                .flux = path->at.throughput,
                .flags = flags,
                .n = face_forward(hit->n_geom, -path->at.ray.direction),
                .tag = (uint32_t)scene_light_group(s, path->light),
                .home = scene_curve_of(s, hit)};
    if (scene_hit_moves(s, hit))
        keep_for_slice(path->task, hit, &p);
    trace_chunk_put(out, &out->of.photons, &p);
}

static bool is_wanted(const photon_path *path)
{
    const trace_task *task = path->task;
    photon_class c = class_here(path);
    if (settings_one_map(task->how))
        return c != PHOTON_DIRECT || !task->how->direct_illumination;
    return c == task->photon_class;
}

/* Stores the photon if its class is the one traced and the surface has a lobe for it. */
static void land(photon_path *path, const surface_hit *hit, const bsdf *b)
{
    const int where = path->task->how->photon_lobes;
    if (!is_wanted(path))
        return;
    bool delta = path->from_delta && path->specular_only && path->n_diffuse == 0;
    bool glossy = where == PHOTON_LOBES_GLOSSY || (where == PHOTON_LOBES_NEEDED && delta);
    unsigned lobes = where == PHOTON_LOBES_DIFFUSE
                         ? b->lobes
                         : scene_lobes_around(path->task->scene, hit, b);
    if ((lobes & LOBE_DIFFUSE) || (glossy && (lobes & LOBE_GLOSSY)))
        store(path, hit, delta ? PHOTON_FROM_DELTA : 0);
}

/* The lobes that a photon of this class may take on its way: a caustic one has only met
   specular and glossy ones, or goes on after it has landed; a direct one none. */
static unsigned lobes_to_take(const photon_path *path)
{
    const settings *how = path->task->how;
    switch (path->task->photon_class) {
    case PHOTON_DIRECT:
        return 0;
    case PHOTON_CAUSTIC:
        return goes_on(path->task) && path->n_after > 0 ? LOBE_ALL
                                                        : photon_followed_lobes(how);
    default:
        return LOBE_ALL;
    }
}

static float power_of(const settings *how, spectrum flux)
{
    return how->roulette == ROULETTE_MAX ? spectrum_max(flux) : spectrum_mean(flux);
}

/* What paths from the eye leave to a photon that scatters first at this hit. */
static float mis_weight_at(photon_path *path, const surface_hit *hit, const bsdf *b,
                           const bsdf_sample *next)
{
    const trace_task *task = path->task;
    if (!task->mis || path->n_followed + path->n_diffuse > 0)
        return 1.0f;
    caustic_end *end = &path->end;
    vec3 to_light = -end->direction;
    end->distance = length3(hit->p - end->p);
    end->specular = (next->lobe & LOBE_SPECULAR) != 0;
    if (!end->specular) {
        const surface_hit on_light = {
            .p = end->p, .n_geom = end->n, .primitive = path->primitive};
        const light *from = scene_light(task->scene, end->light);
        end->pdf_lights =
            light_tree_probability(task->scene->light_tree, hit->p, end->light);
        if (!from->kind->is_delta)
            end->pdf_lights *= from->kind->pdf(from->self, hit->p, to_light, &on_light);
        end->pdf_scatter = bsdf_pdf(b, next->wi, to_light, LOBE_ALL, TRANSPORT_RADIANCE);
    }
    return caustic_mis_weight(task->mis, end);
}

/* Roulette: gives the photon a new flux, or ends it. */
static bool survives(photon_path *path, spectrum flux, float survival, float u)
{
    if (!(u < survival))
        return false;
    path->at.throughput = flux / survival;
    return true;
}

static float survival_with(const photon_path *path, spectrum flux)
{
    const settings *how = path->task->how;
    return minf(1.0f, power_of(how, flux) / power_of(how, path->at.throughput));
}

/* Where only survivors are stored, a photon has its roulette first: by the share of it
   that the surface sends on. */
static bool survives_landing(photon_path *path, const surface_hit *hit, const bsdf *b)
{
    if (!path->task->how->photon_survivors)
        return true;
    spectrum flux = path->at.throughput;
    spectrum sent_on = flux * bsdf_albedo(b, -path->at.ray.direction, LOBE_ALL);
    if (survives(path, flux, survival_with(path, sent_on), sampler_1d(&path->random)))
        return true;
    tell(path, PHOTON_ABSORBED, hit, 0);
    return false;
}

/* Scatters at the hit. @return false if the photon's way ends here. */
static bool scatter(photon_path *path, const surface_hit *hit, const bsdf *b)
{
    unsigned lobes = lobes_to_take(path);
    if (!(b->lobes & lobes & ~(unsigned)LOBE_ANY_SIDE)) {
        tell(path, PHOTON_ENDED, hit, 0);
        return false;
    }
    scatter_numbers u = sampler_scatter(&path->random);
    bsdf_sample next;
    bool scattered =
        bsdf_sample_direction(b, -path->at.ray.direction, u.lobe, u.direction, lobes,
                              TRANSPORT_IMPORTANCE, &next);
    if (scattered && lobes == LOBE_ALL && bsdf_has_both(b))
        bsdf_settle_class(b, -path->at.ray.direction, TRANSPORT_IMPORTANCE,
                          sampler_1d(&path->random), &next);
    spectrum flux = scattered ? path->at.throughput * next.weight : (spectrum){0};
    if (path->out && !spectrum_is_finite(flux))
        path->out->of.n_not_finite++;
    float survival = survival_with(path, flux);
    if (path->task->how->photon_survivors)
        survival = 1.0f; /* it had its roulette where it landed */
    survival = minf(most_survival(path->n_followed + path->n_diffuse), survival);
    if (scattered) {
        float weight = mis_weight_at(path, hit, b, &next);
        path->mis_weight *= weight;
        flux *= weight;
        survival *= minf(1.0f, weight / PHOTON_LEAST_WEIGHT);
    }
    if (!survives(path, flux, survival, u.roulette)) {
        tell(path, PHOTON_ABSORBED, hit, 0);
        return false;
    }
    path->at.wavelength = next.wavelength;
    path->at.ray = hit_ray(hit, next.wi);
    path->specular_only &= (next.lobe & LOBE_SPECULAR) != 0;
    const unsigned gathered = photon_gathered_lobes(path->task->how);
    bool diffuse = (next.lobe & gathered & ~(unsigned)LOBE_ANY_SIDE) != 0;
    path->n_diffuse += diffuse;
    path->n_followed += !diffuse;
    path->n_after = diffuse ? 0 : path->n_after + 1;
    tell(path, PHOTON_SCATTERED, hit, next.lobe);
    return true;
}

/* ---- In media ---- */

/* Of a photon that wanders on and on, fewer and fewer ways leave one. */
static float chance_to_land(const photon_path *path)
{
    return minf(1.0f, (float)WAYS_KEPT / (float)(1 + path->n_in_media));
}

/* Each way through a medium leaves one photon on it, if its class is the one traced: for
   all that is scattered there, whether this photon itself is or goes through. */
static void land_on_way(photon_path *path, float length)
{
    const trace_task *task = path->task;
    const medium *m = scene_medium(task->scene, path->at.ray.media.participating);
    if (!is_wanted(path) || !medium_scatters(m))
        return;
    float chance = chance_to_land(path), u = sampler_1d(&path->random);
    if (!(u < chance))
        return;
    medium_sample at =
        medium_sample_within(m, &task->w, path->at.throughput, length, u / chance);
    if (!at.scatters)
        return;
    const surface_hit hit = hit_in_medium(&path->at.ray, at.t);
    const photon p = {.p = hit.p,
                      .wi = -path->at.ray.direction,
                      .flux = path->at.throughput * at.weight / chance *
                              scene_solid_transmittance(task->scene, &path->at.ray.media,
                                                        at.t, &task->w),
                      .tag = (uint32_t)scene_light_group(task->scene, path->light),
                      .home = medium_home(m)};
    tell_flux(path, PHOTON_STORED, &hit, 0, p.flux);
    if (path->out)
        trace_chunk_put(path->out, &path->out->of.in_media, &p);
}

/* Takes a photon through its medium. One that no diffuse lobe would take goes straight
   on, as far as its light does. */
static scene_event cross_medium(void *data, float length, const surface_hit *behind,
                                surface_hit *at)
{
    (void)behind;
    photon_path *path = data;
    const trace_task *task = path->task;
    const medium *m = scene_medium(task->scene, path->at.ray.media.participating);
    medium_sample next = {.t = length};
    land_on_way(path, length);
    if (medium_scatters(m) && (lobes_to_take(path) & LOBE_DIFFUSE))
        next = medium_sample_free(m, &task->w, path->at.throughput, length,
                                  sampler_1d(&path->random));
    else
        next.weight = medium_transmittance(m, length, &task->w);
    spectrum flux = path->at.throughput * next.weight;
    float survival = survival_with(path, flux);
    float u = survival < 1.0f ? sampler_1d(&path->random) : 0.0f;
    *at = hit_in_medium(&path->at.ray, next.t);
    if (!survives(path, flux, survival, u)) {
        tell(path, PHOTON_ABSORBED, at, 0);
        return EVENT_END;
    }
    if (!next.scatters)
        return EVENT_NONE;
    path->n_in_media++;
    path->at.throughput *=
        scene_solid_transmittance(task->scene, &path->at.ray.media, next.t, &task->w);
    return EVENT_MEDIUM;
}

/* ---- The whole way ---- */

/* Takes the photon to where it is scattered next: a surface, or a point in a medium.
   @return false: its way ends */
static bool come_to_scatterer(photon_path *path, surface_hit *hit, bsdf *b)
{
    const trace_task *task = path->task;
    const bsdf_options options = {.deterministic = !task->how->multiple_samples,
                                  .metal_is_followed = photon_follows_metals(task->how)};
    uint64_t untold = 0;
    const scene_traveller who = {.scene = task->scene,
                                 .w = &task->w,
                                 .n_rays = path->out ? &path->out->of.n_rays : &untold,
                                 .path = path,
                                 .cross_medium = cross_medium};
    scene_event event = scene_advance(&who, &path->at, hit);
    if (event == EVENT_ESCAPE)
        tell(path, PHOTON_LEFT, NULL, 0);
    if (event != EVENT_SURFACE && event != EVENT_MEDIUM)
        return false;
    scene_scatterer(task->scene, hit, &task->w, path->at.wavelength, &options, b);
    if (event != EVENT_SURFACE)
        return true;
    if (!survives_landing(path, hit, b))
        return false;
    land(path, hit, b);
    return true;
}

static void follow(photon_path *path)
{
    int64_t limit = path->task->how->max_forward_bounces;
    surface_hit hit;
    bsdf b;
    for (int64_t bounces = 0; come_to_scatterer(path, &hit, &b); bounces++) {
        if (limit >= 0 && bounces >= limit) {
            tell(path, PHOTON_ENDED, &hit, 0);
            return;
        }
        if (!scatter(path, &hit, &b))
            return;
    }
}

static void trace_one(photon_path *path)
{
    path->random = sampler_make(stream_key(path->task), path->index);
    if (!emit(path))
        return;
    tell(path, PHOTON_EMITTED, NULL, 0);
    follow(path);
}

void photon_tell(const trace_task *task, uint64_t index, photon_listener tell_event,
                 void *data)
{
    photon_path path = {
        .task = task, .index = index, .tell = tell_event, .tell_data = data};
    trace_one(&path);
}

typedef struct trace_loop {
    const trace_task *task;
    trace_result empty; /* what each chunk starts from */
    trace_chunk *chunks;
} trace_loop;

static void trace_some(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    trace_loop *loop = data;
    trace_chunk *out = &loop->chunks[begin / CHUNK];
    out->of = loop->empty;
    const cancel_flag *cancel = loop->task->cancel;
    for (size_t i = begin; i < end && !out->error && !cancelled(cancel); i++) {
        photon_path path = {
            .task = loop->task, .index = loop->task->first + i, .out = out};
        trace_one(&path);
    }
}

static trace_result empty_result(const scene *s, bool oriented)
{
    bool tagged = s->n_light_groups > 0;
    return (trace_result){
        .photons = {.oriented = oriented, .tagged = tagged, .homed = s->camera_facing},
        .in_media = {.tagged = tagged, .homed = true},
    };
}

bool photon_trace(const trace_task *task, bool oriented, trace_result *result,
                  GError **error)
{
    unsigned threads = (unsigned)task->how->threads;
    *result = empty_result(task->scene, oriented);
    size_t n_chunks = ((size_t)task->n_photons + CHUNK - 1) / CHUNK;
    trace_chunk *chunks = big_alloc(n_chunks, sizeof *chunks, "photon chunks", error);
    if (!chunks)
        return false;
    trace_loop loop = {task, *result, chunks};
    bool done = parallel_for((size_t)task->n_photons, CHUNK, threads, task->cancel,
                             trace_some, &loop);
    if (!done)
        error_set(error, ERROR_CANCELLED, "cancelled");
    bool joined = done && trace_chunks_join(chunks, n_chunks, threads, result, error);
    trace_chunks_clear(chunks, n_chunks);
    big_free(chunks);
    if (!joined)
        trace_result_clear(result);
    return joined;
}
