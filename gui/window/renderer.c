#include "window/renderer.h"

#include <epoxy/gl.h>
#include <stdbool.h>
#include <string.h>

/* Mesa's drivers that are programs, by what they call themselves. */
static const char *const in_software[] = {"llvmpipe", "softpipe", "Software Rasterizer",
                                          "SWR"};

static bool draws_in_software(GdkDisplay *display)
{
    g_autoptr(GdkGLContext) context = gdk_display_create_gl_context(display, NULL);
    if (!context || !gdk_gl_context_realize(context, NULL))
        return true;
    gdk_gl_context_make_current(context);
    const char *name = (const char *)glGetString(GL_RENDERER);
    bool found = !name;
    for (size_t i = 0; i < G_N_ELEMENTS(in_software) && !found; i++)
        found = strstr(name, in_software[i]) != NULL;
    gdk_gl_context_clear_current();
    return found;
}

void renderer_choose(GdkDisplay *display)
{
    if (!g_getenv("GSK_RENDERER") && draws_in_software(display))
        g_setenv("GSK_RENDERER", "cairo", FALSE);
}
