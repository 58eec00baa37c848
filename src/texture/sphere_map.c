#include "texture/sphere_map.h"

#include "base/memory.h"
#include "base/wanted.h"

#include <glib.h>

typedef struct sphere_layout {
    const char *name;
    picture_wrap wrap;
    vec2 (*to_square)(vec3 d);
    vec3 (*to_sphere)(vec2 st);
    /* Solid angle per area of the unit square, mean over a band of rows. */
    float (*stretch)(float t0, float t1);
} sphere_layout;

/* ---- Equal-area ---- */

vec3 equal_area_to_sphere(vec2 st)
{
    float x = 2.0f * st.x - 1.0f, y = 2.0f * st.y - 1.0f;
    float ax = fabsf(x), ay = fabsf(y), inside = 1.0f - (ax + ay);
    float r = 1.0f - fabsf(inside);
    float phi = 0.25f * PI_F * (r > 0.0f ? (ay - ax) / r + 1.0f : 1.0f);
    float z = copysignf(1.0f - r * r, inside);
    float across = r * sqrtf(maxf(0.0f, 2.0f - r * r));
    return vec3_make(copysignf(cosf(phi), x) * across, copysignf(sinf(phi), y) * across,
                     z);
}

vec2 equal_area_to_square(vec3 d)
{
    float ax = fabsf(d[0]), ay = fabsf(d[1]);
    /* 1 - |z|, by way of the other two where that would lose digits. */
    float rest = (ax * ax + ay * ay) / (1.0f + fabsf(d[2]));
    float r = sqrtf(minf(rest, 1.0f));
    float phi = ax > 0.0f || ay > 0.0f ? atan2f(ay, ax) * 2.0f * INV_PI_F : 0.0f;
    float y = phi * r, x = r - y;
    if (d[2] < 0.0f) {
        float swapped = 1.0f - y;
        y = 1.0f - x;
        x = swapped;
    }
    return (vec2){0.5f * (copysignf(x, d[0]) + 1.0f), 0.5f * (copysignf(y, d[1]) + 1.0f)};
}

static float square_stretch(float t0, float t1)
{
    (void)t0, (void)t1;
    return 4.0f * PI_F;
}

static const sphere_layout equal_area = {"equal-area", WRAP_OCTAHEDRAL,
                                         equal_area_to_square, equal_area_to_sphere,
                                         square_stretch};

/* ---- Latitude-longitude ---- */

static vec3 latlong_to_sphere(vec2 st)
{
    float theta = PI_F * st.y, phi = 2.0f * PI_F * st.x, sine = sinf(theta);
    return vec3_make(sine * cosf(phi), sine * sinf(phi), cosf(theta));
}

static vec2 sphere_to_latlong(vec3 d)
{
    float phi = atan2f(d[1], d[0]) * 0.5f * INV_PI_F;
    float theta = atan2f(sqrtf(d[0] * d[0] + d[1] * d[1]), d[2]);
    return (vec2){phi < 0.0f ? phi + 1.0f : phi, theta * INV_PI_F};
}

/* ∫ sin over the band, over its width: 2 sin of the middle times sin of half the width.
 */
static float latlong_stretch(float t0, float t1)
{
    float half = 0.5f * PI_F * (t1 - t0), middle = 0.5f * PI_F * (t0 + t1);
    float sine = half > 1e-4f ? sinf(half) / half : 1.0f;
    return 2.0f * PI_F * PI_F * maxf(sinf(middle), 1e-7f) * sine;
}

static const sphere_layout latlong = {"latitude-longitude", WRAP_LATLONG,
                                      sphere_to_latlong, latlong_to_sphere,
                                      latlong_stretch};

/* ---- Building ---- */

static const sphere_layout *find_layout(const texels *img)
{
    float ratio = (float)img->width / (float)img->height;
    if (img->width == img->height)
        return &equal_area;
    return ratio > 1.95f && ratio < 2.05f ? &latlong : NULL;
}

static float mean_rgb(const float rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) * (1.0f / 3.0f);
}

static float row_stretch(const sphere_map *map, int y)
{
    float n = (float)map->pic->levels[0]->height;
    return map->layout->stretch((float)y / n, ((float)y + 1.0f) / n);
}

static bool build(sphere_map *map, source_place place, GError **error)
{
    const texels *img = map->pic->levels[0];
    size_t width = (size_t)img->width, height = (size_t)img->height;
    float *weights = big_alloc(width * height, sizeof *weights, "a light", error);
    if (!weights)
        return false;
    for (int y = 0; y < img->height && still_wanted(NULL); y++)
        for (int x = 0; x < img->width; x++) {
            float rgb[3];
            picture_texel_mean(map->pic, map->layout->wrap, x, y, rgb);
            weights[(size_t)y * width + (size_t)x] = row_stretch(map, y) * mean_rgb(rgb);
        }
    bool done = distribution2_init(&map->drawn, weights, width, height, error);
    big_free(weights);
    if (!done)
        return false;
    map->integral = distribution2_mean(&map->drawn);
    if (map->integral > 0.0 && isfinite(map->integral))
        return true;
    error_at(error, place, "the light's image is black");
    return false;
}

bool sphere_map_init(sphere_map *map, picture *taken, source_place place, GError **error)
{
    *map = (sphere_map){.pic = taken};
    if (!taken)
        return false;
    const texels *img = map->pic->levels[0];
    map->layout = find_layout(img);
    if (!map->layout)
        error_at(error, place,
                 "expected a square image (an equal-area map) or one twice as wide as "
                 "high (latitude-longitude), found %d x %d",
                 img->width, img->height);
    else if (build(map, place, error))
        return true;
    sphere_map_clear(map);
    return false;
}

void sphere_map_clear(sphere_map *map)
{
    picture_unref(map->pic);
    distribution2_clear(&map->drawn);
    *map = (sphere_map){0};
}

const char *sphere_map_layout(const sphere_map *map)
{
    return map->layout->name;
}

/* ---- Asking ---- */

void sphere_map_rgb(const sphere_map *map, vec3 d, float rgb[3])
{
    texel_mix mix =
        picture_bilinear(map->pic, 0, map->layout->to_square(d), map->layout->wrap);
    picture_rgb(map->pic, &mix, rgb);
}

/* Density over the sphere of a point of the square: the sine of its very own row. */
static float over_sphere(const sphere_map *map, vec2 st, float pdf)
{
    return pdf / map->layout->stretch(st.y, st.y);
}

vec3 sphere_map_sample(const sphere_map *map, vec2 u, float *pdf_solid_angle)
{
    float pdf;
    vec2 st = distribution2_sample(&map->drawn, u, &pdf);
    *pdf_solid_angle = over_sphere(map, st, pdf);
    return map->layout->to_sphere(st);
}

float sphere_map_pdf(const sphere_map *map, vec3 d)
{
    vec2 st = map->layout->to_square(d);
    return over_sphere(map, st, distribution2_pdf(&map->drawn, st));
}

enum { MAX_PARTS = 128 };

/* The mean over a block of texels, rows weighed by their solid angle. */
static float block_mean(const sphere_map *map, const int box[4], float rgb[3])
{
    const texels *img = map->pic->levels[0];
    double sum[3] = {0}, weight = 0.0;
    for (int y = box[2]; y < box[3] && still_wanted(NULL); y++)
        for (int x = box[0]; x < box[1]; x++) {
            vec2 st = {((float)x + 0.5f) / (float)img->width,
                       ((float)y + 0.5f) / (float)img->height};
            texel_mix mix = picture_nearest(map->pic, 0, st, WRAP_CLAMP);
            double w = (double)row_stretch(map, y);
            float texel[3];
            picture_rgb(map->pic, &mix, texel);
            for (int c = 0; c < 3; c++)
                sum[c] += w * (double)texel[c];
            weight += w;
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / weight);
    return (float)(weight / ((double)img->width * img->height));
}

void sphere_map_parts(const sphere_map *map, sphere_part tell, void *data)
{
    const texels *img = map->pic->levels[0];
    int nx = MIN(img->width, MAX_PARTS), ny = MIN(img->height, MAX_PARTS);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            const int box[4] = {i * img->width / nx, (i + 1) * img->width / nx,
                                j * img->height / ny, (j + 1) * img->height / ny};
            vec2 middle = {0.5f * (float)(box[0] + box[1]) / (float)img->width,
                           0.5f * (float)(box[2] + box[3]) / (float)img->height};
            float rgb[3], solid_angle = block_mean(map, box, rgb);
            tell(data, map->layout->to_sphere(middle), rgb, solid_angle);
        }
}
