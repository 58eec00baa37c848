#include "render/film/gbuffer.h"

#include "base/memory.h"

static const char *const channels[] = {
    "Albedo.R",
    "Albedo.G",
    "Albedo.B",
    "P.X",
    "P.Y",
    "P.Z",
    "dzdx",
    "dzdy",
    "N.X",
    "N.Y",
    "N.Z",
    "Ns.X",
    "Ns.Y",
    "Ns.Z",
    "u",
    "v",
    "Variance.R",
    "Variance.G",
    "Variance.B",
    "RelativeVariance.R",
    "RelativeVariance.G",
    "RelativeVariance.B",
};

bool gbuffer_open(film *f, const film_settings *how, GError **error)
{
    size_t n = (size_t)f->width * (size_t)f->height;
    if (!how->gbuffer)
        return true;
    f->pass_surfaces = big_alloc(n, sizeof *f->pass_surfaces, "the gbuffer", error);
    if (f->pass_surfaces)
        f->surfaces = big_alloc(n, sizeof *f->surfaces, "the gbuffer", error);
    return f->surfaces != NULL;
}

/* ---- Samples ---- */

static transform to_camera(const view *v, float time)
{
    transform to_world = camera_at(&v->camera, time);
    return transform_inverse(&to_world);
}

void gbuffer_turn(const view *v, float time, radiance_sample *sample)
{
    if (!v->film.in_camera || !(sample->depth > 0.0f))
        return;
    transform t = to_camera(v, time);
    sample->normal = normalize3(transform_normal(&t, sample->normal));
}

/* From the place seen to where the ray through the raster position one pixel on meets the
 * plane there; zero if it never does. */
static vec3 to_next_pixel(const view *v, const gbuffer_sample *look,
                          const radiance_sample *sample, vec2 step)
{
    vec2 raster = {look->raster.x + step.x, look->raster.y + step.y};
    ray r = camera_ray(&v->camera, raster, look->u_lens, look->seen_by.time);
    vec3 n = sample->n_geom;
    float across = dot3(r.direction, n);
    if (!(fabsf(across) > 1e-6f))
        return (vec3){0};
    float t = dot3(sample->p - r.origin, n) / across;
    return r.origin + t * r.direction - sample->p;
}

static void add_vec3(double sum[3], vec3 v, float weight)
{
    for (int i = 0; i < 3; i++)
        sum[i] += (double)(v[i] * weight);
}

static void add_colour(surface_sum *sum, const film *f, const film_pass *pass,
                       const radiance_sample *sample, float dimmed)
{
    spectrum all = {0};
    for (int i = 0; i < N_LAYERS; i++)
        all += sample->layers[i];
    float xyz[3], rgb[3];
    spectrum_to_xyz(pass->w, all * dimmed, xyz);
    film_to_rgb(f, (double[]){(double)xyz[0], (double)xyz[1], (double)xyz[2]}, 1.0, rgb);
    for (int i = 0; i < 3; i++) {
        double value = (double)(rgb[i] * f->scale);
        sum->rgb[i] += value;
        sum->rgb2[i] += value * value;
    }
    sum->n_samples += 1.0;
}

void gbuffer_add(surface_sum *sum, const film *f, const view *v, const film_pass *pass,
                 const gbuffer_sample *look, const radiance_sample *sample)
{
    if (!f->surfaces || !(sample->depth > 0.0f))
        return;
    float weight = look->weight;
    vec3 p = sample->p, n = sample->n_geom;
    vec3 dx = to_next_pixel(v, look, sample, (vec2){1.0f, 0.0f});
    vec3 dy = to_next_pixel(v, look, sample, (vec2){0.0f, 1.0f});
    if (v->film.in_camera) {
        transform t = to_camera(v, look->seen_by.time);
        p = transform_point(&t, p);
        n = normalize3(transform_normal(&t, n));
        dx = transform_vector(&t, dx);
        dy = transform_vector(&t, dy);
    }
    add_vec3(sum->p, p, weight);
    add_vec3(sum->n, n, weight);
    add_vec3(sum->ns, sample->normal, weight);
    sum->uv[0] += (double)(sample->uv.x * weight);
    sum->uv[1] += (double)(sample->uv.y * weight);
    sum->dz[0] += (double)(dx[2] * weight);
    sum->dz[1] += (double)(dy[2] * weight);
    add_colour(sum, f, pass, sample, look->dimmed);
}

/* ---- Pixels ---- */

void gbuffer_put(film *f, int x, int y, const surface_sum *sum)
{
    if (f->surfaces)
        f->pass_surfaces[(size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0)] =
            *sum;
}

static void add_surface(surface_sum *sum, const surface_sum *more)
{
    enum { N = sizeof(surface_sum) / sizeof(double) };
    double *to = (double *)sum;
    const double *from = (const double *)more;
    for (size_t i = 0; i < N; i++)
        to[i] += from[i];
}

void gbuffer_end_pass(const film *f, size_t begin, size_t end)
{
    for (size_t i = begin; i < end && f->surfaces; i++)
        add_surface(&f->surfaces[i], &f->pass_surfaces[i]);
}

void gbuffer_sum(const film *f, size_t i, surface_sum *sum)
{
    if (!f->surfaces)
        return;
    add_surface(sum, &f->surfaces[i]);
    if (film_pass_counts(f, i))
        add_surface(sum, &f->pass_surfaces[i]);
}

void gbuffer_add_names(const film *f, GPtrArray *names)
{
    for (size_t i = 0; f->surfaces && i < G_N_ELEMENTS(channels); i++)
        g_ptr_array_add(names, g_strdup(channels[i]));
}

static float *write_mean(float *out, const double *sum, int n, double weight)
{
    for (int i = 0; i < n; i++)
        *out++ = (float)(sum[i] / weight);
    return out;
}

static float *write_normal(float *out, const double sum[3])
{
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    return write_mean(out, sum, 3, length > 0.0 ? length : 1.0);
}

static float *write_variance(float *out, const surface_sum *of)
{
    double n = of->n_samples;
    for (int i = 0; i < 3; i++) {
        double mean = n > 0.0 ? of->rgb[i] / n : 0.0;
        double variance =
            n > 1.0 ? fmax(of->rgb2[i] - mean * of->rgb[i], 0.0) / (n - 1.0) : 0.0;
        out[i] = (float)variance;
        out[3 + i] = fabs(mean) > 0.0 ? (float)(variance / mean) : 0.0f;
    }
    return out + 6;
}

void gbuffer_write(const film *f, const surface_sum *of, const film_sum *sum, float *out)
{
    if (!f->surfaces)
        return;
    double weight = film_surface_weight(f, sum);
    film_to_rgb(f, sum->color[N_LAYERS], sum->weight, out);
    out = write_mean(out + 3, of->p, 3, weight);
    double dz[2] = {fabs(of->dz[0]), fabs(of->dz[1])};
    out = write_mean(out, dz, 2, weight);
    out = write_normal(out, of->n);
    out = write_normal(out, of->ns);
    out = write_mean(out, of->uv, 2, weight);
    write_variance(out, of);
}
