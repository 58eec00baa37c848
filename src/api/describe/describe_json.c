#include "api/describe/describe.h"

#include "base/json.h"

static void put_vec3(json *j, const char *key, vec3 v)
{
    json_floats(j, key, (const float[]){v[0], v[1], v[2]}, 3);
}

static void put_shapes(json *j, const scene *s, const summary *all)
{
    json_array_begin(j, "shapes");
    for (guint i = 0; i < all->shapes->len; i++) {
        const tally *t = &g_array_index(all->shapes, tally, i);
        json_object_begin(j, NULL);
        json_string(j, "kind", t->kind);
        json_count(j, "count", t->n);
        json_count(j, "triangles", t->n_triangles);
        json_number(j, "area", t->area);
        json_count(j, "shining", t->n_shining);
        json_object_end(j);
    }
    json_array_end(j);
    json_count(j, "objects", s->n_objects);
    json_count(j, "instances", s->instances->len);
    json_string(j, "unit", "m");
    json_object_begin(j, "bounds");
    if (!box3_is_empty(s->bounds)) {
        put_vec3(j, "low", s->bounds.low);
        put_vec3(j, "high", s->bounds.high);
    }
    json_object_end(j);
}

static void put_lights(json *j, const summary *all)
{
    json_array_begin(j, "lights");
    for (guint i = 0; i < all->lights->len; i++) {
        const tally *t = &g_array_index(all->lights, tally, i);
        json_object_begin(j, NULL);
        json_string(j, "kind", t->kind);
        json_count(j, "count", t->n);
        json_number(j, "power", t->power);
        json_object_end(j);
    }
    json_array_end(j);
}

static void put_list(json *j, const char *key, const GPtrArray *texts)
{
    json_array_begin(j, key);
    for (guint i = 0; i < texts->len; i++)
        json_string(j, NULL, texts->pdata[i]);
    json_array_end(j);
}

static void put_materials(json *j, const summary *all)
{
    json_array_begin(j, "materials");
    for (guint i = 0; i < all->materials->len; i++) {
        const tally *t = &g_array_index(all->materials, tally, i);
        json_object_begin(j, NULL);
        json_string(j, "kind", t->kind);
        json_count(j, "count", t->n);
        json_count(j, "casting_caustics", t->n_caustic);
        json_object_end(j);
    }
    json_array_end(j);
    put_list(j, "casting_caustics", all->caustic_names);
    json_object_begin(j, "textures");
    json_count(j, "float", all->n_float_textures);
    json_count(j, "spectrum", all->n_spectrum_textures);
    json_object_begin(j, "kinds");
    for (guint i = 0; i < all->textures->len; i++) {
        const tally *t = &g_array_index(all->textures, tally, i);
        json_count(j, t->kind, t->n);
    }
    json_object_end(j);
    json_object_end(j);
}

static void put_media(json *j, const summary *all)
{
    json_array_begin(j, "media");
    for (guint i = 0; i < all->media->len; i++) {
        const tally *t = &g_array_index(all->media, tally, i);
        json_object_begin(j, NULL);
        json_string(j, "kind", t->kind);
        json_count(j, "count", t->n);
        json_count(j, "scattering", t->n_scattering);
        json_object_end(j);
    }
    json_array_end(j);
}

static void put_files(json *j, const summary *all)
{
    json_array_begin(j, "files");
    for (const char *const *path = scene_sources_paths(all->sources); *path; path++)
        json_string(j, NULL, *path);
    json_array_end(j);
}

static void put_camera(json *j, const view *v, const summary *all)
{
    const transform *to_world = &v->camera.to_world;
    vec3 forward = transform_vector(to_world, vec3_make(0.0f, 0.0f, 1.0f));
    json_object_begin(j, "camera");
    put_vec3(j, "position", transform_point(to_world, vec3_make(0.0f, 0.0f, 0.0f)));
    put_vec3(j, "direction", normalize3(forward));
    json_floats(j, "view_angle", all->view_angle, 2);
    json_float(j, "lens_radius", v->camera.lens_radius);
    if (v->camera.lens_radius > 0.0f)
        json_float(j, "focal_distance", v->camera.focal_distance);
    if (v->camera.media.participating)
        json_string(j, "medium",
                    scene_medium(v->scene, v->camera.media.participating)->name);
    json_object_end(j);
}

static void put_film(json *j, const film_settings *film)
{
    json_object_begin(j, "film");
    json_integer(j, "width", film->width);
    json_integer(j, "height", film->height);
    json_floats(j, "crop", film->crop, 4);
    json_string(j, "file", film->filename);
    json_string(j, "color_space", color_space_name(film->space));
    json_float(j, "iso", film->iso);
    json_object_end(j);
}

static void put_setting(const setting_row *row, const char *value, void *data)
{
    json_string(data, row->name, value);
}

char *describe_as_json(const view *v, const summary *all)
{
    const scene *s = v->scene;
    json j = {0};
    json_object_begin(&j, NULL);
    put_shapes(&j, s, all);
    put_lights(&j, all);
    put_materials(&j, all);
    put_media(&j, all);
    put_camera(&j, v, all);
    put_film(&j, &v->film);
    json_string(&j, "filter", v->filter.name);
    json_object_begin(&j, "settings");
    visit_changed_settings(&s->settings, put_setting, &j);
    json_object_end(&j);
    json_object_begin(&j, "memory");
    json_count(&j, "geometry", all->geometry_bytes);
    json_count(&j, "peak", all->process_bytes);
    json_count(&j, "rendering", all->render_bytes);
    json_object_end(&j);
    put_files(&j, all);
    put_list(&j, "warnings", all->warnings);
    json_object_end(&j);
    return json_finish(&j);
}
