#include "photon_picture.h"

#include <math.h>
#include <string.h>

/* Drawn in so many pixels a side for each of the picture's. */
enum { FINER = 2 };
/* Fewer photons are arrows; line segments of the wireframe, at most. */
enum { MOST_ARROWS = 1000, MOST_EDGES = 200000 };
/* Sides of points in pixels of the picture, and of those where arrows begin. */
enum { POINT_SIZE = 2, ARROW_FOOT = 4 };

/* Length of an arrow, as share of the scene's extent. */
#define ARROW_SHARE 0.05
/* Nearest that anything is drawn, as the same. */
#define NEAR_SHARE 1e-3

static const float background[3] = {0.010f, 0.010f, 0.011f};
static const float wire_color[3] = {0.16f, 0.16f, 0.16f};

typedef struct drawing {
    NephCamera camera;
    double extent; /* of the scene, m */
    int width, height;
    float *rgb, *depth;
} drawing;

typedef struct drawn_point {
    double x, y, depth; /* pixels, m */
} drawn_point;

static double depth_of(const drawing *d, const double p[3])
{
    double depth = 0.0;
    for (int i = 0; i < 3; i++)
        depth += (p[i] - d->camera.position[i]) * d->camera.direction[i];
    return depth;
}

static drawn_point place(const drawing *d, const double p[3])
{
    drawn_point at = {.depth = depth_of(d, p)};
    neph_camera_project(&d->camera, p, &at.x, &at.y);
    at.x *= d->width;
    at.y *= d->height;
    return at;
}

static void put_pixel(drawing *d, int x, int y, double depth, const float color[3])
{
    if (x < 0 || y < 0 || x >= d->width || y >= d->height)
        return;
    size_t i = (size_t)y * (size_t)d->width + (size_t)x;
    if ((float)depth > d->depth[i])
        return;
    d->depth[i] = (float)depth;
    memcpy(d->rgb + 3 * i, color, 3 * sizeof *color);
}

/* A disc of so many pixels of the picture across. */
static void put_point(drawing *d, const double p[3], int size, const float color[3])
{
    drawn_point at = place(d, p);
    double r = 0.5 * size * FINER;
    if (at.depth < NEAR_SHARE * d->extent || fabs(at.x) > 1e6 || fabs(at.y) > 1e6)
        return;
    for (int y = (int)floor(at.y - r); y <= (int)(at.y + r); y++)
        for (int x = (int)floor(at.x - r); x <= (int)(at.x + r); x++)
            if (hypot(x + 0.5 - at.x, y + 0.5 - at.y) <= r)
                put_pixel(d, x, y, at.depth, color);
}

/* Cuts a segment where it comes too near. @return false: nothing is left */
static bool clip_near(const drawing *d, double a[3], double b[3])
{
    double near = NEAR_SHARE * d->extent, da = depth_of(d, a), db = depth_of(d, b);
    if (da < near && db < near)
        return false;
    double *out = da < near ? a : b;
    if (da >= near && db >= near)
        return true;
    double t = (near - da) / (db - da);
    for (int i = 0; i < 3; i++)
        out[i] = a[i] + t * (b[i] - a[i]);
    return true;
}

static void put_line(drawing *d, const double from[3], const double to[3],
                     const float color[3])
{
    double ends[2][3];
    memcpy(ends[0], from, sizeof ends[0]);
    memcpy(ends[1], to, sizeof ends[1]);
    if (!clip_near(d, ends[0], ends[1]))
        return;
    drawn_point a = place(d, ends[0]), b = place(d, ends[1]);
    double length = fmax(fabs(b.x - a.x), fabs(b.y - a.y));
    int n = (int)fmin(length, 1e5) + 1;
    for (int i = 0; i <= n; i++) {
        double t = (double)i / n, x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
        if (x > -1.0 && y > -1.0 && x < d->width && y < d->height)
            put_pixel(d, (int)floor(x), (int)floor(y), a.depth + t * (b.depth - a.depth),
                      color);
    }
}

static void put_wireframe(drawing *d, const NephScene *scene)
{
    size_t n = 0;
    g_autofree float *ends = neph_scene_wireframe(scene, MOST_EDGES, &n);
    for (size_t i = 0; ends && i < n; i++) {
        double from[3], to[3];
        for (int k = 0; k < 3; k++) {
            from[k] = (double)ends[6 * i + (size_t)k];
            to[k] = (double)ends[6 * i + 3 + (size_t)k];
        }
        put_line(d, from, to, wire_color);
    }
}

/* A shaft with two barbs at its end, toward where the photon came from. */
static void put_arrow(drawing *d, const NephPhoton *p, const double at[3],
                      const float color[3])
{
    double length = ARROW_SHARE * d->extent, w[3], side[3], tip[3], barb[3], norm = 0.0;
    for (int k = 0; k < 3; k++)
        w[k] = (double)p->direction[k];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        side[k] = w[i] * d->camera.direction[j] - w[j] * d->camera.direction[i];
        norm += side[k] * side[k];
        tip[k] = at[k] + length * w[k];
    }
    put_line(d, at, tip, color);
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int k = 0; k < 3; k++)
            barb[k] = at[k] + length * (0.75 * w[k] +
                                        sign * 0.1 * side[k] / sqrt(fmax(norm, 1e-20)));
        put_line(d, tip, barb, color);
    }
}

static bool is_drawn(const NephPhotons *photons, size_t i, unsigned classes,
                     NephPhoton *p)
{
    return neph_photons_get(photons, i, p) && (classes >> p->photon_class & 1u);
}

static void put_photons(drawing *d, const NephPhotons *photons, unsigned classes)
{
    size_t n = neph_photons_count(photons), n_drawn = 0;
    NephPhoton p;
    for (size_t i = 0; i < n; i++)
        n_drawn += is_drawn(photons, i, classes, &p);
    bool arrows = n_drawn < MOST_ARROWS;
    for (size_t i = 0; i < n; i++) {
        if (!is_drawn(photons, i, classes, &p))
            continue;
        float most = fmaxf(fmaxf(p.rgb[0], p.rgb[1]), fmaxf(p.rgb[2], 1e-30f));
        float color[3];
        double at[3];
        for (int k = 0; k < 3; k++) {
            color[k] = fmaxf(p.rgb[k], 0.0f) / most;
            at[k] = (double)p.position[k];
        }
        put_point(d, at, arrows ? ARROW_FOOT : POINT_SIZE, color);
        if (arrows)
            put_arrow(d, &p, at, color);
    }
}

static void begin(drawing *d, const NephScene *scene)
{
    double low[3], high[3], sum = 0.0;
    neph_scene_camera(scene, &d->camera);
    neph_scene_size(scene, &d->width, &d->height);
    if (neph_scene_bounds(scene, low, high))
        for (int i = 0; i < 3; i++)
            sum += (high[i] - low[i]) * (high[i] - low[i]);
    d->extent = sum > 0.0 ? sqrt(sum) : 1.0;
    d->width *= FINER;
    d->height *= FINER;
    size_t n = (size_t)d->width * (size_t)d->height;
    d->rgb = g_new(float, 3 * n);
    d->depth = g_new(float, n);
    for (size_t i = 0; i < n; i++) {
        memcpy(d->rgb + 3 * i, background, sizeof background);
        d->depth[i] = INFINITY;
    }
}

NephImage *photon_picture(const NephScene *scene, const NephPhotons *photons,
                          unsigned classes, GError **error)
{
    drawing d = {0};
    begin(&d, scene);
    put_wireframe(&d, scene);
    put_photons(&d, photons, classes);
    g_autoptr(NephImage) fine = neph_image_new(d.width, d.height, d.rgb, error);
    g_free(d.rgb);
    g_free(d.depth);
    return fine ? neph_image_scale(fine, d.width / FINER, d.height / FINER, error) : NULL;
}
