#include "accel/accel_core.h"

/* Of the sizes of the world and its core: from so far, floats tell a thousand steps
   across it apart, and the boxes that rounding adds to those that a ray meets cost
   little. */
#define FAR_IN_CORES 8192.0f
/* How far off that is which is met in the first part for all that Embree rounds, of the
   distance: some 16 steps of floats. */
#define MARGIN 0x1p-19f

enum { MOST_LARGE = 65536 }; /* a world of more has no core worth the search */

static float size_of(box3 box)
{
    return max_component3(box.high - box.low);
}

core_search core_search_begin(box3 bounds)
{
    return (core_search){.box = box3_empty(), .most = size_of(bounds) / FAR_IN_CORES};
}

bool core_search_is_over(const core_search *search)
{
    return search->n_large > MOST_LARGE || size_of(search->box) > search->most;
}

void core_search_add(core_search *search, box3 box)
{
    if (box3_is_empty(box))
        return;
    if (size_of(box) <= search->most)
        search->box = box3_union(search->box, box);
    else
        search->n_large++;
}

static box3 triangle_bounds(const mesh *m, size_t i)
{
    box3 box = box3_empty();
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
        const float *p = &m->positions[3 * (size_t)m->indices[k]];
        box = box3_with_point(box, vec3_make(p[0], p[1], p[2]));
    }
    return box;
}

static void add_parts(core_search *search, const shape *s)
{
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    size_t n = m ? m->n_triangles : s->kind->n_primitives(s->self);
    for (size_t i = 0; i < n && !core_search_is_over(search); i++)
        core_search_add(search, m ? triangle_bounds(m, i)
                                  : s->kind->primitive_bounds(s->self, (uint32_t)i));
}

void core_search_add_shape(core_search *search, const shape *s)
{
    const box3 all = s->kind->bounds(s->self);
    bool has_parts = s->kind->triangles || s->kind->n_primitives;
    if (s->is_invisible || core_search_is_over(search))
        return;
    if (has_parts && size_of(all) > search->most)
        add_parts(search, s);
    else
        core_search_add(search, all);
}

box3 core_search_end(const core_search *search)
{
    return core_search_is_over(search) ? box3_empty() : search->box;
}

accel_core accel_core_make(box3 box)
{
    float far = FAR_IN_CORES * size_of(box);
    return (accel_core){box.low, box.high, far > 0.0f ? far : INFINITY};
}

float accel_core_ahead(const accel_core *core, const ray *r)
{
    const vec3 to_low = core->low - r->origin, to_high = core->high - r->origin;
    const float distance = max_component3(max3(to_low, -to_high));
    if (!(distance > core->far))
        return 0.0f;
    const float margin = MARGIN * max_component3(max3(abs3(to_low), abs3(to_high)));
    float begin = 0.0f, end = r->t_max;
    for (int i = 0; i < 3; i++) {
        float a = (to_low[i] - margin) / r->direction[i];
        float b = (to_high[i] + margin) / r->direction[i];
        begin = maxf(minf(a, b), begin);
        end = minf(maxf(a, b), end);
    }
    return begin < end ? begin : 0.0f;
}
