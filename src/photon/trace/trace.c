#include "photon/trace/trace.h"

#include "base/memory.h"
#include "photon/trace/photon_path.h"

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
                                 .n_rays = path->out ? &path->out->n_rays : &untold,
                                 .path = path,
                                 .cross_medium = photon_path_cross_medium};
    scene_event event = scene_advance(&who, &path->at, hit);
    if (event == EVENT_ESCAPE)
        photon_path_tell(path, PHOTON_LEFT, NULL, 0);
    if (event != EVENT_SURFACE && event != EVENT_MEDIUM)
        return false;
    scene_scatterer(task->scene, hit, &task->w, path->at.wavelength, &options, b);
    if (event != EVENT_SURFACE)
        return true;
    if (!photon_path_survives_landing(path, hit, b))
        return false;
    photon_path_land(path, hit, b);
    return true;
}

static void follow(photon_path *path)
{
    int64_t limit = path->task->how->max_forward_bounces;
    surface_hit hit;
    bsdf b;
    for (int64_t bounces = 0; come_to_scatterer(path, &hit, &b); bounces++) {
        if (limit >= 0 && bounces >= limit) {
            photon_path_tell(path, PHOTON_ENDED, &hit, 0);
            return;
        }
        if (!photon_path_scatter(path, &hit, &b))
            return;
    }
}

static void trace_one(photon_path *path)
{
    if (!photon_path_start(path))
        return;
    photon_path_tell(path, PHOTON_EMITTED, NULL, 0);
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
    uint64_t first;     /* index of the first to emit */
    trace_result empty; /* stores of the sort that is wanted */
    trace_chunk *chunks;
    slab **slabs; /* of each thread */
} trace_loop;

static void trace_some(size_t begin, size_t end, unsigned thread, void *data)
{
    trace_loop *loop = data;
    trace_chunk *out = &loop->chunks[begin / RAYS_AT_ONCE];
    out->from = &loop->slabs[thread];
    out->photons.empty = loop->empty.photons;
    out->in_media.empty = loop->empty.in_media;
    const cancel_flag *cancel = loop->task->cancel;
    sampler_ahead ahead;
    for (size_t i = begin; i < end && !out->error && !cancelled(cancel); i++) {
        photon_path path = {.task = loop->task, .index = loop->first + i, .out = out};
        if ((i - begin) % AHEAD_STREAMS == 0) {
            const sampler random = photon_stream(loop->task, path.index);
            sampler_look_ahead(&random, &ahead);
        }
        path.ahead = &ahead;
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
    const workers by = {(unsigned)task->how->threads, task->cancel};
    *result = empty_result(task->scene, oriented);
    size_t n = (size_t)(task->end > 0 ? task->end - task->begin : task->n_photons);
    size_t n_chunks = (n + RAYS_AT_ONCE - 1) / RAYS_AT_ONCE;
    trace_chunk *chunks = big_alloc(n_chunks, sizeof *chunks, "photon chunks", error);
    if (!chunks)
        return false;
    trace_loop loop = {task, task->first + task->begin, *result, chunks, NULL};
    bool joined = slab_work(n, RAYS_AT_ONCE, by, trace_some, &loop, &loop.slabs, error) &&
                  trace_chunks_join(chunks, n_chunks, by, result, error);
    trace_chunks_clear(chunks, n_chunks);
    big_free(chunks);
    if (!joined)
        trace_result_clear(result);
    return joined;
}
