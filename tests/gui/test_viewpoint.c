/*
 * What the window computes without a window: moving the camera, colours for the screen,
 * sizes of quick looks, clouds of photons, messages taken apart.
 */
#include "panels/error_page.h"
#include "photons/photon_cloud.h"
#include "picture/display.h"
#include "picture/viewpoint.h"
#include "session/preview.h"

#include <glib/gstdio.h>

#include <math.h>
#include <string.h>

static const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};

static viewpoint make_view(bool mirrored)
{
    NephCamera camera = {.position = {0, 0, -4},
                         .direction = {0, 0, 1},
                         .up = {0, 1, 0},
                         .mirrored = mirrored,
                         .fov = 60.0,
                         .focal_distance = 1.0};
    const double side = tan(G_PI / 6.0);
    const double screen[4] = {-side, side, -side, side};
    memcpy(camera.screen, screen, sizeof screen);
    viewpoint v;
    viewpoint_init(&v, &camera, low, high);
    return v;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The axes stay unit and perpendicular, and the horizon level. */
static void assert_upright(const viewpoint *v)
{
    const NephCamera *c = &v->camera;
    g_assert_cmpfloat_with_epsilon(dot(c->direction, c->direction), 1.0, 1e-9);
    g_assert_cmpfloat_with_epsilon(dot(c->up, c->up), 1.0, 1e-9);
    g_assert_cmpfloat_with_epsilon(dot(c->up, c->direction), 0.0, 1e-9);
    g_assert_cmpfloat(dot(c->up, v->up), >, 0.0);
}

/* ---- Moving ---- */

static void test_orbit(void)
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        viewpoint v = make_view(mirrored);
        double before = distance(v.camera.position, v.pivot), x, y;
        for (int i = 0; i < 200; i++) {
            viewpoint_orbit(&v, 0.1, 0.07 * ((i % 40) - 15));
            assert_upright(&v);
            g_assert_cmpfloat_with_epsilon(distance(v.camera.position, v.pivot), before,
                                           1e-6);
            g_assert_true(neph_camera_project(&v.camera, v.pivot, &x, &y));
            g_assert_cmpfloat_with_epsilon(x, 0.5, 1e-6);
            g_assert_cmpfloat_with_epsilon(y, 0.5, 1e-6);
        }
    }
}

/* What is dragged to the right goes to the right, mirrored or not. */
static void test_directions(void)
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        double x, y, front[3] = {0, 0, -1}, ahead[3] = {0, 0, 0};
        viewpoint v = make_view(mirrored);
        viewpoint_orbit(&v, 0.2, 0.0);
        neph_camera_project(&v.camera, front, &x, &y);
        g_assert_cmpfloat(x, >, 0.5);
        v = make_view(mirrored);
        viewpoint_orbit(&v, 0.0, 0.2);
        neph_camera_project(&v.camera, front, &x, &y);
        g_assert_cmpfloat(y, <, 0.5);
        v = make_view(mirrored);
        viewpoint_look(&v, 0.1, 0.05);
        neph_camera_project(&v.camera, ahead, &x, &y);
        g_assert_cmpfloat(x, <, 0.5);
        g_assert_cmpfloat(y, >, 0.5);
        v = make_view(mirrored);
        viewpoint_pan(&v, -0.1, 0.2);
        neph_camera_project(&v.camera, ahead, &x, &y);
        g_assert_cmpfloat_with_epsilon(x, 0.6, 1e-9);
        g_assert_cmpfloat_with_epsilon(y, 0.7, 1e-9);
    }
}

static void test_dolly(void)
{
    viewpoint v = make_view(false);
    viewpoint_dolly(&v, 0.5);
    g_assert_cmpfloat_with_epsilon(v.camera.position[2], -2.0, 1e-9);
    for (int i = 0; i < 1000; i++)
        viewpoint_dolly(&v, 0.5);
    g_assert_cmpfloat(distance(v.camera.position, v.pivot), >, 0.0);
    viewpoint_fly(&v, 0.0, 0.0, -3.0);
    g_assert_cmpfloat(v.camera.position[2], <, -2.9);
}

static void test_frame(void)
{
    viewpoint v = make_view(false);
    viewpoint_orbit(&v, 0.7, -0.4);
    viewpoint_frame(&v, low, high);
    for (int corner = 0; corner < 8; corner++) {
        double p[3], x, y;
        for (int i = 0; i < 3; i++)
            p[i] = corner & (1 << i) ? high[i] : low[i];
        g_assert_true(neph_camera_project(&v.camera, p, &x, &y));
        g_assert_true(x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0);
    }
}

/* ---- Quick looks ---- */

static void test_preview(void)
{
    preview_pace pace = {0};
    const int whole[2] = {640, 480};
    int size[2];
    preview_size(&pace, 0.1, whole, size);
    g_assert_cmpint(size[0], <, 200);
    preview_note(&pace, (const int[]){100, 100}, 0.1);
    preview_size(&pace, 0.4, whole, size);
    g_assert_cmpfloat_with_epsilon((double)size[0] * size[1], 40000.0, 600.0);
    preview_note(&pace, (const int[]){640, 480}, 0.01);
    preview_size(&pace, 0.4, whole, size);
    g_assert_cmpint(size[0], ==, 640);
    g_autoptr(NephSettings) wanted = neph_settings_new();
    g_autoptr(NephSettings) quick = preview_settings(wanted, 10.0);
    g_autofree char *spp = neph_settings_get(quick, "spp");
    g_autofree char *radius = neph_settings_get(quick, "radius");
    g_assert_cmpstr(spp, ==, "1");
    g_assert_cmpfloat(g_ascii_strtod(radius, NULL), >, 0.0);
}

/* With photons where the picture has them, else as it is. */
static void test_preview_integrator(void)
{
    static const char *const looks[][2] = {
        {"auto", "photonmap"}, {"vcm", "photonmap"}, {"path", "path"}};
    g_autoptr(NephSettings) wanted = neph_settings_new();
    for (size_t i = 0; i < G_N_ELEMENTS(looks); i++) {
        g_assert_true(neph_settings_set(wanted, "integrator", looks[i][0], NULL));
        g_autoptr(NephSettings) quick = preview_settings(wanted, 10.0);
        g_autofree char *integrator = neph_settings_get(quick, "integrator");
        g_assert_cmpstr(integrator, ==, looks[i][1]);
    }
}

/* ---- Colours ---- */

/* A picture of one row, by way of a file: the header makes no images. */
static NephImage *make_image(const float *values, int n)
{
    g_autofree char *folder = g_dir_make_tmp("nephroid-display-XXXXXX", NULL);
    g_autofree char *path = g_build_filename(folder, "row.pfm", NULL);
    GString *text = g_string_new(NULL);
    g_string_printf(text, "PF\n%d 1\n-1.0\n", n / 3);
    g_string_append_len(text, (const char *)values, (gssize)(n * (int)sizeof(float)));
    g_assert_true(g_file_set_contents(path, text->str, (gssize)text->len, NULL));
    g_string_free(text, TRUE);
    g_autoptr(GError) error = NULL;
    NephImage *image = neph_image_read(path, &error);
    g_assert_no_error(error);
    g_unlink(path);
    g_rmdir(folder);
    return image;
}

static const uint32_t *surface_row(cairo_surface_t *surface)
{
    g_assert_nonnull(surface);
    return (const uint32_t *)(const void *)cairo_image_surface_get_data(surface);
}

static void test_tones(void)
{
    const float values[] = {0.0f, 0.5f, 1.0f, 0.18f,    0.25f, 4.0f,
                            NAN,  1.0f, 0.0f, INFINITY, 1.0f,  1.0f};
    g_autoptr(NephImage) image = make_image(values, G_N_ELEMENTS(values));
    display_options o = display_defaults();
    cairo_surface_t *surface = display_surface(image, &o);
    const uint32_t *row = surface_row(surface);
    const double expected[6] = {0.0, 187.5, 255.0, 117.6, 136.9, 255.0};
    for (int i = 0; i < 6; i++) {
        int byte = (int)(row[i / 3] >> (16 - 8 * (i % 3)) & 255u);
        g_assert_cmpfloat_with_epsilon((double)byte, expected[i], 1.01);
    }
    g_assert_cmphex(row[2] & 0xffffffu, ==, 0xff00ff);
    g_assert_cmphex(row[3] & 0xffffffu, ==, 0xffff00);
    cairo_surface_destroy(surface);
}

/* Every curve rises, and more exposure is never darker. */
static void test_curves(void)
{
    float values[3 * 64];
    for (int i = 0; i < 3 * 64; i++)
        values[i] = 0.001f * powf(1.15f, (float)(i / 3));
    g_autoptr(NephImage) image = make_image(values, 3 * 64);
    for (int curve = 0; curve < N_TONE_CURVES; curve++) {
        display_options o = display_defaults();
        o.curve = (tone_curve)curve;
        cairo_surface_t *plain = display_surface(image, &o);
        o.exposure = 1.0f;
        cairo_surface_t *brighter = display_surface(image, &o);
        for (int i = 1; i < 64; i++) {
            g_assert_cmpuint(surface_row(plain)[i], >=, surface_row(plain)[i - 1]);
            g_assert_cmpuint(surface_row(brighter)[i], >=, surface_row(plain)[i]);
        }
        cairo_surface_destroy(plain);
        cairo_surface_destroy(brighter);
    }
}

static void test_layers(void)
{
    const float values[] = {1.0f, 2.0f, 3.0f};
    g_autoptr(NephImage) image = make_image(values, 3);
    g_auto(GStrv) layers = display_layers(image);
    int channel[3];
    g_assert_cmpuint(g_strv_length(layers), ==, 1);
    g_assert_true(display_channels(image, "", channel));
    g_assert_false(display_channels(image, "normal", channel));
    display_options o = display_defaults();
    strcpy(o.layer, "normal");
    g_assert_null(display_surface(image, &o));
    static size_t counts[3][256];
    g_assert_cmpuint(display_histogram(image, "", -2.0f, 2.0f, 4, counts), ==, 1);
    g_assert_cmpuint(counts[0][2] + counts[1][3] + counts[2][3], ==, 3);
}

/* ---- Photons ---- */

static photon_cloud *make_cloud(void)
{
    photon_cloud *cloud = g_new0(photon_cloud, 1);
    cloud->n = 3;
    cloud->vertices = g_new0(cloud_vertex, 3);
    cloud->direction = g_malloc0_n(3, sizeof *cloud->direction);
    cloud->rgb = g_malloc0_n(3, sizeof *cloud->rgb);
    cloud->bounces = g_new0(uint8_t, 3);
    for (size_t i = 0; i < 3; i++) {
        cloud->first[i + 1] = i + 1;
        cloud->vertices[i].position[2] = (float)i;
        cloud->direction[i][1] = 1.0f;
        cloud->rgb[i][i] = 0.5f;
        cloud->rgb[i][(i + 1) % 3] = 0.25f;
    }
    return cloud;
}

static void test_cloud(void)
{
    photon_cloud *cloud = make_cloud();
    viewpoint v = make_view(false);
    size_t n, found;
    photon_cloud_color(cloud, COLOR_FLUX);
    for (size_t i = 0; i < 3; i++) {
        g_assert_cmpint(cloud->vertices[i].color[i], ==, 255);
        g_assert_cmpint(cloud->vertices[i].color[(i + 1) % 3], ==, 188);
        g_assert_cmpint(cloud->vertices[i].color[(i + 2) % 3], ==, 0);
    }
    g_autofree cloud_vertex *arrows = photon_cloud_arrows(cloud, 5, 0.5f, &n);
    g_assert_cmpuint(n, ==, 12);
    /* From where it landed to where it came from, where the barbs are. */
    const float along[] = {0.0f, 0.5f, 0.5f, 0.375f, 0.5f, 0.375f};
    for (size_t i = 0; i < G_N_ELEMENTS(along); i++)
        g_assert_cmpfloat_with_epsilon(arrows[i].position[1], along[i], 1e-6f);
    for (int k = 0; k < 3; k++)
        cloud->rgb[1][k] *= 0.5f;
    photon_cloud_color(cloud, COLOR_POWER);
    g_assert_cmpint(cloud->vertices[0].color[0], ==, 255);
    g_assert_cmpint(cloud->vertices[1].color[1], ==, 188); /* 0.25 of 0.5 */
    g_assert_cmpint(cloud->vertices[1].color[2], ==, 137);
    const double middle[2] = {0.5, 0.5}, aside[2] = {0.7, 0.5};
    g_assert_true(photon_cloud_pick(cloud, 7, &v.camera, middle, 0.02, &found));
    g_assert_cmpuint(found, ==, 0);
    g_assert_true(photon_cloud_pick(cloud, 6, &v.camera, middle, 0.02, &found));
    g_assert_cmpuint(found, ==, 1);
    g_assert_false(photon_cloud_pick(cloud, 7, &v.camera, aside, 0.02, &found));
    photon_cloud_free(cloud);
}

/* ---- Messages ---- */

static void test_error_places(void)
{
    g_autoptr(GArray) places = error_places(
        "a b.pbrt:12:7: expected x: found y\nno place at all\nc:3: only a line");
    g_assert_cmpuint(places->len, ==, 3);
    const error_place *p = &g_array_index(places, error_place, 0);
    g_assert_cmpstr(p->file, ==, "a b.pbrt");
    g_assert_cmpint(p->line, ==, 12);
    g_assert_cmpint(p->column, ==, 7);
    g_assert_cmpstr(p->message, ==, "expected x: found y");
    g_assert_null(p->source);
    g_assert_null(p[1].file);
    g_assert_cmpint(p[2].line, ==, 3);
    g_assert_cmpint(p[2].column, ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/viewpoint/orbit", test_orbit);
    g_test_add_func("/viewpoint/directions", test_directions);
    g_test_add_func("/viewpoint/dolly", test_dolly);
    g_test_add_func("/viewpoint/frame", test_frame);
    g_test_add_func("/viewpoint/preview", test_preview);
    g_test_add_func("/viewpoint/preview-integrator", test_preview_integrator);
    g_test_add_func("/viewpoint/tones", test_tones);
    g_test_add_func("/viewpoint/curves", test_curves);
    g_test_add_func("/viewpoint/layers", test_layers);
    g_test_add_func("/viewpoint/cloud", test_cloud);
    g_test_add_func("/viewpoint/error-places", test_error_places);
    return g_test_run();
}
