/* Camera subpaths: each vertex meets lights, is connected, and merges. */
#include "transport/direct.h"
#include "transport/vcm/vcm.h"

/* One camera subpath on its way. */
typedef struct camera_walk {
    vcm_walk walk;
    const vcm_pass *pass;
    sampler *random;
    transport_scratch *scratch;
    radiance_sample *out;
    size_t first_light, end_light;          /* the light subpath that it connects to */
    partial_weights at_curve, before_curve; /* see leave_curve */
    vec3 eye;                               /* where the camera ray began */
    bool guided; /* a surface that it came to guides the denoiser */
} camera_walk;

static void add(camera_walk *c, scattering_counts counts, int source, spectrum radiance)
{
    spectrum value = c->walk.at.throughput * radiance;
    if (!spectrum_is_finite(value)) {
        c->scratch->n_not_finite++;
        return;
    }
    c->out->layers[vcm_layer(counts)] += value;
    if (c->out->groups)
        c->out->groups[scene_light_group(c->pass->scene, source)] += value;
}

/* Which light light came from, and what it scattered by on its way. */
typedef struct arrival {
    scattering_counts before;
    int source;
} arrival;

/* Adds what this surface scatters by its two classes of lobes, f, of light that itself
   came by a light subpath. */
static void add_scattered(camera_walk *c, const lobe_pair *f, arrival from,
                          spectrum arriving)
{
    for (int i = 0; i < 2; i++) {
        scattering_counts seen = vcm_count(c->walk.counts, i == 0);
        if (!spectrum_is_black(f->value[i]))
            add(c, vcm_join(seen, from.before), from.source, f->value[i] * arriving);
    }
}

/* ---- The camera path runs into a light ---- */

/* True if lights that this path meets are counted, and by it alone. */
static bool meets_alone(const camera_walk *c, bool *counted)
{
    const vcm_strategies *how = &c->pass->strategies;
    bool seen_directly = c->walk.counts.n == 0;
    *counted = how->connect || seen_directly || (how->merge && c->walk.at.mirrors_only);
    return !how->connect || seen_directly;
}

static float met_weight(const camera_walk *c, int index, const surface_hit *hit)
{
    const scene *s = c->pass->scene;
    const light *l = scene_light(s, index);
    vec3 d = c->walk.at.ray.direction;
    float connected = light_tree_probability(s->light_tree, c->walk.from, index) *
                      l->kind->pdf(l->self, c->walk.from, d, hit);
    if (hit)
        connected *= fabsf(dot3(d, hit->n_geom)) / length3_2(hit->p - c->walk.from);
    float position, direction;
    l->kind->emit_pdf(l->self, hit ? hit->p : c->walk.from, hit ? hit->n_geom : -d, -d,
                      &position, &direction);
    float p_traced = distribution_pdf(&s->light_power, (size_t)index);
    return weights_met(&c->walk.weights, connected, p_traced * position * direction);
}

static void meet_light(void *data, const met_light *met)
{
    camera_walk *c = data;
    bool counted, alone = meets_alone(c, &counted);
    if (!counted || spectrum_is_black(met->radiance))
        return;
    float weight = alone ? 1.0f : met_weight(c, met->light, met->hit);
    add(c, c->walk.counts, met->light, met->radiance * weight);
    radiance_sample_light(c->out, &c->walk.at, met->radiance * weight);
}

static void meet_surface(void *data, const surface_hit *hit)
{
    camera_walk *c = data;
    const partial_weights before = c->walk.weights;
    if (hit)
        weights_arrive(&c->walk.weights, length3_2(hit->p - c->walk.from),
                       fabsf(dot3(c->walk.at.ray.direction, hit->n_geom)));
    direct_meet(c->pass->scene, &c->pass->w, &c->walk.at.ray, hit, meet_light, c);
    c->walk.weights = before;
}

/* ---- Connections ---- */

static float light_weight(const camera_walk *c, const vcm_vertex *v, int index,
                          const light_sample *to_light)
{
    const scene *s = c->pass->scene;
    const light *l = scene_light(s, index);
    bool far = isinf(to_light->distance);
    const light_start start = {
        .light = l,
        .p_traced = distribution_pdf(&s->light_power, (size_t)index),
        .p = far ? v->hit->p : v->hit->p + to_light->wi * to_light->distance,
        .n = to_light->n,
        .direction = -to_light->wi,
        .distance2 = square(to_light->distance),
        .pdf = to_light->pdf,
        .cosine = hit_cosine(v->hit, to_light->wi),
    };
    float met =
        l->is_delta ? 0.0f : vcm_pdf(v, to_light->wi, TRANSPORT_RADIANCE) / to_light->pdf;
    float reverse = vcm_pdf_reverse(v, to_light->wi, TRANSPORT_RADIANCE);
    float traced =
        weights_connected(&c->walk.weights, light_start_traced_over_connected(&start),
                          reverse, &c->pass->ratios, v->alone);
    return 1.0f / (met + 1.0f + traced);
}

static void connect_to_light(camera_walk *c, const vcm_vertex *v)
{
    const light_numbers u = sampler_light(c->random);
    int index;
    light_sample to_light;
    if (!scene_sample_light(c->pass->scene, &c->pass->w, v->hit->p, u.light, u.primitive,
                            u.place, &index, &to_light))
        return;
    lobe_pair f = vcm_scatter(v, to_light.wi, TRANSPORT_RADIANCE);
    if (lobe_pair_is_black(&f))
        return;
    c->scratch->shadow_rays++;
    spectrum transmittance;
    if (!vcm_visible(c->pass, v->hit, to_light.wi, to_light.distance,
                     vcm_events_left(c->pass, c->walk.counts, 1), &transmittance))
        return;
    float weight = light_weight(c, v, index, &to_light);
    add_scattered(c, &f, (arrival){.source = index},
                  to_light.radiance * (weight / to_light.pdf) * transmittance);
}

/* Where a camera vertex and a light vertex face one another. */
typedef struct vertex_pair {
    const vcm_vertex *eye, *source;
    const light_vertex *light;
    vec3 direction; /* from eye to light */
    float distance2;
} vertex_pair;

static float pair_weight(const camera_walk *c, const vertex_pair *p)
{
    vec3 d = p->direction;
    float eye_area = hit_cosine(p->eye->hit, d) / p->distance2;
    float light_area = fabsf(dot3(d, p->source->hit->n_geom)) / p->distance2;
    float light_side = weights_connected(
        &p->light->weights, light_area * vcm_pdf(p->eye, d, TRANSPORT_RADIANCE),
        vcm_pdf_reverse(p->source, -d, TRANSPORT_IMPORTANCE), &c->pass->ratios,
        p->source->alone);
    float eye_side = weights_connected(
        &c->walk.weights, eye_area * vcm_pdf(p->source, -d, TRANSPORT_IMPORTANCE),
        vcm_pdf_reverse(p->eye, d, TRANSPORT_RADIANCE), &c->pass->ratios, p->eye->alone);
    return 1.0f / (light_side + 1.0f + eye_side);
}

static void add_pair(camera_walk *c, const vertex_pair *p)
{
    lobe_pair f = vcm_scatter(p->eye, p->direction, TRANSPORT_RADIANCE);
    lobe_pair g = vcm_scatter(p->source, -p->direction, TRANSPORT_IMPORTANCE);
    if (lobe_pair_is_black(&f) || lobe_pair_is_black(&g))
        return;
    c->scratch->shadow_rays++;
    spectrum transmittance;
    scattering_counts all = vcm_join(c->walk.counts, p->light->before);
    if (!vcm_visible(c->pass, p->eye->hit, p->direction, sqrtf(p->distance2),
                     vcm_events_left(c->pass, all, 2), &transmittance))
        return;
    spectrum scale = transmittance * (pair_weight(c, p) / p->distance2);
    for (int i = 0; i < 2; i++) {
        scattering_counts before = p->light->before;
        before.n++;
        before.n_diffuse += i == 0;
        if (!spectrum_is_black(g.value[i]))
            add_scattered(c, &f, (arrival){before, p->light->light},
                          p->light->flux * g.value[i] * scale);
    }
}

static void connect_to_vertex(camera_walk *c, const vcm_vertex *v, const light_vertex *l)
{
    static const bsdf_options options = {0};
    const vcm_pass *pass = c->pass;
    if (!vcm_length_allowed(pass, vcm_join(c->walk.counts, l->before), 2))
        return;
    const surface_hit hit = scene_restore_hit(pass->scene, &l->hit);
    vec3 to = hit.p - v->hit->p;
    float distance2 = length3_2(to);
    if (!(distance2 > 0.0f) || vcm_ends_light(pass, &hit))
        return;
    vcm_vertex source = {.hit = &hit, .wo = kept_hit_wo(&l->hit), .alone = l->alone};
    scene_bsdf(pass->scene, &hit, &pass->w, ALL_WAVELENGTHS, &options, &source.bsdf);
    const vertex_pair p = {v, &source, l, to / sqrtf(distance2), distance2};
    add_pair(c, &p);
}

/* What is connected where light subpaths end, nothing is merged (see leave_curve). */
static void connect(camera_walk *c, const vcm_vertex *v)
{
    vcm_vertex at = *v;
    if (vcm_ends_light(c->pass, v->hit))
        at.alone = 0.0f;
    connect_to_light(c, &at);
    for (size_t i = c->first_light; i < c->end_light; i++)
        connect_to_vertex(c, &at, &c->pass->light.vertices[i]);
}

/* ---- Merging ---- */

static float merge_weight(const camera_walk *c, const vcm_vertex *v,
                          const merge_vertex *l, vec3 wi)
{
    if (c->pass->strategies.end_here)
        return 1.0f;
    float light_side = weights_merged(&l->weights, vcm_pdf(v, wi, TRANSPORT_RADIANCE),
                                      &c->pass->ratios, v->alone);
    float eye_side =
        weights_merged(&c->walk.weights, vcm_pdf_reverse(v, wi, TRANSPORT_RADIANCE),
                       &c->pass->ratios, v->alone);
    return 1.0f / (light_side + 1.0f + eye_side);
}

/* To where light came from, of what moves with its surface to another time. */
static vec3 direction_at(const scene *s, const kept_hit *kept, float time)
{
    const surface_hit on = {.instance = kept->instance, .time = kept->time};
    vec3 wi = kept_hit_wo(kept);
    if (!scene_hit_moves(s, &on))
        return wi;
    transform by = scene_motion_to(s, &on, time);
    return normalize3(transform_vector(&by, wi));
}

/* The direction to where the light of the map's k-th vertex came from, at v's time.
   @return false: it is of another slice of time */
static bool direction_of(const vcm_pass *pass, const vcm_vertex *v, size_t k, vec3 *wi)
{
    const float *d = pass->merged[k].wi;
    *wi = vec3_make(d[0], d[1], d[2]);
    if (!pass->scene->moves)
        return true;
    size_t vertex = photon_map_store(pass->map)->number[k];
    const kept_hit *kept = &pass->light.vertices[vertex].hit;
    *wi = direction_at(pass->scene, kept, v->hit->time);
    return time_slice(kept->time, pass->n_slices) ==
           time_slice(v->hit->time, pass->n_slices);
}

/* Light vertices are a density over the true surface; light sees the shading normal by
   the cosine that is in f. @param k of the map */
static void merge_with(camera_walk *c, const vcm_vertex *v, size_t k,
                       float kernel_over_area)
{
    const vcm_pass *pass = c->pass;
    const merge_vertex *l = &pass->merged[k];
    vec3 wi;
    if (vcm_ends_light(pass, v->hit) && pass->strategies.connect && l->weights.vcm > 0.0f)
        return;
    if (!direction_of(pass, v, k, &wi))
        return;
    float cosine = hit_cosine(v->hit, wi);
    if (!(cosine > 0.0f) ||
        !vcm_length_allowed(pass, vcm_join(c->walk.counts, l->before), 1))
        return;
    lobe_pair f = vcm_scatter(v, wi, TRANSPORT_RADIANCE);
    if (lobe_pair_is_black(&f))
        return;
    float density =
        kernel_over_area * (float)pass->n_slices / ((float)pass->light.n * cosine);
    add_scattered(c, &f, (arrival){l->before, l->light},
                  l->flux * (merge_weight(c, v, l, wi) * density));
}

static void merge(camera_walk *c, const vcm_vertex *v)
{
    const vcm_pass *pass = c->pass;
    const settings *how = &pass->plan->how;
    const point_hits *hits = &c->scratch->estimate.hits;
    const kernel kappa = {(kernel_choice)how->class_kernel[PHOTON_INDIRECT],
                          (float)how->class_cone_k[PHOTON_INDIRECT]};
    float r2 = square(pass->radius);
    float area = vcm_find_vertices(pass, v, &kappa, c->walk.counts.n_diffuse == 0,
                                   &c->scratch->estimate);
    for (size_t i = 0; i < hits->n && area > 0.0f; i++)
        merge_with(c, v, hits->index[i],
                   kernel_eval(&kappa, hits->distance2[i], r2) / area);
}

/* ---- The path ---- */

static bool survives(camera_walk *c)
{
    if (c->walk.counts.n < ROULETTE_BOUNCES)
        return true;
    float p = fminf(most_survival(c->walk.counts.n),
                    spectrum_mean(c->walk.at.throughput) * c->walk.eta2);
    c->walk.at.throughput /= p;
    c->walk.at.certain = false;
    return sampler_1d(c->random) < p;
}

/* All that ends at v. */
static void shade(camera_walk *c, const vcm_vertex *v)
{
    const vcm_strategies *how = &c->pass->strategies;
    if (!(v->bsdf.lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)))
        return;
    if (how->connect)
        connect(c, v);
    if (how->merge)
        merge(c, v);
}

/* Where light subpaths end, a curve that turns to face rays, connections find all light
   but that which comes by a mirror: only that is merged, for rays to and from the curve
   differ by its width. So what merging there adds to the weights, at_curve, counts once
   the path has met a mirror next. Without the zeros on arrival /flat-curves/room/vcm
   fails; without those on leaving, or where all is merged, /flat-curves/sky/vcm. */
static void arrive_past_curve(camera_walk *c, const surface_hit *hit, float cosine)
{
    c->before_curve = c->at_curve;
    weights_arrive(&c->at_curve, length3_2(hit->p - c->walk.from), cosine);
    if (vcm_ends_light(c->pass, hit))
        c->walk.weights = c->at_curve = (partial_weights){0};
}

static void leave_curve(camera_walk *c, const vcm_vertex *v)
{
    partial_weights *w = &c->walk.weights;
    if (c->walk.straight) {
        c->at_curve = c->before_curve;
        return;
    }
    if (!(w->vcm > 0.0f)) {
        weights_bounce_specular(&c->at_curve,
                                hit_cosine(v->hit, c->walk.at.ray.direction));
        w->vc += c->at_curve.vc;
        w->vm += c->at_curve.vm;
    }
    c->at_curve = (partial_weights){0};
    if (vcm_ends_light(c->pass, v->hit) && c->pass->strategies.connect) {
        c->at_curve = (partial_weights){.vc = w->vc, .vm = w->vm};
        w->vc = w->vm = 0.0f;
    }
}

/* Goes on from v by some of its lobes, which are followed with some probability. */
static bool go_on_by(camera_walk *c, const vcm_vertex *v, unsigned lobes,
                     float probability)
{
    if (!vcm_bounce(c->pass, &c->walk, v, lobes, probability, c->random))
        return false;
    leave_curve(c, v);
    return survives(c);
}

static void follow(camera_walk *c);

/* Goes on by one side of glass, for roulette as if that was all. */
static bool go_on_by_side(camera_walk *c, const vcm_vertex *v, unsigned side,
                          float probability)
{
    float before = spectrum_mean(c->walk.at.throughput) * c->walk.eta2;
    bool goes_on = go_on_by(c, v, LOBE_SPECULAR | side, probability);
    c->walk.eta2 = before / spectrum_mean(c->walk.at.throughput);
    return goes_on;
}

/* Follows the other side of glass, if so, and goes on with the usual one. */
static bool part(camera_walk *c, const vcm_vertex *v)
{
    const path_sides sides = path_part((unsigned)c->walk.counts.n, &v->bsdf, v->wo);
    camera_walk other = *c;
    sampler own = sampler_split(c->random, 0);
    other.random = &own;
    bool both = sampler_1d(&own) < sides.p_both;
    if (both && go_on_by_side(&other, v, sides.other, sides.p_both))
        follow(&other);
    bool goes_on = go_on_by_side(c, v, sides.usual, 1.0f);
    float scale = both ? sides.beside : sides.alone;
    c->walk.at.throughput *= scale;
    c->walk.eta2 /= scale;
    return goes_on;
}

/* Goes on from v, by mirrors only if all else has been merged. */
static bool go_on(camera_walk *c, const vcm_vertex *v)
{
    const vcm_strategies *how = &c->pass->strategies;
    if (!how->connect && !how->merge)
        return false;
    if (path_is_parted(&c->walk.at, (unsigned)c->walk.counts.n, &v->bsdf))
        return part(c, v);
    return go_on_by(c, v, how->end_here ? LOBE_SPECULAR | LOBE_ANY_SIDE : LOBE_ALL, 1.0f);
}

static void follow(camera_walk *c)
{
    static const bsdf_options options = {0};
    const vcm_pass *pass = c->pass;
    vcm_walk *walk = &c->walk;
    const scene_traveller who = {.scene = pass->scene,
                                 .w = &pass->w,
                                 .n_rays = &c->scratch->camera_rays,
                                 .path = c,
                                 .meet_light = meet_surface};
    surface_hit hit;
    while (!cancelled(pass->plan->cancel)) {
        if (scene_advance(&who, &walk->at, &hit) != EVENT_SURFACE) {
            meet_surface(c, NULL);
            return;
        }
        vcm_vertex v = {.hit = &hit, .wo = -walk->at.ray.direction};
        float cosine = hit_cosine(&hit, v.wo);
        scene_bsdf(pass->scene, &hit, &pass->w, ALL_WAVELENGTHS, &options, &v.bsdf);
        if (walk->at.eye)
            radiance_sample_note(c->out, v.hit, &v.bsdf, v.wo, walk->from);
        c->guided =
            c->guided || radiance_sample_guide(c->out, &hit, &v.bsdf, v.wo, c->eye,
                                               spectrum_mean(walk->at.throughput));
        if (!vcm_length_allowed(pass, walk->counts, 1) || !(cosine > 0.0f))
            return;
        walk->before = walk->weights;
        weights_arrive(&walk->weights, length3_2(hit.p - walk->from), cosine);
        arrive_past_curve(c, &hit, cosine);
        v.alone = walk->at.mirrors_only
                      ? 1.0f
                      : vcm_alone_at(pass, &hit, &c->scratch->estimate.hits);
        shade(c, &v);
        if (!go_on(c, &v))
            return;
    }
}

/* The light subpath that this camera path connects to. */
static void choose_light_path(camera_walk *c)
{
    const light_paths *paths = &c->pass->light;
    size_t i =
        hash_mix(hash_mix(c->random->key, c->random->index), c->pass->index) % paths->n;
    if (c->pass->scene->moves)
        i = MIN((size_t)((double)c->walk.at.ray.time * (double)paths->n), paths->n - 1);
    c->first_light = i > 0 ? paths->end[i - 1] : 0;
    c->end_light = paths->end[i];
}

void vcm_radiance(const void *data, const ray *r, sampler *random,
                  transport_scratch *scratch, radiance_sample *out)
{
    const vcm_pass *pass = data;
    *out = (radiance_sample){.groups = out->groups};
    camera_walk c = {
        .pass = pass, .random = random, .scratch = scratch, .out = out, .eye = r->origin};
    c.walk = (vcm_walk){.at = path_segment_from_eye(pass->plan->view, r),
                        .from = r->origin,
                        .eta2 = 1.0f,
                        .mode = TRANSPORT_RADIANCE};
    if (pass->strategies.splat) {
        float pdf =
            camera_pdf_direction(&pass->plan->view->camera, r->direction, r->time);
        c.walk.weights.vcm = 1.0f / (pdf * pass->camera_per_light);
    }
    if (pass->strategies.connect)
        choose_light_path(&c);
    follow(&c);
}
