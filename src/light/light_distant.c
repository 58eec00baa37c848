/*
 * The distant light: parallel rays that fill the disk before the scene's bounding sphere.
 * Its L is the irradiance on a plane that faces it, Φ = π R² L.
 */
#include "light/light_kinds.h"

typedef struct distant_light {
    emitter irradiance;
    vec3 direction; /* in which light travels, unit */
    light_disk disk;
} distant_light;

static void free_distant(void *self)
{
    distant_light *l = self;
    emitter_clear(&l->irradiance);
    g_free(l);
}

static bool read_direction(distant_light *l, const params *p, const transform *to_world,
                           GError **error)
{
    vec3 from = {0}, to = vec3_make(0.0f, 0.0f, 1.0f);
    if (!params_point3(p, "from", &from, error) || !params_point3(p, "to", &to, error))
        return false;
    l->direction = normalize3(transform_vector(to_world, to - from));
    if (length3_2(l->direction) > 0.0f)
        return true;
    error_at(error, p->place, "a distant light's \"from\" and \"to\" must differ");
    return false;
}

static void *create(const build_context *context, const params *p,
                    const transform *to_world, const shape *on, GError **error)
{
    (void)context, (void)on;
    distant_light *l = g_new0(distant_light, 1);
    if (read_direction(l, p, to_world, error) &&
        emitter_init(&l->irradiance, p, "L", NULL, error) &&
        emitter_set_total(&l->irradiance, p, "illuminance", 1.0f, error))
        return l;
    free_distant(l);
    return NULL;
}

static void prepare(void *self, vec3 center, float radius)
{
    ((distant_light *)self)->disk = (light_disk){center, radius};
}

static spectrum power(const void *self, const wavelengths *w)
{
    const distant_light *l = self;
    return light_disk_area(&l->disk) * emitter_eval(&l->irradiance, w);
}

static light_bound bound(const void *self, const wavelengths *w)
{
    const distant_light *l = self;
    return (light_bound){.irradiance = spectrum_mean(emitter_eval(&l->irradiance, w))};
}

static light_emission leave(const distant_light *l, vec3 origin, spectrum flux)
{
    return (light_emission){.ray = {origin, l->direction, INFINITY, 0.0f, {{0}, 0}},
                            .n = l->direction,
                            .flux = flux,
                            .pdf_position = 1.0f / light_disk_area(&l->disk),
                            .pdf_direction = 1.0f};
}

static bool emit(const void *self, const wavelengths *w, float u_primitive,
                 vec2 u_position, vec2 u_direction, light_emission *out)
{
    (void)u_primitive, (void)u_direction;
    const distant_light *l = self;
    *out = leave(l, light_disk_start(&l->disk, l->direction, u_position), power(self, w));
    return true;
}

static void emit_pdf(const void *self, vec3 p, vec3 n, vec3 direction,
                     float *pdf_position, float *pdf_direction)
{
    (void)p, (void)n, (void)direction;
    const distant_light *l = self;
    *pdf_position = 1.0f / light_disk_area(&l->disk);
    *pdf_direction = 1.0f;
}

static bool emit_toward(const void *self, const wavelengths *w, float u_primitive, vec2 u,
                        vec3 target, light_emission *out)
{
    (void)u_primitive, (void)u;
    const distant_light *l = self;
    *out = leave(l, light_disk_before(&l->disk, l->direction, target),
                 emitter_eval(&l->irradiance, w));
    return true;
}

static bool sample(const void *self, const wavelengths *w, vec3 ref, float u_primitive,
                   vec2 u, light_sample *out)
{
    (void)ref, (void)u_primitive, (void)u;
    const distant_light *l = self;
    *out = (light_sample){.wi = -l->direction,
                          .distance = INFINITY,
                          .radiance = emitter_eval(&l->irradiance, w),
                          .pdf = 1.0f,
                          .n = l->direction};
    return true;
}

const light_kind light_distant = {
    .name = "distant",
    .parameters = "L scale illuminance from to",
    .is_delta = true,
    .is_parallel = true,
    .create = create,
    .free = free_distant,
    .prepare = prepare,
    .power = power,
    .bound = bound,
    .emit = emit,
    .emit_pdf = emit_pdf,
    .emit_toward = emit_toward,
    .sample = sample,
    .pdf = light_delta_pdf,
};
