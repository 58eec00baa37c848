/*
 * The constant environment: the same radiance from everywhere, Φ = 4π · π R² L through
 * the scene's bounding sphere.
 */
#include "light/light_kinds.h"
#include "math/warp.h"

typedef struct infinite_light {
    emitter radiance;
    light_disk disk;
} infinite_light;

static const float all_around = 4.0f * PI_F;

static void free_infinite(void *self)
{
    infinite_light *l = self;
    emitter_clear(&l->radiance);
    g_free(l);
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)context, (void)to_world, (void)on;
    infinite_light *l = g_new0(infinite_light, 1);
    if (emitter_init(&l->radiance, p, "L", NULL, error) &&
        emitter_set_total(&l->radiance, p, "illuminance", PI_F, error))
        return l;
    free_infinite(l);
    return NULL;
}

static void prepare(void *self, vec3 center, float radius)
{
    ((infinite_light *)self)->disk = (light_disk){center, radius};
}

static spectrum power(const void *self, const wavelengths *w)
{
    const infinite_light *l = self;
    return all_around * light_disk_area(&l->disk) * emitter_eval(&l->radiance, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const infinite_light *l = self;
    return (light_bound){.irradiance =
                             PI_F * spectrum_mean(emitter_eval(&l->radiance, w))};
}

static light_emission leave(const infinite_light *l, vec3 origin, vec3 direction,
                            spectrum flux)
{
    return (light_emission){.ray = {origin, direction, INFINITY, 0.0f, {{0}, 0}},
                            .n = direction,
                            .flux = flux,
                            .pdf_position = 1.0f / light_disk_area(&l->disk),
                            .pdf_direction = 1.0f / all_around};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive;
    const infinite_light *l = self;
    vec3 direction = warp_sphere(u_direction);
    *out = leave(l, light_disk_start(&l->disk, direction, u_position), direction,
                 power(self, w));
    return true;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n, (void)direction;
    const infinite_light *l = self;
    *pdf_position = 1.0f / light_disk_area(&l->disk);
    *pdf_direction = 1.0f / all_around;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive;
    const infinite_light *l = self;
    vec3 direction = warp_sphere(u);
    *out = leave(l, light_disk_before(&l->disk, direction, target), direction,
                 all_around * emitter_eval(&l->radiance, w));
    return true;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)ref, (void)u_primitive;
    const infinite_light *l = self;
    vec3 wi = warp_sphere(u);
    *out = (light_sample){.wi = wi,
                          .distance = INFINITY,
                          .radiance = emitter_eval(&l->radiance, w),
                          .pdf = 1.0f / all_around,
                          .n = -wi};
    return true;
}

static float pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit)
{
    (void)self, (void)ref, (void)wi, (void)hit;
    return 1.0f / all_around;
}

static spectrum environment(const void *self, vec3 p, vec3 d, const wavelengths *w)
{
    (void)p, (void)d;
    const infinite_light *l = self;
    return emitter_eval(&l->radiance, w);
}

const light_kind light_infinite = {
    .name = "infinite",
    .parameters = "L scale illuminance",
    .is_environment = true,
    .is_parallel = true,
    .create = create,
    .free = free_infinite,
    .prepare = prepare,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = pdf,
    .environment = environment,
};
