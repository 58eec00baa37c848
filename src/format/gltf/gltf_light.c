/*
 * Lights (KHR_lights_punctual) and cameras of glTF nodes. Both look along their node's
 * -z, with y up.
 *
 * Candela, lux and, of surfaces that shine, candela per square metre are taken as they
 * stand: a radiance of 1 is 1 cd/m², as viewers of glTF show it, and as pbrt's own
 * illuminance is meant. Blender makes lights' numbers from watts by 683 lm/W, unless it
 * is told to leave them as they are, yet leaves shining surfaces as they are: where it
 * wrote the file and its lights are that strong this is taken back, as Blender itself
 * does, so that lights and surfaces keep their proportion.
 */
#include "format/gltf/gltf.h"

#include "format/given.h"

#include <math.h>
#include <string.h>

#define LUMENS_PER_WATT 683.0
/* Between suns of Blender's that are so many watts per square metre, 0.1 to 20, and those
   that are 683 times that; between its lights of 2 to 2000 W, over 4 pi, likewise. */
#define FAINT_SUN 37.0    /* lx */
#define FAINT_LIGHT 150.0 /* cd */
#define DEGREES (180.0 / G_PI)

enum { DEFAULT_HEIGHT = 720 };

static bool is_from_blender(gltf *g)
{
    json_value asset = json_member(&g->root, "asset");
    const char *generator = json_text(&asset, "generator");
    return generator && g_str_has_prefix(generator, "Khronos glTF Blender I/O");
}

/* Whether a light's number is above those that Blender writes without 683 lm/W. */
static bool is_strong(const json_value *source)
{
    const char *type = json_text(source, "type");
    bool is_sun = type && strcmp(type, "directional") == 0;
    return json_real(source, "intensity", 1.0) > (is_sun ? FAINT_SUN : FAINT_LIGHT);
}

/* Lumens that a light's unit stands for: 683 where Blender made it from watts. */
static double lumens_of_unit(gltf *g)
{
    json_value extensions;
    json_value all = gltf_extension(&g->root, "KHR_lights_punctual", &extensions);
    json_value lights = json_member(&all, "lights");
    guint n = json_length(&lights);
    bool strong = false;
    for (guint i = 0; i < n && !strong && !gltf_failed(g); i++) {
        json_value source = json_element(&lights, i);
        strong = is_strong(&source);
    }
    if (!is_from_blender(g))
        return 1.0;
    gltf_note(g, LOG_NOTE,
              strong ? "Blender's lights: 683 lm are read as 1 W, as it does"
                     : "Blender's lights are faint: read as they stand, not "
                       "as 683 lm for 1 W");
    return strong ? LUMENS_PER_WATT : 1.0;
}

/* Colour times candela or lux. */
static params *emission(gltf *g, const json_value *source, const char *name)
{
    double color[3] = {1.0, 1.0, 1.0};
    params *p = gltf_params(g);
    json_numbers(source, "color", color, 3);
    give_triple(p, PARAM_RGB, name, color[0], color[1], color[2]);
    if (!(g->lumens > 0.0))
        g->lumens = lumens_of_unit(g);
    give_float(p, "scale", json_real(source, "intensity", 1.0) / g->lumens);
    return p;
}

/* Blender's lights fade over a share of 1 - cos of the outer angle. What it writes into a
 * file is that share of the angle, which is wider; reading the file, it takes that back.
 */
static double blender_inner(double inner, double outer)
{
    double share = 1.0 - inner / outer, edge = cos(outer);
    return acos(MIN(edge + share * (1.0 - edge), 1.0));
}

/* The standard wants the inner angle below the outer one; Blender writes sharp edges as
 * two equal ones. */
static params *spot_params(gltf *g, const json_value *source)
{
    params *p = emission(g, source, "I");
    json_value spot = json_member(source, "spot");
    double inner = json_real(&spot, "innerConeAngle", 0.0);
    double outer = json_real(&spot, "outerConeAngle", G_PI / 4.0);
    if (!(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= 0.5001 * G_PI))
        json_fail(&spot, "expected cone angles 0 <= inner <= outer <= pi/2");
    else if (is_from_blender(g))
        inner = blender_inner(inner, outer);
    outer = MIN(outer, 0.4999 * G_PI);
    give_float(p, "coneangle", outer * DEGREES);
    give_float(p, "conedeltaangle", (outer - MIN(inner, outer)) * DEGREES);
    give_triple(p, PARAM_POINT3, "to", 0.0, 0.0, -1.0);
    return p;
}

static params *distant_params(gltf *g, const json_value *source)
{
    params *p = emission(g, source, "L");
    give_triple(p, PARAM_POINT3, "to", 0.0, 0.0, -1.0);
    return p;
}

static params *point_params(gltf *g, const json_value *source)
{
    return emission(g, source, "I");
}

typedef struct light_type {
    const char *name, *kind;
    params *(*make)(gltf *g, const json_value *source);
} light_type;

static const light_type types[] = {
    {"directional", "distant", distant_params},
    {"point", "point", point_params},
    {"spot", "spot", spot_params},
};

static bool is_black(const json_value *source)
{
    double color[3] = {1.0, 1.0, 1.0};
    json_numbers(source, "color", color, 3);
    return !(json_real(source, "intensity", 1.0) > 0.0) ||
           !(color[0] + color[1] + color[2] > 0.0);
}

static void add_light(gltf *g, const json_value *source, const transform *to_world)
{
    const char *type = json_text(source, "type");
    const light_type *found = NULL;
    for (size_t i = 0; type && i < G_N_ELEMENTS(types); i++)
        if (strcmp(types[i].name, type) == 0)
            found = &types[i];
    if (!found) {
        json_fail(source, "expected \"type\" directional, point or spot, found %s",
                  type ? type : "none");
        return;
    }
    if (is_black(source) || gltf_failed(g))
        return;
    GError *error = NULL;
    g_autoptr(params) p = found->make(g, source);
    if (!gltf_failed(g) &&
        !builder_add_light(g->builder, found->kind, p, to_world, &error))
        gltf_take_error(g, source, error);
}

void gltf_add_light(gltf *g, const json_value *node, const transform *to_world)
{
    json_value extensions, root_extensions;
    json_value use = gltf_extension(node, "KHR_lights_punctual", &extensions);
    json_value all = gltf_extension(&g->root, "KHR_lights_punctual", &root_extensions);
    gint64 index = json_whole(&use, "light", GLTF_MOST);
    if (index < 0)
        return;
    json_value lights = json_member(&all, "lights");
    json_value source = json_element(&lights, (guint)index);
    if (!gltf_failed(g))
        add_light(g, &source, to_world);
}

/* ---- Cameras ---- */

/* A transform's place and directions, without its scale. The camera's z points forward.
 */
static bool camera_place(const transform *node, transform *out)
{
    vec3 p = transform_point(node, (vec3){0});
    vec3 z = normalize3(transform_vector(node, vec3_make(0.0f, 0.0f, -1.0f)));
    vec3 y = transform_vector(node, vec3_make(0.0f, 1.0f, 0.0f));
    vec3 x = normalize3(cross3(z, y));
    y = cross3(x, z);
    double m[4][4] = {{0}};
    for (int i = 0; i < 3; i++) {
        m[i][0] = (double)x[i];
        m[i][1] = (double)y[i];
        m[i][2] = (double)z[i];
        m[i][3] = (double)p[i];
    }
    m[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])m, out);
}

static void give_film(gltf *g, const json_value *at, double aspect)
{
    GError *error = NULL;
    g_autoptr(params) p = gltf_params(g);
    aspect = CLAMP(aspect, 0.05, 20.0);
    give_integer(p, "yresolution", DEFAULT_HEIGHT);
    give_integer(p, "xresolution", MAX(1, (int)lround(DEFAULT_HEIGHT * aspect)));
    if (!builder_set_film(g->builder, "rgb", p, &error))
        gltf_take_error(g, at, error);
}

static void perspective(gltf *g, const json_value *eye, params *p)
{
    json_value lens = json_member(eye, "perspective");
    double aspect = json_real(&lens, "aspectRatio", 16.0 / 9.0);
    double yfov = json_real(&lens, "yfov", 0.0);
    if (!(yfov > 0.0 && yfov < G_PI) || !(aspect > 0.0)) {
        json_fail(&lens, "expected a \"yfov\" in 0..pi and an \"aspectRatio\" > 0");
        return;
    }
    double fov = aspect >= 1.0 ? yfov : 2.0 * atan(tan(0.5 * yfov) * aspect);
    give_float(p, "fov", fov * DEGREES);
    give_film(g, &lens, aspect);
}

static void orthographic(gltf *g, const json_value *eye, params *p)
{
    json_value lens = json_member(eye, "orthographic");
    double x = json_real(&lens, "xmag", 0.0), y = json_real(&lens, "ymag", 0.0);
    if (!(x > 0.0) || !(y > 0.0)) {
        json_fail(&lens, "expected \"xmag\" and \"ymag\" > 0");
        return;
    }
    float window[4] = {(float)-x, (float)x, (float)-y, (float)y};
    params_add_numbers(p, p->place, PARAM_FLOAT, "screenwindow", window, 4, NULL);
    give_film(g, &lens, x / y);
}

void gltf_add_camera(gltf *g, const json_value *node, const transform *to_world)
{
    json_value array;
    gint64 index;
    json_value eye = gltf_refer(g, node, "camera", "cameras", &array, &index);
    if (!json_exists(&eye))
        return;
    if (g->has_camera) {
        gltf_note(g, LOG_NOTE, "more than one camera: the first one is taken");
        return;
    }
    GError *error = NULL;
    transform place;
    const char *type = json_text(&eye, "type");
    bool is_flat = type && strcmp(type, "orthographic") == 0;
    g_autoptr(params) p = gltf_params(g);
    if (!is_flat && (!type || strcmp(type, "perspective") != 0))
        json_fail(&eye, "expected \"type\" perspective or orthographic");
    else if (is_flat)
        orthographic(g, &eye, p);
    else
        perspective(g, &eye, p);
    if (gltf_failed(g))
        return;
    if (!camera_place(to_world, &place))
        json_fail(node, "the camera's transform flattens space");
    else if (!builder_set_camera(g->builder, is_flat ? "orthographic" : "perspective", p,
                                 &place, &error))
        gltf_take_error(g, node, error);
    g->has_camera = !gltf_failed(g);
}
