/*
 * The film directive: pbrt's "rgb" and "gbuffer" films. Every picture has layers of
 * albedo, shading normal, depth and variance; a gbuffer adds pbrt's own (gbuffer.h in
 * src/render), in the camera's space unless it says "world".
 *
 * What has no meaning here is refused with its place rather than dropped: sensors other
 * than cie1931. "diagonal" acts on realistic cameras only, in pbrt too, and those are
 * refused by the camera; "savefp16" asks for less than the float images that are written.
 */
#include "scene/scene_film.h"
#include "color/balance.h"
#include "scene/scene.h"

#include <string.h>

enum { SIDE_MAX = 65536 };

static bool read_size(const params *p, const char *name, int *out, GError **error)
{
    if (!params_integer(p, name, out, error))
        return false;
    if (*out >= 1 && *out <= SIDE_MAX)
        return true;
    error_at(error, params_find(p, name)->place, "%s must be 1..%d pixels, found %d",
             name, SIDE_MAX, *out);
    return false;
}

static bool read_number_above_zero(const params *p, const char *name, float *out,
                                   GError **error)
{
    if (!params_float(p, name, out, error))
        return false;
    if (*out > 0.0f)
        return true;
    error_at(error, params_find(p, name)->place, "%s must be positive, found %g", name,
             (double)*out);
    return false;
}

static bool read_sensor(const params *p, film_settings *film, GError **error)
{
    static const char *const sensors[] = {"cie1931", NULL};
    int sensor = 0;
    if (!params_choice(p, "sensor", sensors, &sensor, error) ||
        !params_float(p, "whitebalance", &film->kelvin, error))
        return false;
    if (fabsf(film->kelvin) > 0.0f &&
        !(film->kelvin >= DAYLIGHT_COLDEST && film->kelvin <= DAYLIGHT_HOTTEST)) {
        error_at(error, params_find(p, "whitebalance")->place,
                 "\"whitebalance\" must be 0 or the temperature of daylight, %g to %g "
                 "kelvin, found %g",
                 (double)DAYLIGHT_COLDEST, (double)DAYLIGHT_HOTTEST,
                 (double)film->kelvin);
        return false;
    }
    return !params_has(p, "maxcomponentvalue") ||
           read_number_above_zero(p, "maxcomponentvalue", &film->most, error);
}

/* What a gbuffer has and other films have not: the space of its layers, and only one kind
 * of file that can hold them. */
static bool read_gbuffer(const params *p, film_settings *film, GError **error)
{
    static const char *const spaces[] = {"camera", "world", NULL};
    int space = 0;
    if (!params_choice(p, "coordinatesystem", spaces, &space, error))
        return false;
    film->gbuffer = true;
    film->in_camera = space == 0;
    if (!film->filename || g_str_has_suffix(film->filename, ".exr"))
        return true;
    error_at(error, params_find(p, "filename")->place,
             "film \"gbuffer\": only an .exr file can hold its layers, found '%s'",
             film->filename);
    return false;
}

/* Half a pixel inside, so that ceil(crop * size) gives the bounds back. */
static bool read_pixel_bounds(const param *given, film_settings *film, GError **error)
{
    const int size[2] = {film->width, film->height};
    bool fits = given->type == PARAM_INTEGER && given->n == 4;
    for (int i = 0; i < 2 && fits; i++) {
        int low = given->integers[2 * i], high = given->integers[2 * i + 1];
        fits = low >= 0 && low < high && high <= size[i];
        film->crop[2 * i] = maxf(0.0f, ((float)low - 0.5f) / (float)size[i]);
        film->crop[2 * i + 1] = ((float)high - 0.5f) / (float)size[i];
    }
    if (!fits)
        error_at(error, given->place,
                 "\"pixelbounds\" needs four integers x0 x1 y0 y1 with 0 <= x0 < x1 <= "
                 "%d and 0 <= y0 < y1 <= %d",
                 size[0], size[1]);
    return fits;
}

static bool read_crop_window(const param *given, film_settings *film, GError **error)
{
    bool fits = given->type == PARAM_FLOAT && given->n == 4;
    for (int i = 0; i < 2 && fits; i++) {
        float low = given->numbers[2 * i], high = given->numbers[2 * i + 1];
        fits = low >= 0.0f && low < high && high <= 1.0f;
        film->crop[2 * i] = low;
        film->crop[2 * i + 1] = high;
    }
    if (!fits)
        error_at(error, given->place,
                 "\"cropwindow\" needs four numbers x0 x1 y0 y1 with 0 <= x0 < x1 <= 1 "
                 "and 0 <= y0 < y1 <= 1");
    return fits;
}

static bool read_crop(const params *p, film_settings *film, GError **error)
{
    const param *window = params_find(p, "cropwindow");
    const param *bounds = params_find(p, "pixelbounds");
    if (window && bounds) {
        error_at(error, bounds->place,
                 "give either \"cropwindow\" or \"pixelbounds\", not both");
        return false;
    }
    if (bounds)
        return read_pixel_bounds(bounds, film, error);
    return !window || read_crop_window(window, film, error);
}

static bool read_film(const params *p, film_settings *film, GError **error)
{
    float diagonal = 35.0f;
    bool save_half = false;
    const char *filename = NULL;
    if (!read_size(p, "xresolution", &film->width, error) ||
        !read_size(p, "yresolution", &film->height, error) ||
        !read_crop(p, film, error) || !read_sensor(p, film, error) ||
        !read_number_above_zero(p, "iso", &film->iso, error) ||
        !read_number_above_zero(p, "diagonal", &diagonal, error) ||
        !params_bool(p, "savefp16", &save_half, error) ||
        !params_string(p, "filename", &filename, error))
        return false;
    film->space = p->space ? p->space : color_space_srgb();
    film->filename = g_strdup(filename);
    return true;
}

film_settings film_default(void)
{
    return (film_settings){.width = 1280,
                           .height = 720,
                           .iso = 100.0f,
                           .crop = {0.0f, 1.0f, 0.0f, 1.0f},
                           .space = color_space_srgb()};
}

#define ALL_FILMS                                                                        \
    "xresolution yresolution cropwindow pixelbounds filename iso whitebalance "          \
    "maxcomponentvalue"
#define IDLE "sensor diagonal savefp16"

static const struct film_kind {
    const char *name, *parameters;
    bool is_gbuffer;
} kinds[] = {
    {"rgb", ALL_FILMS, false},
    {"gbuffer", ALL_FILMS " coordinatesystem", true},
};

const char *film_kind_at(size_t i, const char **parameters, const char **idle)
{
    if (i >= G_N_ELEMENTS(kinds))
        return NULL;
    *parameters = kinds[i].parameters;
    *idle = IDLE;
    return kinds[i].name;
}

static const struct film_kind *find_kind(const char *name, const params *p,
                                         GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    error_at(error, p->place, "film \"%s\" is not supported; known are rgb and gbuffer",
             name);
    return NULL;
}

bool film_init(film_settings *film, const char *name, const params *p, GError **error)
{
    const struct film_kind *kind = find_kind(name, p, error);
    film_settings read = film_default();
    g_autofree char *what = g_strdup_printf("film \"%s\"", name);
    if (kind && params_known(p, what, kind->parameters, IDLE, error) &&
        read_film(p, &read, error) &&
        (!kind->is_gbuffer || read_gbuffer(p, &read, error)) &&
        params_all_used(p, what, error)) {
        *film = read;
        return true;
    }
    g_free(read.filename);
    return false;
}
