/*
 * nephroid bsdf: the polar diagram of a material.
 */
#include "arguments.h"
#include "command.h"
#include "message.h"

#include <glib/gstdio.h>
#include <string.h>

/* Directions of a diagram. */
enum { DIRECTIONS = 1440 };

static struct {
    char *output, *scene, *incidence;
} given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &given.output,
     "Write the diagram there; else it goes to the terminal", "FILE.svg"},
    {"scene", 0, 0, G_OPTION_ARG_FILENAME, &given.scene,
     "MATERIAL is the name of one in this scene", "SCENE"},
    {"incidence", 0, 0, G_OPTION_ARG_STRING, &given.incidence,
     "Angle of the light from the normal, 0 to 89; 45", "DEGREES"},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "bsdf",
    .operands = "MATERIAL",
    .n_operands = 1,
    .summary = "Draws how a material scatters light, for red, green and blue, as SVG. "
               "MATERIAL is what would\nstand behind Material in a scene, such as\n"
               "'coateddiffuse \"rgb reflectance\" [0.3 0.05 0.4]'.",
    .entries = entries};

/* The kind with its parameters, as a scene of which it is the only material. */
static char *scene_text(const char *material)
{
    size_t kind = strcspn(material, " \t\n");
    g_autofree char *name = g_strndup(material, kind);
    const char *quote = *name == '"' ? "" : "\"";
    return g_strdup_printf("Camera \"perspective\" WorldBegin LightSource \"point\" "
                           "Material %s%s%s%s Shape \"sphere\"\n",
                           quote, name, quote, material + kind);
}

static NephScene *load_text(const char *material, GError **error)
{
    g_autofree char *path = NULL, *text = scene_text(material);
    int file = g_file_open_tmp("nephroid-XXXXXX.pbrt", &path, error);
    if (file < 0)
        return NULL;
    g_close(file, NULL);
    g_autoptr(GError) inner = NULL;
    NephScene *scene = NULL;
    if (g_file_set_contents(path, text, -1, error)) {
        scene = neph_scene_load(path, 1, NULL, NULL, &inner);
        if (inner) {
            g_auto(GStrv) parts = g_strsplit(inner->message, path, -1);
            g_autofree char *message = g_strjoinv("MATERIAL", parts);
            g_set_error_literal(error, inner->domain, inner->code, message);
        }
    }
    g_unlink(path);
    return scene;
}

static bool find_material(const NephScene *scene, const char *name, size_t *i,
                          GError **error)
{
    g_autoptr(GString) known = g_string_new(NULL);
    size_t n = neph_scene_n_materials(scene);
    for (*i = 0; *i < n; ++*i) {
        const char *found = neph_scene_material_name(scene, *i);
        if (strcmp(found, name) == 0)
            return true;
        g_string_append_printf(known, "%s%s", *i ? ", " : "", found);
    }
    g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                "no material '%s' in %s; there are %s", name, given.scene, known->str);
    return false;
}

/* The material last made is the one asked for: those before it are the scene's own. */
static NephScene *open_material(const char *name, size_t *i, GError **error)
{
    NephScene *scene = given.scene ? neph_scene_load(given.scene, 1, NULL, NULL, error)
                                   : load_text(name, error);
    if (!scene)
        return NULL;
    *i = neph_scene_n_materials(scene) - 1;
    if (given.scene && !find_material(scene, name, i, error))
        g_clear_pointer(&scene, neph_scene_free);
    return scene;
}

static int write_diagram(const NephScene *scene, const char *svg)
{
    g_autoptr(GError) error = NULL;
    if (!given.output)
        return print_result("%s", svg);
    if (!neph_file_spares(given.output, neph_scene_files(scene), &error) ||
        !neph_file_write(given.output, svg, &error))
        return report_error(error);
    return print_result("wrote %s\n", given.output);
}

int command_bsdf(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    double incidence = 45.0;
    size_t i;
    if (given.incidence &&
        !argument_between("--incidence", given.incidence, 0.0, 89.0, &incidence, &error))
        return report_error(error);
    g_autoptr(NephScene) scene = open_material(argv[1], &i, &error);
    if (!scene)
        return report_error(error);
    g_autoptr(NephBsdfPlot) plot =
        neph_bsdf_plot(scene, i, incidence, DIRECTIONS, &error);
    if (!plot)
        return report_error(error);
    g_autofree char *svg = neph_bsdf_plot_svg(plot, argv[1]);
    return write_diagram(scene, svg);
}
