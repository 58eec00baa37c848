#include "photons/gl_layer.h"

#include <epoxy/gl.h>
#include <gio/gio.h>
#include <math.h>
#include <stddef.h>

static const char vertex_text[] = "in vec3 position;\n"
                                  "in vec4 color;\n"
                                  "uniform mat4 to_clip;\n"
                                  "uniform float point_size;\n"
                                  "uniform vec2 shift;\n"
                                  "out vec4 shade;\n"
                                  "void main() {\n"
                                  "    gl_Position = to_clip * vec4(position, 1.0);\n"
                                  "    gl_Position.xy += shift * gl_Position.w;\n"
                                  "    gl_PointSize = point_size;\n"
                                  "    shade = color;\n"
                                  "}\n";

static const char fragment_text[] =
    "in vec4 shade;\n"
    "uniform float fade;\n"
    "out vec4 pixel;\n"
    "void main() { pixel = vec4(shade.rgb, shade.a * fade); }\n";

static unsigned compile(GLenum kind, bool es, const char *text, GError **error)
{
    const char *parts[] = {
        es ? "#version 300 es\nprecision highp float;\n" : "#version 150\n", text};
    GLuint shader = glCreateShader(kind);
    GLint done = 0;
    glShaderSource(shader, 2, parts, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done)
        return shader;
    char log[512] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    g_set_error(error, G_IO_ERROR, G_IO_ERROR_NOT_SUPPORTED, "OpenGL: %s", log);
    glDeleteShader(shader);
    return 0;
}

bool gl_painter_init(gl_painter *p, bool es, GError **error)
{
    GLint done = 0;
    GLuint vertex = compile(GL_VERTEX_SHADER, es, vertex_text, error);
    GLuint fragment = vertex ? compile(GL_FRAGMENT_SHADER, es, fragment_text, error) : 0;
    if (fragment) {
        p->program = glCreateProgram();
        glAttachShader(p->program, vertex);
        glAttachShader(p->program, fragment);
        glBindAttribLocation(p->program, 0, "position");
        glBindAttribLocation(p->program, 1, "color");
        glLinkProgram(p->program);
        glGetProgramiv(p->program, GL_LINK_STATUS, &done);
        if (!done)
            g_set_error_literal(error, G_IO_ERROR, G_IO_ERROR_NOT_SUPPORTED,
                                "OpenGL: the program does not link");
    }
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    if (!done)
        return false;
    p->matrix = glGetUniformLocation(p->program, "to_clip");
    p->point_size = glGetUniformLocation(p->program, "point_size");
    p->fade = glGetUniformLocation(p->program, "fade");
    p->shift = glGetUniformLocation(p->program, "shift");
    return true;
}

void gl_painter_clear(gl_painter *p)
{
    glDeleteProgram(p->program);
    p->program = 0;
}

void gl_painter_clear_picture(const float background[3])
{
    glClearColor(background[0], background[1], background[2], 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void gl_painter_begin(gl_painter *p, const float matrix[16], const int pixels[2])
{
    for (int i = 0; i < 2; i++)
        p->pixel[i] = 2.0f / fmaxf((float)pixels[i], 1.0f);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    if (epoxy_is_desktop_gl())
        glEnable(GL_PROGRAM_POINT_SIZE);
    glUseProgram(p->program);
    glUniformMatrix4fv(p->matrix, 1, GL_FALSE, matrix);
    glUniform2f(p->shift, 0.0f, 0.0f);
}

void gl_layer_set(gl_layer *layer, const cloud_vertex *vertices, size_t n)
{
    if (!layer->array) {
        glGenVertexArrays(1, &layer->array);
        glGenBuffers(1, &layer->buffer);
    }
    glBindVertexArray(layer->array);
    glBindBuffer(GL_ARRAY_BUFFER, layer->buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(n * sizeof *vertices), vertices,
                 GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof *vertices,
                          (const void *)offsetof(cloud_vertex, position));
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof *vertices,
                          (const void *)offsetof(cloud_vertex, color));
    glBindVertexArray(0);
    layer->n = n;
}

void gl_layer_clear(gl_layer *layer)
{
    if (layer->array) {
        glDeleteVertexArrays(1, &layer->array);
        glDeleteBuffers(1, &layer->buffer);
    }
    *layer = (gl_layer){0};
}

static void draw(const gl_layer *layer, GLenum mode, size_t first, size_t n)
{
    if (n == 0)
        return;
    glBindVertexArray(layer->array);
    glDrawArrays(mode, (GLint)first, (GLsizei)n);
    glBindVertexArray(0);
}

static void set_fade(const gl_painter *p, float fade)
{
    if (fade < 1.0f) {
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                            GL_ONE_MINUS_SRC_ALPHA); /* the picture stays opaque */
    } else {
        glDisable(GL_BLEND);
    }
    glUniform1f(p->fade, fade);
}

/* OpenGL's core profile draws lines of one pixel only: wider ones are drawn again beside
   themselves, across and down. */
void gl_layer_lines(const gl_painter *p, const gl_layer *layer, float fade, int width)
{
    set_fade(p, fade);
    for (int i = 0; i < width; i++)
        for (int across = 0; across < (i > 0 ? 2 : 1); across++) {
            glUniform2f(p->shift, across ? (float)i * p->pixel[0] : 0.0f,
                        across ? 0.0f : -(float)i * p->pixel[1]);
            draw(layer, GL_LINES, 0, layer->n);
        }
    glUniform2f(p->shift, 0.0f, 0.0f);
}

void gl_layer_points(const gl_painter *p, const gl_layer *layer, const gl_points *points)
{
    set_fade(p, points->fade);
    glUniform1f(p->point_size, points->size);
    draw(layer, GL_POINTS, points->first, points->n);
}
