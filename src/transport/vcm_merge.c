/*
 * Which light vertices a camera vertex merges with, and over what area they are a
 * density.
 *
 * Around a point of a surface that is a disc, of which at edges and corners a part is
 * left. A flat curve turns to face every ray, so its vertices do not lie on what the eye
 * sees; they are put on its axis, and those of one curve within reach along it are a
 * density over as much area as pieces of it show across that axis.
 */
#include "photon/neighbourhood.h"
#include "transport/vcm.h"

/* A search around a camera vertex. */
typedef struct vertex_search {
    const vcm_pass *pass;
    surface_hit at; /* the vertex, where the map has it */
    photon_filter filter;
    const kernel *kappa;
    estimate_scratch *scratch;
} vertex_search;

/* A hit, and its wo, where the map has it. */
static surface_hit place_in_map(const vcm_pass *pass, const surface_hit *hit, vec3 *wo)
{
    surface_hit at = *hit;
    at.p = vcm_place(pass, hit);
    if (pass->n_slices > 1)
        at.time = time_of_slice(time_slice(hit->time, pass->n_slices), pass->n_slices);
    if (scene_hit_moves(pass->scene, hit)) {
        transform by = vcm_motion_to_map(pass, hit);
        instance_move_hit(&by, &at);
        *wo = transform_vector(&by, *wo);
    }
    return at;
}

static vertex_search search_around(const vcm_pass *pass, const vcm_vertex *v)
{
    vec3 wo = v->wo;
    bool transmits = v->bsdf.lobes & LOBE_TRANSMISSION;
    vertex_search s = {.pass = pass, .at = place_in_map(pass, v->hit, &wo)};
    int face = dot3(s.at.n_geom, wo) < 0.0f ? -1 : 1;
    s.filter = (photon_filter){
        .n = face < 0 ? -s.at.n_geom : s.at.n_geom,
        .one_sided = !transmits,
        .any_normal = s.at.turns,
        .face = transmits && !s.at.turns ? face : 0,
        .flatten = s.at.turns ? 1.0f : (float)pass->plan->how.flatten,
    };
    return s;
}

static const light_vertex *vertex_of(const vertex_search *s, size_t k)
{
    spectrum payload = photon_map_store(s->pass->map)->flux[k];
    return &s->pass->light.vertices[vcm_payload_vertex(payload)];
}

/* What turns is a surface of its own, alone with itself. */
static bool is_same_surface(const vertex_search *s, const surface_hit *there)
{
    if (!s->at.turns || !there->turns)
        return s->at.turns == there->turns;
    return s->at.shape == there->shape && s->at.instance == there->instance;
}

/* Leaves out of the hits those on other surfaces, or out of sight of hood, if there is
   one. */
static void leave_out(const vertex_search *s, const neighbourhood *hood)
{
    photon_hits *hits = &s->scratch->hits;
    size_t kept = 0;
    for (size_t i = 0; i < hits->n; i++) {
        size_t k = hits->index[i];
        if (hood ? !neighbourhood_sees(
                       hood, photon_store_get(photon_map_store(s->pass->map), k).p)
                 : !is_same_surface(s, &vertex_of(s, k)->hit))
            continue;
        hits->index[kept] = k;
        hits->distance2[kept++] = hits->distance2[i];
    }
    hits->n = kept;
}

/* The light vertices around the place. @return false: none, or memory is refused. */
static bool find(const vertex_search *s)
{
    photon_hits *hits = &s->scratch->hits;
    bool done =
        photon_map_within(s->pass->map, s->at.p, s->pass->radius, &s->filter, hits);
    s->scratch->failed |= !done;
    if (done && s->pass->some_turn)
        leave_out(s, NULL);
    return done && hits->n > 0;
}

/* Where the camera looks, only the part of the disc counts that is surface in sight.
   @return its share; the hits are then those of that part. */
static float keep_surface(vertex_search *s)
{
    neighbourhood hood = {.scene = s->pass->scene,
                          .p = s->at.p,
                          .n = s->filter.n,
                          .radius = s->pass->radius,
                          .time = s->at.time};
    if (!s->pass->plan->how.edges || neighbourhood_is_whole(&hood))
        return 1.0f;
    float share = neighbourhood_coverage(&hood, s->kappa);
    s->filter.flatten = NEIGHBOURHOOD_FLATTEN;
    if (find(s))
        leave_out(s, &hood);
    return share;
}

/* Sums pieces of a curve around a place, by the kernel. */
typedef struct curve_area {
    vec3 p;
    float r2;
    const kernel *kappa;
    double sum;
} curve_area;

static void add_piece(vec3 middle, float area, void *data)
{
    curve_area *a = data;
    float distance2 = length3_2(middle - a->p);
    if (distance2 < a->r2)
        a->sum += (double)area * (double)kernel_eval(a->kappa, distance2, a->r2);
}

static float area_of_curve(const vertex_search *s, const surface_hit *hit)
{
    const vcm_pass *pass = s->pass;
    curve_area a = {vcm_place(pass, hit), square(pass->radius), s->kappa, 0.0};
    scene_pieces_near(pass->scene, hit, a.p, pass->radius, add_piece, &a);
    return (float)a.sum;
}

float vcm_find_vertices(const vcm_pass *pass, const vcm_vertex *v, const kernel *kappa,
                        bool first, estimate_scratch *scratch)
{
    vertex_search s = search_around(pass, v);
    s.kappa = kappa;
    s.scratch = scratch;
    if (!find(&s))
        return 0.0f;
    if (s.at.turns)
        return area_of_curve(&s, v->hit);
    return kernel_area(kappa, square(pass->radius)) * (first ? keep_surface(&s) : 1.0f);
}
