/*
 * Photons in media, and a ray through them.
 */
#include "transport/photonmap/photonmap_medium.h"

#include "base/memory.h"

typedef struct radius_loop {
    const photon_store *store;
    const radius_cache *of_pass_0; /* NULL: one for all */
    double typical;                /* of pass 0 */
    float shrunk;                  /* radius of this pass over that of pass 0 */
    float *radii;
    atomic_bool refused; /* memory was */
} radius_loop;

static void find_radii(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    radius_loop *loop = data;
    point_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        const photon_store *s = loop->store;
        vec3 p = vec3_make(s->x[i], s->y[i], s->z[i]);
        float typical = (float)loop->typical;
        loop->radii[i] =
            loop->shrunk *
            (loop->of_pass_0 ? radius_cache_at(loop->of_pass_0, p, typical, NULL, &hits)
                             : typical);
    }
    if (hits.refused)
        atomic_store(&loop->refused, true);
    point_hits_clear(&hits);
}

bool photonmap_keep_in_media(photonmap_pass *pass, int slice, photon_class c,
                             photon_store *photons, GError **error)
{
    const transport_plan *plan = pass->plan;
    unsigned threads = (unsigned)pass->how->threads;
    double radius = plan->radius_in_media[c];
    if (photons->n == 0 || !(radius > 0.0))
        return true;
    float *radii = big_alloc(photons->n, sizeof *radii, "photons in media", error);
    if (!radii)
        return false;
    radius_loop loop = {
        .store = photons,
        .of_pass_0 = plan->radius_cache_in_media[c],
        .typical = radius,
        .shrunk = (float)photonmap_radius(1.0, plan->how.alpha, pass->index),
        .radii = radii,
    };
    parallel_for(photons->n, RAYS_AT_ONCE, threads, NULL, find_radii, &loop);
    if (!loop.refused || point_hits_refuse(error))
        pass->in_media[slice][c] = volume_map_build(photons, radii, threads, error);
    big_free(radii);
    return pass->in_media[slice][c] != NULL;
}

/* ---- Light that is scattered once ---- */

/* What has been found, as a whole and by light groups. */
typedef struct direct_sum {
    const photonmap_pass *pass;
    spectrum radiance, *groups;
    size_t n_groups; /* 0: not asked for */
} direct_sum;

static void add(direct_sum *sum, int source, spectrum radiance)
{
    sum->radiance += radiance;
    if (sum->n_groups > 0)
        sum->groups[scene_light_group(sum->pass->scene, source)] += radiance;
}

/* By a point on a light, or on each. */
static void sample_lights(const medium_look *look, const surface_hit *at, const bsdf *b,
                          sampler *random, transport_scratch *scratch, direct_sum *sum)
{
    const photonmap_pass *pass = sum->pass;
    const direct_query query = {
        .scene = pass->scene,
        .w = &pass->w,
        .hit = at,
        .bsdf = b,
        .wo = -look->ray->direction,
        .every_light = look->every_light,
        .shadow_rays = pass->how->shadow_rays,
        .options = &pass->options,
        .most_panes = pass->how->max_forward_bounces,
        .followed = LOBE_ALL,
    };
    direct_radiance found[FEW_LIGHTS];
    int n = direct_light(&query, random, found, &scratch->shadow_rays);
    for (int i = 0; i < n; i++)
        add(sum, found[i].light, found[i].diffuse);
}

/* A direction of the phase function, until it meets a surface that is seen. */
typedef struct scattered_path {
    scattered_from from;
    path_segment at;
    direct_sum *sum;
} scattered_path;

static void meet_light(void *data, const met_light *met)
{
    const scattered_path *path = data;
    const photonmap_pass *pass = path->sum->pass;
    float weight = direct_met_weight(pass->scene, pass->how, &path->from,
                                     path->at.ray.direction, met);
    add(path->sum, met->light, path->at.throughput * met->radiance * weight);
}

static void meet_surface(void *data, const surface_hit *hit)
{
    const scattered_path *path = data;
    const photonmap_pass *pass = path->sum->pass;
    direct_meet(pass->scene, &pass->w, &path->at.ray, hit, meet_light, data);
}

static void meet_lights(const medium_look *look, const surface_hit *at,
                        const bsdf_sample *next, transport_scratch *scratch,
                        direct_sum *sum)
{
    scattered_path path = {
        .from = {at->p, next->pdf, look->every_light},
        .at = {.ray = hit_ray(at, next->wi), .throughput = next->weight},
        .sum = sum,
    };
    const scene_traveller who = {.scene = sum->pass->scene,
                                 .w = &sum->pass->w,
                                 .n_rays = &scratch->shadow_rays,
                                 .path = &path,
                                 .meet_light = meet_surface,
                                 .through_panes = &sum->pass->options};
    surface_hit hit;
    if (scene_advance(&who, &path.at, &hit) == EVENT_ESCAPE)
        meet_surface(&path, NULL);
}

static medium_sample point_on(const photonmap_pass *pass, const medium_look *look,
                              sampler *random)
{
    const ray *r = look->ray;
    const medium *m = scene_medium(pass->scene, r->media.participating);
    medium_pivot pivot;
    bool near = direct_pivot(pass->scene, &pass->w, r, look->length, random, &pivot);
    float u = sampler_1d(random);
    return near ? medium_sample_within_near(m, &pass->w, look->throughput, look->length,
                                            &pivot, u)
                : medium_sample_within(m, &pass->w, look->throughput, look->length, u);
}

spectrum photonmap_direct_in_medium(const photonmap_pass *pass, const medium_look *look,
                                    sampler *random, transport_scratch *scratch)
{
    const ray *r = look->ray;
    const medium *m = scene_medium(pass->scene, r->media.participating);
    direct_sum sum = {.pass = pass,
                      .groups = scratch->estimate.groups,
                      .n_groups = scratch->estimate.n_groups};
    for (size_t i = 0; i < sum.n_groups; i++)
        sum.groups[i] = (spectrum){0};
    if (!medium_scatters(m))
        return sum.radiance;
    medium_sample at = point_on(pass, look, random);
    if (!at.scatters)
        return sum.radiance;
    const surface_hit hit = hit_in_medium(r, at.t);
    bsdf b;
    bsdf_sample drawn;
    bsdf_make_phase(&b, m->g, look->wavelength);
    sample_lights(look, &hit, &b, random, scratch, &sum);
    if (pass->how->shadow_rays &&
        bsdf_sample_direction(&b, -r->direction, 0.0f, sampler_2d(random), LOBE_ALL,
                              TRANSPORT_RADIANCE, &drawn))
        meet_lights(look, &hit, &drawn, scratch, &sum);
    at.weight *= scene_solid_transmittance(pass->scene, &r->media, at.t, &pass->w);
    for (size_t i = 0; i < sum.n_groups; i++)
        sum.groups[i] *= at.weight;
    return sum.radiance * at.weight;
}

/* ---- Photons ---- */

spectrum photonmap_gather_medium(const photonmap_pass *pass, photon_class c, const ray *r,
                                 float length, transport_scratch *scratch)
{
    estimate_scratch *own = &scratch->estimate;
    const volume_map *map = pass->in_media[time_slice(r->time, pass->n_slices)][c];
    const volume_query query = {
        .ray = r,
        .medium = scene_medium(pass->scene, r->media.participating),
        .solid = scene_solid_medium(pass->scene, &r->media),
        .length = length,
        .w = &pass->w,
        .kernel = pass->estimates[c].kernel,
        .groups = own->groups,
        .n_groups = own->n_groups,
    };
    own->n_queries++;
    if (map) {
        size_t n;
        spectrum found = volume_map_radiance(map, &query, &n);
        own->n_weighed += n;
        return found;
    }
    for (size_t i = 0; i < own->n_groups; i++)
        own->groups[i] = (spectrum){0};
    return (spectrum){0};
}
