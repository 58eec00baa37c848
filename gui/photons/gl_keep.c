#include "photons/gl_keep.h"

#include <epoxy/gl.h>

static void make(gl_keep *keep, int width, int height)
{
    *keep = (gl_keep){.width = width, .height = height};
    glGenFramebuffers(1, &keep->frame);
    glGenRenderbuffers(1, &keep->color);
    glGenRenderbuffers(1, &keep->depth);
    glBindFramebuffer(GL_FRAMEBUFFER, keep->frame);
    glBindRenderbuffer(GL_RENDERBUFFER, keep->color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              keep->color);
    glBindRenderbuffer(GL_RENDERBUFFER, keep->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              keep->depth);
}

bool gl_keep_begin(gl_keep *keep, int width, int height)
{
    bool is_old = keep->frame && keep->width == width && keep->height == height;
    if (!is_old) {
        gl_keep_clear(keep);
        make(keep, width, height);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, keep->frame);
    glViewport(0, 0, width, height);
    return is_old;
}

void gl_keep_show(const gl_keep *keep, unsigned frame)
{
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
    glBlitFramebuffer(0, 0, keep->width, keep->height, 0, 0, keep->width, keep->height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
}

void gl_keep_clear(gl_keep *keep)
{
    if (keep->frame) {
        glDeleteFramebuffers(1, &keep->frame);
        glDeleteRenderbuffers(1, &keep->color);
        glDeleteRenderbuffers(1, &keep->depth);
    }
    *keep = (gl_keep){0};
}
