/*
 * How public structs can grow: new fields come at their ends, and a program tells the
 * library how large they were when it was compiled. A function that fills a struct fills
 * so much of it, one that is given a struct takes fields beyond for zero. Part of
 * nephroid.h, where these functions are described; programs call them without a size.
 *
 * Bindings of other languages call the names that end in _sized: size is that of the
 * struct, of an array's element, or for neph_photons_save_sized those of NephSaveOptions
 * and NephStatistics.
 */
#ifndef NEPHROID_SIZED_H
#define NEPHROID_SIZED_H

#include <nephroid/photons.h>

#ifdef __cplusplus
extern "C" {
#endif

NEPH_API const NephSettingInfo *neph_settings_table_sized(size_t *n, size_t size);
NEPH_API NephScene *neph_scene_load_with_sized(const char *path,
                                               const NephLoadOptions *options,
                                               size_t size, GError **error);
NEPH_API bool neph_scene_convert_with_sized(const char *in, const char *out,
                                            const NephLoadOptions *options, size_t size,
                                            GError **error);
NEPH_API void neph_scene_camera_sized(const NephScene *scene, NephCamera *out,
                                      size_t size);
NEPH_API bool neph_scene_set_camera_sized(NephScene *scene, const NephCamera *camera,
                                          size_t size, GError **error);
NEPH_API void neph_camera_set_fov_sized(NephCamera *camera, size_t size, double degrees);
NEPH_API void neph_camera_ray_sized(const NephCamera *camera, size_t size, double x,
                                    double y, double origin[3], double direction[3]);
NEPH_API bool neph_camera_project_sized(const NephCamera *camera, size_t size,
                                        const double point[3], double *x, double *y);
NEPH_API char *neph_camera_text_sized(const NephCamera *camera, size_t size);
NEPH_API bool neph_camera_save_sized(const NephCamera *camera, size_t size,
                                     const char *scene_path, GError **error);
NEPH_API bool neph_image_compare_sized(const NephImage *image, const NephImage *reference,
                                       NephImageDifference *out, size_t size,
                                       GError **error);
NEPH_API char *neph_image_difference_text_sized(const NephImageDifference *difference,
                                                size_t size, bool json);
NEPH_API void neph_render_statistics_sized(const NephRender *render, NephStatistics *out,
                                           size_t size);
NEPH_API char *neph_statistics_text_sized(const NephStatistics *statistics, size_t size,
                                          bool json);
NEPH_API void neph_render_add_statistics_sized(NephRender *render,
                                               const NephStatistics *more, size_t size);
NEPH_API bool neph_render_plan_sized(NephRender *render, NephPlan *out, size_t size,
                                     GError **error);
NEPH_API char *neph_plan_text_sized(const NephPlan *plan, size_t size);
NEPH_API bool neph_scene_pick_sized(const NephScene *scene, const double origin[3],
                                    const double direction[3], NephSurfacePoint *out,
                                    size_t size);
NEPH_API void neph_photons_statistics_sized(const NephPhotons *photons,
                                            NephStatistics *out, size_t size);
NEPH_API bool neph_photons_get_sized(const NephPhotons *photons, size_t i,
                                     NephPhoton *out, size_t size);
NEPH_API bool neph_photons_save_sized(const NephScene *scene,
                                      const NephSettings *settings, const char *path,
                                      const NephSaveOptions *options,
                                      const size_t sizes[2], GError **error);
NEPH_API size_t neph_photons_path_sized(const NephPhotons *photons, size_t i,
                                        NephPhotonEvent *events, size_t size,
                                        size_t capacity);
NEPH_API void neph_photons_estimate_sized(const NephPhotons *photons,
                                          const double point[3], const double normal[3],
                                          double radius, NephEstimate *out, size_t size);

#ifndef NEPHROID_INSIDE
static inline const NephSettingInfo *neph_settings_table(size_t *n)
{
    return neph_settings_table_sized(n, sizeof(NephSettingInfo));
}

static inline NephScene *
neph_scene_load_with(const char *path, const NephLoadOptions *options, GError **error)
{
    return neph_scene_load_with_sized(path, options, sizeof *options, error);
}

static inline bool neph_scene_convert_with(const char *in, const char *out,
                                           const NephLoadOptions *options, GError **error)
{
    return neph_scene_convert_with_sized(in, out, options, sizeof *options, error);
}

static inline void neph_scene_camera(const NephScene *s, NephCamera *out)
{
    neph_scene_camera_sized(s, out, sizeof *out);
}

static inline bool neph_scene_set_camera(NephScene *s, const NephCamera *c,
                                         GError **error)
{
    return neph_scene_set_camera_sized(s, c, sizeof *c, error);
}

static inline void neph_camera_set_fov(NephCamera *c, double degrees)
{
    neph_camera_set_fov_sized(c, sizeof *c, degrees);
}

static inline void neph_camera_ray(const NephCamera *c, double x, double y,
                                   double origin[3], double direction[3])
{
    neph_camera_ray_sized(c, sizeof *c, x, y, origin, direction);
}

static inline bool neph_camera_project(const NephCamera *c, const double point[3],
                                       double *x, double *y)
{
    return neph_camera_project_sized(c, sizeof *c, point, x, y);
}

static inline char *neph_camera_text(const NephCamera *c)
{
    return neph_camera_text_sized(c, sizeof *c);
}

static inline bool neph_camera_save(const NephCamera *c, const char *scene_path,
                                    GError **error)
{
    return neph_camera_save_sized(c, sizeof *c, scene_path, error);
}

static inline bool neph_image_compare(const NephImage *img, const NephImage *reference,
                                      NephImageDifference *out, GError **error)
{
    return neph_image_compare_sized(img, reference, out, sizeof *out, error);
}

static inline char *neph_image_difference_text(const NephImageDifference *difference,
                                               bool json)
{
    return neph_image_difference_text_sized(difference, sizeof *difference, json);
}

static inline void neph_render_statistics(const NephRender *r, NephStatistics *out)
{
    neph_render_statistics_sized(r, out, sizeof *out);
}

static inline char *neph_statistics_text(const NephStatistics *statistics, bool json)
{
    return neph_statistics_text_sized(statistics, sizeof *statistics, json);
}

static inline void neph_render_add_statistics(NephRender *r, const NephStatistics *more)
{
    neph_render_add_statistics_sized(r, more, sizeof *more);
}

static inline bool neph_render_plan(NephRender *r, NephPlan *out, GError **error)
{
    return neph_render_plan_sized(r, out, sizeof *out, error);
}

static inline char *neph_plan_text(const NephPlan *p)
{
    return neph_plan_text_sized(p, sizeof *p);
}

static inline bool neph_scene_pick(const NephScene *s, const double origin[3],
                                   const double direction[3], NephSurfacePoint *out)
{
    return neph_scene_pick_sized(s, origin, direction, out, sizeof *out);
}

static inline void neph_photons_statistics(const NephPhotons *photons,
                                           NephStatistics *out)
{
    neph_photons_statistics_sized(photons, out, sizeof *out);
}

static inline bool neph_photons_get(const NephPhotons *photons, size_t i, NephPhoton *out)
{
    return neph_photons_get_sized(photons, i, out, sizeof *out);
}

static inline bool neph_photons_save(const NephScene *s, const NephSettings *how,
                                     const char *path, const NephSaveOptions *options,
                                     GError **error)
{
    const size_t sizes[2] = {sizeof *options, sizeof *options->statistics};
    return neph_photons_save_sized(s, how, path, options, sizes, error);
}

static inline size_t neph_photons_path(const NephPhotons *photons, size_t i,
                                       NephPhotonEvent *events, size_t capacity)
{
    return neph_photons_path_sized(photons, i, events, sizeof *events, capacity);
}

static inline void neph_photons_estimate(const NephPhotons *photons,
                                         const double point[3], const double normal[3],
                                         double radius, NephEstimate *out)
{
    neph_photons_estimate_sized(photons, point, normal, radius, out, sizeof *out);
}
#endif

#ifdef __cplusplus
}
#endif

#endif
