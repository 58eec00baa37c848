#include "transport/sketch.h"

#include "transport/work.h"

/* Light at places of the film. */
typedef struct light_layer {
    point_set *places; /* NULL: there is none */
    float *brightness;
    double mean;
} light_layer;

struct sketch {
    light_layer paths, caustics;
};

static vec3 on_film(vec2 raster)
{
    return vec3_make(raster.x, raster.y, 0.0f);
}

/* Of n places of n_all, where the others are black. */
static bool layer_fill(light_layer *layer, const vec2 *places, const float *brightness,
                       size_t n, size_t n_all, GError **error)
{
    vec3 *points = g_aligned_alloc0(n, sizeof *points, 16);
    for (size_t i = 0; i < n; i++) {
        points[i] = on_film(places[i]);
        layer->mean += (double)brightness[i] / (double)n_all;
    }
    layer->brightness = g_memdup2(brightness, n * sizeof *brightness);
    layer->places = point_set_build(points, n, 1, error);
    g_aligned_free(points);
    return layer->places;
}

static void layer_clear(light_layer *layer)
{
    g_clear_pointer(&layer->places, point_set_free);
    g_clear_pointer(&layer->brightness, g_free);
}

sketch *sketch_new(const vec2 *places, const float *brightness, size_t n, GError **error)
{
    sketch *s = g_new0(sketch, 1);
    if (layer_fill(&s->paths, places, brightness, n, n, error))
        return s;
    sketch_free(s);
    return NULL;
}

bool sketch_add_caustics(sketch *s, const vec2 *places, const float *brightness, size_t n,
                         size_t n_all, GError **error)
{
    return layer_fill(&s->caustics, places, brightness, n, n_all, error);
}

void sketch_free(sketch *s)
{
    if (!s)
        return;
    layer_clear(&s->paths);
    layer_clear(&s->caustics);
    g_free(s);
}

/* The mean of the nearest places but one. */
static double around(const light_layer *layer, vec2 raster, size_t but, point_hits *hits)
{
    double sum = 0.0, n = 0.0;
    if (!layer->places ||
        !point_set_nearest(layer->places, on_film(raster), LEAST_TRIALS, INFINITY, hits))
        return 0.0;
    for (size_t i = 0; i < hits->n; i++)
        if (hits->index[i] != but) {
            sum += (double)layer->brightness[hits->index[i]];
            n++;
        }
    return sum / fmax(n, 1.0);
}

double sketch_weight(const sketch *s, vec2 raster, size_t but, point_hits *hits)
{
    double here = around(&s->paths, raster, but, hits) +
                  around(&s->caustics, raster, SIZE_MAX, hits);
    return relative_weight(here, s->paths.mean + s->caustics.mean);
}
