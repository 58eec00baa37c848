/* What light and camera subpaths have in common. */
#include "transport/vcm/vcm.h"

#include <float.h>

lobe_pair vcm_scatter(const vcm_vertex *v, vec3 wi, transport_mode mode)
{
    static const unsigned classes[2] = {LOBE_DIFFUSE, LOBE_GLOSSY};
    float cosine = fabsf(dot3(wi, v->bsdf.shading.n));
    lobe_pair out = {{{0}, {0}}};
    for (int i = 0; i < 2; i++) {
        if (v->bsdf.lobes & classes[i])
            out.value[i] =
                cosine * bsdf_eval(&v->bsdf, v->wo, wi, classes[i] | LOBE_ANY_SIDE, mode);
    }
    return out;
}

scattering_counts vcm_count(scattering_counts from_eye, bool diffuse)
{
    if (from_eye.n == 0)
        from_eye.first_diffuse = diffuse;
    from_eye.n++;
    from_eye.n_diffuse += diffuse;
    return from_eye;
}

radiance_layer vcm_layer(scattering_counts counts)
{
    if (counts.n == 0)
        return LAYER_EMISSION;
    if (!counts.first_diffuse)
        return LAYER_SPECULAR;
    if (counts.n_diffuse > 1)
        return LAYER_INDIRECT;
    return counts.n > 1 ? LAYER_CAUSTIC : LAYER_DIRECT;
}

bool vcm_visible(const vcm_pass *pass, const surface_hit *from, vec3 direction,
                 float distance, int64_t most_panes, spectrum *transmittance)
{
    static const bsdf_options options = {0};
    const scene_look look = {pass->scene, &pass->w, &options, most_panes};
    return scene_sees_from(&look, from, direction, distance, transmittance);
}

/* By the bsdf that samples: v's own, or that of the wavelength which the path has kept.
 */
static bool sample_direction(const vcm_pass *pass, const vcm_walk *walk,
                             const vcm_vertex *v, unsigned lobes, sampler *random,
                             bsdf_sample *out)
{
    static const bsdf_options options = {0};
    float u_lobe = sampler_1d(random);
    vec2 u = sampler_2d(random);
    bsdf one_wavelength;
    const bsdf *b = walk->at.wavelength == ALL_WAVELENGTHS ? &v->bsdf : &one_wavelength;
    if (b == &one_wavelength &&
        !scene_bsdf(pass->scene, v->hit, &pass->w, walk->at.wavelength, &options,
                    &one_wavelength))
        return false;
    if (!bsdf_sample_direction(b, v->wo, u_lobe, u, lobes, walk->mode, out))
        return false;
    if (lobes == LOBE_ALL && bsdf_has_both(b))
        bsdf_settle_class(b, v->wo, walk->mode, sampler_1d(random), out);
    return true;
}

/* Light vertices and lights are connected through panes, so it is as if none stood there.
   To the eye they are not: what it sees through a pane is found as what mirrors show. */
static void leave_straight(vcm_walk *walk, const vcm_vertex *v, const bsdf_sample *next,
                           float probability)
{
    path_segment_leave(&walk->at, v->hit, next, probability);
    walk->lobe = next->lobe;
    walk->weights = walk->before;
    walk->counts.n_panes++;
}

bool vcm_bounce(const vcm_pass *pass, vcm_walk *walk, const vcm_vertex *v, unsigned lobes,
                float probability, sampler *random)
{
    bsdf_sample next;
    if (!sample_direction(pass, walk, v, lobes, random, &next))
        return false;
    float cosine = hit_cosine(v->hit, next.wi);
    walk->straight = next.straight && !walk->at.mirrors_only;
    if (walk->straight) {
        leave_straight(walk, v, &next, probability);
        return cosine > 0.0f && !spectrum_is_black(walk->at.throughput);
    }
    if (next.lobe & LOBE_SPECULAR)
        weights_bounce_specular(&walk->weights, cosine);
    else
        weights_bounce(&walk->weights, cosine, vcm_pdf(v, next.wi, walk->mode),
                       vcm_pdf_reverse(v, next.wi, walk->mode), &pass->ratios, v->alone);
    path_segment_leave(&walk->at, v->hit, &next, probability);
    walk->lobe = next.lobe;
    walk->eta2 *= next.eta * next.eta;
    walk->from = v->hit->p;
    walk->counts = vcm_count(walk->counts, (next.lobe & LOBE_DIFFUSE) != 0);
    return cosine > 0.0f && !spectrum_is_black(walk->at.throughput);
}

/* Vertices of a light subpath per square metre around p, on average, by the plan's
   vertex_radii; 0: too few to tell. */
static float density_at(const transport_plan *plan, vec3 p, point_hits *hits)
{
    float radius = radius_cache_at(plan->vertex_radii, p, 0.0f, NULL, hits);
    if (!(radius > 0.0f))
        return 0.0f;
    float density =
        RADIUS_NEAREST / (PI_F * square(radius) * (float)plan->n_vertex_paths);
    return isfinite(density) ? density : FLT_MAX;
}

float vcm_alone_at(const vcm_pass *pass, const surface_hit *hit, point_hits *hits)
{
    if (!pass->plan->vertex_radii)
        return 1.0f;
    vec3 p = scene_hit_place(pass->scene, hit);
    float within = pass->ratios.merge * density_at(pass->plan, p, hits);
    return 1.0f / (1.0f + fminf(within, 1.0f / FLT_EPSILON));
}
