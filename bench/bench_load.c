/*
 * Loading: a mesh of ten million triangles from a binary PLY file to a scene that can be
 * rendered, against what can not be avoided: reading the file's bytes, and Embree's own
 * build. The target is twice that. Seconds are the process' own (all threads), so that a
 * busy machine disturbs little.
 *
 *   bench_load [triangles, default 10000000]
 */
#include "format/format.h"
#include "format/ply/ply.h"
#include "format/ply/ply_write.h"

#include "base/memory.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <glib/gstdio.h>
#include <math.h>
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

/* A landscape of n x n quads. */
static mesh landscape(size_t n)
{
    GError *error = NULL;
    mesh m = {.n_vertices = (n + 1) * (n + 1), .n_triangles = 2 * n * n};
    m.positions = big_alloc(3 * m.n_vertices + 1, sizeof(float), "mesh", &error);
    m.indices = m.positions
                    ? big_alloc(3 * m.n_triangles, sizeof(uint32_t), "mesh", &error)
                    : NULL;
    if (!m.indices)
        give_up(error);
    for (size_t i = 0; i < m.n_vertices; i++) {
        float x = (float)(i % (n + 1)) / (float)n, y = (float)(i / (n + 1)) / (float)n;
        m.positions[3 * i] = x;
        m.positions[3 * i + 1] = 0.02f * sinf(40.0f * x) * cosf(31.0f * y);
        m.positions[3 * i + 2] = y;
    }
    uint32_t *to = m.indices, row = (uint32_t)n + 1;
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * row + i;
            const uint32_t quad[6] = {a, a + row, a + 1, a + 1, a + row, a + row + 1};
            for (int k = 0; k < 6; k++)
                *to++ = quad[k];
        }
    return m;
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
    mesh m = landscape((size_t)sqrt(0.5 * (double)triangles));
    GError *error = NULL;
    g_autofree char *folder = g_dir_make_tmp("nephroid-load-XXXXXX", &error);
    g_autofree char *path = folder ? g_build_filename(folder, "a.ply", NULL) : NULL;
    output *out = path ? output_open(path, &error) : NULL;
    if (out)
        ply_write(out, &m);
    if (!out || !output_commit(out, &error))
        give_up(error);
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
