/*
 * Light subpaths: traced in chunks that are joined in order, so that a pass is the same
 * on any number of threads. Every vertex that scatters not only as a mirror is kept, and
 * connected to the eye on the spot.
 */
#include "base/memory.h"
#include "base/slab_list.h"
#include "transport/vcm/vcm.h"

#include <string.h>

/* What one chunk found, until the chunks are joined. */
typedef struct light_chunk {
    slab_list vertices, splats;
    size_t first_vertex, first_splat; /* of the whole, once that is known */
    slab **from; /* of the thread that traces it; NULL: nothing is kept */
    uint64_t n_rays, n_shadow_rays, n_not_finite;
    point_hits hits; /* scratch */
    GError *error;
} light_chunk;

/* One light subpath. */
typedef struct light_walk {
    vcm_walk walk;
    const vcm_pass *pass;
    sampler random;
    light_chunk *out;
    float time;           /* of the shutter */
    light_start start;    /* of the first vertex, which is still to be found */
    int light;            /* that it left */
    uint32_t primitive;   /* of its mesh */
    uint64_t index;       /* of the subpath */
    photon_listener tell; /* NULL: nobody listens */
    void *tell_data;
} light_walk;

static void tell(const light_walk *l, photon_event_kind kind, const surface_hit *hit)
{
    if (!l->tell)
        return;
    const photon_event event = {
        .kind = kind,
        .index = l->index,
        .p = hit ? hit->p : l->walk.at.ray.origin,
        .direction = l->walk.at.ray.direction,
        .hit = hit,
        .light = l->light,
        .lobe = l->walk.lobe,
        .flux = l->walk.at.throughput / (float)l->pass->light.n,
        .mis_weight = 1.0f,
    };
    l->tell(&event, l->tell_data);
}

/* ---- What is kept ---- */

static void keep(light_walk *l, const vcm_vertex *v)
{
    light_chunk *out = l->out;
    light_vertex *kept = NULL;
    if (out->from && !out->error)
        kept = slab_list_add(&out->vertices, sizeof *kept, out->from, "light vertices",
                             &out->error);
    if (kept)
        *kept = (light_vertex){
            .hit = hit_keep(&l->walk.at.ray, v->hit),
            .flux = l->walk.at.throughput,
            .weights = l->walk.weights,
            .before = l->walk.counts,
            .light = l->light,
            .alone = v->alone,
        };
}

static void keep_splat(light_walk *l, const splat *s)
{
    light_chunk *out = l->out;
    splat *kept = NULL;
    if (!spectrum_is_finite(s->value))
        out->n_not_finite++;
    else if (out->from && !out->error)
        kept =
            slab_list_add(&out->splats, sizeof *kept, out->from, "splats", &out->error);
    if (kept)
        *kept = *s;
}

/* Keeps it wherever the film sees it: filters reach over the film's borders. */
static void keep_splats(light_walk *l, splat s)
{
    const view *v = l->pass->plan->view;
    vec2 at[1 + MOST_REPEATS] = {s.raster};
    int n = 1 + camera_repeats(&v->camera, s.raster, at + 1);
    for (int i = 0; i < n; i++) {
        s.raster = at[i];
        if (filter_reaches(&v->filter, at[i], v->film.width, v->film.height))
            keep_splat(l, &s);
    }
}

/* ---- To the eye ---- */

static bool hidden(const scene *s, const surface_hit *hit)
{
    const shape *on = s->shapes->pdata[hit->shape];
    return on->camera_hidden;
}

/* True if the eye sees the hit, past what it does not see and through interfaces, but not
   through panes. */
static bool seen(const vcm_pass *pass, const surface_hit *hit,
                 const camera_connection *eye, spectrum *share)
{
    if (vcm_visible(pass, hit, eye->direction, eye->distance, 0, share))
        return true;
    if (!pass->camera_hides)
        return false;
    uint64_t untold = 0;
    const scene_traveller who = {.scene = pass->scene, .w = &pass->w, .n_rays = &untold};
    path_segment segment = {.ray = {.origin = hit_offset(hit, eye->direction) +
                                              eye->direction * eye->distance,
                                    .direction = -eye->direction,
                                    .t_max = distance_short_of(eye->distance),
                                    .time = hit->time},
                            .eye = pass->plan->view};
    const ray to = hit_ray_to(hit, eye->direction, eye->distance);
    *share = scene_transmittance(pass->scene, &to, &pass->w);
    surface_hit between;
    return scene_advance(&who, &segment, &between) == EVENT_ESCAPE;
}

/* The weight of this connection among all ways to find the path. */
static float weight_to_eye(const light_walk *l, const vcm_vertex *v,
                           const camera_connection *eye, float pdf_area)
{
    const vcm_pass *pass = l->pass;
    if (!pass->strategies.connect)
        return 1.0f;
    float reverse = vcm_pdf_reverse(v, eye->direction, TRANSPORT_IMPORTANCE);
    return 1.0f /
           (1.0f + weights_connected(&l->walk.weights, pdf_area * pass->camera_per_light,
                                     reverse, &pass->ratios, 1.0f));
}

static void connect_to_eye(light_walk *l, const vcm_vertex *v)
{
    const vcm_pass *pass = l->pass;
    const view *to = pass->plan->view;
    camera_connection eye;
    vec2 u_lens = sampler_2d(&l->random);
    if (hidden(pass->scene, v->hit) ||
        !camera_connect(&to->camera, v->hit->p, u_lens, v->hit->time, &eye) ||
        !filter_reaches(&to->filter, eye.raster, to->film.width, to->film.height))
        return;
    lobe_pair f = vcm_scatter(v, eye.direction, TRANSPORT_IMPORTANCE);
    if (lobe_pair_is_black(&f))
        return;
    l->out->n_shadow_rays++;
    spectrum transmittance;
    if (!seen(pass, v->hit, &eye, &transmittance))
        return;
    float density = eye.pdf / square(eye.distance);
    float cosine = hit_cosine(v->hit, eye.direction);
    float weight = weight_to_eye(l, v, &eye, density * cosine);
    for (int i = 0; i < 2; i++) {
        scattering_counts scattered = vcm_count((scattering_counts){0}, i == 0);
        splat s = {
            .value = l->walk.at.throughput * transmittance * f.value[i] *
                     (weight * density / (float)pass->light.n),
            .raster = eye.raster,
            .layer = vcm_layer(vcm_join(scattered, l->walk.counts)),
            .group = scene_light_group(pass->scene, l->light),
        };
        if (!spectrum_is_black(s.value))
            keep_splats(l, s);
    }
}

/* ---- One subpath ---- */

static uint64_t stream_key(const vcm_pass *pass)
{
    uint64_t key = hash_mix((uint64_t)pass->plan->how.seed, pass->index);
    return hash_mix(key, 0x76636du);
}

/* The i-th part of the shutter's time; 0 where nothing moves. */
static float time_of(const vcm_pass *pass, size_t i)
{
    if (!pass->scene->moves)
        return 0.0f;
    uint64_t h = hash_mix(stream_key(pass) ^ 0x74696d65u, i);
    double at = ((double)i + (double)(h >> 11) * 0x1p-53) / (double)pass->light.n;
    return minf((float)at, 0x1.fffffep-1f);
}

static bool emit(light_walk *l)
{
    const vcm_pass *pass = l->pass;
    const distribution *power = &pass->scene->light_power;
    light_numbers u = sampler_light(&l->random);
    vec2 u_direction = sampler_2d(&l->random);
    if (!scene_is_lit(pass->scene))
        return false;
    size_t index = distribution_sample(power, &u.light);
    const light *from = scene_light(pass->scene, (int)index);
    light_emission e = {.primitive = 0};
    if (!from->kind->emit(from->self, &pass->w, u.primitive, u.place, u_direction, &e))
        return false;
    float p_light = distribution_pdf(power, index);
    l->light = (int)index;
    l->primitive = e.primitive;
    l->start = (light_start){.light = from,
                             .p_traced = p_light,
                             .p = e.ray.origin,
                             .n = e.n,
                             .direction = e.ray.direction};
    e.ray.time = l->time;
    spectrum share = scene_leave_light(pass->scene, l->light, e.n, &pass->w, &e.ray);
    l->walk = (vcm_walk){.at = {.ray = e.ray,
                                .throughput = e.flux * share / p_light,
                                .wavelength = ALL_WAVELENGTHS},
                         .from = l->start.p,
                         .eta2 = 1.0f,
                         .mode = TRANSPORT_IMPORTANCE};
    return !spectrum_is_black(l->walk.at.throughput);
}

static void arrive_first(light_walk *l, const surface_hit *hit, float cosine,
                         float distance2)
{
    light_start *start = &l->start;
    const light *from = start->light;
    const surface_hit on_light = {
        .p = start->p, .n_geom = start->n, .primitive = l->primitive};
    start->cosine = cosine;
    start->distance2 = distance2;
    start->pdf = light_tree_probability(l->pass->scene->light_tree, hit->p, l->light);
    if (!from->kind->is_delta)
        start->pdf *= from->kind->pdf(from->self, hit->p, -start->direction, &on_light);
    l->walk.weights = weights_from_light(start, &l->pass->ratios);
}

static void arrive(light_walk *l, const surface_hit *hit)
{
    float cosine = hit_cosine(hit, l->walk.at.ray.direction);
    float distance2 = length3_2(hit->p - l->walk.from);
    l->walk.before = l->walk.weights;
    if (l->walk.counts.n == 0)
        arrive_first(l, hit, cosine, distance2);
    else
        weights_arrive(&l->walk.weights, distance2, cosine);
}

/* Keeps the power of subpaths even. */
static bool survives(light_walk *l, spectrum before)
{
    float p = fminf(most_survival(l->walk.counts.n),
                    spectrum_mean(l->walk.at.throughput) / spectrum_mean(before));
    l->walk.at.throughput /= p;
    return sampler_1d(&l->random) < p;
}

static void land(light_walk *l, const vcm_vertex *v)
{
    unsigned lobes = scene_lobes_around(l->pass->scene, v->hit, &v->bsdf);
    if (!(lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)) ||
        !vcm_length_allowed(l->pass, l->walk.counts, 1))
        return;
    bool ends = vcm_ends_light(l->pass, v->hit);
    if ((l->pass->strategies.connect && !ends) || l->pass->strategies.merge) {
        keep(l, v);
        tell(l, PHOTON_STORED, v->hit);
    }
    if (l->pass->strategies.splat && !ends)
        connect_to_eye(l, v);
}

/* Goes on from v. @return false: the subpath ends there */
static bool go_on(light_walk *l, const vcm_vertex *v)
{
    const vcm_pass *pass = l->pass;
    spectrum before = l->walk.at.throughput;
    if (vcm_ends_light(pass, v->hit) || !vcm_length_allowed(pass, l->walk.counts, 2)) {
        tell(l, PHOTON_ENDED, v->hit);
        return false;
    }
    bool scattered =
        vcm_bounce(pass, &l->walk, v, LOBE_ALL, 1.0f, &l->random) && survives(l, before);
    tell(l, scattered ? PHOTON_SCATTERED : PHOTON_ABSORBED, v->hit);
    return scattered;
}

static void follow(light_walk *l)
{
    static const bsdf_options options = {0};
    const vcm_pass *pass = l->pass;
    const scene_traveller who = {
        .scene = pass->scene, .w = &pass->w, .n_rays = &l->out->n_rays};
    tell(l, PHOTON_EMITTED, NULL);
    while (!l->out->error) {
        surface_hit hit;
        if (scene_advance(&who, &l->walk.at, &hit) != EVENT_SURFACE) {
            tell(l, PHOTON_LEFT, NULL);
            return;
        }
        vcm_vertex v = {.hit = &hit, .wo = -l->walk.at.ray.direction};
        scene_bsdf(pass->scene, &hit, &pass->w, ALL_WAVELENGTHS, &options, &v.bsdf);
        if (!(fabsf(dot3(v.wo, hit.n_geom)) > 0.0f))
            return;
        arrive(l, &hit);
        v.alone = vcm_alone_at(pass, &hit, &l->out->hits);
        land(l, &v);
        if (!go_on(l, &v))
            return;
    }
}

static light_walk walk_of(const vcm_pass *pass, size_t i)
{
    return (light_walk){.pass = pass,
                        .random = sampler_make(stream_key(pass), i),
                        .time = time_of(pass, i),
                        .index = i};
}

/* ---- All of them ---- */

typedef struct light_loop {
    vcm_pass *pass;
    light_chunk *chunks;
    slab **slabs; /* of each thread */
} light_loop;

static void trace_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    light_loop *loop = data;
    light_chunk *out = &loop->chunks[begin / RAYS_AT_ONCE];
    out->from = &loop->slabs[thread];
    const cancel_flag *cancel = loop->pass->plan->cancel;
    for (size_t i = begin; i < end && !out->error && !cancelled(cancel); i++) {
        light_walk l = walk_of(loop->pass, i);
        l.out = out;
        if (emit(&l))
            follow(&l);
        loop->pass->light.end[i] = out->vertices.n;
    }
    if (out->hits.refused && !out->error)
        point_hits_refuse(&out->error);
    point_hits_clear(&out->hits);
}

static void chunk_clear(light_chunk *chunk)
{
    slab_list_clear(&chunk->vertices);
    slab_list_clear(&chunk->splats);
    g_clear_error(&chunk->error);
    *chunk = (light_chunk){0};
}

static void put_vertices(const void *elements, size_t n, size_t at, void *data)
{
    memcpy((light_vertex *)data + at, elements, n * sizeof(light_vertex));
}

static void put_splats(const void *elements, size_t n, size_t at, void *data)
{
    memcpy((splat *)data + at, elements, n * sizeof(splat));
}

/* Copies chunk c's vertices and splats to their place and frees them. */
static void join_chunk(size_t c, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    const light_loop *loop = data;
    const light_paths *to = &loop->pass->light;
    light_chunk *from = &loop->chunks[c];
    for (size_t i = c * RAYS_AT_ONCE; i < MIN((c + 1) * RAYS_AT_ONCE, to->n); i++)
        to->end[i] += from->first_vertex;
    slab_list_move(&from->vertices, put_vertices, to->vertices + from->first_vertex);
    slab_list_move(&from->splats, put_splats, to->splats + from->first_splat);
}

static bool join(light_loop *loop, size_t n, transport_counts *counts, GError **error)
{
    size_t n_vertices = 0, n_splats = 0;
    light_paths *to = &loop->pass->light;
    light_chunk *chunks = loop->chunks;
    for (size_t c = 0; c < n; c++) {
        if (chunks[c].error) {
            g_propagate_error(error, g_steal_pointer(&chunks[c].error));
            return false;
        }
        chunks[c].first_vertex = n_vertices;
        chunks[c].first_splat = n_splats;
        n_vertices += chunks[c].vertices.n;
        n_splats += chunks[c].splats.n;
        slab_list_uncount(&chunks[c].vertices);
        slab_list_uncount(&chunks[c].splats);
        counts->photon_rays += chunks[c].n_rays;
        counts->n_not_finite += chunks[c].n_not_finite;
    }
    to->vertices = big_alloc(n_vertices, sizeof *to->vertices, "light vertices", error);
    to->splats = big_alloc(n_splats, sizeof *to->splats, "splats", error);
    if (!to->vertices || !to->splats)
        return false;
    to->n_vertices = n_vertices;
    to->n_splats = n_splats;
    parallel_for(n, 1, (unsigned)loop->pass->plan->how.threads, NULL, join_chunk, loop);
    return true;
}

void vcm_tell_light(const vcm_pass *pass, uint64_t i, photon_listener listener,
                    void *data)
{
    light_chunk unused = {0};
    light_walk l = walk_of(pass, (size_t)i);
    l.out = &unused;
    l.tell = listener;
    l.tell_data = data;
    if (emit(&l))
        follow(&l);
    point_hits_clear(&unused.hits);
    chunk_clear(&unused);
}

bool vcm_trace_light(vcm_pass *pass, const cancel_flag *cancel, transport_counts *counts,
                     GError **error)
{
    light_paths *paths = &pass->light;
    size_t n_chunks = (paths->n + RAYS_AT_ONCE - 1) / RAYS_AT_ONCE;
    light_chunk *chunks = big_alloc(n_chunks, sizeof *chunks, "light subpaths", error);
    paths->end =
        chunks ? big_alloc(paths->n, sizeof *paths->end, "light subpaths", error) : NULL;
    if (!paths->end) {
        big_free(chunks);
        return false;
    }
    light_loop loop = {.pass = pass, .chunks = chunks};
    const workers by = {(unsigned)pass->plan->how.threads, cancel};
    bool joined =
        slab_work(paths->n, RAYS_AT_ONCE, by, trace_chunk, &loop, &loop.slabs, error) &&
        join(&loop, n_chunks, counts, error);
    for (size_t c = 0; c < n_chunks; c++)
        chunk_clear(&chunks[c]);
    big_free(chunks);
    return joined;
}

void light_paths_clear(light_paths *paths)
{
    big_free(paths->vertices);
    big_free(paths->end);
    big_free(paths->splats);
    *paths = (light_paths){0};
}
