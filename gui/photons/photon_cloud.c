#include "photons/photon_cloud.h"

#include <math.h>
#include <string.h>

const char *const cloud_coloring_names[] = {"Flux", "Map", "Bounces", "Power", NULL};

static const uint8_t map_colors[NEPH_N_PHOTON_CLASSES][4] = {
    {255, 210, 90, 255}, {95, 170, 255, 255}, {255, 95, 160, 255}};

static const uint8_t bounce_colors[N_BOUNCE_COLORS][4] = {
    {255, 240, 180, 255}, {255, 190, 80, 255}, {245, 120, 60, 255}, {210, 70, 110, 255},
    {140, 80, 190, 255},  {85, 110, 220, 255}, {60, 170, 200, 255}};

void photon_cloud_map_color(int c, uint8_t color[4])
{
    memcpy(color, map_colors[c], 4);
}

void photon_cloud_bounce_color(size_t bounces, uint8_t color[4])
{
    memcpy(color, bounce_colors[MIN(bounces, N_BOUNCE_COLORS - 1)], 4);
}

/* Linear, 0..1 in steps fine enough for eight bits, to the screen's: a million photons
   are coloured while the window waits. */
enum { CURVE_STEPS = 8192 };

static void fill_curve(uint8_t curve[CURVE_STEPS + 1])
{
    for (int i = 0; i <= CURVE_STEPS; i++) {
        float x = (float)i / CURVE_STEPS;
        float y = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
        curve[i] = (uint8_t)(255.0f * fminf(y, 1.0f) + 0.5f);
    }
}

static float largest_component(const float rgb[3])
{
    return fmaxf(fmaxf(rgb[0], rgb[1]), fmaxf(rgb[2], 1e-30f));
}

/* The faintest photons are still to be seen on the dark background. */
#define LEAST_LEVEL 0.04f

/* most: what is shown as full. */
static void flux_color(const uint8_t *curve, const float rgb[3], float most,
                       uint8_t color[4])
{
    float own = largest_component(rgb);
    most = fminf(most, own / LEAST_LEVEL);
    for (int k = 0; k < 3; k++)
        color[k] =
            curve[(int)(CURVE_STEPS * fminf(fmaxf(rgb[k] / most, 0.0f), 1.0f) + 0.5f)];
    color[3] = 255;
}

void photon_cloud_color(photon_cloud *cloud, cloud_coloring coloring)
{
    uint8_t curve[CURVE_STEPS + 1];
    fill_curve(curve);
    cloud->coloring = coloring;
    float most = 0.0f;
    for (size_t i = 0; i < cloud->n; i++)
        most = fmaxf(most, largest_component(cloud->rgb[i]));
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        for (size_t i = cloud->first[c]; i < cloud->first[c + 1]; i++) {
            uint8_t *color = cloud->vertices[i].color;
            if (coloring == COLOR_FLUX)
                flux_color(curve, cloud->rgb[i], largest_component(cloud->rgb[i]), color);
            else if (coloring == COLOR_POWER)
                flux_color(curve, cloud->rgb[i], most, color);
            else if (coloring == COLOR_MAP)
                photon_cloud_map_color(c, color);
            else
                photon_cloud_bounce_color(cloud->bounces[i], color);
        }
}

photon_cloud *photon_cloud_new(const NephPhotons *photons)
{
    photon_cloud *cloud = g_new0(photon_cloud, 1);
    size_t n = cloud->n = neph_photons_count(photons);
    cloud->vertices = g_new(cloud_vertex, n);
    cloud->direction = g_malloc_n(n, sizeof *cloud->direction);
    cloud->rgb = g_malloc_n(n, sizeof *cloud->rgb);
    cloud->bounces = g_new(uint8_t, n);
    for (size_t i = 0; i < n; i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        memcpy(cloud->vertices[i].position, p.position, sizeof p.position);
        memcpy(cloud->direction[i], p.direction, sizeof p.direction);
        memcpy(cloud->rgb[i], p.rgb, sizeof p.rgb);
        cloud->bounces[i] = (uint8_t)MIN(p.bounces, 255);
        for (int c = (int)p.photon_class; c < NEPH_N_PHOTON_CLASSES; c++)
            cloud->first[c + 1] = i + 1;
    }
    photon_cloud_color(cloud, COLOR_FLUX);
    return cloud;
}

void photon_cloud_free(photon_cloud *cloud)
{
    if (!cloud)
        return;
    g_free(cloud->vertices);
    g_free(cloud->direction);
    g_free(cloud->rgb);
    g_free(cloud->bounces);
    g_free(cloud);
}

size_t photon_cloud_count(const photon_cloud *cloud, unsigned mask)
{
    size_t n = 0;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        n += mask & (1u << c) ? cloud->first[c + 1] - cloud->first[c] : 0;
    return n;
}

/* ---- Order ---- */

static size_t common_divisor(size_t a, size_t b)
{
    while (b > 0) {
        size_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Steps of the golden section through the photons, which lie as they were stored: no two
   beginnings leave a gap much larger than another (the three-distance theorem). */
static void put_mixed(cloud_vertex *out, const cloud_vertex *in, size_t n)
{
    size_t step = MAX((size_t)(0.6180339887498949 * (double)n), 1), at = 0;
    while (common_divisor(step, n) > 1)
        step++;
    for (size_t i = 0; i < n; i++) {
        out[i] = in[at];
        at = (at + step) % n;
    }
}

cloud_vertex *photon_cloud_mixed(const photon_cloud *cloud)
{
    cloud_vertex *mixed = g_new(cloud_vertex, cloud->n);
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        size_t first = cloud->first[c], n = cloud->first[c + 1] - first;
        if (n > 0)
            put_mixed(mixed + first, cloud->vertices + first, n);
    }
    return mixed;
}

/* ---- Arrows ---- */

enum { ARROW_VERTICES = 6 };

/* A shaft and two barbs: the head is toward where the photon came from. */
static void put_arrow(cloud_vertex *out, const cloud_vertex *at, const float d[3],
                      float length)
{
    float side[3] = {d[1], -d[0], 0.0f};
    if (fabsf(d[2]) > 0.9f) {
        side[0] = 0.0f;
        side[1] = d[2];
        side[2] = -d[1];
    }
    float norm = length / sqrtf(side[0] * side[0] + side[1] * side[1] +
                                side[2] * side[2] + 1e-20f);
    for (int i = 0; i < ARROW_VERTICES; i++)
        out[i] = *at;
    for (int k = 0; k < 3; k++) {
        for (int tip = 1; tip < ARROW_VERTICES; tip += tip == 1 ? 1 : 2)
            out[tip].position[k] += length * d[k];
        out[3].position[k] += 0.75f * length * d[k] + 0.1f * norm * side[k];
        out[5].position[k] += 0.75f * length * d[k] - 0.1f * norm * side[k];
    }
}

cloud_vertex *photon_cloud_arrows(const photon_cloud *cloud, unsigned mask, float length,
                                  size_t *n)
{
    *n = ARROW_VERTICES * photon_cloud_count(cloud, mask);
    cloud_vertex *arrows = g_new(cloud_vertex, *n), *out = arrows;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        for (size_t i = cloud->first[c]; i < cloud->first[c + 1]; i++) {
            if (!(mask & (1u << c)))
                break;
            put_arrow(out, &cloud->vertices[i], cloud->direction[i], length);
            out += ARROW_VERTICES;
        }
    return arrows;
}

/* ---- Picking ---- */

static double depth_of(const NephCamera *camera, const double p[3])
{
    double depth = 0.0;
    for (int i = 0; i < 3; i++)
        depth += (p[i] - camera->position[i]) * camera->direction[i];
    return depth;
}

bool photon_cloud_pick(const photon_cloud *cloud, unsigned mask, const NephCamera *camera,
                       const double place[2], double reach, size_t *index)
{
    double nearest = (double)INFINITY;
    double aspect =
        (camera->screen[1] - camera->screen[0]) / (camera->screen[3] - camera->screen[2]);
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        for (size_t i = cloud->first[c]; i < cloud->first[c + 1]; i++) {
            const float *at = cloud->vertices[i].position;
            const double p[3] = {(double)at[0], (double)at[1], (double)at[2]};
            double x, y;
            if (!(mask & (1u << c)))
                break;
            if (!neph_camera_project(camera, p, &x, &y) ||
                hypot((x - place[0]) * aspect, y - place[1]) > reach)
                continue;
            double depth = depth_of(camera, p);
            if (depth < nearest) {
                nearest = depth;
                *index = i;
            }
        }
    return isfinite(nearest);
}
