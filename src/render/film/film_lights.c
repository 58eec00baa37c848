#include "render/film/film_lights.h"

#include "render/film/film_halves.h"

/* What guides say of them: by mirrors. @return the weight of the samples that see any */
static double add_mirrored(const guide_sum *guides, double sum[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += (double)guides->lights[c];
    return (double)guides->lit;
}

float film_lights_in_sight(const film *f, size_t pixel, float rgb[3])
{
    size_t from[4];
    film_sum sum = {0};
    double lit = 0.0, *seen = sum.color[LAYER_EMISSION];
    for (int k = 0, n = film_pixels_for(f, pixel, from); k < n; k++) {
        film_add_pixel(f, from[k], &sum);
        lit += add_mirrored(&f->halves[from[k]].guides, seen);
        if (film_pass_counts(f, from[k]))
            lit += add_mirrored(&f->pass_guides[from[k]], seen);
    }
    film_to_rgb(f, seen, sum.weight, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= f->scale;
    return fabs(sum.weight) > 0.0 ? (float)(lit / sum.weight) : 0.0f;
}

/* But for rounding. */
#define ALL 0.999f

static bool is_beside_full(const film *f, size_t pixel)
{
    const int width = f->width;
    int x = (int)(pixel % (size_t)width), y = (int)(pixel / (size_t)width);
    float rgb[3];
    for (int v = MAX(y - 1, 0); v <= MIN(y + 1, f->height - 1); v++)
        for (int u = MAX(x - 1, 0); u <= MIN(x + 1, width - 1); u++) {
            size_t beside = (size_t)v * (size_t)width + (size_t)u;
            if (film_lights_in_sight(f, beside, rgb) >= ALL)
                return true;
        }
    return false;
}

void film_lights(const film *f, size_t pixel, float rgba[4])
{
    float share = film_lights_in_sight(f, pixel, rgba);
    bool is_edge = share > 0.0f && share < ALL && is_beside_full(f, pixel);
    rgba[3] = is_edge ? share : share > 0.0f ? 1.0f : 0.0f;
}
