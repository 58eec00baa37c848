#include "transport/vcm/vcm_weights.h"

/* Density of the light's subpaths at the vertex, but for the distance. */
static float traced(const light_start *start)
{
    float position, direction;
    const light *l = start->light;
    l->kind->emit_pdf(l->self, start->p, start->n, start->direction, &position,
                      &direction);
    return start->p_traced * position * direction * start->cosine;
}

/* Of solid angle at the vertex to area on the light, without the distance, which cancels:
   one for what has no area. */
static float light_cosine(const light_start *start)
{
    const light_kind *kind = start->light->kind;
    bool area = !kind->is_delta && !kind->is_parallel;
    return area ? fabsf(dot3(start->n, start->direction)) : 1.0f;
}

/* A point light's place is certain both ways, and distance does not cancel. */
static float connected(const light_start *start)
{
    const light_kind *kind = start->light->kind;
    bool point = kind->is_delta && !kind->is_parallel;
    return start->pdf * (point ? start->distance2 : light_cosine(start));
}

float light_start_traced_over_connected(const light_start *start)
{
    return traced(start) / connected(start);
}

partial_weights weights_from_light(const light_start *start,
                                   const strategy_ratios *ratios)
{
    float density = traced(start);
    partial_weights w = {.vcm = connected(start) / density};
    w.vc = start->light->is_delta ? 0.0f : light_cosine(start) / density;
    w.vm = w.vc * ratios->connect;
    return w;
}

void weights_arrive(partial_weights *w, float distance2, float cosine)
{
    w->vcm *= distance2 / cosine;
    w->vc /= cosine;
    w->vm /= cosine;
}

void weights_bounce(partial_weights *w, float cosine, float pdf, float pdf_reverse,
                    const strategy_ratios *ratios, float alone)
{
    float scale = cosine / pdf;
    w->vc = scale * (ratios->merge * alone + w->vcm + pdf_reverse * w->vc);
    w->vm = scale * (alone + w->vcm * ratios->connect + pdf_reverse * w->vm);
    w->vcm = 1.0f / pdf;
}

void weights_bounce_specular(partial_weights *w, float cosine)
{
    w->vcm = 0.0f;
    w->vc *= cosine;
    w->vm *= cosine;
}
