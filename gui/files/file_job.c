#include "files/file_job.h"

typedef struct job {
    char *path, *text, *scene;
    NephCamera camera;
    held_picture *picture;
    display_options shown;
} job;

static void free_job(void *data)
{
    job *j = data;
    held_picture_unref(j->picture);
    g_free(j->text);
    g_free(j->scene);
    g_free(j->path);
    g_free(j);
}

static void run(job *j, GTaskThreadFunc work, GCancellable *cancellable,
                GAsyncReadyCallback done, void *data)
{
    g_autoptr(GTask) task = g_task_new(NULL, cancellable, done, data);
    g_task_set_task_data(task, j, free_job);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, work);
}

static void read_picture(GTask *task, void *source, void *data, GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    const job *j = data;
    GError *error = NULL;
    int width, height, n_channels;
    NephImage *image = neph_image_read(j->path, &error);
    if (!image) {
        g_task_return_error(task, error);
        return;
    }
    neph_image_size(image, &width, &height, &n_channels);
    g_task_return_pointer(task, held_picture_new(image, width, height, false),
                          (GDestroyNotify)held_picture_unref);
}

void file_job_read(const char *path, GCancellable *cancellable, GAsyncReadyCallback done,
                   void *data)
{
    job *j = g_new0(job, 1);
    j->path = g_strdup(path);
    run(j, read_picture, cancellable, done, data);
}

held_picture *file_job_read_finish(GAsyncResult *result, GError **error)
{
    return g_task_propagate_pointer(G_TASK(result), error);
}

static bool write_scene(const job *j, GError **error)
{
    return neph_scene_convert(j->scene, j->path, NULL, NULL, error) &&
           neph_camera_save(&j->camera, j->path, error);
}

static bool write_picture(const job *j, GError **error)
{
    bool eight_bits;
    if (!neph_image_is_written(j->path, &eight_bits) || !eight_bits)
        return neph_image_write(j->picture->image, j->path, 0.0f, error);
    g_autoptr(NephImage) seen = display_image(j->picture->image, &j->shown, error);
    return seen && neph_image_write(seen, j->path, 0.0f, error);
}

static bool write_any(const job *j, GError **error)
{
    if (j->picture)
        return write_picture(j, error);
    if (j->scene)
        return write_scene(j, error);
    return neph_file_write(j->path, j->text, error);
}

static void write_content(GTask *task, void *source, void *data,
                          GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    const job *j = data;
    GError *error = NULL;
    if (write_any(j, &error))
        g_task_return_boolean(task, TRUE);
    else
        g_task_return_error(task, error);
}

void file_job_write(const char *path, const file_content *content,
                    GCancellable *cancellable, GAsyncReadyCallback done, void *data)
{
    job *j = g_new0(job, 1);
    *j = (job){.path = g_strdup(path),
               .text = g_strdup(content->text),
               .scene = g_strdup(content->scene),
               .camera = content->camera,
               .picture = held_picture_ref(content->picture),
               .shown = content->shown};
    run(j, write_content, cancellable, done, data);
}

bool file_job_write_finish(GAsyncResult *result, GError **error)
{
    return g_task_propagate_boolean(G_TASK(result), error);
}

const char *file_job_path(GAsyncResult *result)
{
    const job *j = g_task_get_task_data(G_TASK(result));
    return j->path;
}

bool file_job_is_orphan(GAsyncResult *result)
{
    GCancellable *asked = g_task_get_cancellable(G_TASK(result));
    return asked && g_cancellable_is_cancelled(asked);
}
