/*
 * features: every parameter in the table of features does what its column says. Those
 * that are said to act change the image or what the scene asks for, those without effect
 * leave every bit as it is, and whatever is refused is refused by its name. A row without
 * a case fails, and so does a case without a row.
 */
#include "feature_cases.h"
#include "format/features/features.h"
#include "render_with.h"

/* A row of the table. */
typedef struct feature_row {
    char *directive, *kind, *how;
    char **acting, **idle;
} feature_row;

static scene_folder folder;
static GArray *rows;

static void clear_row(void *data)
{
    feature_row *row = data;
    g_free(row->directive);
    g_free(row->kind);
    g_free(row->how);
    g_strfreev(row->acting);
    g_strfreev(row->idle);
}

static char *plain(const char *cell)
{
    g_auto(GStrv) parts = g_strsplit(g_strstrip((char *)cell), "`", -1);
    return g_strjoinv("", parts);
}

static char **words_of(const char *cell)
{
    g_autofree char *text = plain(cell);
    return g_strsplit(text, " ", *text ? -1 : 0);
}

static void read_rows(void)
{
    g_autofree char *page = features_markdown();
    g_auto(GStrv) lines = g_strsplit(page, "\n", -1);
    rows = g_array_new(FALSE, FALSE, sizeof(feature_row));
    g_array_set_clear_func(rows, clear_row);
    for (char **line = lines; *line && !g_str_has_prefix(*line, "| glTF"); line++) {
        g_auto(GStrv) cells = g_strsplit(*line, "|", -1);
        if (!g_str_has_prefix(*line, "| `"))
            continue;
        feature_row row = {plain(cells[1]), plain(cells[2]), plain(cells[3]),
                           words_of(cells[4]), words_of(cells[5])};
        g_array_append_val(rows, row);
    }
    g_assert_cmpuint(rows->len, >, 50);
}

/* ---- The files and the scene that all cases stand in ---- */

static void write_image(const char *name, int bent)
{
    static const char *const channels[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(8, 8, 3, channels, NULL);
    g_autoptr(GError) error = NULL;
    for (int i = 0; i < 64; i++) {
        const float steps[3] = {(float)(i % 8) / 8, (float)(i / 8) / 8, 0.3f};
        const float normal[3] = {i % 8 < 4 ? 0.8f : 0.3f, 0.6f, 0.9f};
        for (int c = 0; c < 3; c++)
            img->pixels[3 * i + c] = bent ? normal[c] : steps[c];
    }
    char *path = g_build_filename(folder.path, name, NULL);
    g_assert_true(image_write(img, path, NULL, &error));
    g_ptr_array_add(folder.files, path);
}

#define PLY(z)                                                                           \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"      \
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"         \
    "end_header\n-1 -1 0\n1 -1 0\n0 1 " z "\n3 0 1 2\n"

static void write_files(void)
{
    folder = folder_new("");
    write_image("square.pfm", 0);
    write_image("map.png", 0);
    write_image("normals.pfm", 1);
    folder_write(&folder, "a.ply", PLY("0"), -1);
    folder_write(&folder, "b.ply", PLY("1"), -1);
}

static const char *const TEXTURES =
    "Texture 'check' 'spectrum' 'checkerboard' 'float uscale' 6 'float vscale' 6\n"
    "  'rgb tex1' [0.9 0.3 0.2] 'rgb tex2' [0.3 0.4 0.9]\n"
    "Texture 'dotted' 'float' 'checkerboard' 'float uscale' 8 'float vscale' 8\n"
    "  'float tex1' 0.9 'float tex2' 0\n"
    "Texture 'waves' 'float' 'scale' 'texture tex' 'dotted' 'float scale' 0.1\n"
    "MakeNamedMaterial 'red' 'string type' 'diffuse' 'rgb reflectance' [0.9 0.2 0.1]\n"
    "MakeNamedMaterial 'steel' 'string type' 'conductor' 'float roughness' 0.1\n";

/* The directive if it is the one, else what stands in its place. */
static void put(GString *out, const char *name, const char *directive, const char *text,
                const char *otherwise)
{
    g_string_append_printf(out, "%s\n", strcmp(name, directive) == 0 ? text : otherwise);
}

static void put_texture(GString *out, const char *directive, const char *kind,
                        const char *given)
{
    if (strcmp(directive, "Texture") != 0)
        return;
    bool is_float = strcmp(kind, "fbm") == 0 || strcmp(kind, "wrinkled") == 0 ||
                    strcmp(kind, "windy") == 0;
    g_string_append_printf(out, "Texture 't' '%s' '%s' %s\n",
                           is_float ? "float" : "spectrum", kind, given);
    g_string_append(out, is_float ? "Material 'conductor' 'texture roughness' 't'\n"
                                  : "Material 'diffuse' 'texture reflectance' 't'\n");
}

static char *text_of(const char *directive, const char *kind, const char *given)
{
    GString *out = g_string_new(NULL);
    bool option = strcmp(directive, "Option") == 0;
    bool filled = strcmp(directive, "MakeNamedMedium") == 0;
    g_autofree char *text = option
                                ? g_strdup_printf("Option %s", given)
                                : g_strdup_printf("%s '%s' %s", directive, kind, given);
    g_autofree char *turned =
        g_strdup_printf("AttributeBegin Translate 0.5 0.5 3 Rotate 180 0 1 0\n"
                        "%s\nAttributeEnd",
                        text);
    g_autofree char *shining =
        g_strdup_printf("AttributeBegin\n%s\nTranslate -0.5 0 0.5 Shape 'disk' 'float "
                        "radius' 0.4\nTranslate 1 0 0 Rotate 180 0 1 0 Shape 'disk' "
                        "'float radius' 0.4\nAttributeEnd",
                        text);
    put(out, "Option", directive, text, "");
    put(out, "Film", directive, text, "Film 'rgb' " SMALL);
    put(out, "PixelFilter", directive, text, "PixelFilter 'box'");
    put(out, "Sampler", directive, text, "");
    put(out, "Integrator", directive, text, "");
    put(out, "Accelerator", directive, text, "");
    g_string_append(out, "LookAt 0 0.3 4  0 0 0  0 1 0\n");
    if (strcmp(directive, "Camera") == 0)
        g_string_append(out, "ActiveTransform EndTime Translate 0.6 0 0\n"
                             "ActiveTransform All\n");
    put(out, "Camera", directive, text, "Camera 'perspective' 'float fov' 50");
    g_string_append_printf(out, "WorldBegin\n%s", TEXTURES);
    put(out, "LightSource", directive, turned,
        "LightSource 'infinite' 'rgb L' [0.3 0.4 0.5]\n"
        "LightSource 'point' 'point3 from' [1 2 3] 'rgb I' [9 8 7]");
    put(out, "AreaLightSource", directive, shining, "");
    g_string_append(out, "Material 'diffuse'\nAttributeBegin\nTranslate 0 0 -2\n"
                         "Shape 'disk' 'float radius' 5\nAttributeEnd\n");
    put_texture(out, directive, kind, given);
    bool plain_look = strcmp(directive, "Texture") == 0;
    put(out, "Material", directive, text,
        plain_look ? ""
        : option   ? "Texture 'soft' 'spectrum' 'imagemap' 'string filename' 'map.png' "
                     "'string filter' 'trilinear' 'float uscale' 20 'float vscale' 20\n"
                     "Material 'diffuse' 'texture reflectance' 'soft'"
                   : "Material 'conductor' 'texture reflectance' 'check' 'float "
                     "uroughness' 0.05 'float vroughness' 0.4");
    if (filled)
        g_string_append_printf(out,
                               "MakeNamedMedium 'm' 'string type' '%s' %s\n"
                               "MediumInterface 'm' '' Material 'interface'\n",
                               kind, given);
    put(out, "Shape", directive, text, "Shape 'sphere'");
    g_strdelimit(out->str, "'", '"');
    return g_string_free(out, FALSE);
}

/* ---- What becomes of it ---- */

typedef struct outcome {
    char *asked; /* settings and the film's file */
    image *img;
} outcome;

static void clear_outcome(outcome *o)
{
    g_free(o->asked);
    image_free(o->img);
}

static char *asked_of(const view *v)
{
    size_t n;
    const setting_row *table = settings_table(&n);
    GString *out = g_string_new(v->film.filename);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(&v->scene->settings, &table[i]);
        g_string_append_printf(out, " %s=%s", table[i].name, value);
    }
    return g_string_free(out, FALSE);
}

static outcome outcome_of(const char *directive, const char *kind, const char *given)
{
    g_autofree char *text = text_of(directive, kind, given);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(folder.main, text, -1, NULL));
    g_autoptr(view) v = load_view(folder.main, NULL, &error);
    if (!v)
        g_error("%s\nof\n%s", error->message, text);
    outcome out = {.asked = asked_of(v)};
    out.img = render_with(v, "integrator=path passes=1 spp=4 maxdepth=4");
    return out;
}

static bool same(const outcome *a, const outcome *b)
{
    if (strcmp(a->asked, b->asked) != 0 || a->img->n_channels != b->img->n_channels ||
        a->img->width != b->img->width || a->img->height != b->img->height)
        return false;
    size_t n = pixels_of(a->img) * (size_t)a->img->n_channels;
    return memcmp(a->img->pixels, b->img->pixels, n * sizeof(float)) == 0;
}

/* The first name in quotes after a type: 'float fov'. */
static char *name_in(const char *given)
{
    const char *last = strstr(given, "## ") ? strstr(given, "## ") + 3 : given;
    last = strstr(last, "|| ") ? strstr(last, "|| ") + 3 : last;
    const char *begin = strchr(last, ' ');
    return g_strndup(begin + 1, strcspn(begin + 1, "'"));
}

static bool case_acts(const feature_case *c)
{
    g_auto(GStrv) instead = g_strsplit(c->given, "## ", 2);
    g_auto(GStrv) besides = g_strsplit(c->given, "|| ", 2);
    g_autofree char *both =
        besides[1] ? g_strconcat(besides[0], besides[1], NULL) : g_strdup(c->given);
    outcome a, b;
    if (instead[1]) {
        a = outcome_of(c->directive, c->kind, instead[0]);
        b = outcome_of(c->directive, c->kind, instead[1]);
    } else {
        a = outcome_of(c->directive, c->kind, besides[1] ? besides[0] : "");
        b = outcome_of(c->directive, c->kind, both);
    }
    bool acts = !same(&a, &b);
    clear_outcome(&a);
    clear_outcome(&b);
    return acts;
}

/* ---- The tests ---- */

static const feature_row *row_of(const feature_case *c)
{
    for (guint i = 0; i < rows->len; i++) {
        const feature_row *row = &g_array_index(rows, feature_row, i);
        if (strcmp(row->directive, c->directive) == 0 && strcmp(row->kind, c->kind) == 0)
            return row;
    }
    g_error("no row for %s \"%s\"", c->directive, c->kind);
}

static void test_cases(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(feature_cases); i++) {
        const feature_case *c = &feature_cases[i];
        const feature_row *row = row_of(c);
        g_autofree char *name = name_in(c->given);
        bool acts = g_strv_contains((const char *const *)row->acting, name);
        bool idle = g_strv_contains((const char *const *)row->idle, name);
        if (acts == idle)
            g_error("%s \"%s\": '%s' is not in the table", c->directive, c->kind, name);
        if (case_acts(c) != acts)
            g_test_fail_printf(
                "%s \"%s\": %s: '%s' %s", c->directive, c->kind, c->given, name,
                acts ? "changes nothing" : "acts, and the table says it does not");
    }
}

static void assert_has_case(const feature_row *row, const char *parameter)
{
    for (size_t i = 0; i < G_N_ELEMENTS(feature_cases); i++) {
        const feature_case *c = &feature_cases[i];
        g_autofree char *name = name_in(c->given);
        if (strcmp(c->directive, row->directive) == 0 &&
            strcmp(c->kind, row->kind) == 0 && strcmp(name, parameter) == 0)
            return;
    }
    g_error("no case for '%s' of %s \"%s\"", parameter, row->directive, row->kind);
}

static void test_every_parameter_has_a_case(void)
{
    for (guint i = 0; i < rows->len; i++) {
        const feature_row *row = &g_array_index(rows, feature_row, i);
        for (char **name = row->acting; *name; name++)
            assert_has_case(row, *name);
        for (char **name = row->idle; *name; name++)
            assert_has_case(row, *name);
    }
}

/* The scene is refused, at a place in the file, and the message has the word. */
static void assert_refused(const char *text, const char *word)
{
    g_autofree char *quoted = g_strdelimit(g_strdup(text), "'", '"');
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(folder.main, quoted, -1, NULL));
    view *v = load_view(folder.main, NULL, &error);
    if (v)
        g_error("accepted, with '%s':\n%s", word, quoted);
    if (!strstr(error->message, word) || !strstr(error->message, "scene.pbrt:"))
        g_error("no '%s' in '%s'", word, error->message);
}

/* A directive as it can stand, with a parameter that no one knows. */
static char *with_nonsense(const feature_row *row)
{
    g_autofree char *given = NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(feature_cases) && !given; i++) {
        const feature_case *c = &feature_cases[i];
        if (strcmp(c->directive, row->directive) != 0 || strcmp(c->kind, row->kind) != 0)
            continue;
        g_auto(GStrv) instead = g_strsplit(c->given, "## ", 2);
        g_auto(GStrv) parts = g_strsplit(instead[0], "|| ", 2);
        given = g_strjoinv("", parts);
    }
    g_autofree char *text = g_strconcat(given ? given : "", " 'float nonsense' 1", NULL);
    return text_of(row->directive, row->kind, text);
}

static void test_refused_by_name(void)
{
    for (guint i = 0; i < rows->len; i++) {
        const feature_row *row = &g_array_index(rows, feature_row, i);
        g_autofree char *unknown = NULL, *option = NULL;
        if (strcmp(row->directive, "Option") == 0) {
            option = g_strdup_printf("'bool %s' true", row->kind);
            unknown = text_of("Option", "",
                              strcmp(row->how, "refused") == 0 ? option
                                                               : "'bool nonsense' false");
        } else {
            unknown = with_nonsense(row);
        }
        bool refused = strcmp(row->how, "refused") == 0;
        assert_refused(unknown, refused ? row->kind : "nonsense");
    }
}

/* Not everything that a texture could stand for may be one, in pbrt too. */
static void test_no_textures(void)
{
    static const feature_case cases[] = {
        {"Material", "dielectric", "'texture eta' 'dotted'"},
        {"Material", "thindielectric", "'texture eta' 'dotted'"},
        {"Material", "coateddiffuse", "'texture eta' 'dotted'"},
        {"Material", "coatedconductor", "'texture interface.eta' 'dotted'"},
        {"Material", "coateddiffuse", "'texture maxdepth' 'dotted'"},
        {"LightSource", "point", "'texture I' 'check'"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text =
            text_of(cases[i].directive, cases[i].kind, cases[i].given);
        g_autofree char *name = name_in(cases[i].given);
        assert_refused(text, name);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    read_rows();
    write_files();
    g_test_add_func("/features/every-parameter", test_every_parameter_has_a_case);
    g_test_add_func("/features/cases", test_cases);
    g_test_add_func("/features/refused", test_refused_by_name);
    g_test_add_func("/features/no-textures", test_no_textures);
    int failed = g_test_run();
    folder_remove(&folder);
    g_array_unref(rows);
    return failed;
}
