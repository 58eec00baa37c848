#include "api/describe/describe.h"

#include "base/printable.h"

/* Names shown of a list that may be long. */
enum { MOST_NAMES = 8 };

/* What a file calls something. */
static void put_name(GString *out, const char *before, const char *name)
{
    g_autofree char *shown = printable(name);
    g_string_append_printf(out, "%s%s", before, shown);
}

static void put_vec3(GString *out, const char *label, vec3 v)
{
    g_string_append_printf(out, "  %-14s %g %g %g\n", label, (double)v[0], (double)v[1],
                           (double)v[2]);
}

static void put_shapes(GString *out, const scene *s, const summary *all)
{
    g_string_append_printf(out, "shapes           %u\n", s->shapes->len);
    for (guint i = 0; i < all->shapes->len; i++) {
        const tally *t = &g_array_index(all->shapes, tally, i);
        g_string_append_printf(out, "  %-14s %zu", t->kind, t->n);
        if (t->n_triangles)
            g_string_append_printf(out, ", %zu triangles", t->n_triangles);
        g_string_append_printf(out, ", %g m²", t->area);
        if (t->n_shining)
            g_string_append_printf(out, ", %zu shining", t->n_shining);
        g_string_append_c(out, '\n');
    }
    if (s->instances->len > 0)
        g_string_append_printf(out, "  instances      %u of %u objects\n",
                               s->instances->len, s->n_objects);
    if (box3_is_empty(s->bounds))
        return;
    put_vec3(out, "from", s->bounds.low);
    put_vec3(out, "to", s->bounds.high);
    g_string_append(out, "  lengths        in metres\n");
}

static void put_lights(GString *out, const scene *s, const summary *all)
{
    g_string_append_printf(out, "lights           %u\n", s->lights->len);
    for (guint i = 0; i < all->lights->len; i++) {
        const tally *t = &g_array_index(all->lights, tally, i);
        g_string_append_printf(out, "  %-14s %zu, %g W%s\n", t->kind, t->n, t->power,
                               t->is_environment ? " onto the scene" : "");
    }
}

static void put_materials(GString *out, const scene *s, const summary *all)
{
    g_string_append_printf(out, "materials        %u\n", s->materials->len);
    for (guint i = 0; i < all->materials->len; i++) {
        const tally *t = &g_array_index(all->materials, tally, i);
        g_string_append_printf(out, "  %-14s %zu", t->kind, t->n);
        if (t->n_caustic)
            g_string_append_printf(out, ", %zu casting caustics", t->n_caustic);
        g_string_append_c(out, '\n');
    }
    if (all->caustic_names->len > 0) {
        g_string_append(out, "  caustics from ");
        for (guint i = 0; i < MIN(all->caustic_names->len, MOST_NAMES); i++)
            put_name(out, i ? ", " : " ", all->caustic_names->pdata[i]);
        if (all->caustic_names->len > MOST_NAMES)
            g_string_append_printf(out, " and %u more",
                                   all->caustic_names->len - MOST_NAMES);
        g_string_append_c(out, '\n');
    }
    g_string_append_printf(out, "textures         %zu float, %zu spectrum\n",
                           all->n_float_textures, all->n_spectrum_textures);
    for (guint i = 0; i < all->textures->len; i++) {
        const tally *t = &g_array_index(all->textures, tally, i);
        g_string_append_printf(out, "  %-14s %zu\n", t->kind, t->n);
    }
}

static void put_media(GString *out, const scene *s, const summary *all)
{
    if (!scene_has_media(s))
        return;
    g_string_append_printf(out, "media            %u\n", s->media->len);
    for (guint i = 0; i < all->media->len; i++) {
        const tally *t = &g_array_index(all->media, tally, i);
        g_string_append_printf(out, "  %-14s %zu, %zu scattering\n", t->kind, t->n,
                               t->n_scattering);
    }
}

static void put_camera(GString *out, const view *v, const summary *all)
{
    const transform *to_world = &v->camera.to_world;
    vec3 forward = transform_vector(to_world, vec3_make(0.0f, 0.0f, 1.0f));
    g_string_append(out, "camera\n");
    put_vec3(out, "at", transform_point(to_world, vec3_make(0.0f, 0.0f, 0.0f)));
    put_vec3(out, "toward", normalize3(forward));
    g_string_append_printf(out, "  %-14s %.4g x %.4g degrees\n", "sees",
                           (double)all->view_angle[0], (double)all->view_angle[1]);
    if (v->camera.lens_radius > 0.0f)
        g_string_append_printf(out, "  %-14s radius %g m, in focus at %g m\n", "lens",
                               (double)v->camera.lens_radius,
                               (double)v->camera.focal_distance);
    else
        g_string_append_printf(out, "  %-14s pinhole\n", "lens");
    const medium *in = scene_medium(v->scene, v->camera.media.participating);
    if (in) {
        put_name(out, "  in medium      ", in->name);
        g_string_append_c(out, '\n');
    }
}

static void put_film(GString *out, const view *v)
{
    const film_settings *film = &v->film;
    g_string_append_printf(out, "film             %d x %d pixels, %s, ISO %g\n",
                           film->width, film->height, color_space_name(film->space),
                           (double)film->iso);
    const float *crop = film->crop;
    if (crop[0] > 0.0f || crop[1] < 1.0f || crop[2] > 0.0f || crop[3] < 1.0f)
        g_string_append_printf(out, "  %-14s %g .. %g across, %g .. %g down\n", "crop",
                               (double)crop[0], (double)crop[1], (double)crop[2],
                               (double)crop[3]);
    put_name(out, "  file           ", film->filename ? film->filename : "not named");
    g_string_append_printf(out, "\n  %-14s %s, %g x %g pixels\n", "filter",
                           v->filter.name, 2.0 * (double)v->filter.x_radius,
                           2.0 * (double)v->filter.y_radius);
}

static void put_setting(const setting_row *row, const char *value, void *data)
{
    GString *out = data;
    g_string_append_printf(out, "  %-14s %s%s%s\n", row->name, value,
                           *row->unit ? " " : "", row->unit);
}

static void put_memory(GString *out, const summary *all)
{
    const GFormatSizeFlags units = G_FORMAT_SIZE_IEC_UNITS;
    g_autofree char *geometry = g_format_size_full(all->geometry_bytes, units);
    g_autofree char *peak = g_format_size_full(all->process_bytes, units);
    g_autofree char *rendering = g_format_size_full(all->render_bytes, units);
    g_string_append_printf(out,
                           "memory           %s of meshes, %s at its peak; rendering "
                           "takes about %s\n",
                           geometry, peak, rendering);
}

static void put_files(GString *out, const summary *all)
{
    const char *const *paths = scene_sources_paths(all->sources);
    guint n = g_strv_length((char **)paths);
    g_string_append_printf(out, "read from        %u file%s\n", n, n == 1 ? "" : "s");
    for (guint i = 0; i < MIN(n, MOST_NAMES); i++) {
        put_name(out, "  ", paths[i]);
        g_string_append_c(out, '\n');
    }
    if (n > MOST_NAMES)
        g_string_append_printf(out, "  and %u more\n", n - MOST_NAMES);
}

static void put_warnings(GString *out, const summary *all)
{
    for (guint i = 0; i < all->warnings->len; i++) {
        put_name(out, "warning          ", all->warnings->pdata[i]);
        g_string_append_c(out, '\n');
    }
}

char *describe_as_text(const view *v, const summary *all)
{
    const scene *s = v->scene;
    GString *out = g_string_new(NULL);
    put_shapes(out, s, all);
    put_lights(out, s, all);
    put_materials(out, s, all);
    put_media(out, s, all);
    put_camera(out, v, all);
    put_film(out, v);
    g_string_append(out, "settings that differ from the defaults\n");
    gsize before = out->len;
    visit_changed_settings(&s->settings, put_setting, out);
    if (out->len == before)
        g_string_append(out, "  none\n");
    put_memory(out, all);
    put_files(out, all);
    put_warnings(out, all);
    return g_string_free(out, FALSE);
}
