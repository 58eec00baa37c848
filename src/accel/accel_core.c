#include "accel/accel_core.h"

/* Of the sizes of the world and its core: from so far, floats tell a thousand steps
   across it apart, and the boxes that rounding adds to those that a ray meets cost
   little. */
#define FAR_IN_CORES 8192.0f
/* How far off that is which is met in the first part for all that Embree rounds, of the
   distance: some 16 steps of floats. */
#define MARGIN 0x1p-19f

/* Times that what is added is large or lies apart: a world of more has no core worth the
   search. */
enum { MOST_ODD = 65536 };
/* So many lie in a core for each small one that lies apart, as a light may. */
enum { INSIDE_FOR_OUTSIDE = 16 };

static float size_of(box3 box)
{
    return max_component3(box.high - box.low);
}

bool core_is_out_of_question(const core_search *search)
{
    return search->n_odd > MOST_ODD;
}

/* Boyer and Moore's vote: what lies apart takes as many votes from the place where most
   seem to be, and is taken for it where it has more. */
static void vote_against(core_search *search, box3 box, size_t n)
{
    search->n_odd++;
    search->n_outside += n;
    if (search->is_found)
        return;
    if (search->n_votes < n)
        search->box = box;
    search->n_votes = search->n_votes < n ? n - search->n_votes : search->n_votes - n;
}

void core_add(core_search *search, box3 box, size_t n)
{
    const box3 both = box3_union(search->box, box);
    if (n == 0 || box3_is_empty(box))
        return;
    if (!(size_of(box) <= search->most)) {
        search->n_odd++;
    } else if (size_of(both) <= search->most) {
        search->box = both;
        search->n_inside += n;
        search->n_votes += n;
    } else {
        vote_against(search, box, n);
    }
}

box3 core_find(box3 bounds, core_walk walk, void *data)
{
    core_search search = {.box = box3_empty(), .most = size_of(bounds) / FAR_IN_CORES};
    walk(&search, data);
    if (search.n_outside > 0 && !core_is_out_of_question(&search)) {
        search = (core_search){.box = search.box, .most = search.most, .is_found = true};
        walk(&search, data);
    }
    bool is_most = search.n_inside >= INSIDE_FOR_OUTSIDE * search.n_outside;
    return is_most && !core_is_out_of_question(&search) ? search.box : box3_empty();
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

static const mesh *mesh_of(const shape *s)
{
    return s->kind->triangles ? s->kind->triangles(s->self) : NULL;
}

size_t core_parts_of(const shape *s)
{
    if (s->is_invisible)
        return 0;
    if (s->kind->triangles)
        return mesh_of(s)->n_triangles;
    return s->kind->n_primitives ? s->kind->n_primitives(s->self) : 1;
}

void core_add_shape(core_search *search, const shape *s)
{
    const mesh *m = mesh_of(s);
    const box3 all = s->kind->bounds(s->self);
    size_t n = core_parts_of(s);
    if (n == 1 || size_of(all) <= search->most) {
        core_add(search, all, n);
        return;
    }
    for (size_t i = 0; i < n && !core_is_out_of_question(search); i++)
        core_add(search,
                 m ? triangle_bounds(m, i)
                   : s->kind->primitive_bounds(s->self, (uint32_t)i),
                 1);
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
