#include "photon/trace/photon_path.h"

static uint64_t stream_key(const trace_task *task)
{
    uint64_t key = hash_mix((uint64_t)task->how->seed, task->pass);
    return hash_mix(key, 0x70686f746f6eu + (uint64_t)task->photon_class);
}

sampler photon_stream(const trace_task *task, uint64_t index)
{
    return sampler_make(stream_key(task), index);
}

static emission_choice emission_of(const trace_task *task)
{
    return (emission_choice)task->how->class_emission[task->photon_class];
}

static const emission_guide *guide_of(const trace_task *task)
{
    return emission_of(task) == EMISSION_GUIDED ? task->guide : NULL;
}

float photon_start_point(const trace_task *task, uint64_t index,
                         float u[EMISSION_DIMENSIONS])
{
    sampler random = photon_stream(task, index);
    return emission_guide_draw(guide_of(task), &random, u);
}

static bool start(const trace_task *task, sampler *random, photon_start *out)
{
    emission_choice emission = emission_of(task);
    if (task->photon_class != PHOTON_CAUSTIC || emission == EMISSION_UNIFORM)
        return photon_emit(task->scene, &task->w, guide_of(task), random, out);
    if (emission == EMISSION_SPECULAR_AREA)
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

bool photon_path_start(photon_path *path)
{
    const trace_task *task = path->task;
    path->random = photon_stream(task, path->index);
    if (path->ahead)
        sampler_use_ahead(&path->random, path->ahead);
    photon_start at = {.ray.time = time_of(task, path->index)};
    if (task->how->photons_per_light && !guide_of(task))
        give_light(task, path->index, &at);
    if (!start(task, &path->random, &at))
        return false;
    path->at.ray = at.ray;
    spectrum share =
        scene_leave_light(task->scene, at.light, at.n, &task->w, &path->at.ray);
    path->at.throughput = at.flux * share / (float)task->n_photons;
    path->light = at.light;
    path->at.wavelength = ALL_WAVELENGTHS;
    path->from_delta = scene_light(task->scene, at.light)->is_delta;
    path->specular_only = true;
    path->mis_weight = 1.0f;
    path->primitive = at.primitive;
    path->end = (caustic_end){
        .light = at.light, .p = at.ray.origin, .n = at.n, .direction = at.ray.direction};
    return !spectrum_is_black(share);
}
