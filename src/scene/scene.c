#include "scene/scene.h"

#include "base/memory.h"

static void free_texture(void *data)
{
    texture_free(data);
}

static void free_material(void *data)
{
    material_free(data);
}

static void free_medium(void *data)
{
    medium_free(data);
}

static void free_shape(void *data)
{
    shape_free(data);
}

static void free_light(void *data)
{
    light_free(data);
}

scene *scene_new(void)
{
    scene *s = g_new0(scene, 1);
    s->shapes = g_ptr_array_new_with_free_func(free_shape);
    s->materials = g_ptr_array_new_with_free_func(free_material);
    s->lights = g_ptr_array_new_with_free_func(free_light);
    s->instances = g_array_new(FALSE, TRUE, sizeof(instance));
    s->textures = g_ptr_array_new_with_free_func(free_texture);
    s->media = g_ptr_array_new_with_free_func(free_medium);
    s->settings = settings_default();
    return s;
}

void scene_forget_commit(scene *s)
{
    accel_free(s->accel);
    s->accel = NULL;
    distribution_clear(&s->light_power);
    g_clear_pointer(&s->light_tree, light_tree_free);
    g_clear_pointer(&s->lines, g_free);
    g_clear_pointer(&s->environments, g_free);
    g_clear_pointer(&s->light_groups, g_strfreev);
    g_clear_pointer(&s->solids, g_free);
    s->n_environments = 0;
}

void scene_free(scene *s)
{
    if (!s)
        return;
    scene_forget_commit(s);
    g_ptr_array_unref(s->lights);
    g_ptr_array_unref(s->shapes);
    g_ptr_array_unref(s->materials);
    memory_release(s->instance_room * INSTANCE_SIZE);
    g_array_unref(s->instances);
    g_ptr_array_unref(s->media);
    g_ptr_array_unref(s->textures);
    g_free(s);
}

/* ---- Asking ---- */

wavelengths scene_wavelengths(const scene *s, const settings *how, uint32_t pass)
{
    bool fixed = s->switches.fixed_wavelengths;
    return wavelengths_drawn(s->lines,
                             fixed ? 0.5f : wavelength_offset((uint64_t)how->seed, pass));
}

wavelengths scene_trial_wavelengths(const scene *s, uint32_t trial)
{
    return wavelengths_drawn(s->lines, s->lines ? wavelength_offset(0, trial) : 0.5f);
}

unsigned scene_possible_lobes(const scene *s, const surface_hit *hit)
{
    const material *m = s->materials->pdata[hit->material];
    return m->lobes;
}

unsigned scene_lobes_around(const scene *s, const surface_hit *hit, const bsdf *b)
{
    return b->lobes | scene_possible_lobes(s, hit);
}

bool scene_bsdf(const scene *s, const surface_hit *hit, const wavelengths *w,
                int wavelength, const bsdf_options *options, bsdf *out)
{
    if (hit->material == NO_INDEX)
        return false;
    material_bsdf(s->materials->pdata[hit->material], hit, w, wavelength, options, out);
    return true;
}
