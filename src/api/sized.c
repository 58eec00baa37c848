/*
 * What takes a plain struct, for programs that know a smaller or a larger one: fields come
 * at the ends of structs, so that what both know is where both look for it.
 *
 *   program's struct ── as much as both know, then zeros ──► ours
 *   ours ── as much as both know, then zeros ──► program's
 */
#include "nephroid/nephroid.h"

#include <pthread.h>
#include <string.h>

static void copy(void *to, size_t to_size, const void *from, size_t from_size)
{
    size_t both = MIN(to_size, from_size);
    memcpy(to, from, both);
    memset((char *)to + both, 0, to_size - both);
}

/* Ours, of the program's. */
#define TAKE(type, name, from, size)                                                     \
    type name;                                                                           \
    copy(&(name), sizeof(name), from, size)

/* ---- Settings ---- */

/* One table for each size that was asked for, to the end of the program. */
static const NephSettingInfo *table_of(const NephSettingInfo *rows, size_t n, size_t size)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static GHashTable *tables;
    pthread_mutex_lock(&lock);
    if (!tables)
        tables = g_hash_table_new(NULL, NULL);
    char *table = g_hash_table_lookup(tables, GSIZE_TO_POINTER(size));
    if (!table) {
        table = g_malloc_n(n, size);
        for (size_t i = 0; i < n; i++)
            copy(table + i * size, size, &rows[i], sizeof rows[i]);
        g_hash_table_insert(tables, GSIZE_TO_POINTER(size), table);
    }
    pthread_mutex_unlock(&lock);
    return (const NephSettingInfo *)(void *)table;
}

const NephSettingInfo *neph_settings_table_sized(size_t *n, size_t size)
{
    const NephSettingInfo *rows = neph_settings_table(n);
    return size == sizeof *rows ? rows : table_of(rows, *n, size);
}

/* ---- Scenes ---- */

NephScene *neph_scene_load_with_sized(const char *path, const NephLoadOptions *options,
                                      size_t size, GError **error)
{
    TAKE(NephLoadOptions, ours, options, size);
    return neph_scene_load_with(path, &ours, error);
}

bool neph_scene_convert_with_sized(const char *in, const char *out,
                                   const NephLoadOptions *options, size_t size,
                                   GError **error)
{
    TAKE(NephLoadOptions, ours, options, size);
    return neph_scene_convert_with(in, out, &ours, error);
}

bool neph_scene_pick_sized(const NephScene *scene, const double origin[3],
                           const double direction[3], NephSurfacePoint *out, size_t size)
{
    NephSurfacePoint ours;
    bool hit = neph_scene_pick(scene, origin, direction, &ours);
    if (hit)
        copy(out, size, &ours, sizeof ours);
    return hit;
}

/* ---- Cameras ---- */

void neph_scene_camera_sized(const NephScene *scene, NephCamera *out, size_t size)
{
    NephCamera ours = {0};
    neph_scene_camera(scene, &ours);
    copy(out, size, &ours, sizeof ours);
}

bool neph_scene_set_camera_sized(NephScene *scene, const NephCamera *camera, size_t size,
                                 GError **error)
{
    TAKE(NephCamera, ours, camera, size);
    return neph_scene_set_camera(scene, &ours, error);
}

void neph_camera_set_fov_sized(NephCamera *camera, size_t size, double degrees)
{
    TAKE(NephCamera, ours, camera, size);
    neph_camera_set_fov(&ours, degrees);
    memcpy(camera, &ours, MIN(size, sizeof ours));
}

void neph_camera_ray_sized(const NephCamera *camera, size_t size, double x, double y,
                           double origin[3], double direction[3])
{
    TAKE(NephCamera, ours, camera, size);
    neph_camera_ray(&ours, x, y, origin, direction);
}

bool neph_camera_project_sized(const NephCamera *camera, size_t size,
                               const double point[3], double *x, double *y)
{
    TAKE(NephCamera, ours, camera, size);
    return neph_camera_project(&ours, point, x, y);
}

char *neph_camera_text_sized(const NephCamera *camera, size_t size)
{
    TAKE(NephCamera, ours, camera, size);
    return neph_camera_text(&ours);
}

bool neph_camera_save_sized(const NephCamera *camera, size_t size, const char *scene_path,
                            GError **error)
{
    TAKE(NephCamera, ours, camera, size);
    return neph_camera_save(&ours, scene_path, error);
}

/* ---- Images ---- */

bool neph_image_compare_sized(const NephImage *image, const NephImage *reference,
                              NephImageDifference *out, size_t size, GError **error)
{
    NephImageDifference ours;
    bool done = neph_image_compare(image, reference, &ours, error);
    if (done)
        copy(out, size, &ours, sizeof ours);
    return done;
}

char *neph_image_difference_text_sized(const NephImageDifference *difference, size_t size,
                                       bool json)
{
    TAKE(NephImageDifference, ours, difference, size);
    return neph_image_difference_text(&ours, json);
}

/* ---- Renders ---- */

void neph_render_statistics_sized(const NephRender *render, NephStatistics *out,
                                  size_t size)
{
    NephStatistics ours;
    neph_render_statistics(render, &ours);
    copy(out, size, &ours, sizeof ours);
}

char *neph_statistics_text_sized(const NephStatistics *statistics, size_t size, bool json)
{
    TAKE(NephStatistics, ours, statistics, size);
    return neph_statistics_text(&ours, json);
}

void neph_render_add_statistics_sized(NephRender *render, const NephStatistics *more,
                                      size_t size)
{
    TAKE(NephStatistics, ours, more, size);
    neph_render_add_statistics(render, &ours);
}

bool neph_render_plan_sized(NephRender *render, NephPlan *out, size_t size,
                            GError **error)
{
    NephPlan ours;
    bool done = neph_render_plan(render, &ours, error);
    if (done)
        copy(out, size, &ours, sizeof ours);
    return done;
}

char *neph_plan_text_sized(const NephPlan *plan, size_t size)
{
    TAKE(NephPlan, ours, plan, size);
    return neph_plan_text(&ours);
}

/* ---- Photons ---- */

void neph_photons_statistics_sized(const NephPhotons *photons, NephStatistics *out,
                                   size_t size)
{
    NephStatistics ours;
    neph_photons_statistics(photons, &ours);
    copy(out, size, &ours, sizeof ours);
}

bool neph_photons_get_sized(const NephPhotons *photons, size_t i, NephPhoton *out,
                            size_t size)
{
    NephPhoton ours;
    bool is_there = neph_photons_get(photons, i, &ours);
    copy(out, size, &ours, sizeof ours);
    return is_there;
}

bool neph_photons_save_sized(const NephScene *scene, const NephSettings *settings,
                             const char *path, const NephSaveOptions *options,
                             const size_t sizes[2], GError **error)
{
    NephStatistics statistics = {0};
    TAKE(NephSaveOptions, ours, options, sizes[0]);
    NephStatistics *theirs = ours.statistics;
    ours.statistics = &statistics;
    bool done = neph_photons_save(scene, settings, path, &ours, error);
    if (theirs)
        copy(theirs, sizes[1], &statistics, sizeof statistics);
    return done;
}

size_t neph_photons_path_sized(const NephPhotons *photons, size_t i,
                               NephPhotonEvent *events, size_t size, size_t capacity)
{
    size_t n = neph_photons_path(photons, i, NULL, 0), some = MIN(n, capacity);
    if (!events)
        return n;
    g_autofree NephPhotonEvent *ours = g_new0(NephPhotonEvent, MAX(some, 1));
    neph_photons_path(photons, i, ours, some);
    for (size_t k = 0; k < some; k++)
        copy((char *)events + k * size, size, &ours[k], sizeof ours[k]);
    return n;
}

void neph_photons_estimate_sized(const NephPhotons *photons, const double point[3],
                                 const double normal[3], double radius, NephEstimate *out,
                                 size_t size)
{
    NephEstimate ours;
    neph_photons_estimate(photons, point, normal, radius, &ours);
    copy(out, size, &ours, sizeof ours);
}
