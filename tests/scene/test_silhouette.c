/*
 * silhouette: a coarse ball with smooth normals has no black rim, whatever it is made of,
 * reflects no more than it gets, and is seen alike by eye and photons.
 */
#include "rooms.h"

enum { AROUND = 10, UP = 5, N_VERTICES = AROUND * (UP + 1) };

/* A unit sphere of few triangles, with the sphere's normals. */
static char *coarse_ball(void)
{
    GString *p = g_string_new(NULL), *i = g_string_new(NULL);
    for (int v = 0; v < N_VERTICES; v++) {
        double theta = G_PI * (v / AROUND) / UP, phi = 2 * G_PI * (v % AROUND) / AROUND;
        g_string_append_printf(p, "%.7f %.7f %.7f ", sin(theta) * cos(phi),
                               sin(theta) * sin(phi), cos(theta));
    }
    for (int y = 0; y < UP; y++)
        for (int x = 0; x < AROUND; x++) {
            int a = y * AROUND + x, b = y * AROUND + (x + 1) % AROUND;
            if (y > 0)
                g_string_append_printf(i, "%d %d %d ", a, a + AROUND, b);
            if (y < UP - 1)
                g_string_append_printf(i, "%d %d %d ", b, a + AROUND, b + AROUND);
        }
    char *text =
        g_strdup_printf("Shape \"trianglemesh\" \"point3 P\" [%s] \"normal N\" [%s] "
                        "\"integer indices\" [%s]\n",
                        p->str, p->str, i->str);
    g_string_free(p, TRUE);
    g_string_free(i, TRUE);
    return text;
}

typedef struct stuff {
    const char *name, *text;
    double least, most; /* of the light that a pixel of it sends, of 1 that it gets */
} stuff;

static const stuff stuffs[] = {
    {"diffuse", "\"diffuse\" \"rgb reflectance\" [1 1 1]", 0.85, 1.03},
    {"mirror", "\"conductor\" \"rgb reflectance\" [0.9999 0.9999 0.9999]", 0.99, 1.001},
    {"brushed",
     "\"conductor\" \"rgb reflectance\" [0.9999 0.9999 0.9999] \"float roughness\" 0.02",
     0.8, 1.02},
    {"plastic", "\"coateddiffuse\" \"rgb reflectance\" [1 1 1] \"float thickness\" 0",
     0.8, 1.03},
    {"glass", "\"dielectric\"", 0.85, 1.001},
};

/* Under a sky of radiance 1 every pixel shows at most 1, and none is black. */
static void test_no_black_rim(gconstpointer data)
{
    const stuff *f = data;
    g_autofree char *ball = coarse_ball();
    g_autofree char *text = g_strconcat(
        "LookAt 0.3 -5 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 26\n",
        SIZE(32) "WorldBegin LightSource \"infinite\"\nMaterial ", f->text, "\n", ball,
        NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) img =
        render_with(v, "integrator=path max_backward_bounces=40 passes=4 spp=64 seed=3");
    int g = image_channel(img, "G"), depth = image_channel(img, "depth.Z");
    double least = INFINITY, most = 0;
    for (int i = 0; i < img->width * img->height; i++) {
        const float *pixel = img->pixels + i * img->n_channels;
        if (!(pixel[depth] > 0.0f))
            continue;
        least = fmin(least, (double)pixel[g]);
        most = fmax(most, (double)pixel[g]);
    }
    g_test_message("%s: %g to %g", f->name, least, most);
    g_assert_cmpfloat(least, >, f->least);
    g_assert_cmpfloat(most, <, f->most);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(stuffs); i++) {
        g_autofree char *name = g_strconcat("/silhouette/", stuffs[i].name, NULL);
        g_test_add_data_func(name, &stuffs[i], test_no_black_rim);
    }
    return g_test_run();
}
