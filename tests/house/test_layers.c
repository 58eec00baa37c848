/*
 * The house's own rules, read off the sources: no include goes upward (tools/layers.txt
 * is the law), no file and no function is long. Each check is tried on a small tree with
 * planted faults, so that a check that sees nothing fails.
 */
#include <glib.h>
#include <glib/gstdio.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_FILE_LINES = 700, MAX_FUNCTION_LINES = 100 };

/** @brief src/, or the folder of a program beside it. */
typedef struct tree {
    char *name;
    GPtrArray *layers; /* of char*: its folders bottom up; none: it keeps to no order */
} tree;

typedef struct house {
    const char *root;
    GPtrArray *trees;  /* of tree*, src/ first */
    GPtrArray *faults; /* of char*, what is wrong */
} house;

static void add_fault(house *h, const char *format, ...) G_GNUC_PRINTF(2, 3);

static void add_fault(house *h, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_ptr_array_add(h->faults, g_strdup_vprintf(format, arguments));
    va_end(arguments);
}

static void add_tree(house *h, const char *name)
{
    tree *t = g_new(tree, 1);
    *t = (tree){g_strdup(name), g_ptr_array_new_with_free_func(g_free)};
    g_ptr_array_add(h->trees, t);
}

static void free_tree(void *data)
{
    tree *t = data;
    g_free(t->name);
    g_ptr_array_unref(t->layers);
    g_free(t);
}

static house house_open(const char *root)
{
    house h = {root, g_ptr_array_new_with_free_func(free_tree),
               g_ptr_array_new_with_free_func(g_free)};
    g_autofree char *path = g_build_filename(SOURCE_ROOT, "tools", "layers.txt", NULL);
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    add_tree(&h, "src");
    for (size_t i = 0; lines[i]; i++) {
        tree *last = h.trees->pdata[h.trees->len - 1];
        if (g_str_has_prefix(lines[i], "layer "))
            g_ptr_array_add(last->layers, g_strdup(lines[i] + strlen("layer ")));
        if (g_str_has_prefix(lines[i], "program "))
            add_tree(&h, lines[i] + strlen("program "));
    }
    const tree *src = h.trees->pdata[0];
    g_assert_cmpuint(src->layers->len, >, 1);
    g_assert_cmpuint(h.trees->len, >, 1);
    return h;
}

static void house_close(house *h)
{
    g_ptr_array_unref(h->trees);
    g_ptr_array_unref(h->faults);
}

/** @brief Prints the faults; the number of them. */
static unsigned count_faults(const house *h)
{
    for (unsigned i = 0; i < h->faults->len; i++)
        g_test_message("%s", (const char *)h->faults->pdata[i]);
    return h->faults->len;
}

/** @brief Calls visit for every .c, .cpp and .h below the folder, which need not exist.
 */
static void each_source(house *h, const char *folder,
                        void (*visit)(house *h, const char *path, const char *text))
{
    g_autofree char *full = g_build_filename(h->root, folder, NULL);
    g_autoptr(GDir) dir = g_dir_open(full, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        g_autofree char *file = g_build_filename(h->root, path, NULL);
        g_autofree char *text = NULL;
        if (g_file_test(file, G_FILE_TEST_IS_DIR))
            each_source(h, path, visit);
        else if ((g_str_has_suffix(name, ".c") || g_str_has_suffix(name, ".cpp") ||
                  g_str_has_suffix(name, ".h")) &&
                 g_file_get_contents(file, &text, NULL, NULL))
            visit(h, path, text);
    }
}

/* ---- Includes ---- */

static const tree *tree_of(const house *h, const char *path)
{
    g_auto(GStrv) parts = g_strsplit(path, "/", 2);
    for (unsigned i = 0; i < h->trees->len; i++) {
        const tree *t = h->trees->pdata[i];
        if (g_str_equal(parts[0], t->name))
            return t;
    }
    g_assert_not_reached();
}

/** @brief The layer (from 0) of a name in the tree, or -1. */
static int layer_of(const tree *t, const char *name)
{
    g_auto(GStrv) parts = g_strsplit(name, "/", 2);
    for (unsigned i = 0; parts[0] && parts[1] && i < t->layers->len; i++)
        if (g_str_equal(parts[0], t->layers->pdata[i]))
            return (int)i;
    return -1;
}

/** @brief The name in an #include line, owned by the caller, or NULL. */
static char *included_name(const char *line, bool *is_system)
{
    static GRegex *pattern;
    if (!pattern)
        pattern = g_regex_new("^\\s*#\\s*include\\s*([<\"])([^>\"]*)", 0, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    if (!g_regex_match(pattern, line, 0, &match))
        return NULL;
    g_autofree char *opening = g_match_info_fetch(match, 1);
    *is_system = opening[0] == '<';
    return g_match_info_fetch(match, 2);
}

static void check_src_include(house *h, const char *path, const char *name,
                              bool is_system)
{
    const tree *src = h->trees->pdata[0];
    int own = layer_of(src, path + strlen("src/"));
    int other = g_str_has_prefix(name, "nephroid/") ? (int)src->layers->len - 1
                                                    : layer_of(src, name);
    if (own < 0)
        add_fault(h, "%s is in no layer of tools/layers.txt", path);
    else if (other > own)
        add_fault(h, "%s includes %s, which is above it", path, name);
    else if (other < 0 && !is_system && strchr(name, '/'))
        add_fault(h, "%s includes %s: that folder is in no layer", path, name);
}

/** @brief Where a program has layers, its main file lies beside them and sees all. */
static void check_program_include(house *h, const char *path, const char *name,
                                  bool is_system)
{
    const tree *t = tree_of(h, path);
    const char *inside = path + strlen(t->name) + 1;
    int own = layer_of(t, inside), other = layer_of(t, name);
    bool is_ordered = t->layers->len > 0;
    bool is_public = g_str_has_prefix(name, "nephroid/");
    if (!is_public && layer_of(h->trees->pdata[0], name) >= 0)
        add_fault(h, "%s includes %s: a program sees only the installed header", path,
                  name);
    else if (is_ordered && own < 0 && strchr(inside, '/'))
        add_fault(h, "%s is in no layer of tools/layers.txt", path);
    else if (own >= 0 && other > own)
        add_fault(h, "%s includes %s, which is above it", path, name);
    else if (is_ordered && other < 0 && !is_system && !is_public)
        add_fault(h, "%s includes %s, which names no layer", path, name);
}

static void check_include(house *h, const char *path, const char *name, bool is_system)
{
    if (strstr(name, "../"))
        add_fault(h, "%s includes %s: a way around the layers", path, name);
    else if (g_str_has_prefix(path, "src/"))
        check_src_include(h, path, name, is_system);
    else
        check_program_include(h, path, name, is_system);
}

static void visit_includes(house *h, const char *path, const char *text)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    for (size_t i = 0; lines[i]; i++) {
        bool is_system = false;
        g_autofree char *name = included_name(lines[i], &is_system);
        if (name)
            check_include(h, path, name, is_system);
    }
}

static void check_layers(house *h)
{
    for (unsigned i = 0; i < h->trees->len; i++) {
        const tree *t = h->trees->pdata[i];
        each_source(h, t->name, visit_includes);
    }
}

/* ---- Lengths ---- */

/** @brief In our layout a function's body opens and closes with a brace in column 1. */
static void visit_lengths(house *h, const char *path, const char *text)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    size_t n = g_strv_length(lines) - 1, open = 0;
    if (n > MAX_FILE_LINES)
        add_fault(h, "%s has %zu lines", path, n);
    for (size_t i = 0; i < n; i++) {
        if (g_str_equal(lines[i], "{"))
            open = i + 1;
        if (lines[i][0] == '}' && open && i - open > MAX_FUNCTION_LINES)
            add_fault(h, "%s:%zu: a function of %zu lines", path, open, i - open);
        if (lines[i][0] == '}')
            open = 0;
    }
}

static void check_lengths(house *h)
{
    const char *folders[] = {"src", "include", "cli", "gui", "mpi", "tests", "bench"};
    for (size_t i = 0; i < G_N_ELEMENTS(folders); i++)
        each_source(h, folders[i], visit_lengths);
}

/* ---- Tests ---- */

static void test_no_include_goes_upward(void)
{
    house h = house_open(SOURCE_ROOT);
    check_layers(&h);
    g_assert_cmpuint(count_faults(&h), ==, 0);
    house_close(&h);
}

static void test_nothing_is_long(void)
{
    house h = house_open(SOURCE_ROOT);
    check_lengths(&h);
    g_assert_cmpuint(count_faults(&h), ==, 0);
    house_close(&h);
}

/** @brief A tree with one file, thrown away by drop_tree. */
static char *plant(const char *path, const char *text)
{
    char *root = g_dir_make_tmp("nephroid-layers-XXXXXX", NULL);
    g_autofree char *file = g_build_filename(root, path, NULL);
    g_autofree char *folder = g_path_get_dirname(file);
    g_assert_cmpint(g_mkdir_with_parents(folder, 0700), ==, 0);
    g_assert_true(g_file_set_contents(file, text, -1, NULL));
    return root;
}

static void drop_tree(const char *root, const char *path)
{
    g_autofree char *at = g_build_filename(root, path, NULL);
    while (strlen(at) >= strlen(root)) {
        g_remove(at);
        char *parent = g_path_get_dirname(at);
        g_free(at);
        at = parent;
    }
}

static unsigned faults_of(const char *path, const char *text, void (*check)(house *h))
{
    g_autofree char *root = plant(path, text);
    house h = house_open(root);
    check(&h);
    unsigned n = h.faults->len;
    house_close(&h);
    drop_tree(root, path);
    return n;
}

static void test_planted_includes_are_seen(void)
{
    const struct {
        const char *path, *text;
        unsigned n_faults;
    } cases[] = {
        {"src/photon/a.c", "#include \"photon/b.h\"\n#include \"base/error.h\"\n", 0},
        {"src/photon/a.c", "#include <math.h>\n#include <embree3/rtcore.h>\n", 0},
        {"src/photon/a.c", "#include \"render/film.h\"\n", 1},
        {"src/photon/a.c", "  #  include <render/film.h>\n", 1},
        {"src/photon/deep/a.h", "#include \"transport/path/path.h\"\n", 1},
        {"src/photon/a.c", "#include \"../render/film.h\"\n", 1},
        {"src/render/a.c", "#include \"nephroid/nephroid.h\"\n", 1},
        {"src/api/a.c", "#include <nephroid/nephroid.h>\n#include \"base/log.h\"\n", 0},
        {"src/cellar/a.c", "#include \"base/log.h\"\n", 1},
        {"src/base/a.c", "#include \"cellar/wine.h\"\n", 1},
        {"cli/a.c", "#include <nephroid/nephroid.h>\n#include \"args.h\"\n", 0},
        {"cli/a.c", "#include \"base/error.h\"\n", 1},
        {"cli/a.c", "#include \"../src/base/error.h\"\n", 1},
        {"gui/a.c", "#include \"window/a.h\"\n#include <gtk/gtk.h>\n", 0},
        {"gui/panels/a.c", "#include \"panels/a.h\"\n#include \"session/b.h\"\n", 0},
        {"gui/panels/a.c", "#include <nephroid/nephroid.h>\n#include <math.h>\n", 0},
        {"gui/panels/a.c", "#include \"window/window.h\"\n", 1},
        {"gui/panels/deep/a.c", "#include \"window/window.h\"\n", 1},
        {"gui/panels/a.c", "#include \"app.h\"\n", 1},
        {"gui/panels/a.c", "#include \"photon/photon.h\"\n", 1},
        {"gui/cellar/a.c", "#include <math.h>\n", 1},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        g_assert_cmpuint(faults_of(cases[i].path, cases[i].text, check_layers), ==,
                         cases[i].n_faults);
}

static void test_planted_lengths_are_seen(void)
{
    g_autoptr(GString) text = g_string_new("int f(void)\n{\n");
    for (int i = 0; i < MAX_FUNCTION_LINES; i++)
        g_string_append(text, "    ;\n");
    g_string_append(text, "}\n");
    g_assert_cmpuint(faults_of("src/base/a.c", text->str, check_lengths), ==, 0);
    g_string_insert(text, 15, "    ;\n");
    g_assert_cmpuint(faults_of("src/base/a.c", text->str, check_lengths), ==, 1);
    g_string_truncate(text, 0);
    for (int i = 0; i < MAX_FILE_LINES; i++)
        g_string_append(text, "\n");
    g_assert_cmpuint(faults_of("tests/a.h", text->str, check_lengths), ==, 0);
    g_string_append(text, "\n");
    g_assert_cmpuint(faults_of("tests/a.h", text->str, check_lengths), ==, 1);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/layers/includes", test_no_include_goes_upward);
    g_test_add_func("/layers/includes/planted", test_planted_includes_are_seen);
    g_test_add_func("/layers/lengths", test_nothing_is_long);
    g_test_add_func("/layers/lengths/planted", test_planted_lengths_are_seen);
    return g_test_run();
}
