#include "window_parts.h"

void window_view_moved(const NephCamera *camera, bool moving, void *data)
{
    window *w = data;
    if (w->scene)
        session_set_camera(w->session, camera, moving);
}

void window_set_camera(window *w, const NephCamera *camera)
{
    w->view.camera = *camera;
    window_view_moved(camera, false, w);
}

void window_view_clicked(double x, double y, int n, void *data)
{
    (void)x, (void)y, (void)n, (void)data;
}

void window_hover(bool inside, int x, int y, void *data)
{
    window *w = data;
    const held_picture *picture = canvas_picture(w->canvas);
    int width, height, n, channel[3];
    if (!inside || !picture || !display_channels(picture->image, "", channel)) {
        status_show_pointer(w->status, NULL);
        return;
    }
    neph_image_size(picture->image, &width, &height, &n);
    const float *pixel = neph_image_pixels(picture->image) +
                         ((size_t)y * (size_t)width + (size_t)x) * (size_t)n;
    g_autofree char *text = g_strdup_printf(
        "(%d, %d)  R %.4g  G %.4g  B %.4g", x, y, (double)pixel[channel[0]],
        (double)pixel[channel[1]], (double)pixel[channel[2]]);
    status_show_pointer(w->status, text);
}
