/*
 * Loading: a mesh of ten million triangles from a binary PLY file to a scene that can be
 * rendered, against what can not be avoided: reading the file's bytes, and Embree's own
 * build. The target is twice that. Seconds are the process' own (all threads), so that a
 * busy machine disturbs little.
 *
 *   bench_load [triangles, default 10000000]
 */
#include "bench_mesh.h"
#include "format/format.h"
#include "format/ply/ply.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <glib/gstdio.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void give_up(const GError *error)
{
    fprintf(stderr, "bench_load: %s\n", error->message);
    exit(3);
}

static double time_bytes(const char *path)
{
    double start = seconds();
    char *bytes = NULL;
    gsize size;
    GError *error = NULL;
    if (!g_file_get_contents(path, &bytes, &size, &error))
        give_up(error);
    g_free(bytes);
    return seconds() - start;
}

static double time_parse(const char *path)
{
    double start = seconds();
    GError *error = NULL;
    mesh m = {0};
    if (!ply_read(path, &m, &error))
        give_up(error);
    double taken = seconds() - start;
    mesh_clear(&m);
    return taken;
}

static double time_scene(const char *path)
{
    double start = seconds();
    GError *error = NULL;
    g_autoptr(scene) s = format_load(path, 0, NULL, &error);
    if (!s)
        give_up(error);
    return seconds() - start;
}

/* Embree alone, with the settings that the scene uses. */
static double time_embree(const mesh *m)
{
    RTCDevice device = rtcNewDevice("set_affinity=0");
    RTCScene bare = rtcNewScene(device);
    double start = seconds();
    rtcSetSceneFlags(bare, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               m->positions, 0, 3 * sizeof(float), m->n_vertices);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices,
                               0, 3 * sizeof(uint32_t), m->n_triangles);
    rtcCommitGeometry(g);
    rtcAttachGeometry(bare, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(bare);
    double taken = seconds() - start;
    rtcReleaseScene(bare);
    rtcReleaseDevice(device);
    return taken;
}

int main(int argc, char **argv)
{
    size_t triangles = argc > 1 ? strtoull(argv[1], NULL, 10) : 10000000;
    mesh m = bench_mesh_make(triangles, bench_landscape);
    GError *error = NULL;
    g_autofree char *folder = g_dir_make_tmp("nephroid-load-XXXXXX", &error);
    g_autofree char *path = folder ? g_build_filename(folder, "a.ply", NULL) : NULL;
    if (!path)
        give_up(error);
    bench_mesh_write(&m, path);
    size_t n = m.n_triangles;
    double embree = time_embree(&m);
    mesh_clear(&m);
    double bytes = time_bytes(path), parse = time_parse(path), whole = time_scene(path);
    g_unlink(path);
    g_rmdir(folder);
    printf(
        "%zu triangles\n  bytes      %8.3f s\n  PLY        %8.3f s\n  Embree     %8.3f "
        "s\n  whole      %8.3f s, %.2f times bytes and Embree\n",
        n, bytes, parse, embree, whole, whole / (bytes + embree));
    return 0;
}
