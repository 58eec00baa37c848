/*
 * memory: what is reserved stays below a limit, which comes from the machine, and
 * whatever asks for much (files of a few bytes that claim many pixels or copies, films)
 * is refused before it is allocated, by an error that says how much was wanted and by
 * what.
 */
#include "base/machine.h"
#include "base/memory.h"
#include "gltf_text.h"
#include "render_with.h"
#include "sanitizers.h"

#include <sys/resource.h>
#include <unistd.h>

#define KIB ((size_t)1 << 10)
#define MIB ((size_t)1 << 20)

static void assert_refused(GError *error, const char *what)
{
    g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
    g_test_message("%s", error->message);
    g_assert_nonnull(strstr(error->message, "out of memory: "));
    g_assert_nonnull(strstr(error->message, what));
    g_error_free(error);
}

/* Whether so much can be had, without taking it. */
static bool is_left(size_t bytes)
{
    bool fits = memory_reserve(bytes, "a trial", NULL);
    if (fits)
        memory_release(bytes);
    return fits;
}

static void test_limit(void)
{
    GError *error = NULL;
    memory_set_limit(MIB);
    void *half = big_alloc(512, KIB, "the first half", NULL);
    g_assert_nonnull(half);
    g_assert_null(big_alloc(600, KIB, "the other half", &error));
    assert_refused(error, "600.1 KiB for the other half, where 511.9 KiB are left of the "
                          "limit of 1.0 MiB");
    error = NULL;
    void *grown = big_grow(half, 512 * KIB, 400 * KIB, 1, "less", NULL);
    g_assert_nonnull(grown);
    g_assert_true(memory_reserve(600 * KIB, "a library", NULL));
    g_assert_false(memory_reserve(30 * KIB, "another", &error));
    assert_refused(error, "another");
    memory_release(600 * KIB);
    big_free(grown);
    g_assert_true(is_left(MIB));
    g_assert_false(is_left(MIB + 1));
    memory_set_limit(0);
}

/* Zero as far as asked, of small arrays and of large ones, and no further. */
static void test_zero(void)
{
    static const size_t sizes[] = {100, 5000, 131072, 400000, 9000000};
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        size_t n = sizes[i], zeroed = n - 37, left = memory_left();
        unsigned char *array = big_alloc(n, 1, "test", NULL);
        memset(array, 7, n);
        big_zero(array, zeroed);
        for (size_t k = 0; k < n; k++)
            g_assert_cmpuint(array[k], ==, k < zeroed ? 0 : 7);
        big_free(array);
        g_assert_cmpuint(memory_left(), ==, left);
    }
}

static void *claim(void *data)
{
    (void)data;
    guintptr n = 0;
    for (int i = 0; i < 10000; i++)
        n += memory_reserve(KIB, "threads", NULL);
    return (void *)n;
}

/* Together they get what there is, and no more. */
static void test_threads(void)
{
    GThread *threads[4];
    guintptr got = 0;
    memory_set_limit(MIB);
    for (int i = 0; i < 4; i++)
        threads[i] = g_thread_new(NULL, claim, NULL);
    for (int i = 0; i < 4; i++)
        got += (guintptr)g_thread_join(threads[i]);
    g_assert_cmpuint(got, ==, MIB / KIB);
    memory_release(MIB);
    memory_set_limit(0);
}

/* ---- The machine ---- */

static void put(const char *root, const char *folder, const char *file, const char *text)
{
    g_autofree char *where = g_build_filename(root, folder, NULL);
    g_autofree char *path = g_build_filename(where, file, NULL);
    g_mkdir_with_parents(where, 0700);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
}

static void test_cgroups(void)
{
    g_autofree char *root = g_dir_make_tmp("nephroid-cgroup-XXXXXX", NULL);
    put(root, "a", "memory.max", "4000000\n");
    put(root, "a/b", "memory.max", "max\n");
    put(root, "a/small", "memory.max", "3000000\n");
    put(root, "a/large", "memory.max", "9000000\n");
    put(root, "memory", "memory.limit_in_bytes", "9223372036854771712\n");
    put(root, "memory/c", "memory.limit_in_bytes", "2000000\n");
    put(root, "cpu/c", "memory.limit_in_bytes", "1\n");
    const struct {
        const char *groups;
        size_t expected;
    } cases[] = {
        {"0::/a/b\n", 4000000},
        {"0::/a/small\n", 3000000},
        {"0::/a/large\n", 4000000}, /* what it lies in has less */
        {"0::/\n", SIZE_MAX},
        {"0::/not/mounted/here\n", SIZE_MAX},
        {"4:cpu:/c\n3:memory:/c\n0::/a/b\n", 2000000},
        {"3:hugetlb,memory:/c\n", 2000000},
        {"3:memory:/\n", 9223372036854771712u},
        {"4:cpu:/c\n", SIZE_MAX},
        {"", SIZE_MAX},
        {"nonsense\n", SIZE_MAX},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        g_assert_cmpuint(machine_cgroup_memory(root, cases[i].groups), ==,
                         cases[i].expected);
    g_autofree char *remove = g_strdup_printf("rm -r '%s'", root);
    g_assert_true(g_spawn_command_line_sync(remove, NULL, NULL, NULL, NULL));
}

/* Of this process: with a sanitizer's shadow it is terabytes. */
static size_t address_space(void)
{
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents("/proc/self/statm", &text, NULL, NULL));
    return (size_t)g_ascii_strtoull(text, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE);
}

static void test_machine(void)
{
    struct rlimit before, small = {.rlim_cur = 700 * MIB, .rlim_max = RLIM_INFINITY};
    getrlimit(RLIMIT_AS, &before);
    size_t free_of_limits = machine_memory();
    g_assert_cmpuint(memory_limit(), >, free_of_limits / 2);
    g_assert_cmpuint(memory_limit(), <, free_of_limits);
    small.rlim_max = before.rlim_max;
    if (free_of_limits > small.rlim_cur && address_space() < small.rlim_cur &&
        setrlimit(RLIMIT_AS, &small) == 0) {
        g_assert_cmpuint(machine_memory(), ==, small.rlim_cur);
        setrlimit(RLIMIT_AS, &before);
    }
}

/* ---- Who asks ---- */

static void test_images(void)
{
    enum { SIDE = 400 };
    /* the last is as large in its file as in memory */
    const char *const extensions[] = {"exr", "png", "jpg", "hdr", "pfm"};
    const char *const names[] = {"R", "G", "B"};
    scene_folder f = folder_new("");
    g_autoptr(image) img = image_new(SIDE, SIDE, 3, names, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(extensions); i++) {
        GError *error = NULL;
        g_autofree char *path = g_strconcat(f.main, ".", extensions[i], NULL);
        g_assert_true(image_write(img, path, NULL, NULL));
        /* what img has, and as much as the file has but not its pixels */
        memory_set_limit(3 * MIB);
        g_assert_null(image_read(path, NULL, &error));
        g_assert_nonnull(strstr(error->message, path));
        assert_refused(error, i < 4 ? "image" : "the file");
        memory_set_limit(16 * MIB);
        g_autoptr(image) back = image_read(path, NULL, NULL);
        g_assert_nonnull(back);
        g_unlink(path);
    }
    memory_set_limit(0);
    folder_remove(&f);
}

/* A file of less than 2 kB says that there are three million copies, all where the first
   is. */
static void test_copies(void)
{
    g_autofree char *buffers = buffer_uri();
    g_autofree char *text = g_strdup_printf(
        "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": "
        "[0]}],"
        "%s"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3,"
        "\"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 1, 0]},"
        "{\"componentType\": 5126, \"count\": 3000000, \"type\": \"VEC3\"}],"
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],"
        "\"extensionsUsed\": [\"EXT_mesh_gpu_instancing\"],"
        "\"nodes\": [{\"mesh\": 0, \"extensions\": {\"EXT_mesh_gpu_instancing\":"
        "{\"attributes\": {\"TRANSLATION\": 1}}}}]}",
        buffers);
    scene_folder f = folder_new("");
    folder_write(&f, "copies.gltf", text, -1);
    const char *path = f.files->pdata[f.files->len - 1];
    GError *error = NULL;
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    memory_set_limit(200 * MIB);
    g_assert_null(format_load(path, 1, NULL, &error));
    getrusage(RUSAGE_SELF, &after);
    g_assert_nonnull(strstr(error->message, path));
    assert_refused(error, "3000000 instances");
    g_assert_cmpint(after.ru_maxrss - before.ru_maxrss, <, 200 * 1024);
    g_assert_true(is_left(199 * MIB));
    memory_set_limit(0);
    folder_remove(&f);
}

#define WORLD "Camera \"perspective\" WorldBegin\n"

/* Small things that a file may have very many of. */
static const struct {
    const char *name, *head, *unit, *tail; /* the file; "%d" in a unit is its number */
    int n;
} swarms[] = {
    {"spheres.pbrt", WORLD, "Shape\"sphere\"\n", "", 50000},
    {"materials.pbrt", WORLD, "Material\"diffuse\"\n", "", 200000},
    {"textures.pbrt", WORLD, "Texture\"%d\"\"float\"\"constant\"\n", "", 150000},
    {"lights.pbrt", WORLD, "LightSource\"point\"", "", 50000},
    {"systems.pbrt", WORLD, "CoordinateSystem\"%d\"\n", "", 50000},
    {"attributes.pbrt", WORLD, "Attribute\"shape\"\"float a\"1\n", "", 60000},
    {"objects.pbrt", WORLD, "ObjectBegin\"%d\"ObjectEnd ", "Shape\"sphere\"", 12000},
    {"strings.pbrt", WORLD "Shape\"sphere\"\"string a\"[", "\"\"", "]", 300000},
    {"v3.pbrt", "Sampler\"random\"" WORLD, "Texture\"%d\"\"color\"\"constant\"\n",
     "WorldEnd", 50000},
    {"field.pbrt",
     "Sampler\"random\"" WORLD "Shape\"heightfield\"\"integer nu\"1000\"integer "
     "nv\"500\"float Pz\"[",
     "0 ", "]WorldEnd", 500000},
    {"numbers.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":[", "0,", "0]}",
     400000},
    {"nodes.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[", "{},", "{}]}", 120000},
};

static char *swarm_text(size_t i)
{
    GString *text = g_string_new(swarms[i].head);
    bool numbered = strchr(swarms[i].unit, '%') != NULL;
    g_auto(GStrv) around = g_strsplit(swarms[i].unit, "%d", 2);
    for (int n = 0; n < swarms[i].n; n++) {
        g_string_append(text, around[0]);
        if (numbered)
            g_string_append_printf(text, "%d%s", n, around[1]);
    }
    return g_string_free(g_string_append(text, swarms[i].tail), FALSE);
}

/* They are refused before GLib has to end the program, and all that was had is given
 * back. */
static void test_small_things(void)
{
    enum { LIMIT = 16 };
    for (size_t i = 0; i < G_N_ELEMENTS(swarms); i++) {
        g_autofree char *text = swarm_text(i);
        scene_folder f = folder_new("");
        folder_write(&f, swarms[i].name, text, -1);
        g_clear_pointer(&text, g_free);
        const char *path = f.files->pdata[f.files->len - 1];
        GError *error = NULL;
        memory_set_limit(LIMIT * MIB);
        g_autoptr(view) v = load_view(path, NULL, &error);
        g_assert_null(v);
        g_assert_nonnull(strstr(error->message, swarms[i].name));
        assert_refused(error, " for ");
        g_assert_true(is_left(LIMIT * MIB));
        g_assert_true(memory_ask((LIMIT - 6) * MIB, "a trial", NULL));
        memory_set_limit(0);
        folder_remove(&f);
    }
}

static const char picture_scene[] =
    "Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 300\n"
    "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
    "Translate 0 0 3 Shape \"sphere\"\n";

/* A render for which there is memory has a picture, too: whatever the limit, there is
   either neither or both. */
static void test_picture_is_reserved(void)
{
    scene_folder f = folder_new(picture_scene);
    unsigned n_refused = 0, n_rendered = 0;
    for (size_t limit = 20 * MIB; n_rendered < 3; limit += 4 * MIB) {
        g_autoptr(view) v = load_view(f.main, NULL, NULL);
        g_assert_nonnull(v);
        settings how =
            settings_with(v->scene, "integrator=path passes=1 spp=1 threads=1");
        GError *error = NULL;
        memory_set_limit(limit);
        g_autoptr(render) r = render_new(v, &how, &error);
        if (r && render_run(r, NULL, NULL, &error)) {
            g_autoptr(image) img = render_image(r, &error);
            g_assert_no_error(error);
            g_assert_nonnull(img);
            n_rendered++;
        } else {
            assert_refused(error, " for ");
            n_refused++;
        }
        memory_set_limit(0);
    }
    g_assert_cmpuint(n_refused, >, 0);
    folder_remove(&f);
}

/* Embree's memory counts: what it may not have it does not take, and the scene is
 * refused.
 */
static void test_search_structure(void)
{
    enum { SIDE = 300 };
    g_autoptr(GString) text = g_string_new(
        "Camera \"perspective\" WorldBegin\nShape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i < SIDE * SIDE; i++)
        g_string_append_printf(text, "%d %d %d ", i % SIDE, i / SIDE, i * 7919 % 100);
    g_string_append(text, "] \"integer indices\" [");
    for (int i = 0; i + SIDE + 1 < SIDE * SIDE; i++)
        g_string_append_printf(text, "%d %d %d ", i, i + 1, i + SIDE);
    g_string_append(text, "]\n");
    scene_folder f = folder_new(text->str);
    unsigned n_refused = 0;
    bool loaded = false;
    for (size_t limit = 2 * MIB; !loaded; limit += MIB) {
        GError *error = NULL;
        memory_set_limit(limit);
        g_autoptr(view) v = load_view(f.main, NULL, &error);
        loaded = v != NULL;
        if (!loaded) {
            n_refused += strstr(error->message, "the search structure") != NULL;
            assert_refused(error, f.main);
        }
        g_clear_pointer(&v, view_free);
        g_assert_true(is_left(limit));
    }
    g_assert_cmpuint(n_refused, >, 0);
    memory_set_limit(0);
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/memory/limit", test_limit);
    g_test_add_func("/memory/zero", test_zero);
    g_test_add_func("/memory/threads", test_threads);
    g_test_add_func("/memory/cgroups", test_cgroups);
    g_test_add_func("/memory/machine", test_machine);
    g_test_add_func("/memory/images", test_images);
    g_test_add_func("/memory/copies", test_copies);
    g_test_add_func("/memory/small-things", test_small_things);
    g_test_add_func("/memory/picture-is-reserved", test_picture_is_reserved);
    g_test_add_func("/memory/search-structure", test_search_structure);
    return g_test_run();
}
