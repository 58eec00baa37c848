#include "photon/trace/photon_path.h"

unsigned photon_path_lobes(const photon_path *path)
{
    const settings *how = path->task->how;
    switch (path->task->photon_class) {
    case PHOTON_DIRECT: /* straight through panes */
        return LOBE_SPECULAR | LOBE_TRANSMISSION;
    case PHOTON_CAUSTIC:
        return photon_path_goes_on(path) && path->n_after > 0
                   ? LOBE_ALL
                   : photon_followed_lobes(how);
    default:
        return LOBE_ALL;
    }
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

bool photon_path_survives_landing(photon_path *path, const surface_hit *hit,
                                  const bsdf *b)
{
    if (!path->task->how->photon_survivors)
        return true;
    spectrum flux = path->at.throughput;
    spectrum sent_on = flux * bsdf_albedo(b, -path->at.ray.direction, LOBE_ALL);
    if (photon_path_survives(path, flux, photon_path_survival(path, sent_on),
                             sampler_1d(&path->random)))
        return true;
    photon_path_tell(path, PHOTON_ABSORBED, hit, 0);
    return false;
}

static void count(photon_path *path, unsigned lobe)
{
    const unsigned gathered = photon_gathered_lobes(path->task->how);
    bool diffuse = (lobe & gathered & ~(unsigned)LOBE_ANY_SIDE) != 0;
    path->specular_only &= (lobe & LOBE_SPECULAR) != 0;
    path->n_diffuse += diffuse;
    path->n_followed += !diffuse;
    path->n_after = diffuse ? 0 : path->n_after + 1;
}

/* True if no lobe takes the photon on; a direct one none but through panes. */
static bool ends(const photon_path *path, const bsdf *b, unsigned lobes)
{
    if (!(b->lobes & lobes & ~(unsigned)LOBE_ANY_SIDE))
        return true;
    return path->task->photon_class == PHOTON_DIRECT &&
           spectrum_is_black(bsdf_straight(b, -path->at.ray.direction));
}

bool photon_path_scatter(photon_path *path, const surface_hit *hit, const bsdf *b)
{
    unsigned lobes = photon_path_lobes(path);
    if (ends(path, b, lobes)) {
        photon_path_tell(path, PHOTON_ENDED, hit, 0);
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
        path->out->n_not_finite++;
    float survival = photon_path_survival(path, flux);
    if (path->task->how->photon_survivors)
        survival = 1.0f; /* it had its roulette where it landed */
    survival = minf(most_survival(path->n_followed + path->n_diffuse), survival);
    if (scattered && !next.straight) {
        float weight = mis_weight_at(path, hit, b, &next);
        path->mis_weight *= weight;
        flux *= weight;
        survival *= weight; /* those that survive carry alike */
    }
    if (!photon_path_survives(path, flux, survival, u.roulette)) {
        photon_path_tell(path, PHOTON_ABSORBED, hit, 0);
        return false;
    }
    path->at.wavelength = next.wavelength;
    path->at.ray = hit_ray(hit, next.wi);
    if (!next.straight)
        count(path, next.lobe);
    photon_path_tell(path, PHOTON_SCATTERED, hit, next.lobe);
    return true;
}
