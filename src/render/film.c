#include "render/film.h"

#include "base/memory.h"

static const char *const layer_names[FILM_COLORS] = {"direct",   "indirect", "caustic",
                                                     "specular", "emission", "albedo"};

bool film_open(film *f, const scene *s, GError **error)
{
    const film_settings *how = &s->film;
    int x1 = (int)ceilf(how->crop[1] * (float)how->width);
    int y1 = (int)ceilf(how->crop[3] * (float)how->height);
    *f = (film){
        .x0 = (int)ceilf(how->crop[0] * (float)how->width),
        .y0 = (int)ceilf(how->crop[2] * (float)how->height),
        .scale = scene_imaging_ratio(s),
        .space = how->space ? how->space : color_space_srgb(),
    };
    f->width = x1 - f->x0;
    f->height = y1 - f->y0;
    if (f->width < 1 || f->height < 1) {
        error_set(error, ERROR_INPUT, "the crop window leaves no pixel of %d x %d",
                  how->width, how->height);
        return false;
    }
    f->pixels = big_alloc((size_t)f->width * (size_t)f->height, sizeof *f->pixels,
                          "the film", error);
    return f->pixels != NULL;
}

void film_clear(film *f)
{
    big_free(f->pixels);
    *f = (film){0};
}

film_pass film_pass_for(const wavelengths *w)
{
    g_autoptr(curve) d65 = curve_named("stdillum-D65");
    return (film_pass){w, curve_eval(d65, w) / curve_photometric(d65)};
}

static void add_color(double sum[3], const wavelengths *w, spectrum radiance,
                      float weight)
{
    float xyz[3];
    spectrum_to_xyz(w, radiance, xyz);
    for (int i = 0; i < 3; i++)
        sum[i] += (double)(xyz[i] * weight);
}

void film_add(film *f, const film_pass *pass, int x, int y, const radiance_sample *sample,
              float weight)
{
    film_pixel *pixel =
        &f->pixels[(size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0)];
    for (int i = 0; i < N_LAYERS; i++)
        add_color(pixel->color[i], pass->w, sample->layers[i], weight);
    pixel->weight += (double)weight;
    if (!(sample->depth > 0.0f))
        return;
    add_color(pixel->color[N_LAYERS], pass->w, sample->albedo * pass->white, weight);
    for (int i = 0; i < 3; i++)
        pixel->normal[i] += (double)(sample->normal[i] * weight);
    pixel->depth += (double)(sample->depth * weight);
    pixel->surface_weight += (double)weight;
}

/* ---- The picture ---- */

/* Channel names: R G B, then layer.R ..., normal.X ..., depth.Z. */
static GPtrArray *channel_names(void)
{
    GPtrArray *names = g_ptr_array_new_with_free_func(g_free);
    for (const char *c = "RGB"; *c; c++)
        g_ptr_array_add(names, g_strdup_printf("%c", *c));
    for (int i = 0; i < FILM_COLORS; i++) {
        for (const char *c = "RGB"; *c; c++)
            g_ptr_array_add(names, g_strdup_printf("%s.%c", layer_names[i], *c));
    }
    for (const char *c = "XYZ"; *c; c++)
        g_ptr_array_add(names, g_strdup_printf("normal.%c", *c));
    g_ptr_array_add(names, g_strdup("depth.Z"));
    return names;
}

static void to_rgb(const film *f, const double sum[3], double weight, float out[3])
{
    float xyz[3] = {0};
    for (int i = 0; i < 3 && fabs(weight) > 0.0; i++)
        xyz[i] = (float)(sum[i] / weight);
    color_space_from_xyz(f->space, xyz, out);
}

static void write_pixel(const film *f, const film_pixel *pixel, float *out)
{
    float *beauty = out, *layers = out + 3;
    for (int i = 0; i < FILM_COLORS; i++) {
        bool is_albedo = i == N_LAYERS;
        float *rgb = layers + 3 * i;
        to_rgb(f, pixel->color[i], is_albedo ? pixel->surface_weight : pixel->weight,
               rgb);
        for (int c = 0; c < 3 && !is_albedo; c++) {
            rgb[c] *= f->scale;
            beauty[c] += rgb[c];
        }
    }
    float *rest = layers + 3 * FILM_COLORS;
    double weight = fabs(pixel->surface_weight) > 0.0 ? pixel->surface_weight : 1.0;
    for (int i = 0; i < 3; i++)
        rest[i] = (float)(pixel->normal[i] / weight);
    rest[3] = (float)(pixel->depth / weight);
}

image *film_image(const film *f, GError **error)
{
    g_autoptr(GPtrArray) names = channel_names();
    image *img = image_new(f->width, f->height, (int)names->len,
                           (const char *const *)names->pdata, error);
    if (!img)
        return NULL;
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++)
        write_pixel(f, &f->pixels[i], img->pixels + i * names->len);
    color_space_chromaticities(f->space, img->chromaticities);
    image_header_set(img, "colorSpace", color_space_name(f->space));
    return img;
}
