/*
 * Where things are: objects and their instances, the scene's bounds, the acceleration
 * structure.
 *
 * Instances are taken at the opening of the shutter where one number must do for all
 * times (areas), and over the whole time where bounds are asked for.
 */
#include "scene/scene_geometry.h"

#include "base/wanted.h"

/* ---- Bounds ---- */

box3 scene_placed_bounds(const scene *s, const instance *is, box3 box)
{
    if (box3_is_empty(box))
        return box;
    return motion_bounds(&is->to_world, box, (double)s->shutter[0],
                         (double)s->shutter[1]);
}

double scene_instance_growth(const scene *s, const instance *is)
{
    transform at = motion_at(&is->to_world, (double)s->shutter[0]);
    return instance_mean_area_factor(&at);
}

static box3 *object_bounds(const scene *s)
{
    box3 *boxes = g_aligned_alloc(MAX(s->n_objects, 1), sizeof *boxes, 16);
    for (guint i = 0; i < s->n_objects; i++)
        boxes[i] = box3_empty();
    for (guint i = 0; i < s->shapes->len && still_wanted(NULL); i++) {
        const shape *on = s->shapes->pdata[i];
        if (on->object != NO_INDEX)
            boxes[on->object] = box3_union(boxes[on->object], on->kind->bounds(on->self));
    }
    return boxes;
}

box3 scene_world_bounds(const scene *s)
{
    box3 *boxes = object_bounds(s), all = box3_empty();
    for (guint i = 0; i < s->shapes->len && still_wanted(NULL); i++) {
        const shape *on = s->shapes->pdata[i];
        if (on->object == NO_INDEX)
            all = box3_union(all, on->kind->bounds(on->self));
    }
    for (guint i = 0; i < s->instances->len && still_wanted(NULL); i++) {
        const instance *is = scene_instance(s, (int)i);
        all = box3_union(all, scene_placed_bounds(s, is, boxes[is->object]));
    }
    g_aligned_free(boxes);
    return all;
}

bool scene_check_reach(box3 box, const char *what, source_place place, GError **error)
{
    if (box3_is_empty(box))
        return true;
    vec3 far = max3(abs3(box.low), abs3(box.high));
    bool is_finite = finite3(box.low) && finite3(box.high);
    if (is_finite && max_component3(far) <= FARTHEST_COORDINATE)
        return true;
    error_at(error, place,
             "%s extends to %g m from the origin: expected coordinates up to %g m", what,
             is_finite ? (double)max_component3(far) : (double)INFINITY,
             (double)FARTHEST_COORDINATE);
    return false;
}

/* Shapes have been looked at one by one; of instances only if one is too far away. */
static bool check_reach(const scene *s, GError **error)
{
    if (scene_check_reach(s->bounds, "the scene", (source_place){0}, NULL))
        return true;
    box3 *boxes = object_bounds(s);
    bool near = true;
    for (guint i = 0; i < s->instances->len && near; i++) {
        const instance *is = scene_instance(s, (int)i);
        near = scene_check_reach(scene_placed_bounds(s, is, boxes[is->object]),
                                 "the instance", is->place, error);
    }
    g_aligned_free(boxes);
    return near && scene_check_reach(s->bounds, "the scene", (source_place){0}, error);
}

/* What has no extent at all is no smaller than others: it is not seen. */
static bool check_extent(box3 bounds, GError **error)
{
    float extent =
        box3_is_empty(bounds) ? 0.0f : max_component3(bounds.high - bounds.low);
    if (!(extent > 0.0f) || extent >= SMALLEST_EXTENT)
        return true;
    error_set(error, ERROR_INPUT, "the scene's extent is %g m: expected %g to %g m",
              (double)extent, (double)SMALLEST_EXTENT, (double)FARTHEST_COORDINATE);
    return false;
}

bool scene_find_bounds(scene *s, GError **error)
{
    s->bounds = scene_world_bounds(s);
    if (!still_wanted(error) || !check_reach(s, error) || !check_extent(s->bounds, error))
        return false;
    bool is_empty = box3_is_empty(s->bounds);
    s->center = is_empty ? vec3_make(0.0f, 0.0f, 0.0f) : box3_center(s->bounds);
    /* A little larger, so that what lies on the box is inside whatever the rounding. */
    float far =
        is_empty ? 0.0f : max_component3(max3(abs3(s->bounds.low), abs3(s->bounds.high)));
    s->radius = 1.0001f * box3_radius(s->bounds) + 1e-6f * far;
    if (!(s->radius > 0.0f))
        s->radius = 1.0f;
    return true;
}

/* ---- What turns ---- */

vec3 scene_axis_at(const scene *s, const surface_hit *hit)
{
    const shape *on = s->shapes->pdata[hit->shape];
    vec3 p = on->kind->axis_at(on->self, hit);
    if (hit->instance == NO_INDEX)
        return p;
    transform to_world = accel_instance_at(s->accel, hit->instance, hit->time);
    return transform_point(&to_world, p);
}

uint32_t scene_curve_of(const scene *s, const surface_hit *hit)
{
    if (!hit->camera_facing)
        return 0;
    uint32_t placed = (uint32_t)(hit->instance - NO_INDEX);
    uint32_t number = placed * s->shapes->len + (uint32_t)hit->shape + 1;
    return MAX(number, 1);
}

/* Takes pieces from the space of an object to the world. */
typedef struct placed_pieces {
    transform to_world;
    float area_factor;
    shape_piece piece;
    void *data;
} placed_pieces;

static void place_piece(vec3 middle, float area, void *data)
{
    const placed_pieces *to = data;
    to->piece(transform_point(&to->to_world, middle), area * to->area_factor, to->data);
}

void scene_pieces_near(const scene *s, const surface_hit *hit, vec3 p, float radius,
                       shape_piece piece, void *data)
{
    const shape *on = s->shapes->pdata[hit->shape];
    if (hit->instance == NO_INDEX) {
        on->kind->pieces_near(on->self, p, radius, piece, data);
        return;
    }
    placed_pieces to = {.to_world = accel_instance_at(s->accel, hit->instance, hit->time),
                        .piece = piece,
                        .data = data};
    to.area_factor = (float)instance_mean_area_factor(&to.to_world);
    transform to_object = transform_inverse(&to.to_world);
    on->kind->pieces_near(on->self, transform_point(&to_object, p),
                          radius * instance_largest_scale(&to_object), place_piece, &to);
}

/* ---- Time ---- */

transform scene_motion_to(const scene *s, const surface_hit *hit, float time)
{
    if (!scene_hit_moves(s, hit))
        return transform_identity();
    transform now = accel_instance_at(s->accel, hit->instance, hit->time);
    transform then = accel_instance_at(s->accel, hit->instance, time);
    transform back = transform_inverse(&now);
    return transform_multiply(&then, &back);
}

double scene_area_change(const scene *s, const surface_hit *hit, float time)
{
    if (!scene_hit_moves(s, hit))
        return 1.0;
    transform by = scene_motion_to(s, hit, time);
    vec3 n = normalize3(transform_normal(&by, hit->n_geom));
    return instance_area_factor(&by, n);
}

/* ---- The acceleration structure ---- */

/* Which shapes do not stop rays that look for light. */
static void find_panes(scene *s)
{
    s->has_panes = false;
    for (guint i = 0; i < s->shapes->len; i++) {
        shape *on = s->shapes->pdata[i];
        bool is_interface = on->material == NO_INDEX;
        bool is_pane =
            !is_interface && material_is_pane(s->materials->pdata[on->material]);
        on->lets_through = is_interface || is_pane;
        s->has_panes |= is_pane;
    }
}

bool scene_build_accel(scene *s, unsigned threads, GError **error)
{
    const accel_input in = {
        .shapes = (shape *const *)s->shapes->pdata,
        .n_shapes = s->shapes->len,
        .instances = (const instance *)(void *)s->instances->data,
        .n_instances = s->instances->len,
        .n_objects = s->n_objects,
        .shutter = {(double)s->shutter[0], (double)s->shutter[1]},
    };
    find_panes(s);
    s->accel = accel_build(&in, threads, error);
    s->moves = s->camera_facing = false;
    for (guint i = 0; i < s->shapes->len; i++)
        s->camera_facing |= in.shapes[i]->kind->axis_at != NULL;
    for (guint i = 0; i < s->instances->len && s->accel; i++)
        s->moves |= accel_instance_moves(s->accel, (int)i);
    return s->accel != NULL;
}
