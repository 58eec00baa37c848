#include "photon/trace/caustic_mis.h"

#include "photon/trace/emit.h"

/* Density of the emission in the measure that p_scatter and p_lights are compared in. */
static float emission_density(const caustic_mis *mis, const caustic_end *end)
{
    const caustic_casters *c = mis->casters;
    const light *l = scene_light(c->scene, end->light);
    float position, direction;
    l->kind->emit_pdf(l->self, end->p, end->n, end->direction, &position, &direction);
    if (c->is_apart[end->light] && direction > 0.0f)
        direction = photon_cone_pdf(c, end->p);
    float e = distribution_pdf(&c->power, (size_t)end->light) * direction;
    if (mis->boost)
        e *= mis->boost[end->light];
    if (l->kind->is_parallel)
        return e / (PI_F * square(c->radius));
    if (l->kind->is_delta)
        return e / square(end->distance);
    return e * position / fabsf(dot3(end->n, end->direction));
}

float caustic_mis_weight(const caustic_mis *mis, const caustic_end *end)
{
    if (!mis)
        return 1.0f;
    bool delta = scene_light(mis->casters->scene, end->light)->is_delta;
    float scatter = end->specular ? 1.0f : end->pdf_scatter;
    float merged = scatter * PI_F * mis->discs * emission_density(mis, end);
    float others = (delta ? 0.0f : scatter) + (end->specular ? 0.0f : end->pdf_lights);
    if (!(others > 0.0f) || isinf(merged))
        return 1.0f;
    return merged > 0.0f ? merged / (merged + others) : 0.0f;
}
