/*
 * Which light vertices a camera vertex merges with, and over what area they are a
 * density.
 *
 * Around a point of a surface that is a disc, of which at edges and corners a part is
 * left. For flat curves see photon/flat_curve.h.
 */
#include "photon/flat_curve.h"
#include "photon/neighbourhood.h"
#include "transport/vcm/vcm.h"

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
    if (pass->scene->moves)
        at.time = time_of_slice(time_slice(hit->time, pass->n_slices), pass->n_slices);
    if (scene_hit_moves(pass->scene, hit)) {
        transform by = vcm_motion_to_map(pass, hit);
        instance_move_hit(&by, &at);
        *wo = transform_vector(&by, *wo);
    }
    at.p = scene_hit_place(pass->scene, &at);
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
        .face = transmits ? face : 0,
        .flatten = (float)pass->plan->how.flatten,
        .curve = scene_curve_of(pass->scene, v->hit),
    };
    return s;
}

/* Leaves out of the hits those that hood does not see. */
static void leave_out_unseen(const vertex_search *s, const neighbourhood *hood)
{
    const photon_store *store = photon_map_store(s->pass->map);
    point_hits *hits = &s->scratch->hits;
    size_t kept = 0;
    for (size_t i = 0; i < hits->n; i++) {
        size_t k = hits->index[i];
        if (!neighbourhood_sees(hood, vec3_make(store->x[k], store->y[k], store->z[k])))
            continue;
        hits->index[kept] = k;
        hits->distance2[kept++] = hits->distance2[i];
    }
    hits->n = kept;
}

/* The light vertices around the place. @return false: none, or memory is refused. */
static bool find(const vertex_search *s)
{
    point_hits *hits = &s->scratch->hits;
    bool done =
        photon_map_within(s->pass->map, s->at.p, s->pass->radius, &s->filter, hits);
    s->scratch->failed |= !done;
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
        leave_out_unseen(s, &hood);
    return share;
}

float vcm_find_vertices(const vcm_pass *pass, const vcm_vertex *v, const kernel *kappa,
                        bool first, estimate_scratch *scratch)
{
    vertex_search s = search_around(pass, v);
    s.kappa = kappa;
    s.scratch = scratch;
    if (!find(&s))
        return 0.0f;
    if (s.at.camera_facing) {
        const flat_curve flat = {pass->scene, &s.at};
        return flat_curve_area(&flat, s.at.p, pass->radius, kappa);
    }
    return kernel_area(kappa, square(pass->radius)) * (first ? keep_surface(&s) : 1.0f);
}
