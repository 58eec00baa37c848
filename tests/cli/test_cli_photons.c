/*
 * Photons that are kept in a file: made by one command and used by another, for the same
 * scene from wherever it is seen, and refused for any other.
 */
#include "cli_run.h"

#include <string.h>

/* Replaces a part of box.pbrt, and puts it into another file. */
static void write_other(const folder *f, const char *name, const char *from,
                        const char *to)
{
    g_autofree char *scene = folder_read(f, "box.pbrt");
    g_assert_nonnull(strstr(scene, from));
    g_auto(GStrv) parts = g_strsplit(scene, from, 2);
    g_autofree char *other = g_strjoinv(to, parts);
    folder_write(f, name, other);
}

static void test_same(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "render box.pbrt -q -o a.exr --passes 2 --set integrator=photonmap");
    g_auto(result) kept = run(f, "photons box.pbrt --save kept --passes 2 --set "
                                 "integrator=photonmap");
    g_assert_cmpint(kept.code, ==, 0);
    contains(kept.out, "wrote kept");
    contains(kept.out, "emitted");
    run_well(f, "render box.pbrt -q -o b.exr --photons kept --passes 2 -j1");
    g_auto(result) same = run(f, "compare a.exr b.exr --metric rmse");
    g_assert_cmpstr(same.out, ==, "0\n");
}

/* What is about seeing may be another, what photons meet may not. */
static void test_scene(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "photons box.pbrt -q --save kept --set integrator=photonmap");
    write_other(
        f, "seen.pbrt", "WorldBegin",
        "Translate 0.1 0 0 # elsewhere\nSampler \"halton\" \"integer pixelsamples\" "
        "4\nWorldBegin");
    run_well(f, "render seen.pbrt -q -o a.exr --photons kept --size 9x7 --passes 3");
    write_other(f, "moved.pbrt", "WorldBegin", "WorldBegin Translate 0.1 0 0");
    g_auto(result) other = run(f, "render moved.pbrt -o b.exr --photons kept");
    g_assert_cmpint(other.code, ==, 1);
    contains(other.err,
             "kept: error: the photon map is of another scene, or of files that "
             "have changed");
    g_assert_false(folder_has(f, "b.exr"));
}

static void test_refused(folder *f, gconstpointer data)
{
    (void)data;
    static const refused_run cases[] = {
        {"photons box.pbrt --save kept --set integrator=vcm", "expected one of photonmap",
         2},
        {"photons box.pbrt --save kept --set integrator=path",
         "expected one of photonmap", 2},
        {"photons box.pbrt --passes 2", "--passes: expected --save FILE too", 2},
        {"photons box.pbrt --save box.pbrt", "it would replace", 2},
        {"photons box.pbrt --save nowhere/kept", "cannot write nowhere/kept", 1},
        {"render box.pbrt --photons none", "cannot open 'none'", 1},
        {"render box.pbrt --photons box.pbrt", "expected a photon map, found another", 1},
        {"render box.pbrt --photons kept --seed 3", "with seed = 0, not 3", 1},
        {"render box.pbrt --photons kept -o kept.exr --set radius=2",
         "with radius = ", 1},
    };
    run_well(f, "photons box.pbrt -q --save kept --set integrator=photonmap");
    run_refused(f, "", cases, G_N_ELEMENTS(cases));
    g_assert_cmpuint(folder_count(f), ==, 2);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli-photons/same", test_same);
    folder_add_test("/cli-photons/scene", test_scene);
    folder_add_test("/cli-photons/refused", test_refused);
    return g_test_run();
}
