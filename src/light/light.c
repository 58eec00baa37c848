/*
 * The table of lights, and what several of them share.
 */
#include "light/light.h"

#include "light/light_kinds.h"
#include "math/frame.h"
#include "math/warp.h"
#include "params/kinds.h"

#include <glib.h>
#include <string.h>

static const light_kind *const kinds[] = {
#define LIGHT(kind, file) &light_##kind,
#include "light/light.def"
#undef LIGHT
};

const light_kind *light_kind_at(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i] : NULL;
}

/* Area lights are asked for by another directive than all others. */
static const char *name_of(size_t i, bool on_shape)
{
    if (i >= G_N_ELEMENTS(kinds))
        return NULL;
    return (kinds[i] == &light_area) == on_shape ? kinds[i]->name : "";
}

static const char *name_on_shape(size_t i)
{
    return name_of(i, true);
}

static const char *name_of_source(size_t i)
{
    return name_of(i, false);
}

static const light_kind *find_kind(const char *name, const params *p, bool on_shape)
{
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++)
        if (*name && strcmp(name_of(i, on_shape), name) == 0 &&
            (!kinds[i]->is_meant || kinds[i]->is_meant(p)))
            return kinds[i];
    return NULL;
}

/* The name of a light's group, which becomes part of channels' names; NULL if it has none
   or an error. */
static char *read_group(const params *p, GError **error)
{
    const char *name = NULL;
    if (!params_string(p, "group", &name, error) || !name)
        return NULL;
    if (*name &&
        strspn(name, G_CSET_A_2_Z G_CSET_a_2_z G_CSET_DIGITS "_-") == strlen(name))
        return g_strdup(name);
    error_at(error, params_find(p, "group")->place,
             "parameter 'group': expected letters, digits, _ and -, found \"%s\"", name);
    return NULL;
}

light *light_new(const build_context *context, const char *name, const params *p,
                 const transform *to_world, const shape *on, GError **error)
{
    const light_kind *kind = find_kind(name, p, on != NULL);
    if (!kind) {
        kind_unknown(on ? name_on_shape : name_of_source,
                     on ? "an area light" : "a light source", name, p->place, error);
        return NULL;
    }
    g_autofree char *what = g_strdup_printf("light \"%s\"", name);
    if (!params_known(p, what, kind->parameters, LIGHT_PARAMETERS, error))
        return NULL;
    void *self = kind->create(context, p, to_world, on, error);
    if (!self)
        return NULL;
    g_autofree char *group = read_group(p, error);
    bool is_wrong = params_has(p, "group") && !group;
    if (is_wrong || !params_all_used(p, what, error)) {
        kind->free(self);
        return NULL;
    }
    light *l = g_new0(light, 1);
    *l = (light){.kind = kind,
                 .self = self,
                 .place = p->place,
                 .is_delta = kind->is_delta || (on && on->is_invisible),
                 .group = g_steal_pointer(&group)};
    return l;
}

void light_free(light *l)
{
    if (!l)
        return;
    l->kind->free(l->self);
    g_free(l->group);
    g_free(l);
}

/* ---- Emitters ---- */

static bool read_scale(const params *p, float *scale, GError **error)
{
    if (!params_float(p, "scale", scale, error))
        return false;
    if (*scale >= 0.0f)
        return true;
    error_at(error, params_find(p, "scale")->place,
             "a light's scale must not be negative, found %g", (double)*scale);
    return false;
}

bool emitter_init(emitter *e, const params *p, const char *name, const color_space *space,
                  GError **error)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    if (!space)
        space = p->space ? p->space : color_space_srgb();
    *e = (emitter){.scale = 1.0f};
    if (!read_scale(p, &e->scale, error) ||
        (name && !params_curve(p, name, CURVE_EMISSION, &e->spectrum, error)))
        return false;
    if (!e->spectrum)
        e->spectrum = curve_rgb(space, white, CURVE_EMISSION, error);
    if (!e->spectrum)
        return false;
    float photometric = curve_photometric(e->spectrum);
    if (!(photometric > 0.0f)) {
        error_at(error, p->place, "the light's spectrum \"%s\" has no visible power",
                 name);
        emitter_clear(e);
        return false;
    }
    e->scale /= photometric;
    return true;
}

bool emitter_set_total(emitter *e, const params *p, const char *name, float k_e,
                       GError **error)
{
    float total = 0.0f;
    if (!params_has(p, name))
        return true;
    if (!params_float(p, name, &total, error))
        return false;
    if (!(total > 0.0f)) {
        error_at(error, params_find(p, name)->place,
                 "a light's %s must be positive, found %g", name, (double)total);
        return false;
    }
    e->scale *= total / k_e;
    return true;
}

spectrum emitter_eval(const emitter *e, const wavelengths *w)
{
    return e->scale * curve_eval(e->spectrum, w);
}

void emitter_clear(emitter *e)
{
    curve_unref(e->spectrum);
    *e = (emitter){0};
}

bool light_axes(frame *axes, const transform *to_world, const params *p, GError **error)
{
    vec3 a[3];
    float length[3], off = 0.0f;
    for (int i = 0; i < 3; i++) {
        vec3 unit = {0};
        unit[i] = 1.0f;
        a[i] = transform_vector(to_world, unit);
        length[i] = length3(a[i]);
        a[i] = normalize3(a[i]);
    }
    for (int i = 0; i < 3; i++) {
        off = maxf(off, fabsf(dot3(a[i], a[(i + 1) % 3])));
        off = maxf(off, fabsf(length[i] / length[0] - 1.0f));
    }
    *axes = (frame){a[0], a[1], a[2]};
    if (off < 1e-3f)
        return true;
    error_at(error, p->place,
             "this light needs a transform that keeps angles: it is stretched or skewed");
    return false;
}

/* ---- The disk before the scene ---- */

vec3 light_disk_start(const light_disk *disk, vec3 direction, vec2 u)
{
    frame f = frame_from_normal(direction);
    vec2 d = warp_disk(u);
    return disk->center + disk->radius * (d.x * f.s + d.y * f.t - direction);
}

vec3 light_disk_before(const light_disk *disk, vec3 direction, vec3 target)
{
    float along = dot3(target - disk->center, direction);
    return target - direction * (along + disk->radius);
}

float light_disk_area(const light_disk *disk)
{
    return PI_F * disk->radius * disk->radius;
}

light_emission light_leave_point(vec3 p, vec3 direction, float pdf_direction,
                                 spectrum flux)
{
    return (light_emission){
        .ray = {.origin = p, .direction = direction, .t_max = INFINITY},
        .n = direction,
        .flux = flux,
        .pdf_position = 1.0f,
        .pdf_direction = pdf_direction};
}

bool light_arrive_from_point(vec3 p, vec3 ref, spectrum intensity, light_sample *out)
{
    vec3 to = p - ref;
    float distance = length3(to);
    if (!(distance > 0.0f) || spectrum_is_black(intensity))
        return false;
    *out = (light_sample){.wi = to / distance,
                          .distance = distance,
                          .radiance = intensity / square(distance),
                          .pdf = 1.0f,
                          .n = -to / distance};
    return true;
}

float light_delta_pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit)
{
    (void)self, (void)ref, (void)wi, (void)hit;
    return 0.0f;
}
