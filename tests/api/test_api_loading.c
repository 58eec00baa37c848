/*
 * Loading can be stopped: at whatever moment of reading a scene of any format, decoding
 * its pictures or making it ready, it ends soon; nothing is left of it, and loaded again
 * it is whole. So can keeping a render in a file, and going on from there.
 */
#include "api_scene.h"
#include "asked_end.h"
#include "folder.h"
#include "sanitizers.h"

#include <math.h>
#include <string.h>

/* Within this it ends, s; where each access to memory is watched, ten times that: there
   large arrays are set to zero byte by byte. */
static const double soon = MEMORY_IS_WATCHED ? 1.0 : 0.1;

enum { TRIES = 4, MOMENTS = 6 };

/* s from the asking to the end; 0: it was loaded before. */
static double stop_after(const char *path, gint64 after)
{
    g_autoptr(GError) error = NULL;
    asked_end end = {.after = after};
    const NephLoadOptions how = {
        .threads = 1, .go_on = asked_end_go_on, .go_on_data = &end};
    asked_end_begin(&end);
    NephScene *scene = neph_scene_load_with(path, &how, &error);
    double took = asked_end_took(&end);
    neph_scene_free(scene);
    if (scene)
        return 0.0;
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    return took;
}

/* s that it takes whole. */
static double load_whole(const char *path)
{
    g_autoptr(GError) error = NULL;
    const NephLoadOptions how = {.threads = 1};
    gint64 start = g_get_monotonic_time();
    g_autoptr(NephScene) scene = neph_scene_load_with(path, &how, &error);
    g_assert_no_error(error);
    g_assert_nonnull(scene);
    return 1e-6 * (double)(g_get_monotonic_time() - start);
}

/* ---- Files that take a while ---- */

static char *in_folder(const char *name)
{
    return g_build_filename(folder, name, NULL);
}

static void write_text(const char *name, GString *text)
{
    g_autofree char *path = in_folder(name);
    g_assert_true(g_file_set_contents(path, text->str, (gssize)text->len, NULL));
    g_string_free(text, TRUE);
}

static GString *begin_scene(void)
{
    return g_string_new("Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n");
}

enum { SIDE = 400, N_TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

/* A wavy sheet: the height over a place of its grid. */
static double wave(int x, int y)
{
    return 0.1 * sin(0.05 * x) * cos(0.07 * y);
}

/* The grid's triangles' corners. */
static void corners_of(int i, int out[3])
{
    int cell = i / 2, at = cell / (SIDE - 1) * SIDE + cell % (SIDE - 1);
    out[0] = at + (i % 2 ? 1 : 0);
    out[1] = at + (i % 2 ? SIDE + 1 : 1);
    out[2] = at + SIDE;
}

static void write_pbrt(void)
{
    GString *text = begin_scene();
    g_string_append(text, "Shape \"trianglemesh\" \"point3 P\" [\n");
    for (int i = 0; i < SIDE * SIDE; i++)
        g_string_append_printf(text, "%.5f %.5f %.5f\n", 0.01 * (i % SIDE),
                               0.01 * (i / SIDE), wave(i % SIDE, i / SIDE));
    g_string_append(text, "] \"integer indices\" [\n");
    for (int i = 0; i < N_TRIANGLES; i++) {
        int c[3];
        corners_of(i, c);
        g_string_append_printf(text, "%d %d %d\n", c[0], c[1], c[2]);
    }
    g_string_append(text, "]\n");
    write_text("text.pbrt", text);
}

static void write_many(void)
{
    GString *text = begin_scene();
    for (int i = 0; i < 20000; i++)
        g_string_append_printf(text,
                               "AttributeBegin Translate %d %d %d %s\nShape \"sphere\" "
                               "\"float radius\" 0.4 AttributeEnd\n",
                               i % 40, i / 40 % 40, i / 1600,
                               i % 4 ? "" : "AreaLightSource \"diffuse\"");
    write_text("many.pbrt", text);
}

static void put_ply(GString *text, bool binary)
{
    g_string_append_printf(text,
                           "ply\nformat %s 1.0\nelement vertex %d\nproperty float "
                           "x\nproperty float y\nproperty float z\nelement face "
                           "%d\nproperty list uchar int vertex_indices\nend_header\n",
                           binary ? "binary_little_endian" : "ascii", SIDE * SIDE,
                           N_TRIANGLES);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float p[3] = {0.01f * (float)(i % SIDE), 0.01f * (float)(i / SIDE),
                            (float)wave(i % SIDE, i / SIDE)};
        if (binary)
            g_string_append_len(text, (const char *)p, sizeof p);
        else
            g_string_append_printf(text, "%g %g %g\n", (double)p[0], (double)p[1],
                                   (double)p[2]);
    }
    for (int i = 0; i < N_TRIANGLES; i++) {
        int c[3];
        corners_of(i, c);
        if (binary) {
            g_string_append_c(text, 3);
            g_string_append_len(text, (const char *)c, sizeof c);
        } else
            g_string_append_printf(text, "3 %d %d %d\n", c[0], c[1], c[2]);
    }
}

static void write_ply(const char *name, bool binary)
{
    GString *text = g_string_new(NULL);
    put_ply(text, binary);
    write_text(name, text);
}

static void write_obj(void)
{
    GString *text = g_string_new(NULL);
    for (int i = 0; i < SIDE * SIDE; i++)
        g_string_append_printf(text, "v %.5f %.5f %.5f\n", 0.01 * (i % SIDE),
                               0.01 * (i / SIDE), wave(i % SIDE, i / SIDE));
    for (int i = 0; i < N_TRIANGLES; i++) {
        int c[3];
        corners_of(i, c);
        g_string_append_printf(text, "f %d %d %d\n", c[0] + 1, c[1] + 1, c[2] + 1);
    }
    write_text("model.obj", text);
}

/* Glass, so that it is asked whether the mesh is closed. */
static void write_gltf(void)
{
    GString *data = g_string_new(NULL);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float p[3] = {0.01f * (float)(i % SIDE), 0.01f * (float)(i / SIDE),
                            (float)wave(i % SIDE, i / SIDE)};
        g_string_append_len(data, (const char *)p, sizeof p);
    }
    for (int i = 0; i < N_TRIANGLES; i++) {
        int c[3];
        corners_of(i, c);
        g_string_append_len(data, (const char *)c, sizeof c);
    }
    size_t vertices = (size_t)SIDE * SIDE * 12, size = data->len;
    write_text("model.bin", data);
    GString *text = g_string_new(NULL);
    g_string_append_printf(
        text,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":"
        "\"model.bin\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":"
        "0,\"byteOffset\":%zu,\"byteLength\":%zu}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\",\"min\":[0,0,-1],\"max\":"
        "[10,10,1]},{\"bufferView\":1,\"componentType\":5125,\"count\":%d,\"type\":"
        "\"SCALAR\"}],\"extensionsUsed\":[\"KHR_materials_transmission\"],\"materials\":"
        "[{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
        "\"material\":0}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}",
        size, vertices, vertices, size - vertices, SIDE * SIDE, 3 * N_TRIANGLES);
    write_text("model.gltf", text);
}

/* A picture, as a sky and on a sheet. */
static void write_picture(const char *ending)
{
    enum { SIZE = 2048 };
    g_autofree float *rgb = g_new(float, 3 * SIZE * SIZE);
    g_autoptr(GRand) random = g_rand_new_with_seed(23);
    for (size_t i = 0; i < 3 * SIZE * SIZE; i++)
        rgb[i] = (float)g_rand_double(random);
    g_autoptr(NephImage) image = neph_image_new(SIZE, SIZE, rgb, NULL);
    g_autofree char *name = g_strconcat("picture", ending, NULL), *path = in_folder(name);
    g_assert_true(neph_image_write(image, path, 0.0f, NULL));
    GString *text = g_string_new(NULL);
    g_string_append_printf(text,
                           "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" "
                           "\"string filename\" \"%s\"\nTexture \"t\" \"spectrum\" "
                           "\"imagemap\" \"string filename\" \"%s\"\nMaterial "
                           "\"diffuse\" \"texture reflectance\" \"t\"\nShape \"disk\"\n",
                           name, name);
    g_autofree char *scene = g_strconcat("with", ending, ".pbrt", NULL);
    write_text(scene, text);
}

static void write_subdivision(void)
{
    GString *text = begin_scene();
    g_string_append(text,
                    "Shape \"loopsubdiv\" \"integer levels\" 9 \"point3 P\" [0 0 0  1 0 "
                    "0  0 1 0  0 0 1] \"integer indices\" [0 2 1  0 1 3  0 3 2  1 2 "
                    "3]\n");
    write_text("subdivision.pbrt", text);
}

/* ---- ---- */

static void test_stop(const void *name)
{
    g_autofree char *path = in_folder(name);
    double whole = load_whole(path), worst = 0.0;
    unsigned n = 0;
    for (int i = 0; i < MOMENTS; i++) {
        double best = INFINITY, at = whole * (i + 0.3) / MOMENTS;
        for (int k = 0; k < TRIES && best > soon; k++)
            best = fmin(best, stop_after(path, (gint64)(1e6 * at)));
        g_test_message("at %.2f of %.2f s: %.1f ms", at, whole, 1e3 * best);
        worst = fmax(worst, best);
        n += best > 0.0;
    }
    g_assert_cmpuint(n, >, 0);
    g_assert_cmpfloat(worst, <, soon);
    load_whole(path);
}

/* ---- Checkpoints ---- */

static NephRender *make_render(const NephScene *scene)
{
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", "path", NULL);
    neph_settings_set(settings, "passes", "1", NULL);
    neph_settings_set(settings, "spp", "1", NULL);
    neph_settings_set(settings, "denoise", "off", NULL);
    return neph_render_new(scene, settings, NULL);
}

static int64_t passes_of(const NephRender *render)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    return s.passes;
}

/* It keeps the render in a file, or goes on from there. */
typedef bool (*keeping)(NephRender *render, const char *path, NephGoOnFunc go_on,
                        void *data, GError **error);

/* s from the asking to the end; 0: it was done before. */
static double stop_keeping(NephRender *render, keeping keep, const char *path,
                           gint64 after)
{
    g_autoptr(GError) error = NULL;
    asked_end end = {.after = after};
    asked_end_begin(&end);
    bool done = keep(render, path, asked_end_go_on, &end, &error);
    double took = asked_end_took(&end);
    if (done)
        return 0.0;
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    return took;
}

/* @param took µs, whole; the last of the moments is that it was never wanted */
static gint64 moment(gint64 took, int i)
{
    return i == MOMENTS - 1 ? 0 : took * (i + 1) / MOMENTS;
}

static void assert_file_is(const char *path, const char *text)
{
    g_autofree char *found = NULL;
    g_assert_true(g_file_get_contents(path, &found, NULL, NULL));
    g_assert_cmpstr(found, ==, text);
}

static void test_keep(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autofree char *path = in_folder("kept");
    neph_scene_resize(scene, 1000, 800, NULL);
    g_autoptr(NephRender) render = make_render(scene);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    gint64 start = g_get_monotonic_time();
    g_assert_true(neph_render_save_checkpoint(render, path, NULL));
    gint64 took = g_get_monotonic_time() - start;
    unsigned before = n_files_in(folder), n = 0;
    for (int i = 0; i < MOMENTS; i++) {
        double best = INFINITY;
        g_assert_true(g_file_set_contents(path, "old", 3, NULL));
        for (int k = 0; k < TRIES && best > soon; k++)
            best = fmin(best, stop_keeping(render, neph_render_save_checkpoint_while,
                                           path, moment(took, i)));
        g_test_message("%d: %.1f ms", i, 1e3 * best);
        g_assert_cmpfloat(best, <, soon);
        if (best > 0.0)
            assert_file_is(path, "old");
        g_assert_cmpuint(n_files_in(folder), ==, before);
        n += best > 0.0;
    }
    g_assert_cmpuint(n, >, 0);
    g_assert_true(neph_render_save_checkpoint(render, path, NULL));
    start = g_get_monotonic_time();
    g_autoptr(NephRender) whole = make_render(scene);
    g_assert_true(neph_render_resume(whole, path, NULL));
    g_assert_cmpint(passes_of(whole), ==, 1);
    took = g_get_monotonic_time() - start;
    for (int i = 0; i < MOMENTS; i++) {
        g_autoptr(NephRender) other = make_render(scene);
        double late =
            stop_keeping(other, neph_render_resume_while, path, moment(took, i));
        g_test_message("resume %d: %.1f ms", i, 1e3 * late);
        g_assert_cmpfloat(late, <, soon);
        g_assert_cmpint(passes_of(other), ==, late > 0.0 ? 0 : 1);
        if (late > 0.0) { /* as new: it can be done again */
            g_assert_true(neph_render_resume(other, path, NULL));
            g_assert_cmpint(passes_of(other), ==, 1);
        }
    }
}

static void write_all(void)
{
    write_pbrt();
    write_many();
    write_ply("binary.ply", true);
    write_ply("text.ply", false);
    write_obj();
    write_gltf();
    write_subdivision();
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"text.pbrt",       "many.pbrt", "binary.ply",
                                        "text.ply",        "model.obj", "model.gltf",
                                        "subdivision.pbrt"};
    static const char *const pictures[] = {".exr", ".png", ".jpg", ".hdr", ".pfm"};
    static char *with[G_N_ELEMENTS(pictures)];
    g_test_init(&argc, &argv, NULL);
    open_folder();
    write_all();
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *name = g_strconcat("/api-loading/stop/", names[i], NULL);
        g_test_add_data_func(name, names[i], test_stop);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(pictures); i++) {
        write_picture(pictures[i]);
        with[i] = g_strconcat("with", pictures[i], ".pbrt", NULL);
        g_autofree char *name = g_strconcat("/api-loading/stop/", with[i], NULL);
        g_test_add_data_func(name, with[i], test_stop);
    }
    g_test_add_func("/api-loading/checkpoint", test_keep);
    int result = g_test_run();
    for (size_t i = 0; i < G_N_ELEMENTS(pictures); i++)
        g_free(with[i]);
    remove_folder();
    return result;
}
