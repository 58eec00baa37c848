#include "transport/transport.h"

#include "base/memory.h"

static const transport_kind *const kinds[] = {
#define INTEGRATOR(choice, word) [INTEGRATOR_##choice] = &transport_##word,
#include "settings/integrator.def"
#undef INTEGRATOR
};

const transport_kind *transport_find(int integrator)
{
    return kinds[integrator];
}

void radiance_sample_note(radiance_sample *out, const surface_hit *hit, const bsdf *b,
                          vec3 wo, vec3 from)
{
    out->depth = length3(hit->p - from);
    out->normal = face_forward(hit->n, wo);
    out->albedo = bsdf_albedo(b, wo, LOBE_ALL);
    out->p = hit->p;
    out->n_geom = face_forward(hit->n_geom, wo);
    out->uv = hit->uv;
}

bool radiance_sample_guide(radiance_sample *out, const surface_hit *hit, const bsdf *b,
                           vec3 wo, vec3 eye, float arrives)
{
    light_guide *guide = &out->guide;
    if (!(b->lobes & (LOBE_DIFFUSE | LOBE_GLOSSY)) || !(arrives > 0.0f))
        return false;
    guide->albedo += arrives * bsdf_albedo(b, wo, LOBE_ALL);
    guide->normal += arrives * face_forward(hit->n, wo);
    guide->depth += arrives * length3(hit->p - eye);
    guide->weight += arrives;
    return true;
}

void radiance_sample_light(radiance_sample *out, const path_segment *at,
                           spectrum radiance)
{
    if (at->eye || !at->mirrors_only)
        return;
    spectrum *seen = at->certain ? &out->guide.lights : &out->guide.glints;
    *seen += at->throughput * radiance;
}

path_sides path_part(unsigned bounces, const bsdf *b, vec3 wo)
{
    float reflected = spectrum_mean(bsdf_albedo(b, wo, LOBE_SPECULAR | LOBE_REFLECTION));
    float through = spectrum_mean(bsdf_albedo(b, wo, LOBE_SPECULAR | LOBE_TRANSMISSION));
    bool mirrors = reflected > through;
    path_sides sides = {mirrors ? LOBE_REFLECTION : LOBE_TRANSMISSION,
                        mirrors ? LOBE_TRANSMISSION : LOBE_REFLECTION, 0.0f, 1.0f, 1.0f};
    float less = minf(reflected, through);
    if (!(less > 0.0f))
        return sides;
    float share = less / (reflected + through);
    sides.p_both = bounces == 0 ? 1.0f : sqrtf(share);
    sides.alone = 1.0f / (1.0f - share);
    sides.beside = (1.0f - share / sides.p_both) / (1.0f - share);
    return sides;
}

bool transport_scratch_init(transport_scratch *scratch, size_t n_groups, GError **error)
{
    if (!estimate_scratch_init(&scratch->estimate, n_groups, error))
        return false;
    if (n_groups > 0)
        scratch->gathered =
            big_alloc(n_groups, sizeof *scratch->gathered, "light groups", error);
    return n_groups == 0 || scratch->gathered;
}

void transport_scratch_clear(transport_scratch *scratch)
{
    estimate_scratch_clear(&scratch->estimate);
    big_free(scratch->gathered);
    scratch->gathered = NULL;
}

transport_plan transport_plan_of(const view *v, const settings *how)
{
    transport_plan plan = {.scene = v->scene, .view = v, .how = *how};
    settings_forget_unread(&plan.how);
    plan.how.threads = parallel_threads((unsigned)how->threads);
    return plan;
}

bool transport_plan_prepare(transport_plan *plan, const cancel_flag *cancel,
                            GError **error)
{
    transport_plan_clear(plan);
    *plan = transport_plan_of(plan->view, &plan->how);
    plan->cancel = cancel;
    return transport_find(plan->how.integrator)->prepare(plan, cancel, error);
}

bool transport_plan_find_casters(transport_plan *plan, GError **error)
{
    bool metals = photon_follows_metals(&plan->how);
    if (!plan->casters)
        plan->casters = metals ? caustic_casters_new_with_metals(plan->scene, error)
                               : caustic_casters_new(plan->scene, error);
    return plan->casters != NULL;
}

void transport_plan_clear(transport_plan *plan)
{
    g_clear_pointer(&plan->casters, caustic_casters_free);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_clear_pointer(&plan->guide[c], emission_guide_free);
    g_clear_pointer(&plan->boost, g_free);
    g_clear_pointer(&plan->sight, g_aligned_free);
    plan->n_sight = 0;
    g_clear_pointer(&plan->sketch, sketch_free);
    g_clear_pointer(&plan->vertex_radii, radius_cache_free);
    g_free(plan->lit);
    plan->mis = (caustic_mis){0};
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_clear_pointer(&plan->radius_cache[c], radius_cache_free);
        g_clear_pointer(&plan->radius_cache_in_media[c], radius_cache_free);
    }
}
