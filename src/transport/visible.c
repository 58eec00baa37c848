#include "transport/visible.h"

#include "scene/advance.h"
#include "transport/work.h"

/* What all camera rays share. */
typedef struct lookout {
    const scene *scene;
    const view *view;
    wavelengths w;
    bsdf_options options;
    uint64_t key;
    visible_point *points; /* one a ray; of no size where it met nothing that gathers */
} lookout;

/* Follows a camera ray to the first surface that gathers, if it meets one. */
static void find_one(const lookout *from, const ray *r, sampler *random,
                     visible_point *out)
{
    uint64_t untold = 0;
    const scene_traveller who = {.scene = from->scene, .w = &from->w, .n_rays = &untold};
    path_segment path = path_segment_from_eye(from->view, r);
    float length = 0.0f;
    int64_t bounces = 0;
    do {
        surface_hit hit;
        bsdf b;
        bsdf_sample next;
        vec3 start = path.ray.origin;
        if (scene_advance(&who, &path, &hit) != EVENT_SURFACE)
            return;
        length += length3(hit.p - start);
        scene_bsdf(from->scene, &hit, &from->w, ALL_WAVELENGTHS, &from->options, &b);
        if (b.lobes & LOBE_DIFFUSE) {
            float area = camera_pixel_area(&from->view->camera, length);
            float cosine = fabsf(dot3(hit.n_geom, path.ray.direction));
            spectrum albedo = bsdf_albedo(&b, -path.ray.direction, LOBE_ALL);
            out->p = hit.p;
            out->pixel = sqrtf(area);
            out->area = area / cosine;
            out->albedo = spectrum_mean(albedo);
            return;
        }
        float u_lobe = sampler_1d(random);
        vec2 u = sampler_2d(random);
        if (!bsdf_sample_direction(&b, -path.ray.direction, u_lobe, u, LOBE_FOLLOWED,
                                   TRANSPORT_RADIANCE, &next))
            return;
        path.ray = hit_ray(&hit, next.wi);
        path.eye = NULL;
    } while (sampler_1d(random) < most_survival(++bounces));
}

static void find_some(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const lookout *from = data;
    const camera *c = &from->view->camera;
    for (size_t i = begin; i < end; i++) {
        sampler random = sampler_make(from->key, i);
        vec2 u = sampler_2d(&random);
        vec2 raster = {u.x * (float)c->width, u.y * (float)c->height};
        vec2 u_lens = sampler_2d(&random);
        ray r = camera_ray(c, raster, u_lens, sampler_1d(&random));
        from->points[i] = (visible_point){.raster = raster};
        find_one(from, &r, &random, &from->points[i]);
    }
}

/* Moves those that were found to the front. @return how many. */
static size_t keep_found(visible_point *points, uint32_t n)
{
    size_t kept = 0;
    for (uint32_t i = 0; i < n; i++)
        if (points[i].pixel > 0.0f)
            points[kept++] = points[i];
    return kept;
}

size_t find_visible_points(const transport_plan *plan, uint32_t n, visible_point *out)
{
    lookout from = {.scene = plan->scene,
                    .view = plan->view,
                    .w = scene_trial_wavelengths(plan->scene, 0),
                    .key = hash_mix((uint64_t)plan->how.seed, 0x6c6f6f6bu),
                    .points = out};
    from.options.deterministic = !plan->how.multiple_samples;
    from.options.metal_is_followed = photon_follows_metals(&plan->how);
    parallel_for(n, LEAST_TRIALS, (unsigned)plan->how.threads, NULL, find_some, &from);
    return keep_found(out, n);
}

void plan_look(transport_plan *plan)
{
    if (plan->sight)
        return;
    uint32_t n = MIN(plan_trials_for(plan, 0.5, PHOTON_RAYS, UINT32_MAX), MOST_PLACES);
    plan->sight = g_aligned_alloc0(n, sizeof *plan->sight, 16);
    plan->n_looks = n;
    plan->n_sight = find_visible_points(plan, n, plan->sight);
    plan->planning += n * PHOTON_RAYS;
}

point_set *visible_index(const transport_plan *plan, GError **error)
{
    vec3 *points = g_aligned_alloc0(MAX(plan->n_sight, 1), sizeof *points, 16);
    for (size_t i = 0; i < plan->n_sight; i++)
        points[i] = plan->sight[i].p;
    point_set *index = point_set_build(points, plan->n_sight, 1, error);
    g_aligned_free(points);
    return index;
}

float visible_pixel(transport_plan *plan)
{
    plan_look(plan);
    double sum = 0.0;
    for (size_t i = 0; i < plan->n_sight; i++)
        sum += 1.0 / (double)plan->sight[i].pixel;
    return sum > 0.0 ? (float)((double)plan->n_sight / sum) : 0.0f;
}

double sharp_radius(transport_plan *plan)
{
    double pixel = (double)visible_pixel(plan);
    return pixel > 0.0 ? SHARP_PIXELS * pixel : unknown_radius(plan);
}
