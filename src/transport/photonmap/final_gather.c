/*
 * Final gathering (Jensen 1996; Christensen 1999): indirect light at a seen point is the
 * mean over rays of what the maps say about the surfaces those rays meet, so that the
 * map's blotches are averaged away.
 *
 * A gather ray never counts lights it meets: light → here is the direct layer's, and
 * light → specular → here the caustic map's.
 *
 * The irradiance cache is looked up nearby only. Where light falls off to nothing, as on
 * a wall above its light, there are no photons, and the nearest place with any is far and
 * in the light: what is dark would shine. There the maps are asked, which is quick, for
 * few photons are in reach.
 */
#include "transport/photonmap/photonmap_medium.h"

#include "base/memory.h"
#include "photon/direction.h"
#include "photon/neighbourhood.h"

/* ---- The irradiance cache, at photon positions ---- */

typedef struct irradiance_loop {
    const photonmap_pass *pass;
    const photon_store *points;
    irradiance_cache *out;
    size_t offset;
    int slice;
    atomic_bool failed; /* memory was refused */
} irradiance_loop;

/* A place where the maps of a slice are asked. */
typedef struct map_place {
    const photonmap_pass *pass;
    int slice;
    vec3 p, n;
} map_place;

/* By the photons of one class; scratch->groups are its parts. */
static spectrum class_irradiance(const map_place *at, int c, estimate_scratch *scratch)
{
    const photonmap_pass *pass = at->pass;
    const photon_map *map = pass->maps[at->slice][c];
    estimate_options options =
        photonmap_options_at(pass, (photon_class)c, at->p, &scratch->hits);
    options.scene = pass->how->edges ? pass->scene : NULL;
    options.time = photonmap_slice_time(pass, at->slice);
    if (map)
        return photon_irradiance(map, at->p, at->n, &options, scratch, NULL);
    for (size_t i = 0; i < scratch->n_groups; i++)
        scratch->groups[i] = (spectrum){0};
    return (spectrum){0};
}

/* groups, if there are any, get their parts of it. */
static spectrum irradiance_at(const map_place *at, estimate_scratch *scratch,
                              spectrum *groups)
{
    spectrum sum = {0};
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        sum += class_irradiance(at, c, scratch);
        for (size_t i = 0; i < scratch->n_groups; i++)
            groups[i] += scratch->groups[i];
    }
    return sum;
}

static void irradiance_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    irradiance_loop *loop = data;
    estimate_scratch scratch = {0};
    size_t n_groups = (size_t)loop->pass->scene->n_light_groups;
    bool ready = estimate_scratch_init(&scratch, n_groups, NULL);
    for (size_t i = begin; i < end && ready; i++) {
        photon p = photon_store_get(loop->points, i);
        size_t at = loop->offset + i;
        loop->out->places.x[at] = p.p[0];
        loop->out->places.y[at] = p.p[1];
        loop->out->places.z[at] = p.p[2];
        loop->out->normal[at] = loop->points->normal[i];
        spectrum *groups = n_groups > 0 ? loop->out->groups + at * n_groups : NULL;
        const map_place place = {loop->pass, loop->slice, p.p, p.n};
        loop->out->irradiance[at] = irradiance_at(&place, &scratch, groups);
    }
    if (estimate_scratch_refused(&scratch) || !ready)
        atomic_store(&loop->failed, true);
    estimate_scratch_clear(&scratch);
}

/* @param offset of the first of them in the cache */
static bool add_points(const photonmap_pass *pass, int slice, const trace_result *points,
                       size_t offset, irradiance_cache *out, GError **error)
{
    irradiance_loop loop = {.pass = pass,
                            .points = &points->photons,
                            .out = out,
                            .offset = offset,
                            .slice = slice};
    if (!parallel_work(points->photons.n, RAYS_AT_ONCE, plan_workers(pass->plan),
                       irradiance_chunk, &loop, error))
        return false;
    if (atomic_load(&loop.failed)) {
        error_set(error, ERROR_FAILED, "out of memory for irradiance estimates");
        return false;
    }
    return true;
}

void irradiance_cache_free(irradiance_cache *cache)
{
    if (!cache)
        return;
    point_index_free(cache->index);
    point_arrays_clear(&cache->places);
    big_free(cache->normal);
    big_free(cache->irradiance);
    big_free(cache->groups);
    g_free(cache);
}

static irradiance_cache *cache_with_room(size_t n, size_t n_groups, GError **error)
{
    const char *what = "the irradiance cache";
    size_t padded = points_padded(n);
    irradiance_cache *cache = g_new0(irradiance_cache, 1);
    if (point_arrays_make(&cache->places, n, what, error))
        cache->normal = big_alloc(padded, sizeof *cache->normal, what, error);
    if (cache->normal)
        cache->irradiance = big_alloc(n, sizeof *cache->irradiance, what, error);
    if (cache->irradiance && n_groups > 0)
        cache->groups = big_alloc(n * n_groups, sizeof *cache->groups, what, error);
    if (cache->irradiance && (cache->groups || n_groups == 0))
        return cache;
    irradiance_cache_free(cache);
    return NULL;
}

/* Sorts the places, and what is kept at them likewise. */
static bool sort_cache(irradiance_cache *cache, size_t n_groups, workers by,
                       GError **error)
{
    size_t n = cache->places.n, *order = NULL;
    cache->index = point_index_build(MAP_KDTREE, &cache->places, 0.0f, by, &order, error);
    bool ok =
        cache->index &&
        (!order ||
         (points_permute(&cache->normal, n, sizeof *cache->normal, order, by, error) &&
          points_permute(&cache->irradiance, n, sizeof *cache->irradiance, order, by,
                         error) &&
          (!cache->groups ||
           points_permute(&cache->groups, n, n_groups * sizeof *cache->groups, order, by,
                          error))));
    big_free(order);
    return ok;
}

bool irradiance_cache_build(photonmap_pass *pass, int slice, const trace_result *points,
                            size_t n, GError **error)
{
    size_t total = 0, n_groups = (size_t)pass->scene->n_light_groups;
    for (size_t i = 0; i < n; i++)
        total += points[i].photons.n;
    irradiance_cache *cache = cache_with_room(total, n_groups, error);
    pass->irradiance[slice] = cache;
    bool ok = cache != NULL;
    for (size_t i = 0, offset = 0; i < n && ok; offset += points[i++].photons.n)
        ok = add_points(pass, slice, &points[i], offset, cache, error);
    return ok && sort_cache(cache, n_groups, plan_workers(pass->plan), error);
}

/* What moves is looked up where its photons are kept. */
static map_place place_of(const photonmap_pass *pass, const shading_point *at)
{
    map_place place = {pass, time_slice(at->hit->time, pass->n_slices), at->hit->p,
                       face_forward(at->hit->n_geom, at->wo)};
    if (scene_hit_moves(pass->scene, at->hit)) {
        transform by = scene_motion_to(pass->scene, at->hit,
                                       photonmap_slice_time(pass, place.slice));
        place.p = transform_point(&by, place.p);
        place.n = normalize3(transform_normal(&by, place.n));
    }
    return place;
}

static float cache_reach(const map_place *at, point_hits *hits)
{
    float least = INFINITY;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        if (c != PHOTON_CAUSTIC && at->pass->plan->n_photons[c] > 0)
            least =
                minf(least,
                     photonmap_options_at(at->pass, (photon_class)c, at->p, hits).radius);
    }
    return SHARED_REACH * least;
}

/* ---- Places that face a surface ---- */

typedef struct facing {
    const uint32_t *normal; /* packed, of the places */
    vec3 n;
} facing;

static bool faces(const void *data, size_t place)
{
    const facing *f = data;
    return direction_dot(f->normal[place], f->n) > 0.0f;
}

static unsigned faces_lanes(const void *data, size_t first, unsigned bits)
{
    const facing *f = data;
    return bits & directions_on_side(load_lane_ints(f->normal + first), f->n);
}

static const point_rules facing_rules = {.accepts = faces, .accepted = faces_lanes};

/* The irradiance that the cache has nearest, of a surface that faces the same way.
   @return false: there is none within reach */
static bool cached_irradiance(const map_place *at, estimate_scratch *scratch,
                              spectrum *irradiance, const spectrum **groups)
{
    const photonmap_pass *pass = at->pass;
    point_hits *hits = &scratch->hits;
    const irradiance_cache *cache = pass->irradiance[at->slice];
    float reach = cache_reach(at, hits);
    const facing by = {cache->normal, at->n};
    const point_query query = {.p = at->p, .rules = &facing_rules, .data = &by};
    if (!point_index_nearest(cache->index, &query, 1, reach, hits))
        scratch->failed = true;
    if (hits->n == 0)
        return false;
    size_t k = hits->index[0];
    *irradiance = cache->irradiance[k];
    if (cache->groups)
        *groups = cache->groups + (size_t)pass->scene->n_light_groups * k;
    return true;
}

/* ---- Gather rays ---- */

typedef struct gather_path {
    path_segment at;
    int64_t bounces; /* since it left the point that gathers */
    const photonmap_pass *pass;
    sampler *random;
    transport_scratch *scratch;
    spectrum sum; /* found so far */
} gather_path;

/* Adds parts by light groups to scratch->gathered; parts may be NULL: none. */
static void collect(const photonmap_pass *pass, transport_scratch *scratch,
                    spectrum factor, const spectrum *parts)
{
    for (int i = 0; i < pass->scene->n_light_groups && parts; i++)
        scratch->gathered[i] += factor * parts[i];
}

/* What a Lambertian surface sends out by all maps, cached or asked; throughput times its
   parts by light groups are collected. */
static spectrum outgoing_by_maps(const photonmap_pass *pass, const shading_point *at,
                                 spectrum throughput, transport_scratch *scratch)
{
    const map_place place = place_of(pass, at);
    const spectrum f = at->bsdf->rho * INV_PI_F, *parts = NULL;
    spectrum irradiance = {0};
    if (cached_irradiance(&place, &scratch->estimate, &irradiance, &parts)) {
        collect(pass, scratch, throughput * f, parts);
        return irradiance * f;
    }
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        irradiance += class_irradiance(&place, c, &scratch->estimate);
        collect(pass, scratch, throughput * f, scratch->estimate.groups);
    }
    return irradiance * f;
}

/* Outgoing radiance of the diffuse lobes at a point, from all that light does there;
   throughput times its parts by light groups are collected. */
static spectrum outgoing(const photonmap_pass *pass, const shading_point *at,
                         spectrum throughput, sampler *random, transport_scratch *scratch)
{
    const bool glossy = has_lobes(at->bsdf, pass->gathered & LOBE_GLOSSY);
    if (pass->irradiance[0] && at->bsdf->lambertian && !glossy && !at->hit->camera_facing)
        return outgoing_by_maps(pass, at, throughput, scratch);
    spectrum radiance = {0};
    if (pass->how->direct_illumination) {
        const direct_query query = {
            .scene = pass->scene,
            .w = &pass->w,
            .hit = at->hit,
            .bsdf = at->bsdf,
            .wo = at->wo,
            .shadow_rays = pass->how->shadow_rays,
            .options = &pass->options,
            .most_panes = pass->how->max_forward_bounces,
        };
        direct_radiance found[FEW_LIGHTS];
        if (direct_light(&query, random, found, &scratch->shadow_rays) > 0) {
            radiance = glossy ? found[0].diffuse + found[0].glossy : found[0].diffuse;
            if (scratch->gathered)
                scratch->gathered[scene_light_group(pass->scene, found[0].light)] +=
                    throughput * radiance;
        }
    }
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        if (c == PHOTON_DIRECT && pass->how->direct_illumination)
            continue;
        radiance += photonmap_gather(pass, (photon_class)c, at, 0, scratch);
        collect(pass, scratch, throughput, scratch->estimate.groups);
    }
    return radiance;
}

/* Goes on by a specular or glossy lobe; roulette ends weak paths and long ones. */
static bool gather_on(gather_path *path, const surface_hit *hit, const bsdf *b)
{
    scatter_numbers u = sampler_scatter(path->random);
    bsdf_sample next;
    const unsigned followed = path->pass->followed;
    if (!has_lobes(b, followed) ||
        !bsdf_sample_direction(b, -path->at.ray.direction, u.lobe, u.direction, followed,
                               TRANSPORT_RADIANCE, &next))
        return false;
    float p = minf(most_survival(path->bounces),
                   spectrum_mean(next.weight) * next.eta * next.eta);
    if (!(u.roulette < p))
        return false;
    path->at.throughput *= next.weight / p;
    path->at.wavelength = next.wavelength;
    path->at.ray = hit_ray(hit, next.wi);
    path->bounces++;
    return true;
}

/* What the medium that the ray travels in sends along it; what comes from behind it is
   multiplied by its transmittance. */
static scene_event cross_medium(void *data, float length, const surface_hit *behind,
                                surface_hit *at)
{
    (void)behind;
    (void)at;
    gather_path *path = data;
    const photonmap_pass *pass = path->pass;
    transport_scratch *scratch = path->scratch;
    const medium *m = scene_medium(pass->scene, path->at.ray.media.participating);
    const bool samples_lights = pass->how->direct_illumination;
    const spectrum before = path->at.throughput;
    const medium_look look = {&path->at.ray, length, before, path->at.wavelength, false};
    if (samples_lights) {
        path->sum +=
            before * photonmap_direct_in_medium(pass, &look, path->random, scratch);
        collect(pass, scratch, before, scratch->estimate.groups);
    }
    for (int c = samples_lights ? PHOTON_INDIRECT : PHOTON_DIRECT; c < N_PHOTON_CLASSES;
         c++) {
        path->sum += before * photonmap_gather_medium(pass, (photon_class)c,
                                                      &path->at.ray, length, scratch);
        collect(pass, scratch, before, scratch->estimate.groups);
    }
    path->at.throughput *= medium_transmittance(m, length, &pass->w);
    return EVENT_NONE;
}

static spectrum gather_along(gather_path path, int64_t events)
{
    const photonmap_pass *pass = path.pass;
    const scene_traveller who = {.scene = pass->scene,
                                 .w = &pass->w,
                                 .n_rays = &path.scratch->camera_rays,
                                 .path = &path,
                                 .cross_medium = cross_medium};
    surface_hit hit;
    while ((events < 0 || path.bounces < events) && !cancelled(pass->plan->cancel) &&
           scene_advance(&who, &path.at, &hit) == EVENT_SURFACE) {
        bsdf b;
        scene_bsdf(pass->scene, &hit, &pass->w, path.at.wavelength, &pass->options, &b);
        const shading_point at = {.hit = &hit, .bsdf = &b, .wo = -path.at.ray.direction};
        if (has_lobes(&b, pass->gathered))
            path.sum += path.at.throughput * outgoing(pass, &at, path.at.throughput,
                                                      path.random, path.scratch);
        if (!gather_on(&path, &hit, &b))
            break;
    }
    return path.sum;
}

spectrum final_gather(const photonmap_pass *pass, const shading_point *at,
                      float importance, int64_t events, sampler *random,
                      transport_scratch *scratch)
{
    float wanted = ceilf((float)pass->how->gather_rays * clampf(importance, 0.0f, 1.0f));
    uint32_t n = (uint32_t)maxf(1.0f, wanted);
    sampler own = sampler_split(random, 0x6761u);
    uint64_t key = hash_mix(own.key, own.index);
    spectrum sum = {0};
    int n_groups = pass->scene->n_light_groups;
    for (int i = 0; i < n_groups; i++)
        scratch->gathered[i] = (spectrum){0};
    for (uint32_t i = 0; i < n && !cancelled(pass->plan->cancel); i++) {
        sampler stream = sampler_make(key, i);
        float u_lobe = sampler_1d(&stream);
        vec2 u = sampler_2d(&stream);
        bsdf_sample first;
        if (!bsdf_sample_direction(at->bsdf, at->wo, u_lobe, u, pass->gathered,
                                   TRANSPORT_RADIANCE, &first))
            continue;
        const gather_path path = {.at = {.ray = hit_ray(at->hit, first.wi),
                                         .throughput = first.weight,
                                         .wavelength = first.wavelength},
                                  .pass = pass,
                                  .random = &stream,
                                  .scratch = scratch};
        sum += gather_along(path, events);
    }
    for (int i = 0; i < n_groups; i++)
        scratch->gathered[i] /= (float)n;
    return sum / (float)n;
}
