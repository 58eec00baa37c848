/*
 * Photons in media, and a ray through them.
 */
#include "transport/photonmap_medium.h"

#include "transport/places.h"

#include "base/memory.h"

enum { CHUNK = 1024 };

typedef struct radius_loop {
    const photonmap_pass *pass;
    const photon_store *store;
    const photon_map *places; /* whose numbers are radii of pass 0; NULL: one for all */
    double typical;           /* of pass 0 */
    float shrunk;             /* radius of this pass over that of pass 0 */
    float *radii;
} radius_loop;

static void find_radii(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    radius_loop *loop = data;
    photon_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        const photon_store *s = loop->store;
        vec3 p = vec3_make(s->x[i], s->y[i], s->z[i]);
        float typical = (float)loop->typical;
        loop->radii[i] =
            loop->shrunk *
            (loop->places ? places_at(loop->places, p, typical, &hits) : typical);
    }
    photon_hits_clear(&hits);
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
        .pass = pass,
        .store = photons,
        .places = plan->radius_map_in_media[c],
        .typical = radius,
        .shrunk = (float)photonmap_radius(1.0, plan->how.alpha, pass->index),
        .radii = radii,
    };
    parallel_for(photons->n, CHUNK, threads, NULL, find_radii, &loop);
    pass->in_media[slice][c] = volume_map_build(photons, radii, threads, error);
    big_free(radii);
    return pass->in_media[slice][c] != NULL;
}

int photonmap_direct_in_medium(const photonmap_pass *pass, const medium_look *look,
                               sampler *random, transport_scratch *scratch,
                               direct_radiance found[FEW_LIGHTS])
{
    const ray *r = look->ray;
    if (!medium_scatters(r->medium))
        return 0;
    const medium *m = r->medium;
    medium_pivot pivot;
    bool near = direct_pivot(pass->scene, &pass->w, r, look->length, random, &pivot);
    float u = sampler_1d(random);
    medium_sample at =
        near ? medium_sample_within_near(m, &pass->w, look->carried, look->length, &pivot,
                                         u)
             : medium_sample_within(m, &pass->w, look->carried, look->length, u);
    if (!at.scatters)
        return 0;
    bsdf b;
    bsdf_make_phase(&b, m->g, look->lane);
    const surface_hit hit = hit_in_medium(r, at.t);
    const direct_query query = {
        .scene = pass->scene,
        .w = &pass->w,
        .hit = &hit,
        .bsdf = &b,
        .wo = -r->direction,
        .every_light = look->every_light,
        .shadow_rays = pass->how->shadow_rays,
    };
    int n = direct_light(&query, random, found, &scratch->shadow_rays);
    at.weight *= solids_transmittance(&r->solids, at.t, &pass->w);
    for (int i = 0; i < n; i++)
        found[i].diffuse *= at.weight;
    return n;
}

spectrum photonmap_gather_medium(const photonmap_pass *pass, photon_class c, const ray *r,
                                 float length, transport_scratch *scratch)
{
    estimate_scratch *own = &scratch->estimate;
    const volume_map *map = pass->in_media[time_slice(r->time, pass->n_slices)][c];
    const volume_query query = {
        .ray = r,
        .length = length,
        .w = &pass->w,
        .kernel = pass->estimates[c].kernel,
        .crossings = &own->crossings,
        .groups = own->groups,
        .n_groups = own->n_groups,
    };
    if (map)
        return volume_map_radiance(map, &query, &own->failed);
    for (size_t i = 0; i < own->n_groups; i++)
        own->groups[i] = (spectrum){0};
    return (spectrum){0};
}
