/*
 * The list of pbrt-v4's kinds is pbrt's; whether one is rendered is asked of the tables
 * that make them, so that a new row there shows up here by itself. Parameters are the
 * lists that unknown ones are refused by.
 */
#include "format/features.h"

#include "format/gltf_extensions.h"
#include "scene/scene.h"

#include <string.h>

/* The name and the parameters of kind number i; NULL behind the last. */
typedef const char *(*kind_at)(size_t i, const char **parameters);

static const char *texture_at(size_t i, const char **parameters)
{
    const texture_kind *kind = texture_kind_at(i);
    *parameters = kind ? kind->parameters : NULL;
    return kind ? kind->name : NULL;
}

static const char *material_at(size_t i, const char **parameters)
{
    const material_kind *kind = material_kind_at(i);
    *parameters = kind ? kind->parameters : NULL;
    return kind ? kind->name : NULL;
}

static const char *light_at(size_t i, const char **parameters)
{
    const light_kind *kind = light_kind_at(i);
    *parameters = kind ? kind->parameters : NULL;
    return kind ? kind->name : NULL;
}

static const char *shape_at(size_t i, const char **parameters)
{
    *parameters = shape_kind_parameters(i);
    return shape_kind_name(i);
}

static const char *camera_kind_of(size_t i, const char **parameters)
{
    *parameters = camera_kind_parameters(i);
    return camera_kind_at(i);
}

static const char *filter_at(size_t i, const char **parameters)
{
    *parameters = NULL;
    return filter_kind_name(i);
}

/* pbrt-v4's kinds of a directive, and the table that ours are in. */
typedef struct feature_list {
    const char *directive, *pbrt_kinds;
    kind_at at;
    const char *common; /* parameters that all have */
} feature_list;

static const feature_list lists[] = {
    {"Camera", "perspective orthographic spherical realistic", camera_kind_of, NULL},
    {"PixelFilter", "box gaussian mitchell sinc triangle", filter_at, NULL},
    {"Shape", "bilinearmesh curve cylinder disk loopsubdiv plymesh sphere trianglemesh",
     shape_at, "alpha camera_visible"},
    {"LightSource", "distant goniometric infinite point projection spot", light_at,
     LIGHT_PARAMETERS},
    {"AreaLightSource", "diffuse", light_at, LIGHT_PARAMETERS},
    {"Material",
     "coatedconductor coateddiffuse conductor dielectric diffuse diffusetransmission "
     "hair "
     "interface measured mix subsurface thindielectric",
     material_at, MATERIAL_PARAMETERS},
    {"Texture",
     "bilerp checkerboard constant directionmix dots fbm imagemap marble mix ptex scale "
     "windy wrinkled",
     texture_at, NULL},
};

/* What is not quite as pbrt has it, or is made elsewhere than in the tables. */
typedef struct feature_note {
    const char *directive, *kind, *how, *note;
} feature_note;

static const feature_note notes[] = {
    {"Shape", "plymesh", "rendered", "a triangle mesh from a file"},
    {"Shape", "curve", "approximated",
     "a `cylinder` is a tube, which pbrt draws as a flat ribbon with a tube's normals"},
    {"Shape", "loopsubdiv", "approximated",
     "boundaries are put on their exact limit, which pbrt's are near"},
    {"Camera", "orthographic", "approximated",
     "every place on the screen has a lens of its own, where pbrt's rays leave one lens"},
    {"Material", "interface", "rendered", "lets light pass"},
    {"Material", "coateddiffuse", "rendered",
     "the mean of pbrt's random walk; in closed form, where `nsamples` changes nothing, "
     "if `albedo` is 0 and `thickness` a number"},
    {"Material", "coatedconductor", "rendered",
     "pbrt's random walk; the lanes share the mean `interface.eta`"},
    {"Texture", "imagemap", "approximated", "`EWA` filters as `trilinear` does"},
    {"LightSource", "infinite", "approximated",
     "pictures are mixed bilinearly; `portal` needs a `filename`"},
};

static const feature_note *find_note(const char *directive, const char *kind)
{
    for (size_t i = 0; i < G_N_ELEMENTS(notes); i++)
        if (strcmp(notes[i].directive, directive) == 0 &&
            strcmp(notes[i].kind, kind) == 0)
            return &notes[i];
    return NULL;
}

/* Adds the words of a list that are not there yet, each as code. */
static void append_words(GString *out, GHashTable *there, const char *list)
{
    g_auto(GStrv) words = g_strsplit(list ? list : "", " ", -1);
    for (char **word = words; *word; word++)
        if (**word && g_hash_table_add(there, g_strdup(*word)))
            g_string_append_printf(out, "%s`%s`", out->len ? " " : "", *word);
}

/* One kind may be made in several ways, with parameters of their own each. */
static bool find_kind(const feature_list *list, const char *kind, GString *parameters)
{
    g_autoptr(GHashTable) there =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    const char *name, *own;
    bool found = false;
    for (size_t i = 0; (name = list->at(i, &own)); i++)
        if (strcmp(name, kind) == 0) {
            found = true;
            append_words(parameters, there, own);
        }
    if (found)
        append_words(parameters, there, list->common);
    return found;
}

static void append_row(GString *out, const feature_list *list, const char *kind)
{
    g_autoptr(GString) parameters = g_string_new(NULL);
    const feature_note *note = find_note(list->directive, kind);
    bool made =
        find_kind(list, kind, parameters) || (note && strcmp(note->how, "rendered") == 0);
    const char *how = !made ? "refused" : note ? note->how : "rendered";
    g_string_append_printf(out, "| `%s` | `%s` | %s | %s | %s |\n", list->directive, kind,
                           how, parameters->str, made && note ? note->note : "");
}

char *features_markdown(void)
{
    GString *out = g_string_new("| directive | kind | | parameters | |\n"
                                "|---|---|---|---|---|\n");
    for (size_t i = 0; i < G_N_ELEMENTS(lists); i++) {
        g_auto(GStrv) kinds = g_strsplit(lists[i].pbrt_kinds, " ", -1);
        for (char **kind = kinds; *kind; kind++)
            append_row(out, &lists[i], *kind);
    }
    gltf_append_features(out);
    return g_string_free(out, FALSE);
}
