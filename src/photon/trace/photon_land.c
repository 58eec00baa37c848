#include "photon/time_slice.h"
#include "photon/trace/photon_path.h"

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
    photon_path_tell(path, PHOTON_STORED, hit, 0);
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
    trace_chunk_put(out, &out->photons, &p);
}

void photon_path_land(photon_path *path, const surface_hit *hit, const bsdf *b)
{
    const int where = path->task->how->photon_lobes;
    if (!photon_path_is_wanted(path))
        return;
    bool delta = path->from_delta && path->specular_only && path->n_diffuse == 0;
    bool glossy = where == PHOTON_LOBES_GLOSSY || (where == PHOTON_LOBES_NEEDED && delta);
    unsigned lobes = where == PHOTON_LOBES_DIFFUSE
                         ? b->lobes
                         : scene_lobes_around(path->task->scene, hit, b);
    if ((lobes & LOBE_DIFFUSE) || (glossy && (lobes & LOBE_GLOSSY)))
        store(path, hit, delta ? PHOTON_FROM_DELTA : 0);
}
