#include "window/screenshot.h"

bool screenshot_take(GtkWindow *window, const char *path, GError **error)
{
    g_autoptr(GdkPaintable) paintable = gtk_widget_paintable_new(GTK_WIDGET(window));
    int width = gdk_paintable_get_intrinsic_width(paintable);
    int height = gdk_paintable_get_intrinsic_height(paintable);
    int scale = gtk_widget_get_scale_factor(GTK_WIDGET(window));
    GtkSnapshot *snapshot = gtk_snapshot_new();
    gtk_snapshot_scale(snapshot, (float)scale, (float)scale);
    gdk_paintable_snapshot(paintable, snapshot, width, height);
    g_autoptr(GskRenderNode) node = gtk_snapshot_free_to_node(snapshot);
    GskRenderer *renderer = gtk_native_get_renderer(GTK_NATIVE(window));
    if (!node || !renderer) {
        g_set_error_literal(error, G_IO_ERROR, G_IO_ERROR_BUSY,
                            "the window is just being drawn");
        return false;
    }
    const graphene_rect_t all = {{0, 0},
                                 {(float)(scale * width), (float)(scale * height)}};
    g_autoptr(GdkTexture) texture = gsk_renderer_render_texture(renderer, node, &all);
    if (gdk_texture_save_to_png(texture, path))
        return true;
    g_set_error(error, G_IO_ERROR, G_IO_ERROR_FAILED, "%s cannot be written", path);
    return false;
}
