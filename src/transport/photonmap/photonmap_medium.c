/*
 * Photons in media, and a ray through them.
 */
#include "transport/photonmap/photonmap_medium.h"

#include "transport/places.h"

#include "base/memory.h"

enum { CHUNK = 1024 };

typedef struct radius_loop {
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

/* ---- Light that is scattered once ---- */

/* What has been found, as a whole and by light groups. */
typedef struct direct_sum {
    const photonmap_pass *pass;
    spectrum radiance, *groups;
    size_t n_groups; /* 0: not asked for */
} direct_sum;

static void add(direct_sum *sum, int lamp, spectrum radiance)
{
    sum->radiance += radiance;
    if (sum->n_groups > 0)
        sum->groups[scene_light_group(sum->pass->scene, lamp)] += radiance;
}

/* By a point on a lamp, or on each. */
static void sample_lamps(const medium_look *look, const surface_hit *at, const bsdf *b,
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
        .followed = LOBE_ALL,
    };
    direct_radiance found[FEW_LIGHTS];
    int n = direct_light(&query, random, found, &scratch->shadow_rays);
    for (int i = 0; i < n; i++)
        add(sum, found[i].light, found[i].diffuse);
}

/* What is left for a lamp that a direction was not drawn toward. hit NULL: the sky */
static float met_weight(const photonmap_pass *pass, const medium_look *look,
                        const surface_hit *from, const bsdf_sample *way, int lamp,
                        const surface_hit *hit)
{
    float pdf =
        direct_light_pdf(pass->scene, look->every_light, lamp, from->p, way->wi, hit);
    return followed_weight(way->pdf, pdf);
}

/* By a direction of the phase function, until it meets a surface that is seen. */
static void meet_lamps(const medium_look *look, const surface_hit *at,
                       const bsdf_sample *way, transport_scratch *scratch,
                       direct_sum *sum)
{
    const photonmap_pass *pass = sum->pass;
    const scene *s = pass->scene;
    spectrum left = way->weight;
    surface_hit hit;
    for (ray r = hit_ray(at, way->wi);; r = hit_ray(&hit, way->wi)) {
        scratch->shadow_rays++;
        bool met = scene_intersect(s, &r, &hit);
        if (r.medium)
            left *= medium_transmittance(
                r.medium, scene_medium_end(s, &r, met ? hit.t : INFINITY), &pass->w);
        if (!met)
            break;
        left *= hit_transmittance(&hit, &pass->w);
        spectrum radiance = scene_emitted(s, &hit, -way->wi, &pass->w);
        if (!spectrum_is_black(radiance))
            add(sum, hit.light,
                left * radiance * met_weight(pass, look, at, way, hit.light, &hit));
        if (hit.material != NO_INDEX)
            return;
    }
    for (int i = 0; i < s->n_environments; i++) {
        int lamp = s->environments[i];
        const light *l = scene_light(s, lamp);
        add(sum, lamp,
            left * l->kind->environment(l->self, at->p, way->wi, &pass->w) *
                met_weight(pass, look, at, way, lamp, NULL));
    }
}

static medium_sample point_on(const photonmap_pass *pass, const medium_look *look,
                              sampler *random)
{
    const ray *r = look->ray;
    medium_pivot pivot;
    bool near = direct_pivot(pass->scene, &pass->w, r, look->length, random, &pivot);
    float u = sampler_1d(random);
    return near ? medium_sample_within_near(r->medium, &pass->w, look->carried,
                                            look->length, &pivot, u)
                : medium_sample_within(r->medium, &pass->w, look->carried, look->length,
                                       u);
}

spectrum photonmap_direct_in_medium(const photonmap_pass *pass, const medium_look *look,
                                    sampler *random, transport_scratch *scratch)
{
    const ray *r = look->ray;
    direct_sum sum = {.pass = pass,
                      .groups = scratch->estimate.groups,
                      .n_groups = scratch->estimate.n_groups};
    for (size_t i = 0; i < sum.n_groups; i++)
        sum.groups[i] = (spectrum){0};
    if (!medium_scatters(r->medium))
        return sum.radiance;
    medium_sample at = point_on(pass, look, random);
    if (!at.scatters)
        return sum.radiance;
    const surface_hit hit = hit_in_medium(r, at.t);
    bsdf b;
    bsdf_sample way;
    bsdf_make_phase(&b, r->medium->g, look->lane);
    sample_lamps(look, &hit, &b, random, scratch, &sum);
    if (pass->how->shadow_rays &&
        bsdf_sample_direction(&b, -r->direction, 0.0f, sampler_2d(random), LOBE_ALL,
                              TRANSPORT_RADIANCE, &way))
        meet_lamps(look, &hit, &way, scratch, &sum);
    at.weight *= solids_transmittance(&r->solids, at.t, &pass->w);
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
