#include "photons/photon_job.h"

typedef struct job {
    held_scene *scene;
    NephScene *seen; /* taken by the photons */
    NephSettings *settings;
} job;

static void free_job(void *data)
{
    job *j = data;
    neph_scene_free(j->seen);
    held_scene_unref(j->scene);
    neph_settings_free(j->settings);
    g_free(j);
}

void photon_result_free(photon_result *result)
{
    if (!result)
        return;
    held_photons_unref(result->photons);
    photon_cloud_free(result->cloud);
    g_free(result);
}

static bool go_on(void *data)
{
    return !g_cancellable_is_cancelled(data);
}

static void work(GTask *task, void *source, void *data, GCancellable *cancellable)
{
    (void)source;
    job *j = data;
    GError *error = NULL;
    g_autoptr(NephPhotons) photons =
        neph_photons_trace_while(j->seen, j->settings, go_on, cancellable, &error);
    if (!photons || !neph_photons_follow(photons, go_on, cancellable, &error)) {
        g_task_return_error(task, error);
        return;
    }
    photon_result *result = g_new0(photon_result, 1);
    result->cloud = photon_cloud_new(photons);
    result->photons =
        held_photons_new(g_steal_pointer(&photons), g_steal_pointer(&j->seen), j->scene);
    g_task_return_pointer(task, result, (GDestroyNotify)photon_result_free);
}

void photon_job_start(const photon_wish *wish, GCancellable *cancellable,
                      GAsyncReadyCallback done, void *data)
{
    job *j = g_new(job, 1);
    *j = (job){held_scene_ref(wish->scene), neph_scene_share(wish->scene->scene),
               neph_settings_copy(wish->settings)};
    neph_scene_resize(j->seen, wish->width, wish->height, NULL);
    neph_scene_set_camera(j->seen, wish->camera, NULL);
    g_autoptr(GTask) task = g_task_new(NULL, cancellable, done, data);
    g_task_set_task_data(task, j, free_job);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, work);
}

photon_result *photon_job_finish(GAsyncResult *result, GError **error)
{
    return g_task_propagate_pointer(G_TASK(result), error);
}
