/* Renders a scene to an image: render SCENE IMAGE */
#include <nephroid/nephroid.h>
#include <stdio.h>

static bool render_scene(const char *scene_path, const char *image_path, GError **error)
{
    NephScene *scene = neph_scene_load(scene_path, 0, NULL, NULL, error);
    if (!scene)
        return false;
    NephSettings *settings = neph_scene_settings(scene);
    NephRender *render = neph_render_new(scene, settings, error);
    NephImage *image = NULL;
    if (render && neph_render_run(render, NULL, NULL, error))
        image = neph_render_image(render, error);
    bool done = image && neph_image_write(image, image_path, 0.0f, error);
    neph_image_free(image);
    neph_render_free(render);
    neph_settings_free(settings);
    neph_scene_free(scene);
    return done;
}

int main(int argc, char **argv)
{
    GError *error = NULL;
    if (argc != 3) {
        fprintf(stderr, "usage: %s SCENE IMAGE\n", argv[0]);
        return NEPH_ERROR_USAGE;
    }
    if (render_scene(argv[1], argv[2], &error))
        return 0;
    fprintf(stderr, "%s\n", error->message);
    int code = error->code;
    g_error_free(error);
    return code;
}
