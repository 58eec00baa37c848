#include "medium/medium_sample.h"
#include "photon/trace/photon_path.h"

/* Of a photon that wanders on and on, fewer and fewer ways leave one. */
static float chance_to_land(const photon_path *path)
{
    return 1.0f / sqrtf((float)(1 + path->n_in_media));
}

/* Each way through a medium leaves one photon on it, if its class is the one traced: for
   all that is scattered there, whether this photon itself is or goes through. */
static void land_on_segment(photon_path *path, float length)
{
    const trace_task *task = path->task;
    const medium *m = scene_medium(task->scene, path->at.ray.media.participating);
    if (!photon_path_is_wanted(path) || !medium_scatters(m))
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
    photon_path_tell_flux(path, PHOTON_STORED, &hit, 0, p.flux);
    if (path->out)
        trace_chunk_put(path->out, &path->out->in_media, &p);
}

scene_event photon_path_cross_medium(void *data, float length, const surface_hit *behind,
                                     surface_hit *at)
{
    (void)behind;
    photon_path *path = data;
    const trace_task *task = path->task;
    const medium *m = scene_medium(task->scene, path->at.ray.media.participating);
    medium_sample next = {.t = length};
    land_on_segment(path, length);
    if (medium_scatters(m) && (photon_path_lobes(path) & LOBE_DIFFUSE))
        next = medium_sample_free(m, &task->w, path->at.throughput, length,
                                  sampler_1d(&path->random));
    else
        next.weight = medium_transmittance(m, length, &task->w);
    spectrum flux = path->at.throughput * next.weight;
    float survival = photon_path_survival(path, flux);
    float u = survival < 1.0f ? sampler_1d(&path->random) : 0.0f;
    *at = hit_in_medium(&path->at.ray, next.t);
    if (!photon_path_survives(path, flux, survival, u)) {
        photon_path_tell(path, PHOTON_ABSORBED, at, 0);
        return EVENT_END;
    }
    if (!next.scatters)
        return EVENT_NONE;
    path->n_in_media++;
    return EVENT_MEDIUM;
}
