/*
 * The list of pbrt-v4's kinds is pbrt's; whether one is rendered is asked of the tables
 * that make them, so that a new row there shows up here by itself. Parameters are the
 * lists that unknown ones are refused by.
 */
#include "format/features/features.h"

#include "base/intern.h"
#include "format/gltf/gltf_extensions.h"
#include "format/pbrt/pbrt_parser.h"
#include "scene/scene.h"
#include "scene/scene_film.h"

#include <string.h>

static directive_kind texture_at(size_t i)
{
    const texture_kind *kind = texture_kind_at(i);
    return kind ? (directive_kind){kind->name, kind->parameters, NULL, NULL, NULL}
                : (directive_kind){0};
}

static directive_kind material_at(size_t i)
{
    const material_kind *kind = material_kind_at(i);
    return kind ? (directive_kind){kind->name, kind->parameters, NULL, NULL, NULL}
                : (directive_kind){0};
}

static directive_kind medium_at(size_t i)
{
    return (directive_kind){medium_kind_name(i), medium_kind_parameters(i), NULL, NULL,
                            NULL};
}

static directive_kind light_at(size_t i)
{
    const light_kind *kind = light_kind_at(i);
    return kind ? (directive_kind){kind->name, kind->parameters, NULL, NULL, NULL}
                : (directive_kind){0};
}

static directive_kind shape_at(size_t i)
{
    return (directive_kind){shape_kind_name(i), shape_kind_parameters(i), NULL, NULL,
                            NULL};
}

/* Behind the scene's own kinds, what the reader makes one of them of. */
static directive_kind camera_kind_of(size_t i)
{
    static const directive_kind lens = {
        "realistic", "", "", "approximated",
        "becomes `perspective`, by `lensfile`, `aperturediameter` and `focusdistance`"};
    if (camera_kind_at(i))
        return (directive_kind){camera_kind_at(i), camera_kind_parameters(i), NULL, NULL,
                                NULL};
    return i == 0 || camera_kind_at(i - 1) ? lens : (directive_kind){0};
}

static directive_kind film_at(size_t i)
{
    directive_kind kind = {0};
    kind.name = film_kind_at(i, &kind.parameters, &kind.idle);
    return kind;
}

static directive_kind filter_at(size_t i)
{
    const char *name = filter_kind_name(i);
    if (!name)
        return (directive_kind){0};
    g_autofree char *parameters = filter_kind_parameters(i);
    return (directive_kind){name, intern(parameters), NULL, NULL, NULL};
}

/* pbrt-v4's kinds of a directive, and the table that ours are in. */
typedef struct feature_list {
    const char *directive, *pbrt_kinds;
    kind_at at;
    const char *common; /* parameters that all have */
    bool own_too;       /* then those of the table that pbrt has not */
} feature_list;

static const feature_list lists[] = {
    {"Option",
     "seed displacementedgescale gpu pixelstats rendercoordsys wavefront "
     "disablepixeljitter disabletexturefiltering disablewavelengthjitter forcediffuse "
     "msereferenceimage msereferenceout",
     pbrt_option_kind, NULL, false},
    {"Camera", "perspective orthographic spherical realistic", camera_kind_of, NULL,
     false},
    {"Film", "rgb gbuffer spectral", film_at, NULL, false},
    {"PixelFilter", "box gaussian mitchell sinc triangle", filter_at, NULL, false},
    {"Sampler", "halton independent paddedsobol pmj02bn sobol stratified zsobol",
     pbrt_sampler_kind, NULL, false},
    {"Integrator",
     "ambientocclusion bdpt function lightpath mlt path randomwalk simplepath "
     "simplevolpath sppm volpath",
     pbrt_integrator_kind, NULL, true},
    {"Accelerator", "bvh kdtree", pbrt_accelerator_kind, NULL, false},
    {"Shape", "bilinearmesh curve cylinder disk loopsubdiv plymesh sphere trianglemesh",
     shape_at, "alpha camera_visible", false},
    {"LightSource", "distant goniometric infinite point projection spot", light_at,
     LIGHT_PARAMETERS, false},
    {"AreaLightSource", "diffuse", light_at, LIGHT_PARAMETERS, false},
    {"Material",
     "coatedconductor coateddiffuse conductor dielectric diffuse diffusetransmission "
     "hair "
     "interface measured mix subsurface thindielectric",
     material_at, MATERIAL_PARAMETERS, false},
    {"MakeNamedMedium", "homogeneous cloud nanovdb rgbgrid uniformgrid", medium_at, NULL,
     false},
    {"Texture",
     "bilerp checkerboard constant directionmix dots fbm imagemap marble mix ptex scale "
     "windy wrinkled",
     texture_at, NULL, false},
};

/* What is not quite as pbrt has it, or is made elsewhere than in the tables. */
typedef struct feature_note {
    const char *directive, *kind, *how, *note;
    const char *idle;       /* parameters that change nothing; NULL: none */
    const char *parameters; /* of a kind that is in no table */
} feature_note;

static const feature_note notes[] = {
    {"Shape", "plymesh", "approximated",
     "a triangle mesh from a file; `displacement` moves nothing, with a warning",
     "displacement displacement.edgelength",
     "filename alpha camera_visible displacement displacement.edgelength"},
    {"Shape", "trianglemesh", "rendered", "`faceIndices` are for `ptex`", "faceIndices",
     NULL},
    {"Shape", "bilinearmesh", "rendered",
     "`faceIndices` are for `ptex`; where the light is, is found without "
     "`emissionfilename`",
     "faceIndices emissionfilename", NULL},
    {"Shape", "curve", "approximated",
     "a `cylinder` is a tube, which pbrt draws as a flat ribbon with a tube's normals",
     "splitdepth", NULL},
    {"Shape", "loopsubdiv", "approximated",
     "boundaries are put on their exact limit, which pbrt's are near",
     "faceIndices scheme", NULL},
    {"Camera", "orthographic", "approximated",
     "every place on the screen has a lens of its own, where pbrt's rays leave one lens",
     NULL, NULL},
    {"Film", "rgb", "rendered", "all sensors see as `cie1931`", NULL, NULL},
    {"Film", "spectral", "approximated", "becomes `rgb`", NULL, NULL},
    {"Film", "gbuffer", "rendered",
     "all sensors see as `cie1931`; `dzdx` and `dzdy` are for whole pixels, where pbrt's "
     "shrink with the number of "
     "samples; the variances are of the film's colours",
     NULL, NULL},
    {"Material", "interface", "rendered", "lets light pass", NULL, NULL},
    {"Material", "coateddiffuse", "rendered",
     "the mean of pbrt's random walk; in closed form, where `nsamples` changes nothing, "
     "if `albedo` is 0, `thickness` a number and the coat not brushed",
     NULL, NULL},
    {"Material", "coatedconductor", "rendered",
     "pbrt's random walk; the wavelengths share the mean `interface.eta`", NULL, NULL},
    {"MakeNamedMedium", "homogeneous", "rendered",
     "`Le` must be 0; `vcm` and the kinds of it refuse media", "Le Lescale", NULL},
    {"Texture", "imagemap", "approximated", "`EWA` filters as `trilinear` does",
     "maxanisotropy", NULL},
    {"LightSource", "infinite", "approximated",
     "pictures are mixed bilinearly; `L` behind a `portal` is a colour", NULL, NULL},
};

static const feature_note *find_note(const char *directive, const char *kind)
{
    for (size_t i = 0; i < G_N_ELEMENTS(notes); i++)
        if (strcmp(notes[i].directive, directive) == 0 &&
            strcmp(notes[i].kind, kind) == 0)
            return &notes[i];
    return NULL;
}

/* Whether the word is in a list with blanks between, which may be NULL. */
static bool lists_word(const char *list, const char *word)
{
    g_auto(GStrv) words = g_strsplit(list ? list : "", " ", -1);
    return g_strv_contains((const char *const *)words, word);
}

/* Words of a list that are not there yet are added, each as code, to those that act or
 * to those that are idle. */
typedef struct word_columns {
    GString *acting, *idle;
    GHashTable *there;
    const char *known_idle;
} word_columns;

static void append_words(word_columns *to, const char *list, bool idle)
{
    g_auto(GStrv) words = g_strsplit(list ? list : "", " ", -1);
    for (char **word = words; *word; word++) {
        if (!**word || !g_hash_table_add(to->there, g_strdup(*word)))
            continue;
        GString *out = idle || lists_word(to->known_idle, *word) ? to->idle : to->acting;
        g_string_append_printf(out, "%s`%s`", out->len ? " " : "", *word);
    }
}

/* One kind may be made in several ways, with parameters of their own each.
 * @return the last that was found, its name NULL if none was */
static directive_kind find_feature(const feature_list *list, const char *name,
                                   word_columns *to)
{
    directive_kind found = {0}, kind;
    for (size_t i = 0; (kind = list->at(i)).name; i++)
        if (strcmp(kind.name, name) == 0) {
            found = kind;
            append_words(to, kind.parameters, false);
            append_words(to, kind.idle, true);
        }
    if (found.name)
        append_words(to, list->common, false);
    return found;
}

static const char *status_of(const directive_kind *made, const feature_note *note)
{
    if (note)
        return note->how;
    if (!made->name)
        return "refused";
    return made->how ? made->how : "rendered";
}

static void append_row(GString *out, const feature_list *list, const char *name)
{
    g_autoptr(GString) acting = g_string_new(NULL), idle = g_string_new(NULL);
    g_autoptr(GHashTable) there =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    const feature_note *note = find_note(list->directive, name);
    word_columns words = {acting, idle, there, note ? note->idle : NULL};
    directive_kind made = find_feature(list, name, &words);
    append_words(&words, note ? note->parameters : NULL, false);
    const char *text = note ? note->note : made.note;
    g_string_append_printf(out, "| `%s` | `%s` | %s | %s | %s | %s |\n", list->directive,
                           name, status_of(&made, note), acting->str, idle->str,
                           text ? text : "");
}

static void append_list(GString *out, const feature_list *list)
{
    directive_kind kind;
    g_auto(GStrv) theirs = g_strsplit(list->pbrt_kinds, " ", -1);
    for (char **name = theirs; *name; name++)
        append_row(out, list, *name);
    for (size_t i = 0; list->own_too && (kind = list->at(i)).name; i++)
        if (!g_strv_contains((const char *const *)theirs, kind.name))
            append_row(out, list, kind.name);
}

char *features_markdown(void)
{
    GString *out = g_string_new("| directive | kind | | parameters | accepted without "
                                "effect | |\n"
                                "|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < G_N_ELEMENTS(lists); i++)
        append_list(out, &lists[i]);
    gltf_append_features(out);
    return g_string_free(out, FALSE);
}
