#include "api/describe/describe.h"

#include "base/memory.h"
#include "render/footprint.h"

#include <math.h>
#include <string.h>

static tally *tally_of(GArray *list, const char *kind)
{
    for (guint i = 0; i < list->len; i++) {
        tally *t = &g_array_index(list, tally, i);
        if (strcmp(t->kind, kind) == 0)
            return t;
    }
    g_array_append_val(list, ((tally){.kind = kind}));
    return &g_array_index(list, tally, list->len - 1);
}

static size_t mesh_bytes(const mesh *m)
{
    size_t per_vertex = 3 * sizeof(float) + (m->normals ? 3 * sizeof(float) : 0) +
                        (m->tangents ? 3 * sizeof(float) : 0) +
                        (m->uvs ? sizeof(vec2) : 0) + (m->uvs2 ? sizeof(vec2) : 0) +
                        (m->colors ? 4 * sizeof(float) : 0);
    return m->n_vertices * per_vertex + m->n_triangles * 3 * sizeof(uint32_t);
}

static void count_shapes(const scene *s, summary *all)
{
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *one = s->shapes->pdata[i];
        tally *t = tally_of(all->shapes, one->kind->name);
        t->n++;
        t->n_shining += one->light != NO_INDEX;
        t->area += (double)one->area;
        const mesh *m = one->kind->triangles ? one->kind->triangles(one->self) : NULL;
        if (m) {
            t->n_triangles += m->n_triangles;
            all->geometry_bytes += mesh_bytes(m);
        }
    }
}

/* The light that the eye sees, over all wavelengths, lines too: Y, as the film has it. */
static double watts_of(const light *one)
{
    double sum = 0.0;
    for (int k = 0; k < CELLS_PER_STRATUM; k++) {
        const wavelengths w = wavelengths_at(((float)k + 0.5f) / CELLS_PER_STRATUM);
        float xyz[3];
        spectrum_to_xyz(&w, one->kind->power(one->self, &w), xyz);
        sum += (double)xyz[1];
    }
    return sum / CELLS_PER_STRATUM;
}

static void count_lights(const scene *s, summary *all)
{
    for (guint i = 0; i < s->lights->len; i++) {
        const light *one = s->lights->pdata[i];
        tally *t = tally_of(all->lights, one->kind->name);
        t->n++;
        t->is_environment = one->kind->is_environment;
        t->power += watts_of(one);
    }
}

static int compare_kinds(const void *a, const void *b)
{
    return strcmp(((const tally *)a)->kind, ((const tally *)b)->kind);
}

static void count_textures(const scene *s, summary *all)
{
    for (guint i = 0; i < s->textures->len; i++) {
        const texture *one = s->textures->pdata[i];
        size_t *n =
            texture_is_spectrum(one) ? &all->n_spectrum_textures : &all->n_float_textures;
        (*n)++;
        tally_of(all->textures, texture_kind_name(one))->n++;
    }
    g_array_sort(all->textures, compare_kinds);
}

static void count_materials(const scene *s, summary *all)
{
    for (guint i = 0; i < s->materials->len; i++) {
        const material *one = s->materials->pdata[i];
        tally *t = tally_of(all->materials, one->kind->name);
        t->n++;
        t->n_caustic += material_casts_caustics(one);
        if (material_casts_caustics(one))
            g_ptr_array_add(all->caustic_names,
                            one->name ? one->name : (char *)"unnamed");
    }
}

static void count_media(const scene *s, summary *all)
{
    for (guint i = 0; i < s->media->len; i++) {
        tally *t = tally_of(all->media, medium_kind_name(0)); /* there is one kind */
        t->n++;
        t->n_scattering += medium_scatters(s->media->pdata[i]);
    }
}

static void measure_view(const view *v, summary *all)
{
    for (int axis = 0; axis < 2; axis++) {
        double low = (double)v->camera.screen[2 * axis];
        double high = (double)v->camera.screen[2 * axis + 1];
        all->view_angle[axis] =
            (float)((atan(fabs(high)) + atan(fabs(low))) * (180.0 / G_PI));
    }
}

static void summary_init(summary *all, const view *v)
{
    const scene *s = v->scene;
    *all = (summary){.shapes = g_array_new(FALSE, TRUE, sizeof(tally)),
                     .lights = g_array_new(FALSE, TRUE, sizeof(tally)),
                     .materials = g_array_new(FALSE, TRUE, sizeof(tally)),
                     .media = g_array_new(FALSE, TRUE, sizeof(tally)),
                     .textures = g_array_new(FALSE, TRUE, sizeof(tally)),
                     .caustic_names = g_ptr_array_new()};
    count_shapes(s, all);
    count_lights(s, all);
    count_materials(s, all);
    count_media(s, all);
    measure_view(v, all);
    count_textures(s, all);
    all->warnings = describe_warnings(v);
    all->process_bytes = memory_peak();
    all->render_bytes = footprint_of(v, &v->scene->settings);
}

static void summary_clear(summary *all)
{
    g_array_unref(all->shapes);
    g_array_unref(all->lights);
    g_array_unref(all->materials);
    g_array_unref(all->media);
    g_array_unref(all->textures);
    g_ptr_array_unref(all->caustic_names);
    g_ptr_array_unref(all->warnings);
}

char *neph_scene_describe(const NephScene *s, bool as_json)
{
    summary all;
    summary_init(&all, s->view);
    all.sources = s->sources;
    char *text =
        as_json ? describe_as_json(s->view, &all) : describe_as_text(s->view, &all);
    summary_clear(&all);
    return text;
}
