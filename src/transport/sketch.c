#include "transport/sketch.h"

#include "transport/work.h"

struct sketch {
    point_set *places;
    float *brightness;
    double mean;
};

static vec3 on_film(vec2 raster)
{
    return vec3_make(raster.x, raster.y, 0.0f);
}

sketch *sketch_new(const vec2 *places, const float *brightness, size_t n, GError **error)
{
    sketch *s = g_new0(sketch, 1);
    vec3 *points = g_aligned_alloc0(n, sizeof *points, 16);
    for (size_t i = 0; i < n; i++) {
        points[i] = on_film(places[i]);
        s->mean += (double)brightness[i] / (double)n;
    }
    s->brightness = g_memdup2(brightness, n * sizeof *brightness);
    s->places = point_set_build(points, n, 1, error);
    g_aligned_free(points);
    if (s->places)
        return s;
    sketch_free(s);
    return NULL;
}

void sketch_free(sketch *s)
{
    if (!s)
        return;
    point_set_free(s->places);
    g_free(s->brightness);
    g_free(s);
}

double sketch_weight(const sketch *s, vec2 raster, size_t but, point_hits *hits)
{
    double sum = 0.0, n = 0.0;
    if (!point_set_nearest(s->places, on_film(raster), LEAST_TRIALS, INFINITY, hits))
        return 0.0;
    for (size_t i = 0; i < hits->n; i++)
        if (hits->index[i] != but) {
            sum += (double)s->brightness[hits->index[i]];
            n++;
        }
    return relative_weight(sum / fmax(n, 1.0), s->mean);
}
